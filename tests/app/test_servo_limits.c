/* test_servo_limits.c - the limits: whatever comes in, no goal breaks one, and what is within them passes. */
#include "servo_fixture.h"

void setUp(void) {}
void tearDown(void) {}

#define PERIOD_S 0.001

static uint32_t follow_one(servo_map *map, double target_rad)
{
    const float target = (float)target_rad;
    return servo_map_follow(map, &target);
}

static double goal_of(const servo_map *map)
{
    return (double)servo_map_goals(map)[0];
}

/* Everything a rod, a broken rod and a broken link can ask for, in bursts of one kind. */
static float random_target(uint32_t *seed, int kind, int period, float last_rad)
{
    switch (kind) {
    case 0: /* leaps */
        return random_below(seed, 200) == 0 ? (float)random_between(seed, -9.0, 9.0) : last_rad;
    case 1: /* noise */
        return (float)random_between(seed, -9.0, 9.0);
    case 2: /* a wave whose amplitude and pace change */
        return (float)(sin((double)period * 0.01) * (double)(period % 1000) * 0.004);
    case 3: /* a walk */
        return last_rad + (float)random_between(seed, -0.02, 0.02);
    case 4: /* not numbers, now and then */
        return random_below(seed, 20) == 0 ? float_of(0x7F800000u | random_bits(seed)) : last_rad;
    default: /* any bits at all */
        return float_of(random_bits(seed));
    }
}

static void no_input_breaks_a_limit(void)
{
    enum { SERVOS_N = 16, KINDS_N = 6, MAPS_N = HOST_OR_BOARD(64, 2), PERIODS_N = 1000 };
    uint32_t seed = 57u;
    static witness w;
    for (int round = 0; round < MAPS_N; round++) {
        servo_config configs[SERVOS_N];
        float targets[SERVOS_N] = {0}, placed[SERVOS_N];
        for (int i = 0; i < SERVOS_N; i++) {
            configs[i] = random_servo(&seed, i);
            placed[i] = (float)random_between(&seed, -8.0, 8.0);
        }
        servo_map map = map_of(configs, SERVOS_N, round % 2 == 0 ? 0.001 : 0.02);
        if (round % 4 >= 2) { /* else straight */
            TEST_ASSERT_EQUAL_INT(SERVO_OK, servo_map_place(&map, placed, NULL));
        }
        witness_rest(&w, configs, &map);
        for (int period = 0; period < PERIODS_N * KINDS_N; period++) {
            const int kind = period / PERIODS_N;
            for (int i = 0; i < SERVOS_N; i++) {
                targets[i] = random_target(&seed, kind, period, targets[i]);
            }
            if (period % 97 < 5) {
                servo_map_hold(&map);
            } else {
                servo_map_follow(&map, targets);
            }
            witness_period(&w, &map);
        }
    }
}

/* --- resting targets --------------------------------------------------------------------------- */

/* The least time over a way from rest to rest: up, along, down; each of whole periods. */
static double least_periods(double way_rad, const servo_config *c)
{
    const double rate = (double)c->rate_rad_s, accel = (double)c->accel_rad_s2;
    const double ramps = rate * rate / accel;
    return (way_rad > ramps ? way_rad / rate + rate / accel : 2.0 * sqrt(way_rad / accel)) /
           PERIOD_S;
}

static void a_resting_target_is_met_without_overshoot_and_in_hardly_more_than_the_least_time(void)
{
    uint32_t seed = 7u;
    for (int round = 0; round < HOST_OR_BOARD(3000, 20); round++) {
        servo_config c = ORDINARY;
        c.rate_rad_s = (float)random_between(&seed, 1.0, 20.0);
        c.accel_rad_s2 = (float)random_between(&seed, 30.0, 3000.0);
        servo_map map = map_of(&c, 1, PERIOD_S);
        static witness w;
        witness_rest(&w, &c, &map);
        const double target = random_between(&seed, -1.5, 1.5), side = target < 0.0 ? -1.0 : 1.0;
        const double bound = least_periods(fabs(target), &c) * 1.03 + 8.0;
        int periods = 0;
        while (!servo_map_settled(&map) || periods == 0) {
            follow_one(&map, target);
            witness_period(&w, &map);
            periods++;
            TEST_ASSERT_TRUE(side * (goal_of(&map) - target) <= UNIT_RAD);
            TEST_ASSERT_TRUE(side * w.speed[0] >= 0.0);
            TEST_ASSERT_TRUE((double)periods < bound);
        }
        TEST_ASSERT_TRUE(fabs(goal_of(&map) - target) <= UNIT_RAD);
    }
}

