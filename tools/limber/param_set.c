/* param_set.c - see param_set.h. */
#include "param_set.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "texts.h"

/* What had been staged before something was refused must not wait for somebody else's COMMIT: the values
 * in force are staged again. */
static void take_back(session *s, const message_param_set *sets, int sets_n)
{
    for (int i = 0; i < sets_n && !s->lost; i++) {
        message ask = {.type = MESSAGE_PARAM_GET, .param_get = {.which = PARAM_IN_FORCE}};
        memcpy(ask.param_get.name, sets[i].name, sizeof ask.param_get.name);
        if (session_try(s, &ask) == REQUEST_DONE) {
            message set = {.type = MESSAGE_PARAM_SET};
            const message_param_value *const value = &s->answer.param_value;
            memcpy(set.param_set.name, sets[i].name, sizeof set.param_set.name);
            set.param_set.values_n = value->values_n;
            memcpy(set.param_set.values, value->values, sizeof value->values);
            (void)session_try(s, &set);
        }
    }
}

/* What the refusal was about: a place in a file, or nothing worth telling. */
static int complain_of(session *s, const char *origin)
{
    if (s->request != REQUEST_REFUSED || s->lost || strcmp(origin, "params set") == 0) {
        return session_complain(s);
    }
    port_why text;
    texts_refusal(&s->answer.nack, text);
    return limber_refuse("%s: %s", origin, text);
}

/* Lists come after what may change their length. */
static bool comes_in_round(const param_table *table, const message_param_set *set, int round)
{
    const message_param_info *const info = param_table_find(table, set->name);
    return ((info->flags & PARAM_LIST) != 0) == (round == 1);
}

int param_set_all(session *s, const param_table *table, const param_assignments *all)
{
    message_param_set *const sets = calloc((size_t)all->items_n + 1, sizeof *sets);
    int result = sets == NULL ? sim_give_up("out of memory") : SIM_OK;
    for (int i = 0; result == SIM_OK && i < all->items_n; i++) {
        result = param_assignment_parse(&all->items[i], table, &sets[i]);
    }
    bool staged = false;
    for (int round = 0; round < 2 && result == SIM_OK; round++) {
        for (int i = 0; result == SIM_OK && i < all->items_n; i++) {
            if (comes_in_round(table, &sets[i], round)) {
                staged = true;
                if (session_try(s, &(message){.type = MESSAGE_PARAM_SET, .param_set = sets[i]}) !=
                    REQUEST_DONE) {
                    result = complain_of(s, all->items[i].origin);
                }
            }
        }
    }
    if (result == SIM_OK) {
        result = session_request(s, &(message){.type = MESSAGE_PARAM_COMMIT});
    }
    if (result != SIM_OK && staged) {
        take_back(s, sets, all->items_n);
    } else if (result == SIM_OK) {
        printf("%d parameter%s set; limber params save makes it last\n", all->items_n,
               all->items_n == 1 ? "" : "s");
    }
    free(sets);
    return result;
}
