/* stream_graphics.c - nodes_rate of a device for as long as somebody draws its rod. */
#include <stdio.h>

#include "stream.h"

static const char RATE_PARAMETER[] = "nodes_rate";

enum { NODES_HZ = 60 };

/* Negative: it does not tell. */
static double rate_hz(stream *st)
{
    message ask = {.type = MESSAGE_PARAM_GET, .param_get = {.which = PARAM_IN_FORCE}};
    snprintf(ask.param_get.name, sizeof ask.param_get.name, "%s", RATE_PARAMETER);
    return session_try(&st->s, &ask) == REQUEST_DONE && st->s.answer.param_value.values_n == 1
               ? (double)st->s.answer.param_value.values[0]
               : -1.0;
}

static bool set_rate(stream *st, float hz)
{
    message set = {.type = MESSAGE_PARAM_SET, .param_set = {.values_n = 1, .values = {hz}}};
    snprintf(set.param_set.name, sizeof set.param_set.name, "%s", RATE_PARAMETER);
    return session_try(&st->s, &set) == REQUEST_DONE &&
           session_try(&st->s, &(message){.type = MESSAGE_PARAM_COMMIT}) == REQUEST_DONE;
}

void stream_begin_graphics(stream *st)
{
    if (st->graphics == NULL || rate_hz(st) > 0.0) {
        return;
    }
    /* COMMIT would put in force whatever else somebody has staged */
    if ((st->s.heartbeat.flags & HEARTBEAT_STAGED) != 0) {
        limber_note("the device sends no NODES; parameters are staged there, so nodes_rate is left "
                    "alone");
    } else if (set_rate(st, NODES_HZ)) {
        st->nodes_asked = true;
    } else if (!st->s.lost) {
        (void)set_rate(st, 0.0f);
        limber_note("the device takes no nodes_rate of %d Hz: only angles are drawn", NODES_HZ);
    }
}

void stream_end_graphics(stream *st)
{
    if (st->nodes_asked && st->in_session && !st->s.lost) {
        (void)set_rate(st, 0.0f);
    }
}
