/* servo_map.c - see servo_map.h. */
#include "servo_map.h"

#include <float.h>
#include <stddef.h>

#define UNITS_PER_RAD 2097152.0f /* 2^21: 8 rad are 2^24 units, all of them exact in a float */
#define RAD_PER_UNIT (1.0f / UNITS_PER_RAD)
enum { UNITS_MAX = 1 << 24 };

static int32_t clamp(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

static bool is_finite(float value)
{
    return trig_abs(value) <= FLT_MAX; /* fails for NaN */
}

static int32_t to_units(float rad)
{
    const float units = rad * UNITS_PER_RAD;
    return (int32_t)(units >= 0.0f ? units + 0.5f : units - 0.5f);
}

/* The way from `speed`, this period's included, until at rest: speed + (speed - accel) + ... */
static int32_t stopping_room(int32_t speed, int32_t accel)
{
    const int64_t n = speed / accel;
    const int64_t room = (n + 1) * speed - accel * n * (n + 1) / 2;
    return room < INT32_MAX ? (int32_t)room : INT32_MAX;
}

/* stopping_room(v) = (n + 1) v - accel n (n + 1) / 2 with n = v / accel rounded down: solved for v on the
 * piece where n fits. Everything is whole, so it is exact. */
static int32_t braking_speed(const servo_motion *s, int32_t room)
{
    const float root = trig_sqrt(1.0f + (float)room * s->eight_over_accel);
    int32_t n = (int32_t)(0.5f * (root - 1.0f));
    int32_t used = s->accel * n * (n + 1) / 2;
    while (used > room) { /* the root was rounded up: once at most */
        used -= s->accel * n;
        n--;
    }
    while (used + s->accel * (n + 1) <= room) { /* or down */
        n++;
        used += s->accel * n;
    }
    return s->accel * n + (room - used) / (n + 1);
}

/* The greatest speed for the next period from which the servo can still stop within `room`, up to one
 * more than its rate. Whoever obeys it once can obey it in every later period by braking with accel,
 * which is what keeps the three limits compatible. */
static inline int32_t stop_speed(const servo_motion *s, int32_t room)
{
    if (room >= s->room_for_more) {
        return s->rate + 1; /* more than the servo may: it is not the room that limits */
    }
    return room > s->accel ? braking_speed(s, room) : room > 0 ? room : 0;
}

/* One period at the wished speed, within angle, acceleration and rate. The three intervals overlap in at
 * least one speed, so that clamping to one after the other ends in all of them. */
static uint8_t advance(servo_motion *s, int32_t wish, uint32_t acted)
{
    const int32_t up = stop_speed(s, s->max - s->goal), down = stop_speed(s, s->goal - s->min);
    wish = clamp(wish, -s->rate - 1, s->rate + 1); /* how much more does not matter */
    int32_t speed = clamp(wish, -down, up);
    acted |= speed != wish ? (uint32_t)SERVO_AT_ANGLE : 0u;
    wish = speed;
    speed = clamp(wish, s->speed - s->accel, s->speed + s->accel);
    acted |= speed != wish ? (uint32_t)SERVO_AT_ACCEL : 0u;
    wish = speed;
    speed = clamp(wish, -s->rate, s->rate);
    acted |= speed != wish ? (uint32_t)SERVO_AT_RATE : 0u;
    s->speed = speed;
    s->goal += speed;
    s->acted = (uint8_t)acted;
    return s->acted;
}

static uint8_t stop(servo_motion *s, uint32_t acted)
{
    s->target_known = false;
    return advance(s, 0, acted);
}

/* The everyday case, and the same as what follow and advance would come to: the goal is where the target was, nothing
 * is near an end, and the target's own motion keeps the limits. */
static bool keeps_up(servo_motion *s, float target_rad)
{
    if (!s->target_known || !(trig_abs(target_rad) <= SERVO_REACH_RAD)) {
        return false;
    }
    const int32_t target = to_units(target_rad);
    const int32_t moved = target - s->target, change = moved - s->speed;
    if (s->goal != s->target || target > s->max || target < s->min ||
        s->max - s->goal < s->room_for_more || s->goal - s->min < s->room_for_more ||
        moved > s->rate || moved < -s->rate || change > s->accel || change < -s->accel) {
        return false;
    }
    s->goal = s->target = target;
    s->speed = moved;
    s->acted = 0;
    return true;
}

static uint8_t follow(servo_motion *s, float target_rad)
{
    if (keeps_up(s, target_rad)) {
        return 0;
    }
    if (!is_finite(target_rad)) {
        return stop(s, SERVO_NOT_FINITE);
    }
    uint32_t acted = 0;
    int32_t target;
    const float units = target_rad * UNITS_PER_RAD;
    /* a whole unit of grace: the range was rounded inward */
    if (units >= (float)s->max + 1.0f) {
        acted = SERVO_AT_ANGLE;
        target = s->max;
    } else if (units <= (float)s->min - 1.0f) {
        acted = SERVO_AT_ANGLE;
        target = s->min;
    } else {
        target = clamp(to_units(target_rad), s->min, s->max);
    }
    /* Move as the target moved, and besides toward it, no faster than can be braked before it. */
    const int32_t moved = s->target_known ? clamp(target - s->target, -s->rate, s->rate) : 0;
    const int32_t behind = (s->target_known ? s->target : target) - s->goal;
    const int32_t close = behind >= 0 ? stop_speed(s, behind) : -stop_speed(s, -behind);
    s->target = target;
    s->target_known = true;
    return advance(s, moved + close, acted);
}

static uint32_t count_up(servo_map *map, int servo, uint32_t acted)
{
    for (int limiter = 0; acted >> limiter != 0; limiter++) {
        if ((acted >> limiter & 1u) != 0 && map->counts[limiter] < UINT32_MAX) {
            map->counts[limiter]++;
        }
    }
    map->goals_rad[servo] = (float)map->servo[servo].goal * RAD_PER_UNIT;
    return acted;
}

uint32_t servo_map_follow(servo_map *map, const float *targets_rad)
{
    uint32_t acted = 0;
    for (int i = 0; i < map->servos_n; i++) {
        acted |= count_up(map, i, follow(&map->servo[i], targets_rad[i]));
    }
    return acted;
}

uint32_t servo_map_hold(servo_map *map)
{
    uint32_t acted = 0;
    for (int i = 0; i < map->servos_n; i++) {
        acted |= count_up(map, i, stop(&map->servo[i], 0));
    }
    return acted;
}

void servo_map_targets(const servo_map *map, const rod_joint *angles_rad, int links_n,
                       float *targets_rad)
{
    for (int i = 0; i < map->servos_n; i++) {
        const servo_motion *s = &map->servo[i];
        const float angle_rad = s->joint < links_n ? angles_rad[s->joint][s->axis] : 0.0f;
        targets_rad[i] = s->offset_rad + s->sign * angle_rad;
    }
}

void servo_map_straight(const servo_map *map, float *targets_rad)
{
    for (int i = 0; i < map->servos_n; i++) {
        targets_rad[i] = map->servo[i].offset_rad;
    }
}

static void rest_at(servo_map *map, int servo, int32_t goal)
{
    servo_motion *s = &map->servo[servo];
    s->goal = s->target = goal;
    s->speed = 0;
    s->target_known = false;
    s->acted = 0;
    map->goals_rad[servo] = (float)goal * RAD_PER_UNIT;
}

servo_error servo_map_place(servo_map *map, const float *positions_rad, int *servo)
{
    for (int i = 0; i < map->servos_n; i++) {
        if (!(trig_abs(positions_rad[i]) <= SERVO_REACH_RAD)) {
            if (servo != NULL) {
                *servo = i;
            }
            return SERVO_E_POSITION;
        }
    }
    for (int i = 0; i < map->servos_n; i++) {
        rest_at(map, i, to_units(positions_rad[i]));
    }
    return SERVO_OK;
}

/* A limit per period, in units: rounded down, and what the products before may have rounded up first, so
 * never exceeded. */
static int32_t limit_units(float per_period_rad)
{
    const float units = per_period_rad * (UNITS_PER_RAD * (1.0f - 0x1p-21f));
    return units < (float)UNITS_MAX ? (int32_t)units : UNITS_MAX;
}

servo_error servo_map_init(servo_map *map, const servo_config *configs, int servos_n,
                           float period_s, servo_refusal *refusal)
{
    const servo_error error = servo_map_check(configs, servos_n, period_s, refusal);
    if (error != SERVO_OK) {
        return error;
    }
    *map = (servo_map){.servos_n = servos_n, .period_s = period_s};
    for (int i = 0; i < servos_n; i++) {
        const servo_config *c = &configs[i];
        servo_motion *s = &map->servo[i];
        s->joint = c->joint;
        s->axis = c->axis;
        s->sign = (float)c->sign;
        s->offset_rad = c->offset_rad;
        s->min = to_units(c->min_rad);
        s->min += (float)s->min < c->min_rad * UNITS_PER_RAD ? 1 : 0;
        s->max = to_units(c->max_rad);
        s->max -= (float)s->max > c->max_rad * UNITS_PER_RAD ? 1 : 0;
        s->rate = limit_units(c->rate_rad_s * period_s);
        s->accel = limit_units(c->accel_rad_s2 * period_s * period_s);
        s->room_for_more = stopping_room(s->rate + 1, s->accel);
        s->eight_over_accel = 8.0f / (float)s->accel;
        rest_at(map, i, clamp(to_units(c->offset_rad), s->min, s->max));
    }
    return SERVO_OK;
}

const float *servo_map_goals(const servo_map *map)
{
    return map->goals_rad;
}

uint32_t servo_map_acted(const servo_map *map, int servo)
{
    return map->servo[servo].acted;
}

bool servo_map_settled(const servo_map *map)
{
    for (int i = 0; i < map->servos_n; i++) {
        const servo_motion *s = &map->servo[i];
        if (!s->target_known || s->speed != 0 || s->goal != s->target) {
            return false;
        }
    }
    return true;
}
