/* test_servo_map.c - signs and offsets, which limiter acted, stopping without a target, placing. */
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

static void each_limiter_raises_its_flag_and_its_count(void)
{
    const servo_config c = ORDINARY;
    servo_map map = map_of(&c, 1, PERIOD_S);
    TEST_ASSERT_EQUAL_HEX32(0, follow_one(&map, 0.0));
    TEST_ASSERT_EQUAL_HEX32(SERVO_AT_ACCEL, follow_one(&map, 1.0));
    uint32_t acted = 0;
    for (int period = 0; period < 60; period++) { /* 6 / 120 s until at full rate */
        acted = follow_one(&map, 1.0);
    }
    TEST_ASSERT_EQUAL_HEX32(SERVO_AT_RATE, acted);
    TEST_ASSERT_EQUAL_HEX32(SERVO_NOT_FINITE | SERVO_AT_ACCEL, follow_one(&map, (double)NAN));
    TEST_ASSERT_EQUAL_HEX32(SERVO_NOT_FINITE | SERVO_AT_ACCEL, servo_map_acted(&map, 0));
    for (int period = 0; period < 1000; period++) {
        acted = follow_one(&map, 1.6);
    }
    TEST_ASSERT_EQUAL_HEX32(SERVO_AT_ANGLE, acted);
    TEST_ASSERT_EQUAL_UINT32(1, map.counts[0]);
    TEST_ASSERT_EQUAL_UINT32(1000, map.counts[1]);
    TEST_ASSERT_TRUE(map.counts[2] >= 50 && map.counts[2] <= 200);
}

static void a_target_that_moves_faster_than_the_rate_is_flagged_for_it(void)
{
    const servo_config c = ORDINARY;
    servo_map map = map_of(&c, 1, PERIOD_S);
    uint32_t acted = 0;
    for (int period = 0; period < 100; period++) {
        acted = follow_one(&map, 0.012 * period);
    }
    TEST_ASSERT_TRUE((acted & SERVO_AT_RATE) != 0);
    TEST_ASSERT_TRUE(map.counts[3] > 0);
}

static void flags_are_of_all_servos_and_of_each(void)
{
    servo_config c[2] = {ORDINARY, ORDINARY};
    c[1].id = 1;
    servo_map map = map_of(c, 2, PERIOD_S);
    const float targets[2] = {0.0f, NAN};
    TEST_ASSERT_EQUAL_HEX32(SERVO_NOT_FINITE, servo_map_follow(&map, targets));
    TEST_ASSERT_EQUAL_HEX32(0, servo_map_acted(&map, 0));
    TEST_ASSERT_EQUAL_HEX32(SERVO_NOT_FINITE, servo_map_acted(&map, 1));
}

/* --- not finite, hold, placing ----------------------------------------------------------------- */

/* At full rate, then nothing: brakes as hard as it may, rests 6^2 / (2 * 120) rad further, stays. */
static void without_a_target_it_brakes_and_holds(void)
{
    static const float NOT_NUMBERS[] = {NAN, INFINITY, -INFINITY};
    for (int kind = 0; kind < 4; kind++) {
        const servo_config c = ORDINARY;
        servo_map map = map_of(&c, 1, PERIOD_S);
        static witness w;
        witness_rest(&w, &c, &map);
        for (int period = 0; period < 100; period++) {
            follow_one(&map, 1.4);
            witness_period(&w, &map);
        }
        const double from = goal_of(&map);
        for (int period = 0; period < 2000; period++) {
            const double before = goal_of(&map);
            const uint32_t acted =
                kind < 3 ? servo_map_follow(&map, &NOT_NUMBERS[kind]) : servo_map_hold(&map);
            witness_period(&w, &map);
            TEST_ASSERT_EQUAL(kind < 3, (acted & SERVO_NOT_FINITE) != 0);
            TEST_ASSERT_TRUE(period < 52 || fabs(goal_of(&map) - before) <= 0.0);
        }
        TEST_ASSERT_DOUBLE_WITHIN(0.005, 0.15, goal_of(&map) - from);
        /* and follows again, without a kick from a target that moved meanwhile */
        for (int period = 0; period < 2000; period++) {
            follow_one(&map, -1.0);
            witness_period(&w, &map);
        }
        TEST_ASSERT_DOUBLE_WITHIN(UNIT_RAD, -1.0, goal_of(&map));
    }
}

