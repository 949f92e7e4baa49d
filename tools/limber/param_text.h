/* param_text.h - parameters' values as people write them, and what people want to set. */
#ifndef LIMBER_PARAM_TEXT_H
#define LIMBER_PARAM_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "param_table.h"

/* NAME=VALUE..., from the command line or a file. */
typedef struct {
    char *key, *values; /* from malloc */
    char origin[160];   /* "foil.ini:7", for complaints */
} param_assignment;

typedef struct {
    param_assignment *items;
    int items_n;
} param_assignments;

/* Each returns SIM_OK, or an exit code after complaining. */
int param_assignments_add(param_assignments *all, const char *origin, const char *key,
                          const char *values);
int param_assignments_take(param_assignments *all, const char *key_equals_values);
int param_assignments_read_ini(param_assignments *all, const char *path);
void param_assignments_free(param_assignments *all);

/* As PARAM_SET: numbers separated by commas or blanks, or a choice's name; NAME[3] begins at the third
 * entry. Bounds are the device's business. */
int param_assignment_parse(const param_assignment *one, const param_table *table,
                           message_param_set *set);

/* The value as it is written in files: choices by name. */
void param_text_value(const message_param_info *info, float value, char text[32]);

/* All of them, a list whose entries are all the same as one. */
void param_text_values(const message_param_info *info, const message_param_value *values,
                       const char *wrap, FILE *out);

#endif
