/* params_text.c - see params_text.h. */
#include "params_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "ini_lines.h"
#include "params.h"
#include "params_material.h"
#include "sim.h"

enum { LINKS_OF_MATERIAL = 10 };

int params_text_preset(params_text *text, const char *name)
{
    text->preset = rod_preset_find(name);
    if (text->preset != NULL) {
        return SIM_OK;
    }
    char names[200] = "";
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        strcat(strcat(names, i == 0 ? "" : ", "), rod_presets[i].name);
    }
    return sim_complain("--preset %s: there is no such preset; there are %s", name, names);
}

static int unknown_key(const char *origin, const char *key)
{
    char names[400] = "";
    for (int i = 0; i < PARAMS_KEYS_N; i++) {
        if (params_key_is_settable(i)) {
            strcat(strcat(names, *names == '\0' ? "" : ", "), params_key_at(i).name);
        }
    }
    return sim_complain("%s: unknown key '%.40s'; there are %s%s", origin, key, names,
                        strcmp(key, "tick") == 0 ? " (the tick is set by --rate)" : "");
}

/* "a, b or c" */
static int bad_choice(const params_key *key, const char *origin, const char *word)
{
    char names[200] = "";
    const int last = (int)key->max;
    for (int i = 0; i <= last; i++) {
        strcat(strcat(names, i == 0 ? "" : i == last ? " or " : ", "), key->choices[i]);
    }
    return sim_complain("%s: %s = %.40s: must be %s", origin, key->name, word, names);
}

static int read_value(const params_key *key, const char *origin, const char *word, float *value)
{
    if (key->choices != NULL) {
        for (int i = 0; i <= (int)key->max; i++) {
            if (strcmp(word, key->choices[i]) == 0) {
                *value = (float)i;
                return SIM_OK;
            }
        }
        return bad_choice(key, origin, word);
    }
    char *end;
    const double number = strtod(word, &end);
    if (end == word || *end != '\0') {
        return sim_complain("%s: %s = %.40s: not a number", origin, key->name, word);
    }
    *value = (float)number;
    /* the bounds are floats; a number that rounds to one is meant to be it */
    if (!(*value >= key->min && *value <= key->max)) {
        return sim_complain("%s: %s = %.40s: out of bounds, must be %g ... %g%s%s", origin,
                            key->name, word, (double)key->min, (double)key->max,
                            *key->unit == '\0' ? "" : " ", key->unit);
    }
    if (key->whole && fabs(number - round(number)) > 0.0) {
        return sim_complain("%s: %s = %.40s: must be a whole number", origin, key->name, word);
    }
    return SIM_OK;
}

/* Takes a text of one or more values, separated by commas or blanks; appends where `more` says that
 * the line continues the one before. */
static int take(params_text *text, const char *origin, const char *name, const char *value,
                bool more)
{
    const int index = params_key_find(name);
    if (index < 0) {
        return unknown_key(origin, name);
    }
    const params_key key = params_key_at(index);
    params_entry *entry = &text->entries[index];
    if (!more) {
        entry->values_n = 0;
        snprintf(entry->origin, sizeof entry->origin, "%s", origin);
    }
    char *copy = strdup(value);
    char *rest = copy;
    int result = SIM_OK;
    for (char *word; result == SIM_OK && (word = strsep(&rest, ", \t")) != NULL;) {
        if (*word == '\0') {
            continue;
        }
        if (entry->values_n == key.values_max) {
            result = sim_complain("%s: %s takes at most %d value%s", origin, name, key.values_max,
                                  key.values_max == 1 ? "" : "s");
        } else {
            result = read_value(&key, origin, word, &entry->values[entry->values_n++]);
        }
    }
    free(copy);
    if (result == SIM_OK && entry->values_n == 0) {
        result = sim_complain("%s: %s has no value", origin, name);
    }
    return result;
}

int params_text_key(params_text *text, const char *origin, const char *key, const char *value)
{
    return take(text, origin, key, value, false);
}

int params_text_model(params_text *text, const char *name)
{
    return take(text, "--model", "model", name, false);
}

int params_text_set(params_text *text, const char *key_equals_value)
{
    const char *equals = strchr(key_equals_value, '=');
    if (equals == NULL || equals == key_equals_value) {
        return sim_complain("--set %.60s: must be key=value", key_equals_value);
    }
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)(equals - key_equals_value), key_equals_value);
    return take(text, "--set", key, equals + 1, false);
}

/* What limber params list --ini writes beside the rod's keys: nothing to a replay. */
static bool is_devices_own(const char *name)
{
    return params_find(name) >= ROD_FIELDS_N;
}

