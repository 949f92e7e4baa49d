/* servo_map.h - from the rod's joint angles to servo goals, within what each servo may do.
 *
 *     servo_map_targets(&map, rod_angles(&foil), links_n, targets_rad);  // sign, offset
 *     servo_blend_mix(&blend, targets_rad);                              // servo_blend.h
 *     acted = servo_map_follow(&map, targets_rad);                       // the limits
 *     hal->servo_write(hal->context, servo_map_goals(&map), map.servos_n);
 *
 * once every servo period, which is not the rod's tick. A goal is in rad of the servo's shaft; servo i is
 * the hal's servo i. Limits, in safety.md's order, each with its flag:
 *
 *   finite        a target that is not: stop within the limits below and hold
 *   angle         the target is brought into [min, max]; and no goal moves toward an end faster than it
 *                 can still stop there
 *   acceleration  |goal[k+1] - 2 goal[k] + goal[k-1]| <= accel * period^2
 *   rate          |goal[k+1] - goal[k]| <= rate * period
 *
 * All four hold always and exactly, whatever comes in: positions are whole multiples of 2^-21 rad
 * (5e-7) and the sums are of integers; rate and acceleration are rounded down to that grid (0.48 rad/s^2
 * at 1 kHz). A target that keeps the limits is followed without lag, to half a unit. One that does not
 * is caught up with as fast as the limits allow, braking in time to meet it at its own speed: a resting
 * target is not overshot unless it appeared within the braking distance.
 *
 * A servo placed outside its range (bent by hand while limp) stays there until told, never goes
 * further out, and comes in within the limits.
 *
 * Caller-owned, no heap, no libm; main loop only. Per servo 52 bytes, and on a Cortex-M4F, counted,
 * 65 instructions where nothing limits, up to 200 where it brakes (a square root and a division more).
 * Sources: the discrete stopping distance is derived at braking_speed() in servo_map.c; nothing is
 * borrowed.
 */
#ifndef LIMBER_SERVO_MAP_H
#define LIMBER_SERVO_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "kinematics.h"
#include "rod_config.h"

enum { SERVOS_MAX = 2 * ROD_MAX_LINKS };

#define SERVO_REACH_RAD 8.0f /* no position, offset or range beyond it */
#define SERVO_PERIOD_MIN_S 0.0005f
#define SERVO_PERIOD_MAX_S 0.1f
#define SERVO_RATE_MAX_RAD_S 1000.0f
#define SERVO_ACCEL_MAX_RAD_S2 100000.0f

typedef enum {
    SERVO_OK = 0,
    SERVO_E_COUNT = -1,
    SERVO_E_PERIOD = -2,
    SERVO_E_ID = -3,
    SERVO_E_JOINT = -4,
    SERVO_E_AXIS = -5,
    SERVO_E_SIGN = -6,
    SERVO_E_RANGE = -7,
    SERVO_E_OFFSET = -8,
    SERVO_E_RATE = -9,
    SERVO_E_ACCEL = -10,
    SERVO_E_POSITION = -11,
} servo_error;

/* One clear sentence for each error; never NULL. */
const char *servo_error_text(servo_error error);

/* Where and why a map was refused: the servo (-1: none), what was given and what is allowed there. */
typedef struct {
    servo_error error;
    int servo;
    float value, min, max;
} servo_refusal;

/* One servo, as people describe it. goal = offset + sign * angle of the joint's axis. */
typedef struct {
    uint16_t id;      /* on the bus, or the PWM channel; each once */
    uint8_t joint;    /* from 0 */
    uint8_t axis;     /* ROD_THETA, ROD_PHI */
    int8_t sign;      /* 1 or -1 */
    float offset_rad; /* the goal at which the joint is straight; within the range */
    float min_rad, max_rad;
    float rate_rad_s, accel_rad_s2; /* at least one grid unit a period, a period squared */
} servo_config;

/* Which limiter acted, bits; what servo_map_follow returns and ANGLES reports. */
enum {
    SERVO_NOT_FINITE = 1 << 0,
    SERVO_AT_ANGLE = 1 << 1,
    SERVO_AT_ACCEL = 1 << 2,
    SERVO_AT_RATE = 1 << 3,
    SERVO_LIMITERS_N = 4,
};

/* One servo, prepared: positions in units of 2^-21 rad, speeds in units a period. Private. */
typedef struct {
    uint8_t joint, axis, acted;
    bool target_known; /* the last target was one */
    float sign, offset_rad;
    int32_t min, max;       /* the range */
    int32_t rate, accel;    /* the limits */
    int32_t room_for_more;  /* from here on the rate limits, not the room to stop */
    float eight_over_accel; /* saves a division */
    int32_t goal, speed;    /* the last goal, and it less the one before */
    int32_t target;         /* the last one */
} servo_motion;

/* Treat the members as private, but for servos_n and the counts. */
typedef struct {
    int servos_n;
    float period_s;
    uint32_t
        counts[SERVO_LIMITERS_N]; /* servos times periods in which each limiter acted; saturate */
    servo_motion servo[SERVOS_MAX];
    float goals_rad[SERVOS_MAX];
} servo_map;

/* Checks everything a map can get wrong; fills *refusal if that is not NULL. */
servo_error servo_map_check(const servo_config *configs, int servos_n, float period_s,
                            servo_refusal *refusal);

/* Checks, prepares, and lays every goal straight and at rest. On an error *map is as it was. Only
 * while the servos have no torque: goals may jump here. */
servo_error servo_map_init(servo_map *map, const servo_config *configs, int servos_n,
                           float period_s, servo_refusal *refusal);

/* The goals are now where the servos are, at rest: before they get torque. All positions finite and
 * within SERVO_REACH_RAD, or SERVO_E_POSITION, *servo (may be NULL) is the first that is not, and
 * nothing has changed. */
servo_error servo_map_place(servo_map *map, const float *positions_rad, int *servo);

/* The goals for these joint angles, without limits, into targets_rad[servos_n]. Joints at and beyond
 * links_n are straight. */
void servo_map_targets(const servo_map *map, const rod_joint *angles_rad, int links_n,
                       float *targets_rad);

/* The goals of the straight rod. */
void servo_map_straight(const servo_map *map, float *targets_rad);

/* One period: toward the targets. Returns the flags of all servos together. */
uint32_t servo_map_follow(servo_map *map, const float *targets_rad);

/* One period without targets: stop within the limits, then hold. Returns the flags (AT_ACCEL while
 * still moving). */
uint32_t servo_map_hold(servo_map *map);

/* The goals after the last period, servos_n of them; valid as long as the map. */
const float *servo_map_goals(const servo_map *map);

/* One servo's flags in the last period. */
uint32_t servo_map_acted(const servo_map *map, int servo);

/* Every servo rests at its target. */
bool servo_map_settled(const servo_map *map);

#endif
