/* param_text.c - see param_text.h; files are param_file.c's. */
#include "param_text.h"

#include <stdlib.h>
#include <string.h>

#include "texts.h"

int param_assignments_add(param_assignments *all, const char *origin, const char *key,
                          const char *values)
{
    param_assignment *grown = realloc(all->items, ((size_t)all->items_n + 1) * sizeof *all->items);
    if (grown == NULL) {
        return sim_give_up("out of memory");
    }
    all->items = grown;
    param_assignment *const one = &grown[all->items_n++];
    *one = (param_assignment){strdup(key), strdup(values), ""};
    snprintf(one->origin, sizeof one->origin, "%s", origin);
    return one->key == NULL || one->values == NULL ? sim_give_up("out of memory") : SIM_OK;
}

int param_assignments_take(param_assignments *all, const char *key_equals_values)
{
    const char *equals = strchr(key_equals_values, '=');
    char key[64];
    if (equals == NULL || equals == key_equals_values || equals - key_equals_values >= 64) {
        return sim_complain("params set %.60s: must be NAME=VALUE, NAME=VALUE,VALUE,... or "
                            "NAME[3]=VALUE; limber params list tells the names",
                            key_equals_values);
    }
    snprintf(key, sizeof key, "%.*s", (int)(equals - key_equals_values), key_equals_values);
    return param_assignments_add(all, "params set", key, equals + 1);
}

void param_assignments_free(param_assignments *all)
{
    for (int i = 0; i < all->items_n; i++) {
        free(all->items[i].key);
        free(all->items[i].values);
    }
    free(all->items);
    *all = (param_assignments){NULL, 0};
}

/* --- choices: the text of a PARAM_INFO ends in their names, [a|b|c] ------------------------------- */

/* The names without the brackets; "" where there are none. */
static void choices_of(const message_param_info *info, char names[MESSAGES_TEXT_MAX + 1])
{
    const char *open = strrchr(info->text, '[');
    snprintf(names, MESSAGES_TEXT_MAX + 1, "%s", open == NULL ? "" : open + 1);
    char *close = strchr(names, ']');
    if (close != NULL) {
        *close = '\0';
    }
}

static bool choice_value(const message_param_info *info, const char *word, float *value)
{
    char names[MESSAGES_TEXT_MAX + 1], *rest = names;
    choices_of(info, names);
    *value = 0.0f;
    for (const char *name; (name = strsep(&rest, "|")) != NULL; *value += 1.0f) {
        if (*name != '\0' && strcmp(name, word) == 0) {
            return true;
        }
    }
    return false;
}

void param_text_value(const message_param_info *info, float value, char text[32])
{
    if (info->kind == PARAM_CHOICE) {
        char names[MESSAGES_TEXT_MAX + 1], *rest = names;
        choices_of(info, names);
        float index = 0.0f;
        for (const char *name; (name = strsep(&rest, "|")) != NULL; index += 1.0f) {
            if (*name != '\0' && !(index < value || index > value)) {
                snprintf(text, 32, "%.31s", name);
                return;
            }
        }
    }
    texts_float(value, text);
}

void param_text_values(const message_param_info *info, const message_param_value *values,
                       const char *wrap, FILE *out)
{
    int values_n = values->values_n;
    bool same = true;
    for (int i = 1; i < values_n; i++) {
        same = same &&
               !(values->values[i] < values->values[0] || values->values[i] > values->values[0]);
    }
    values_n = same && values_n > 1 ? 1 : values_n;
    for (int i = 0; i < values_n; i++) {
        char text[32];
        param_text_value(info, values->values[i], text);
        fprintf(out, "%s%s", i == 0 ? "" : i % 8 == 0 ? wrap : " ", text);
    }
}

/* --- values ---------------------------------------------------------------------------------------- */

static int parse_value(const param_assignment *one, const message_param_info *info,
                       const char *word, float *value)
{
    char *end;
    if (info->kind == PARAM_CHOICE && choice_value(info, word, value)) {
        return SIM_OK;
    }
    *value = strtof(word, &end);
    if (end != word && *end == '\0') {
        return SIM_OK;
    }
    if (info->kind == PARAM_CHOICE) {
        char names[MESSAGES_TEXT_MAX + 1];
        choices_of(info, names);
        return sim_complain("%s: %s = %.40s: must be one of %s", one->origin, info->name, word,
                            names);
    }
    return sim_complain("%s: %s = %.40s: not a number", one->origin, info->name, word);
}

/* "spring[3]" into name and first entry, which people count from 1. */
static int parse_key(const param_assignment *one, char name[64], uint16_t *first)
{
    *first = 0;
    snprintf(name, 64, "%s", one->key);
    char *const open = strchr(name, '[');
    if (open == NULL) {
        return SIM_OK;
    }
    char *end;
    const long entry = strtol(open + 1, &end, 10);
    if (end == open + 1 || strcmp(end, "]") != 0 || entry < 1 || entry > MESSAGES_VALUES_MAX) {
        return sim_complain("%s: %.60s: entries are counted from 1, as in spring[1]", one->origin,
                            one->key);
    }
    *open = '\0';
    *first = (uint16_t)(entry - 1);
    return SIM_OK;
}

int param_assignment_parse(const param_assignment *one, const param_table *table,
                           message_param_set *set)
{
    char name[64];
    *set = (message_param_set){0};
    int result = parse_key(one, name, &set->first);
    if (result != SIM_OK) {
        return result;
    }
    const message_param_info *const info = param_table_find(table, name);
    if (info == NULL) {
        return sim_complain("%s: the device has no parameter '%.40s'; limber params list tells the "
                            "names",
                            one->origin, name);
    }
    snprintf(set->name, sizeof set->name, "%s", info->name);
    char *const copy = strdup(one->values);
    char *rest = copy;
    for (char *word; result == SIM_OK && (word = strsep(&rest, ", \t")) != NULL;) {
        if (*word == '\0') {
            continue;
        }
        if (set->values_n == MESSAGES_VALUES_MAX) {
            result =
                sim_complain("%s: %s: more than %d values", one->origin, name, MESSAGES_VALUES_MAX);
        } else {
            result = parse_value(one, info, word, &set->values[set->values_n++]);
        }
    }
    free(copy);
    if (result == SIM_OK && set->values_n == 0) {
        result = sim_complain("%s: %s has no value", one->origin, name);
    }
    return result;
}