static int take_from_ini(void *context, const ini_piece *piece)
{
    if (piece->key == NULL) {
        return SIM_OK; /* a section with nothing in it may have any name */
    }
    if (strcmp(piece->section, "rod") != 0) {
        return sim_complain("%s: '%.40s' stands in section [%.40s]; limber reads only [rod]",
                            piece->origin, piece->key, piece->section);
    }
    return is_devices_own(piece->key)
               ? SIM_OK
               : take(context, piece->origin, piece->key, piece->value, piece->continued);
}

int params_text_read_ini(params_text *text, const char *path)
{
    long lines_n;
    const int result = ini_lines_read(path, take_from_ini, text, &lines_n);
    if (result == SIM_OK && lines_n == 0) {
        return sim_complain("%s: empty; limber-sim params prints a complete file", path);
    }
    return result;
}

void params_text_beneath(params_text *text, const params_text *other)
{
    for (int i = 0; i < PARAMS_KEYS_N; i++) {
        if (text->entries[i].values_n == 0) {
            text->entries[i] = other->entries[i];
        }
    }
}

static int explain(const params_text *text, const rod_refusal *why, const rod_params *params)
{
    if (why->error == ROD_E_OVERDAMPED) {
        const params_entry *damper = &text->entries[params_key_find("damper")];
        const double drag = (double)params->drag[why->joint];
        return sim_complain(
            "%s: drag + damper of joint %d is %g N m s: with its inertia at %g Hz at "
            "most %g is allowed (2 inertia / tick); raise the inertia or --rate, or "
            "damp less",
            damper->values_n > 0 ? damper->origin : "rod", why->joint + 1,
            drag + (double)why->value, 1.0 / (double)params->tick_s, drag + (double)why->max);
    }
    if (why->field != NULL && strcmp(why->field->name, "tick") == 0) {
        return sim_complain("--rate: a tick of %g s is out of bounds, must be %g ... %g Hz",
                            (double)why->value, 1.0 / (double)why->max, 1.0 / (double)why->min);
    }
    if (why->field != NULL && params_material_is_asked(text)) {
        return sim_complain(
            "rod: %s of joint %d comes out as %g %s, must be %g ... %g: ask for %s, or "
            "change diameter or total_length",
            why->field->name, why->joint + 1, (double)why->value,
            params_text_unit(why->field, params->model), (double)why->min, (double)why->max,
            why->error == ROD_E_DAMPER ? "less damping_ratio" : "fewer links");
    }
    return sim_complain("rod: joint %d: %s", why->joint + 1, rod_error_text(why->error));
}

/* The first value written for a key, or what it is without. */
static int first_of(const params_text *text, const char *key, int otherwise)
{
    const params_entry *entry = &text->entries[params_key_find(key)];
    return entry->values_n > 0 ? (int)entry->values[0] : otherwise;
}

/* The rod before single keys change it. */
static int resolve_base(const params_text *text, double rate_hz, rod_params *params)
{
    const bool of_material = params_material_is_asked(text);
    const int model = first_of(text, "model", of_material ? ROD_MODEL_ELASTIC : ROD_MODEL_CONTOUR);
    if (text->preset != NULL) {
        rod_preset_fill(text->preset, model, first_of(text, "links", text->preset->links_n),
                        params);
    } else {
        rod_params_defaults(params);
        params->model = model;
        params->links_n =
            first_of(text, "links", of_material ? LINKS_OF_MATERIAL : params->links_n);
    }
    params->tick_s = (float)(1.0 / rate_hz);
    rod_blank blank;
    if (!of_material) {
        return SIM_OK;
    }
    const int result = params_material_blank(text, &blank);
    if (result == SIM_OK) {
        rod_blank_fill(&blank, params);
    }
    return result;
}

int params_text_resolve(const params_text *text, double rate_hz, rod_params *params)
{
    const int result = resolve_base(text, rate_hz, params);
    if (result != SIM_OK) {
        return result;
    }
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        const params_entry *entry = &text->entries[i];
        if (entry->values_n > 1 && entry->values_n != params->links_n) {
            return sim_complain("%s: %s has %d values for %d links; give one, or one per joint",
                                entry->origin, field->name, entry->values_n, params->links_n);
        }
        if (strcmp(entry->origin, "--set") == 0 && !rod_field_is_read(field, params->model)) {
            return sim_complain("--set %s: the %s model does not read it", field->name,
                                rod_field_find("model")->choices[params->model]);
        }
        const int entries_n = field->kind == ROD_FIELD_PER_JOINT ? ROD_MAX_LINKS : 1;
        for (int joint = 0; joint < entries_n && entry->values_n > 0; joint++) {
            const int last = entry->values_n - 1;
            rod_field_set(field, params, joint, entry->values[joint < last ? joint : last]);
        }
    }
    rod trial; /* whatever the rod would refuse is refused here, in words */
    rod_refusal why;
    return rod_init(&trial, params, &why) == ROD_OK ? SIM_OK : explain(text, &why, params);
}
