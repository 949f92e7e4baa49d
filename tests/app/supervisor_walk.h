/* supervisor_walk.h - every state of the supervisor with every set of conditions. */
#ifndef LIMBER_SUPERVISOR_WALK_H
#define LIMBER_SUPERVISOR_WALK_H

#include <stdio.h>

#include "supervisor.h"

enum { SETS_N = 1 << SUPERVISOR_CONDITIONS_N };

#define EACH_STATE_AND_SET                                                                         \
    for (int state = 0; state < SUPERVISOR_STATES_N; state++)                                      \
        for (uint32_t set = 0; set < SETS_N; set++)

static inline supervisor_state next(int state, uint32_t set)
{
    return supervisor_next((supervisor_state)state, set);
}

static inline const char *about(int state, uint32_t set)
{
    static char text[80];
    snprintf(text, sizeof text, "in %s with 0x%03x to %s", supervisor_duties[state].name,
             (unsigned)set, supervisor_duties[next(state, set)].name);
    return text;
}

static inline bool torque(supervisor_state state)
{
    return supervisor_duties[state].servo_power;
}

#endif
