/* params_keys.h - every key that [rod] and --set take: the rod's fields, then a blank's, then the material's name. */
#ifndef LIMBER_PARAMS_KEYS_H
#define LIMBER_PARAMS_KEYS_H

#include <stdbool.h>

#include "rod.h"

enum {
    PARAMS_KEY_BLANK = ROD_FIELDS_N, /* the first of a blank's: rod_blank_fields[0] */
    PARAMS_KEY_MATERIAL = PARAMS_KEY_BLANK + ROD_BLANK_FIELDS_N,
    PARAMS_KEYS_N
};

typedef struct {
    const char *name;
    const char *unit; /* "" where there is none */
    float min, max;
    int values_max;
    bool whole;
    const char *const *choices; /* max + 1 names, or NULL for numbers */
} params_key;

/* index: 0 ... PARAMS_KEYS_N - 1 */
params_key params_key_at(int index);

/* Can a person set it? All but the tick, which is the rate's. */
bool params_key_is_settable(int index);

/* The index of a settable key, or -1. */
int params_key_find(const char *name);

#endif
