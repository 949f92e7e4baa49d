/* servo_fixture.h - servo maps for tests, and a witness that no goal ever breaks a limit. */
#ifndef LIMBER_SERVO_FIXTURE_H
#define LIMBER_SERVO_FIXTURE_H

#include <stdio.h>

#include "servo_blend.h"
#include "test_support.h"
#include "unity.h"

#define UNIT_RAD (1.0 / 2097152.0)

static const servo_config ORDINARY = {
    .sign = 1, .min_rad = -1.5f, .max_rad = 1.5f, .rate_rad_s = 6.0f, .accel_rad_s2 = 120.0f};

/* Servos as different as they can be: ranges about and beside zero, from sluggish to hardly limited. */
static inline servo_config random_servo(uint32_t *seed, int servo)
{
    servo_config c = ORDINARY;
    c.id = (uint16_t)servo;
    c.joint = (uint8_t)(servo / 2);
    c.axis = (uint8_t)(servo % 2);
    c.sign = random_below(seed, 2) == 0 ? 1 : -1;
    c.min_rad = (float)random_between(seed, -8.0, 7.0);
    c.max_rad = (float)random_between(seed, (double)c.min_rad + 0.01, 8.0);
    c.offset_rad = (float)random_between(seed, (double)c.min_rad, (double)c.max_rad);
    c.rate_rad_s = (float)random_magnitude(seed, 0.05, 200.0);
    c.accel_rad_s2 = (float)random_magnitude(seed, 5.0, 20000.0);
    return c;
}

static inline servo_map map_of(const servo_config *configs, int servos_n, double period_s)
{
    static servo_map map;
    TEST_ASSERT_EQUAL_INT(SERVO_OK, servo_map_init(&map, configs, servos_n, (float)period_s, NULL));
    return map;
}

/* The last two goals of each servo, and what they may do next. In double, where the differences of goals
 * are exact. */
typedef struct {
    const servo_config *configs;
    int servos_n;
    double period_s;
    double before[SERVOS_MAX], speed[SERVOS_MAX];
} witness;

static inline void witness_rest(witness *w, const servo_config *configs, const servo_map *map)
{
    w->configs = configs;
    w->servos_n = map->servos_n;
    w->period_s = (double)map->period_s;
    for (int i = 0; i < map->servos_n; i++) {
        w->before[i] = (double)servo_map_goals(map)[i];
        w->speed[i] = 0.0;
    }
}

static inline double beyond(double goal, const servo_config *c)
{
    return goal > (double)c->max_rad   ? goal - (double)c->max_rad
           : goal < (double)c->min_rad ? (double)c->min_rad - goal
                                       : 0.0;
}

static inline void witness_period(witness *w, const servo_map *map)
{
    for (int i = 0; i < w->servos_n; i++) {
        const servo_config *c = &w->configs[i];
        const double goal = (double)servo_map_goals(map)[i], speed = goal - w->before[i];
        const double change = speed - w->speed[i];
        const double rate = (double)c->rate_rad_s * w->period_s;
        const double accel = (double)c->accel_rad_s2 * w->period_s * w->period_s;
        if (!(fabs(speed) <= rate) || !(fabs(change) <= accel) ||
            beyond(goal, c) > beyond(w->before[i], c)) {
            char text[160];
            snprintf(text, sizeof text,
                     "servo %d: speed %g of %g, change %g of %g, goal %g in %g %g", i, speed, rate,
                     change, accel, goal, (double)c->min_rad, (double)c->max_rad);
            TEST_FAIL_MESSAGE(text);
        }
        w->before[i] = goal;
        w->speed[i] = speed;
    }
}

#endif