/* A target seen before the stop must not count as where the next one came from. */
static void after_a_stop_the_next_target_is_taken_as_new(void)
{
    const servo_config c = ORDINARY;
    servo_map map = map_of(&c, 1, PERIOD_S);
    follow_one(&map, 0.02);
    for (int period = 0; period < 10; period++) {
        servo_map_hold(&map);
    }
    const double rest = goal_of(&map);
    TEST_ASSERT_EQUAL_HEX32(0, follow_one(&map, rest));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, rest, goal_of(&map));
    TEST_ASSERT_TRUE(servo_map_settled(&map));
}

static void placing_takes_positions_as_they_are_or_not_at_all(void)
{
    servo_config c[2] = {ORDINARY, ORDINARY};
    c[1].id = 1;
    servo_map map = map_of(c, 2, PERIOD_S);
    float positions[2] = {0.7f, 2.5f}; /* the second beyond its range: bent by hand */
    TEST_ASSERT_EQUAL_INT(SERVO_OK, servo_map_place(&map, positions, NULL));
    TEST_ASSERT_FLOAT_WITHIN((float)UNIT_RAD, 0.7f, servo_map_goals(&map)[0]);
    TEST_ASSERT_FLOAT_WITHIN((float)UNIT_RAD, 2.5f, servo_map_goals(&map)[1]);
    servo_map_hold(&map);
    TEST_ASSERT_FLOAT_WITHIN((float)UNIT_RAD, 2.5f, servo_map_goals(&map)[1]);

    static const float BAD[] = {NAN, INFINITY, 8.5f, -8.5f};
    for (int i = 0; i < 4; i++) {
        const servo_map before = map;
        int servo = -1;
        positions[1] = BAD[i];
        TEST_ASSERT_EQUAL_INT(SERVO_E_POSITION, servo_map_place(&map, positions, &servo));
        TEST_ASSERT_EQUAL_INT(1, servo);
        TEST_ASSERT_EQUAL_MEMORY(&before, &map, sizeof map);
    }
}

static void the_map_places_signs_and_offsets(void)
{
    enum { N = 4 };
    static const struct {
        uint8_t joint, axis;
        int8_t sign;
        float offset, expected;
    } CASES[N] = {{0, ROD_THETA, 1, 0.0f, 0.1f},
                  {0, ROD_PHI, -1, 0.5f, 0.3f},
                  {1, ROD_PHI, 1, -0.5f, -0.1f},
                  {7, ROD_THETA, -1, 1.0f, 1.0f}}; /* no such link: straight */
    servo_config c[N];
    for (int i = 0; i < N; i++) {
        c[i] = ORDINARY;
        c[i].id = (uint16_t)i;
        c[i].joint = CASES[i].joint;
        c[i].axis = CASES[i].axis;
        c[i].sign = CASES[i].sign;
        c[i].offset_rad = CASES[i].offset;
    }
    const servo_map map = map_of(c, N, PERIOD_S);
    const rod_joint angles[2] = {{0.1f, 0.2f}, {0.3f, 0.4f}};
    float targets[N];
    servo_map_targets(&map, angles, 2, targets);
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-7f, CASES[i].expected, targets[i]);
        TEST_ASSERT_FLOAT_WITHIN((float)UNIT_RAD, CASES[i].offset, servo_map_goals(&map)[i]);
    }
    servo_map_straight(&map, targets);
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.0f, CASES[i].offset, targets[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_limiter_raises_its_flag_and_its_count);
    RUN_TEST(a_target_that_moves_faster_than_the_rate_is_flagged_for_it);
    RUN_TEST(flags_are_of_all_servos_and_of_each);
    RUN_TEST(without_a_target_it_brakes_and_holds);
    RUN_TEST(after_a_stop_the_next_target_is_taken_as_new);
    RUN_TEST(placing_takes_positions_as_they_are_or_not_at_all);
    RUN_TEST(the_map_places_signs_and_offsets);
    return UNITY_END();
}
