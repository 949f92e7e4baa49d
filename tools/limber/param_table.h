/* param_table.h - the device's own list of its parameters: this tool knows none by name. */
#ifndef LIMBER_PARAM_TABLE_H
#define LIMBER_PARAM_TABLE_H

#include "session.h"

typedef struct {
    message_param_info *infos; /* from malloc */
    int infos_n;
} param_table;

/* SIM_OK, or an exit code after complaining. */
int param_table_read(session *s, param_table *table);
void param_table_free(param_table *table);

/* The parameter of that name, or NULL. */
const message_param_info *param_table_find(const param_table *table, const char *name);

/* Its values; which: PARAM_IN_FORCE or PARAM_STAGED. SIM_OK, or LIMBER_DEVICE after complaining. */
int param_table_values(session *s, const char *name, uint8_t which, message_param_value *values);

#endif
