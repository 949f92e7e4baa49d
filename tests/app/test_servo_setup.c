/* test_servo_setup.c - how often servos are served, and what is refused because they cannot be. */
#include "servo_setup.h"
#include "servos.h"
#include "unity.h"

static params all;
static servo_setup setup;
static params_refusal why;

void setUp(void)
{
    params_init(&all);
    all.in_force.rod.links_n = 4;
}

void tearDown(void) {}

static void bus_of(int links_n, uint32_t baud)
{
    all.in_force.rod.links_n = links_n;
    all.in_force.device.servo_kind = SERVOS_BUS;
    all.in_force.device.servo_baud = (float)baud;
}

static void refused(uint8_t reason, const char *field)
{
    TEST_ASSERT_FALSE(servo_setup_make(&setup, &all.in_force, &why));
    TEST_ASSERT_EQUAL_INT(reason, why.reason);
    TEST_ASSERT_EQUAL_STRING(field, why.field);
    TEST_ASSERT_TRUE(why.text != NULL && why.text[0] != '\0');
}

static void without_servos_at_any_whole_tick(void)
{
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
    TEST_ASSERT_EQUAL_INT(8, setup.servos_n);
    TEST_ASSERT_EQUAL_INT(1, setup.period_ticks);
    const struct {
        float asked_hz;
        int ticks;
    } cases[] = {{1000.0f, 1}, {900.0f, 2}, {500.0f, 2}, {499.0f, 3}, {10.0f, 100}};
    for (int i = 0; i < 5; i++) {
        all.in_force.device.servo_hz = cases[i].asked_hz;
        TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
        TEST_ASSERT_EQUAL_INT(cases[i].ticks, setup.period_ticks);
    }
}

/* The wire decides, bit by bit: never sooner than 14 + 5 n bytes of ten bits take. */
static void a_bus_is_served_as_often_as_it_carries(void)
{
    static const uint32_t BAUDS[] = {57600, 115200, 1000000, 2000000, 3000000, 4000000};
    static const int LINKS_N[] = {1, 4, 10, 50, 64};
    for (int b = 0; b < 6; b++) {
        for (int l = 0; l < 5 && LINKS_N[l] <= ROD_MAX_LINKS; l++) {
            bus_of(LINKS_N[l], BAUDS[b]);
            const float bytes_s = 10.0f * (14.0f + 10.0f * (float)LINKS_N[l]) / (float)BAUDS[b];
            if (!servo_setup_make(&setup, &all.in_force, &why)) {
                TEST_ASSERT_TRUE_MESSAGE(bytes_s > 0.04f, "only what takes too long is refused");
                continue;
            }
            TEST_ASSERT_TRUE(setup.period_s >= bytes_s);
            TEST_ASSERT_TRUE(setup.period_s <= 1.3f * bytes_s + 0.004f);
        }
    }
    bus_of(50, 4000000);
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
    TEST_ASSERT_EQUAL_INT(2, setup.period_ticks); /* 1.3 ms, and a question */
}

static void a_rate_that_the_bus_does_not_carry_is_refused_with_what_it_does(void)
{
    bus_of(4, 57600); /* 54 bytes: 9.4 ms */
    all.in_force.device.servo_hz = 200.0f;
    refused(REASON_LINE_RATE, "servo_rate");
    TEST_ASSERT_TRUE(why.max > 50.0f && why.max < 106.0f);
    all.in_force.device.servo_hz = 0.99f * why.max;
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
}

static void hobby_servos_are_served_once_a_pulse(void)
{
    all.in_force.device.servo_kind = SERVOS_PWM;
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
    TEST_ASSERT_EQUAL_INT(20, setup.period_ticks);
    all.in_force.device.pwm_hz = 333.0f;
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
    TEST_ASSERT_EQUAL_INT(4, setup.period_ticks);
    all.in_force.device.servo_hz = 400.0f;
    refused(REASON_COMBINATION, "servo_rate");
}

static void what_cannot_be_driven_is_refused(void)
{
    all.in_force.device.servo_kind = SERVOS_PWM;
    all.in_force.rod.links_n = 5;
    refused(REASON_COMBINATION, "links");
    TEST_ASSERT_TRUE(why.value > 4.9f && why.value < 5.1f && why.max > 3.9f && why.max < 4.1f);
    all.in_force.rod.links_n = 4;
    all.in_force.device.servo_id[3] = 9.0f;
    refused(REASON_COMBINATION, "servo_id");
    TEST_ASSERT_EQUAL_INT(3, why.entry);
    bus_of(4, 1000000);
    all.in_force.device.servo_id[3] = all.in_force.device.servo_id[1];
    refused(REASON_COMBINATION, "servo_id");
    all.in_force.device.servo_id[3] = 9.0f;
    TEST_ASSERT_TRUE(servo_setup_make(&setup, &all.in_force, &why));
    bus_of(4, 250000); /* no such rate in the X series */
    refused(REASON_COMBINATION, "servo_baud");
    TEST_ASSERT_TRUE(why.value > 249999.0f && why.value < 250001.0f && why.min > 9599.0f);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(without_servos_at_any_whole_tick);
    RUN_TEST(a_bus_is_served_as_often_as_it_carries);
    RUN_TEST(a_rate_that_the_bus_does_not_carry_is_refused_with_what_it_does);
    RUN_TEST(hobby_servos_are_served_once_a_pulse);
    RUN_TEST(what_cannot_be_driven_is_refused);
    return UNITY_END();
}
