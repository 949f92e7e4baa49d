/* test_servo_pwm.c - hobby servos: pulses, one channel after the other. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

static servos_config hobby(int servos_n)
{
    wire_fresh(0);
    servos_config config = {.kind = SERVOS_PWM,
                            .servos_n = servos_n,
                            .pwm_hz = 50.0f,
                            .pwm_center_us = 1500.0f,
                            .pwm_us_per_rad = 636.62f};
    for (int i = 0; i < servos_n; i++) {
        config.id[i] = (uint8_t)(i + 1);
    }
    return config;
}

static void on(const servos_config *config)
{
    prepared(config);
    TEST_ASSERT_TRUE(w.supply);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, config->pwm_hz, w.pwm_hz);
    TEST_ASSERT_FALSE(servos_positions(&subject, goals_rad));
    for (int i = 0; i < 8; i++) {
        goals_rad[i] = 0.1f * (float)i;
    }
    servos_torque(&subject, goals_rad, w.now_us);
}

static int pulsing(void)
{
    int n = 0;
    for (int i = 0; i < HAL_PWM_CHANNELS_N; i++) {
        n += w.pulse_us[i] != 0 ? 1 : 0;
    }
    return n;
}

static void widths_are_rounded_and_stay_in_bounds(void)
{
    const servos_config config = hobby(1);
    TEST_ASSERT_EQUAL_UINT32(1500, servo_pwm_width_us(&config, 0.0f));
    TEST_ASSERT_EQUAL_UINT32(1564, servo_pwm_width_us(&config, 0.1f)); /* 1563.66 */
    TEST_ASSERT_EQUAL_UINT32(2500, servo_pwm_width_us(&config, 1.58f));
    TEST_ASSERT_EQUAL_UINT32(500, servo_pwm_width_us(&config, -1.58f));
    TEST_ASSERT_EQUAL_UINT32(2500, servo_pwm_width_us(&config, float_of(0x7F800000u)));
    TEST_ASSERT_EQUAL_UINT32(500, servo_pwm_width_us(&config, float_of(0xFF800000u)));
    TEST_ASSERT_EQUAL_UINT32(500, servo_pwm_width_us(&config, float_of(0x7FC00000u)));
    for (float rad = -2.0f; rad < 2.0f; rad += 0.001f) {
        const double exact = fmin(fmax(1500.0 + 636.62 * (double)rad, 500.0), 2500.0);
        TEST_ASSERT_TRUE(fabs(exact - (double)servo_pwm_width_us(&config, rad)) <= 0.501);
    }
}

static void channels_begin_one_at_a_time(void)
{
    const servos_config config = hobby(8);
    on(&config);
    for (int n = 1; n <= 8; n++) {
        TEST_ASSERT_EQUAL_INT(n, pulsing());
        TEST_ASSERT_TRUE(w.pulse_us[n - 1] != 0);
        run_ms(99);
        TEST_ASSERT_EQUAL_INT(n, pulsing());
        run_ms(1);
    }
    TEST_ASSERT_EQUAL_UINT32(1500 + 446, w.pulse_us[7]);
    TEST_ASSERT_EQUAL_INT(8, pulsing());
}

static void goals_move_those_that_have_begun(void)
{
    const servos_config config = hobby(4);
    on(&config);
    run_ms(150);
    for (int i = 0; i < 4; i++) {
        goals_rad[i] = -0.5f;
    }
    servos_goals(&subject, goals_rad);
    TEST_ASSERT_EQUAL_UINT32(1182, w.pulse_us[1]);
    TEST_ASSERT_EQUAL_UINT32(0, w.pulse_us[2]);
    run_ms(200);
    TEST_ASSERT_EQUAL_UINT32(1182, w.pulse_us[3]);
    goals_rad[0] = float_of(0x7FC00000u);
    goals_rad[1] = 0.0f;
    servos_goals(&subject, goals_rad);
    TEST_ASSERT_EQUAL_UINT32(1182, w.pulse_us[0]); /* no number: stays */
    TEST_ASSERT_EQUAL_UINT32(1500, w.pulse_us[1]);
    TEST_ASSERT_TRUE(servos_healthy(&subject));
}