static void a_target_beyond_the_end_is_followed_to_the_end_and_not_a_unit_further(void)
{
    uint32_t seed = 8u;
    for (int round = 0; round < HOST_OR_BOARD(1000, 20); round++) {
        servo_config c = random_servo(&seed, 0);
        servo_map map = map_of(&c, 1, PERIOD_S);
        static witness w;
        witness_rest(&w, &c, &map);
        const bool up = random_below(&seed, 2) == 0;
        const double end = (double)(up ? c.max_rad : c.min_rad);
        uint32_t acted = 0;
        int periods = 0;
        do {
            acted = follow_one(&map, up ? 1e30 : -1e30);
            witness_period(&w, &map);
        } while (!servo_map_settled(&map) && ++periods < 400000);
        TEST_ASSERT_TRUE(fabs(goal_of(&map) - end) <= UNIT_RAD);
        TEST_ASSERT_EQUAL_HEX32(SERVO_AT_ANGLE, acted);
    }
}

/* --- moving targets ---------------------------------------------------------------------------- */

static void a_target_within_the_limits_passes_unchanged_and_unflagged(void)
{
    servo_config c = ORDINARY;
    c.sign = -1;
    c.offset_rad = 0.25f;
    servo_map map = map_of(&c, 1, PERIOD_S);
    /* 1 rad at 9 rad/s: 9 rad/s is too fast, 0.5 rad gives 4.5 rad/s and 40 rad/s^2; eased in */
    for (int period = 0; period < 20000; period++) {
        const double t = period * PERIOD_S, ease = t < 2.0 ? t * t * (3.0 - t) / 4.0 : 1.0;
        const rod_joint joint = {(float)(0.5 * ease * sin(9.0 * t)), 0.0f};
        float target;
        servo_map_targets(&map, &joint, 1, &target);
        TEST_ASSERT_EQUAL_HEX32(0, servo_map_follow(&map, &target));
        TEST_ASSERT_TRUE(fabs(goal_of(&map) - (0.25 - (double)joint[ROD_THETA])) <=
                         0.51 * UNIT_RAD + 1e-7);
    }
    for (int limiter = 0; limiter < SERVO_LIMITERS_N; limiter++) {
        TEST_ASSERT_EQUAL_UINT32(0, map.counts[limiter]);
    }
}

static void a_moving_target_is_caught_up_with_and_then_followed_without_lag(void)
{
    uint32_t seed = 9u;
    for (int round = 0; round < HOST_OR_BOARD(500, 5); round++) {
        const servo_config c = ORDINARY;
        servo_map map = map_of(&c, 1, PERIOD_S);
        const double amplitude = random_between(&seed, 0.05, 0.8);
        /* up to half of what rate and acceleration allow */
        const double fastest = fmin(3.0 / amplitude, sqrt(60.0 / amplitude));
        const double omega = random_between(&seed, 0.5, fastest);
        const double phase = random_between(&seed, -PI, PI);
        const float start = (float)random_between(&seed, -1.5, 1.5);
        servo_map_place(&map, &start, NULL);
        for (int period = 0; period < 4000; period++) {
            const double target = amplitude * sin(omega * period * PERIOD_S + phase);
            const uint32_t acted = follow_one(&map, target);
            if (period >= 1500) {
                TEST_ASSERT_EQUAL_HEX32(0, acted);
                TEST_ASSERT_TRUE(fabs(goal_of(&map) - target) <= UNIT_RAD);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_input_breaks_a_limit);
    RUN_TEST(a_resting_target_is_met_without_overshoot_and_in_hardly_more_than_the_least_time);
    RUN_TEST(a_target_beyond_the_end_is_followed_to_the_end_and_not_a_unit_further);
    RUN_TEST(a_target_within_the_limits_passes_unchanged_and_unflagged);
    RUN_TEST(a_moving_target_is_caught_up_with_and_then_followed_without_lag);
    return UNITY_END();
}
