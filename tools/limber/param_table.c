/* param_table.c - see param_table.h. */
#include "param_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int param_table_read(session *s, param_table *table)
{
    *table = (param_table){NULL, 0};
    for (int params_n = 1; table->infos_n < params_n;) {
        const message ask = {.type = MESSAGE_PARAM_LIST,
                             .param_list = {.index = (uint16_t)table->infos_n}};
        const int result = session_request(s, &ask);
        if (result != SIM_OK) {
            param_table_free(table);
            return result;
        }
        const message_param_info *const info = &s->answer.param_info;
        params_n = info->params_n;
        if (table->infos_n == 0) {
            table->infos = calloc((size_t)params_n + 1, sizeof *table->infos);
            if (table->infos == NULL) {
                return sim_give_up("out of memory");
            }
        }
        table->infos[table->infos_n++] = *info;
    }
    return SIM_OK;
}

void param_table_free(param_table *table)
{
    free(table->infos);
    *table = (param_table){NULL, 0};
}

const message_param_info *param_table_find(const param_table *table, const char *name)
{
    for (int i = 0; i < table->infos_n; i++) {
        if (strcmp(table->infos[i].name, name) == 0) {
            return &table->infos[i];
        }
    }
    return NULL;
}

int param_table_values(session *s, const char *name, uint8_t which, message_param_value *values)
{
    message ask = {.type = MESSAGE_PARAM_GET, .param_get = {.which = which}};
    snprintf(ask.param_get.name, sizeof ask.param_get.name, "%.24s", name);
    const int result = session_request(s, &ask);
    if (result == SIM_OK) {
        *values = s->answer.param_value;
    }
    return result;
}