static void off_is_at_once_and_for_good(void)
{
    const servos_config config = hobby(8);
    on(&config);
    run_ms(250);
    servos_off(&subject);
    TEST_ASSERT_EQUAL_INT(0, pulsing());
    TEST_ASSERT_FALSE(w.supply);
    run_ms(500);
    TEST_ASSERT_EQUAL_INT(0, pulsing());
    on(&config);
    TEST_ASSERT_EQUAL_INT(1, pulsing());
}

static void a_test_turns_from_the_middle_and_back(void)
{
    const servos_config config = hobby(2);
    servo_info info;
    servo_trouble trouble;
    configured(&config);
    const servo_request request = {.kind = SERVO_REQUEST_TEST, .id = 7, .turn_rad = -0.4f};
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    uint32_t least = 3000;
    int ms = 0;
    for (; servos_answer(&subject, &info, &trouble) == SERVO_REQUEST_BUSY; ms++) {
        tick();
        least = w.pulse_us[6] != 0 && w.pulse_us[6] < least ? w.pulse_us[6] : least;
        TEST_ASSERT_TRUE(pulsing() <= 1);
    }
    TEST_ASSERT_EQUAL_INT(1600, ms);
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_DONE, servos_answer(&subject, &info, &trouble));
    TEST_ASSERT_EQUAL_UINT8(7, info.id);
    TEST_ASSERT_UINT32_WITHIN(1, 1500 - 255, least);
    TEST_ASSERT_EQUAL_INT(0, pulsing());
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    run_ms(100);
    servos_prepare(&subject, w.now_us);
    run_ms(100);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_EQUAL_INT(0, pulsing());
}

static void other_requests(void)
{
    const servos_config config = hobby(2);
    servo_info info;
    servo_trouble trouble;
    configured(&config);
    TEST_ASSERT_FALSE(servos_request(
        &subject, &(servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 2}, 0));
    TEST_ASSERT_TRUE(
        servos_request(&subject, &(servo_request){.kind = SERVO_REQUEST_PING, .id = 9}, 0));
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_FAILED, servos_answer(&subject, &info, &trouble));
    TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_CHANNEL, trouble.kind);
    TEST_ASSERT_TRUE(
        servos_request(&subject, &(servo_request){.kind = SERVO_REQUEST_PING, .id = 2}, 0));
    tick();
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_DONE, servos_answer(&subject, &info, &trouble));
    TEST_ASSERT_EQUAL_UINT8(2, info.id);
}

static void what_cannot_be_driven_is_said(void)
{
    servo_trouble trouble;
    servos_config config = hobby(8);
    TEST_ASSERT_TRUE(servos_check(&config, &trouble));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.02f, servos_period_s(&config));
    config.id[3] = 9;
    TEST_ASSERT_FALSE(servos_check(&config, &trouble));
    TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_CHANNEL, trouble.kind);
    TEST_ASSERT_EQUAL_INT(3, trouble.servo);
    config.id[3] = 0;
    TEST_ASSERT_FALSE(servos_check(&config, &trouble));
    config.id[3] = 4;
    config.servos_n = 9;
    TEST_ASSERT_FALSE(servos_check(&config, &trouble));
    TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_COUNT, trouble.kind);
    static const float RATES_HZ[] = {49.0f, 334.0f, 0.0f};
    config.servos_n = 8;
    for (int i = 0; i < 3; i++) {
        config.pwm_hz = RATES_HZ[i];
        TEST_ASSERT_FALSE(servos_check(&config, &trouble));
        TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_BAUD, trouble.kind);
    }
    servos_configure(&subject, &WIRE_HAL, &config);
    servos_prepare(&subject, w.now_us);
    TEST_ASSERT_EQUAL_INT(SERVOS_FAILED, subject.state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(widths_are_rounded_and_stay_in_bounds);
    RUN_TEST(channels_begin_one_at_a_time);
    RUN_TEST(goals_move_those_that_have_begun);
    RUN_TEST(off_is_at_once_and_for_good);
    RUN_TEST(a_test_turns_from_the_middle_and_back);
    RUN_TEST(other_requests);
    RUN_TEST(what_cannot_be_driven_is_said);
    return UNITY_END();
}
