/* test_servo_config.c - what a servo map refuses, and how it says so. */
#include "servo_fixture.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static servo_config two[2];

static void expect(servo_error error, int servo, float period_s)
{
    static servo_map map, before;
    servo_refusal refusal;
    memset(&map, 0x5A, sizeof map);
    before = map;
    TEST_ASSERT_EQUAL_INT(error, servo_map_init(&map, two, 2, period_s, &refusal));
    TEST_ASSERT_EQUAL_INT(error, refusal.error);
    TEST_ASSERT_EQUAL_INT(servo, refusal.servo);
    TEST_ASSERT_EQUAL_INT(error, servo_map_check(two, 2, period_s, NULL));
    if (error != SERVO_OK) {
        TEST_ASSERT_EQUAL_MEMORY(&before, &map, sizeof map);
    }
}

static void fill(void)
{
    two[0] = two[1] = ORDINARY;
    two[1].id = 9;
    two[1].axis = ROD_PHI;
}

#define EXPECT_WITH(error, change)                                                                 \
    do {                                                                                           \
        fill();                                                                                    \
        two[1].change;                                                                             \
        expect(error, (error) == SERVO_OK ? -1 : 1, 0.001f);                                       \
    } while (0)

static void every_field_is_checked_at_its_bounds(void)
{
    EXPECT_WITH(SERVO_OK, id = 9);
    EXPECT_WITH(SERVO_E_ID, id = two[0].id);
    EXPECT_WITH(SERVO_OK, joint = ROD_MAX_LINKS - 1);
    if (ROD_MAX_LINKS < 256) {
        EXPECT_WITH(SERVO_E_JOINT, joint = (uint8_t)ROD_MAX_LINKS);
    }
    EXPECT_WITH(SERVO_E_AXIS, axis = 2);
    EXPECT_WITH(SERVO_OK, sign = -1);
    EXPECT_WITH(SERVO_E_SIGN, sign = 0);
    EXPECT_WITH(SERVO_E_SIGN, sign = 2);
    EXPECT_WITH(SERVO_E_SIGN, sign = -2);
    EXPECT_WITH(SERVO_OK, min_rad = -8.0f);
    EXPECT_WITH(SERVO_OK, max_rad = 8.0f);
    EXPECT_WITH(SERVO_E_RANGE, min_rad = nextafterf(-8.0f, -9.0f));
    EXPECT_WITH(SERVO_E_RANGE, max_rad = nextafterf(8.0f, 9.0f));
    EXPECT_WITH(SERVO_E_RANGE, max_rad = two[1].min_rad);
    EXPECT_WITH(SERVO_OK, offset_rad = 1.5f);
    EXPECT_WITH(SERVO_E_OFFSET, offset_rad = nextafterf(1.5f, 2.0f));
    EXPECT_WITH(SERVO_E_OFFSET, offset_rad = nextafterf(-1.5f, -2.0f));
    EXPECT_WITH(SERVO_OK, rate_rad_s = 0.0005f);
    EXPECT_WITH(SERVO_E_RATE, rate_rad_s = 0.0004f);
    EXPECT_WITH(SERVO_OK, rate_rad_s = 1000.0f);
    EXPECT_WITH(SERVO_E_RATE, rate_rad_s = 1001.0f);
    EXPECT_WITH(SERVO_OK, accel_rad_s2 = 0.5f);
    EXPECT_WITH(SERVO_E_ACCEL, accel_rad_s2 = 0.4f);
    EXPECT_WITH(SERVO_OK, accel_rad_s2 = 1e5f);
    EXPECT_WITH(SERVO_E_ACCEL, accel_rad_s2 = 1.1e5f);
}

static void nothing_that_is_not_a_number_gets_in(void)
{
    static const float NOT_NUMBERS[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        EXPECT_WITH(SERVO_E_RANGE, min_rad = NOT_NUMBERS[i]);
        EXPECT_WITH(SERVO_E_RANGE, max_rad = NOT_NUMBERS[i]);
        EXPECT_WITH(SERVO_E_OFFSET, offset_rad = NOT_NUMBERS[i]);
        EXPECT_WITH(SERVO_E_RATE, rate_rad_s = NOT_NUMBERS[i]);
        EXPECT_WITH(SERVO_E_ACCEL, accel_rad_s2 = NOT_NUMBERS[i]);
        fill();
        expect(SERVO_E_PERIOD, -1, NOT_NUMBERS[i]);
    }
}

static void period_and_count_have_bounds(void)
{
    static servo_map map;
    fill();
    expect(SERVO_OK, -1, SERVO_PERIOD_MAX_S);
    expect(SERVO_E_PERIOD, -1, 0.11f);
    expect(SERVO_E_PERIOD, -1, 0.0004f);
    expect(SERVO_E_PERIOD, -1, 0.0f);
    two[0].accel_rad_s2 = two[1].accel_rad_s2 = 120.0f;
    expect(SERVO_OK, -1, SERVO_PERIOD_MIN_S);
    TEST_ASSERT_EQUAL_INT(SERVO_E_COUNT, servo_map_init(&map, two, -1, 0.001f, NULL));
    TEST_ASSERT_EQUAL_INT(SERVO_E_COUNT, servo_map_init(&map, two, SERVOS_MAX + 1, 0.001f, NULL));
    TEST_ASSERT_EQUAL_INT(SERVO_OK, servo_map_init(&map, two, 0, 0.001f, NULL));
    TEST_ASSERT_TRUE(servo_map_settled(&map));
}

static void a_refusal_states_value_and_bounds(void)
{
    servo_refusal refusal;
    fill();
    two[1].offset_rad = 1.75f;
    servo_map_check(two, 2, 0.001f, &refusal);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 1.75f, refusal.value);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, -1.5f, refusal.min);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 1.5f, refusal.max);
}

static void each_error_has_its_own_text(void)
{
    const char *unknown = servo_error_text((servo_error)-99);
    for (int i = 0; i >= SERVO_E_POSITION; i--) {
        for (int j = 0; j > i; j--) {
            TEST_ASSERT_TRUE(
                strcmp(servo_error_text((servo_error)i), servo_error_text((servo_error)j)) != 0);
        }
        TEST_ASSERT_TRUE(strcmp(servo_error_text((servo_error)i), unknown) != 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_field_is_checked_at_its_bounds);
    RUN_TEST(nothing_that_is_not_a_number_gets_in);
    RUN_TEST(period_and_count_have_bounds);
    RUN_TEST(a_refusal_states_value_and_bounds);
    RUN_TEST(each_error_has_its_own_text);
    return UNITY_END();
}
