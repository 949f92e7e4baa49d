/* servo_blend.h - from what the servos do now to what they shall do, over a given time, without a jump.
 *
 * The weight runs 10 s^3 - 15 s^4 + 6 s^5 (minimum jerk: Flash and Hogan 1985), from 0 to 1 with no speed
 * and no acceleration at either end; peak speed is 1.875 times way / time. Two kinds:
 *
 *   from rest     the joints stand where they are and are drawn to the target, moving or not: arming,
 *                 HOLD to ACTIVE, and the ramp to straight of RELAX
 *   from motion   the joints keep moving with the target, and only the difference fades: parameter
 *                 and preset changes while the rod lives
 *
 * Sits between servo_map_targets and servo_map_follow, and is stepped as often. Starting one while
 * another runs is allowed: it starts where the goals are; the speed that the old one gave them is
 * dropped, and servo_map's limits round that corner. Targets that are not finite
 * stay so, for servo_map to see. Caller-owned; 8 instructions a servo on a Cortex-M4F, 40 besides; no libm.
 */
#ifndef LIMBER_SERVO_BLEND_H
#define LIMBER_SERVO_BLEND_H

#include "servo_map.h"

/* Private, but for reading. */
typedef struct {
    int servos_n;
    bool from_motion;
    int32_t period, periods_n;  /* done, and in all: over when equal */
    float per_period;           /* 1 / periods_n */
    float from_rad[SERVOS_MAX]; /* the goals at the start, or from motion: what they differed by */
} servo_blend;

/* No blend: targets pass unchanged. */
void servo_blend_none(servo_blend *blend);

/* Starts at the goals of the last period (servo_map_goals), for time_us. A time under one period is
 * no blend. */
void servo_blend_from_rest(servo_blend *blend, const servo_map *map, uint32_t time_us);

/* As well, with the targets as the new parameters put them before the next rod_step. */
void servo_blend_from_motion(servo_blend *blend, const servo_map *map, const float *targets_rad,
                             uint32_t time_us);

/* One period: targets_rad[servos_n] in place. The first call already moves. */
void servo_blend_mix(servo_blend *blend, float *targets_rad);

bool servo_blend_done(const servo_blend *blend);

#endif
