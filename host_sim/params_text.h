/* params_text.h - rod parameters as people write them: presets, INI files, key=value, and back to INI. */
#ifndef LIMBER_PARAMS_TEXT_H
#define LIMBER_PARAMS_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "params_keys.h"

/* What was written for one key; a scalar counts for every joint. */
typedef struct {
    int values_n; /* 0: nothing was */
    float values[ROD_MAX_LINKS];
    char origin[160]; /* "foil.ini:7", for complaints that come later */
} params_entry;

/* Everything written so far. Start it with {0}; later entries replace earlier ones. */
typedef struct {
    const rod_preset *preset; /* the base of it all, or NULL for the defaults */
    params_entry entries[PARAMS_KEYS_N];
} params_text;

/* Each returns SIM_OK, or SIM_BAD_INPUT after one line with place, value and bounds. A file may hold what is
 * the device's alone (servo_kind, ...) and not the rod's: that is passed over. */
int params_text_preset(params_text *text, const char *name);
int params_text_read_ini(params_text *text, const char *path);
int params_text_set(params_text *text, const char *key_equals_value);
int params_text_model(params_text *text, const char *name);

/* The same for one key; origin says where it was written. */
int params_text_key(params_text *text, const char *origin, const char *key, const char *value);

/* What another said goes beneath: it holds for the keys of which nothing was said here. */
void params_text_beneath(params_text *text, const params_text *other);

/* Everything together at this tick, checked as the rod itself will check it. Where keys of a blank were written, the
 * rod follows from them (params_material.h), and is elastic and of 10 links where nothing else was said; damper, drag,
 * coupling and smoothing replace what follows. */
int params_text_resolve(const params_text *text, double rate_hz, rod_params *params);

/* The unit of a field as a model reads it: drag is N m s at a joint to contour, N s/m at a node to elastic. */
const char *params_text_unit(const rod_field *field, int32_t model);

/* A commented INI file of all that the rod's model reads; it reads back to the same rod. */
void params_text_write_ini(const rod_params *params, const char *title, FILE *out);

#endif
