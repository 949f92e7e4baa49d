/* test_servo_blend.c - blends: smooth at both ends, for resting and moving joints, and before the limits. */
#include "servo_fixture.h"

void setUp(void) {}
void tearDown(void) {}

#define PERIOD_S 0.001

static servo_blend blend;

static servo_map one_servo_at(float position_rad)
{
    const servo_config c = ORDINARY;
    servo_map map = map_of(&c, 1, PERIOD_S);
    servo_map_place(&map, &position_rad, NULL);
    return map;
}

static double mixed(double target_rad)
{
    float target = (float)target_rad;
    servo_blend_mix(&blend, &target);
    return (double)target;
}

static void without_a_blend_targets_pass(void)
{
    servo_blend_none(&blend);
    TEST_ASSERT_TRUE(servo_blend_done(&blend));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.625, mixed(0.625));
    const servo_map map = one_servo_at(0.3f);
    servo_blend_from_rest(&blend, &map, 0);
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.625, mixed(0.625));
}

/* From rest to a resting target: the minimum-jerk curve, in the time asked for. */
static void the_weight_runs_the_minimum_jerk_curve(void)
{
    const servo_map map = one_servo_at(-0.5f);
    servo_blend_from_rest(&blend, &map, 1000000);
    double before = -0.5, fastest = 0.0;
    for (int period = 1; period <= 1000; period++) {
        TEST_ASSERT_FALSE(servo_blend_done(&blend));
        const double s = period / 1000.0, now = mixed(0.5);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, s * s * s * (10.0 - 15.0 * s + 6.0 * s * s) - 0.5, now);
        TEST_ASSERT_TRUE(now - before >= -1e-6);
        fastest = fmax(fastest, now - before);
        before = now;
    }
    TEST_ASSERT_TRUE(servo_blend_done(&blend));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.5, before);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.875, fastest * 1000.0);
}

static void a_blend_takes_no_less_than_its_time(void)
{
    static const double PERIODS_S[] = {0.0005, 0.001, 0.003, 0.02, 0.1};
    for (int i = 0; i < 5; i++) {
        servo_config c = ORDINARY;
        const servo_map map = map_of(&c, 1, PERIODS_S[i]);
        servo_blend_from_rest(&blend, &map, 2000000);
        int periods = 0;
        while (!servo_blend_done(&blend)) {
            mixed(1.0);
            periods++;
        }
        TEST_ASSERT_TRUE(periods * PERIODS_S[i] >= 2.0 - 1e-6);
        TEST_ASSERT_TRUE((periods - 1.01) * PERIODS_S[i] <= 2.0);
    }
}

/* Arming onto a rod in full swing: the limits have nothing to do at either end. */
static void arming_onto_a_moving_rod_never_jumps(void)
{
    servo_map map = one_servo_at(0.9f);
    servo_blend_from_rest(&blend, &map, 1000000);
    double before = 0.9, speed = 0.0, hardest = 0.0;
    for (int period = 1; period <= 3000; period++) {
        const double now = mixed(0.4 * sin(7.0 * period * PERIOD_S + 1.0));
        hardest = fmax(hardest, fabs(now - before - speed));
        speed = now - before;
        before = now;
        float target = (float)now;
        TEST_ASSERT_EQUAL_HEX32(0, servo_map_follow(&map, &target));
    }
    TEST_ASSERT_TRUE(hardest < 45.0 * PERIOD_S * PERIOD_S);
}

/* A preset change in full swing, the new rod elsewhere but as fast: the motion goes on. */
static void a_blend_from_motion_keeps_the_speed(void)
{
    servo_map map = one_servo_at(0.0f);
    double before = 0.0, speed = 0.0, hardest = 0.0;
    servo_blend_none(&blend);
    int phase = 0;
    for (int period = 0; period <= 6000; period++) {
        const double swing = 0.4 * sin(7.0 * period * PERIOD_S), s = fmin(period / 1000.0, 1.0);
        const double ease = s * s * (3.0 - 2.0 * s);
        if (period >= 2000 && (period - 2000) % 1100 == 0) {
            phase++;
            const float here =
                (float)(0.4 * sin(7.0 * (period - 1) * PERIOD_S) + 0.2 * (phase % 2));
            servo_blend_from_motion(&blend, &map, &here, 1000000);
        }
        float target = (float)mixed(swing * ease + 0.2 * (phase % 2));
        TEST_ASSERT_EQUAL_HEX32(0, servo_map_follow(&map, &target));
        const double now = (double)servo_map_goals(&map)[0];
        hardest = period > 1500 ? fmax(hardest, fabs(now - before - speed)) : 0.0;
        speed = now - before;
        before = now;
    }
    TEST_ASSERT_TRUE(hardest < 45.0 * PERIOD_S * PERIOD_S);
}

