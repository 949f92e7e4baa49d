/* params_text.c - see params_text.h. */
#include "params_text.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "params.h"
#include "sim.h"

bool params_text_is_settable(const rod_field *field)
{
    return strcmp(field->name, "tick") != 0; /* the tick is the rate's */
}

static int index_of(const rod_field *field)
{
    return (int)(field - rod_fields);
}

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
    char names[200] = "";
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        if (params_text_is_settable(&rod_fields[i])) {
            strcat(strcat(names, *names == '\0' ? "" : ", "), rod_fields[i].name);
        }
    }
    return sim_complain("%s: unknown key '%.40s'; there are %s%s", origin, key, names,
                        strcmp(key, "tick") == 0 ? " (the tick is set by --rate)" : "");
}

static int bad_choice(const rod_field *field, const char *origin, const char *word)
{
    char names[100] = "";
    for (int i = 0; i <= (int)field->max; i++) {
        strcat(strcat(names, i == 0 ? "" : " or "), field->choices[i]);
    }
    return sim_complain("%s: %s = %.40s: must be %s", origin, field->name, word, names);
}

static int read_value(const rod_field *field, const char *origin, const char *word, float *value)
{
    if (field->kind == ROD_FIELD_CHOICE) {
        for (int i = 0; i <= (int)field->max; i++) {
            if (strcmp(word, field->choices[i]) == 0) {
                *value = (float)i;
                return SIM_OK;
            }
        }
        return bad_choice(field, origin, word);
    }
    char *end;
    const double number = strtod(word, &end);
    if (end == word || *end != '\0') {
        return sim_complain("%s: %s = %.40s: not a number", origin, field->name, word);
    }
    *value = (float)number;
    /* the bounds are floats; a number that rounds to one is meant to be it */
    if (!(*value >= field->min && *value <= field->max)) {
        return sim_complain("%s: %s = %.40s: out of bounds, must be %g ... %g%s%s", origin,
                            field->name, word, (double)field->min, (double)field->max,
                            *field->unit == '\0' ? "" : " ", field->unit);
    }
    if (field->kind == ROD_FIELD_COUNT_OF && fabs(number - round(number)) > 0.0) {
        return sim_complain("%s: %s = %.40s: must be a whole number", origin, field->name, word);
    }
    return SIM_OK;
}

/* Takes a text of one or more values, separated by commas or blanks; appends where `more` says that
 * the line continues the one before. */
