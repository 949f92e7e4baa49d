/* servo_setup.h - the servos as the parameters describe them: to the map, to the back end, and how often they are
 * served.
 *
 * Main loop only; costs a few thousand instructions and 4 KB of stack: for changes of parameters, not for ticks.
 */
#ifndef LIMBER_SERVO_SETUP_H
#define LIMBER_SERVO_SETUP_H

#include "params.h"
#include "servo_map.h"
#include "servo_types.h"

/* All that is derived from one set of parameters. */
typedef struct {
    int servos_n, period_ticks;
    float period_s;
    servo_config map[SERVOS_MAX];
} servo_setup;

/* False with *why filled where the parameters do not go together: a map that cannot be, servos that the chosen back
 * end cannot drive, or a servo_rate that it cannot carry (with the arithmetic). */
bool servo_setup_make(servo_setup *setup, const params_set *set, params_refusal *why);

/* The same servos for the back end. */
void servo_setup_hardware(const params_set *set, servos_config *config);

#endif