/* A hundred changes to rods anywhere, at random moments: no limit broken, whatever the old one did. */
static void a_hundred_changes_while_moving_break_no_limit(void)
{
    uint32_t seed = 100u;
    const servo_config c = ORDINARY;
    servo_map map = map_of(&c, 1, PERIOD_S);
    static witness w;
    witness_rest(&w, &c, &map);
    servo_blend_none(&blend);
    double amplitude = 0.5, centre = 0.0;
    for (int change = 0, period = 0; change < 100; period++) {
        const double swing = sin(5.0 * period * PERIOD_S);
        if (random_below(&seed, 150) == 0) {
            change++;
            amplitude = random_between(&seed, 0.0, 1.5);
            centre = random_between(&seed, -1.0, 1.0);
            const float here = (float)(centre + amplitude * swing);
            if (change % 2 == 0) {
                servo_blend_from_motion(&blend, &map, &here, 200000);
            } else {
                servo_blend_from_rest(&blend, &map, 200000);
            }
        }
        const float target = (float)mixed(centre + amplitude * swing);
        servo_map_follow(&map, &target);
        witness_period(&w, &map);
    }
}

/* RELAX from anywhere, with servos that can hardly keep up as well: straight at the end, settled. */
static void the_ramp_to_straight_takes_two_seconds_and_ends_straight(void)
{
    enum { N = 6 };
    uint32_t seed = 3u;
    for (int round = 0; round < HOST_OR_BOARD(50, 3); round++) {
        servo_config c[N];
        float placed[N], targets[N];
        for (int i = 0; i < N; i++) {
            c[i] = ORDINARY;
            c[i].id = (uint16_t)i;
            c[i].offset_rad = (float)random_between(&seed, -1.0, 1.0);
            c[i].rate_rad_s = (float)random_between(&seed, 0.7, 6.0);
            placed[i] = (float)random_between(&seed, -1.5, 1.5);
        }
        servo_map map = map_of(c, N, PERIOD_S);
        servo_map_place(&map, placed, NULL);
        static witness w;
        witness_rest(&w, c, &map);
        servo_blend_from_rest(&blend, &map, 2000000);
        int periods = 0;
        while (!servo_blend_done(&blend) || !servo_map_settled(&map)) {
            servo_map_straight(&map, targets);
            servo_blend_mix(&blend, targets);
            servo_map_follow(&map, targets);
            witness_period(&w, &map);
            TEST_ASSERT_TRUE(++periods < 5000);
        }
        TEST_ASSERT_TRUE(periods >= 2000);
        for (int i = 0; i < N; i++) {
            TEST_ASSERT_FLOAT_WITHIN((float)UNIT_RAD, c[i].offset_rad, servo_map_goals(&map)[i]);
        }
    }
}

static void what_is_not_a_number_is_left_to_the_limits_and_forgotten(void)
{
    const servo_map map = one_servo_at(0.25f);
    const float not_a_number = NAN;
    servo_blend_from_motion(&blend, &map, &not_a_number, 1000000);
    TEST_ASSERT_TRUE(isnan(mixed((double)NAN)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.5, mixed(0.5));
    servo_blend_from_rest(&blend, &map, 1000000);
    TEST_ASSERT_TRUE(isnan(mixed((double)NAN)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.25, mixed(0.5));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(without_a_blend_targets_pass);
    RUN_TEST(the_weight_runs_the_minimum_jerk_curve);
    RUN_TEST(a_blend_takes_no_less_than_its_time);
    RUN_TEST(arming_onto_a_moving_rod_never_jumps);
    RUN_TEST(a_blend_from_motion_keeps_the_speed);
    RUN_TEST(a_hundred_changes_while_moving_break_no_limit);
    RUN_TEST(the_ramp_to_straight_takes_two_seconds_and_ends_straight);
    RUN_TEST(what_is_not_a_number_is_left_to_the_limits_and_forgotten);
    return UNITY_END();
}