static int take(params_text *text, const char *origin, const char *key, const char *value,
                bool more)
{
    const rod_field *field = rod_field_find(key);
    if (field == NULL || !params_text_is_settable(field)) {
        return unknown_key(origin, key);
    }
    params_entry *entry = &text->entries[index_of(field)];
    if (!more) {
        entry->values_n = 0;
        snprintf(entry->origin, sizeof entry->origin, "%s", origin);
    }
    const int most_n = field->kind == ROD_FIELD_PER_JOINT ? ROD_MAX_LINKS : 1;
    char *copy = strdup(value);
    char *rest = copy;
    int result = SIM_OK;
    for (char *word; result == SIM_OK && (word = strsep(&rest, ", \t")) != NULL;) {
        if (*word == '\0') {
            continue;
        }
        if (entry->values_n == most_n) {
            result = sim_complain("%s: %s takes at most %d value%s", origin, key, most_n,
                                  most_n == 1 ? "" : "s");
        } else {
            result = read_value(field, origin, word, &entry->values[entry->values_n++]);
        }
    }
    free(copy);
    if (result == SIM_OK && entry->values_n == 0) {
        result = sim_complain("%s: %s has no value", origin, key);
    }
    return result;
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

/* inih calls back without saying where it is: its lines are read here, so that they can be counted. */
typedef struct {
    params_text *text;
    const char *path;
    FILE *file;
    long line;
    bool in_value;  /* a key stands above in this section, so that a value can go on */
    bool continued; /* the line begins with a blank: inih takes it as more of the one before */
    int result;
} ini_reading;

/* Remarks may follow a value after a blank; inih's versions differ on them in lines that go on. */
static void cut_remark(char *line)
{
    for (char *c = line; *c != '\0'; c++) {
        if ((*c == ';' || *c == '#') && c > line && isspace((unsigned char)c[-1])) {
            *c = '\0';
            return;
        }
    }
}

static char *next_ini_line(char *buffer, int size, void *context)
{
    ini_reading *reading = context;
    int c = EOF, used = 0;
    reading->line++;
    while (reading->result == SIM_OK && (c = getc(reading->file)) != EOF && c != '\n') {
        if (c < ' ' && !isspace(c)) {
            reading->result = sim_complain("%s:%ld: not a text file", reading->path, reading->line);
        } else if (used == size - 2) {
            reading->result =
                sim_complain("%s:%ld: longer than %d characters; go on with the list on an "
                             "indented line",
                             reading->path, reading->line, size - 2);
        } else {
            buffer[used++] = (char)c;
        }
    }
    if (reading->result != SIM_OK || (c == EOF && used == 0)) {
        reading->line--;
        return NULL;
    }
    buffer[used] = '\0';
    cut_remark(buffer);
    reading->continued = reading->in_value && isspace((unsigned char)*buffer);
    if (!reading->continued && buffer[strspn(buffer, " \t")] == '[') {
        reading->in_value = false;
    }
    return buffer;
}

/* What limber params list --ini writes beside the rod's keys: nothing to a replay. */
static bool is_devices_own(const char *name)
{
    return params_find(name) >= ROD_FIELDS_N;
}

static int take_from_ini(void *context, const char *section, const char *name, const char *value)
{
    ini_reading *reading = context;
    if (reading->result != SIM_OK) {
        return 0;
    }
    reading->in_value = true;
    char origin[160];
    snprintf(origin, sizeof origin, "%.140s:%ld", reading->path, reading->line);
    if (strcmp(section, "rod") != 0) {
        reading->result =
            sim_complain("%s: '%.40s' stands in section [%.40s]; limber reads only [rod]", origin,
                         name, section);
    } else if (!is_devices_own(name)) {
        reading->result = take(reading->text, origin, name, value, reading->continued);
    }
    return reading->result == SIM_OK;
}

int params_text_read_ini(params_text *text, const char *path)
{
    ini_reading reading = {.text = text, .path = path, .file = fopen(path, "r")};
    if (reading.file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    const int line = ini_parse_stream(next_ini_line, &reading, take_from_ini, &reading);
    const bool unreadable = ferror(reading.file) != 0;
    fclose(reading.file);
    if (reading.result == SIM_OK && unreadable) {
        return sim_complain("%s: cannot be read: %s", path, strerror(errno));
    }
    if (reading.result == SIM_OK && line != 0) {
        return sim_complain("%s:%d: neither a [section], a key = value nor a comment", path, line);
    }
    if (reading.result == SIM_OK && reading.line == 0) {
        return sim_complain("%s: empty; limber-sim params prints a complete file", path);
    }
    return reading.result;
}

static int explain(const params_text *text, const rod_refusal *why, const rod_params *params)
{
    if (why->error == ROD_E_OVERDAMPED) {
        const params_entry *damper = &text->entries[index_of(rod_field_find("damper"))];
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
    return sim_complain("rod: joint %d: %s", why->joint + 1, rod_error_text(why->error));
}

/* The first value written for a key, or what it is without. */
static int first_of(const params_text *text, const char *key, int otherwise)
{
    const params_entry *entry = &text->entries[index_of(rod_field_find(key))];
    return entry->values_n > 0 ? (int)entry->values[0] : otherwise;
}

int params_text_resolve(const params_text *text, double rate_hz, rod_params *params)
{
    if (text->preset != NULL) {
        rod_preset_fill(text->preset, first_of(text, "model", ROD_MODEL_CONTOUR),
                        first_of(text, "links", text->preset->links_n), params);
    } else {
        rod_params_defaults(params);
        params->links_n = first_of(text, "links", params->links_n);
    }
    params->tick_s = (float)(1.0 / rate_hz);
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
