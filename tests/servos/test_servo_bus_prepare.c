/* test_servo_bus_prepare.c - finding the servos, and everything that can be wrong with one of them. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

static void fails(const servos_config *config)
{
    configured(config);
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 5000);
    TEST_ASSERT_EQUAL_INT(SERVOS_FAILED, subject.state);
    TEST_ASSERT_FALSE(w.supply);
    TEST_ASSERT_FALSE(servos_positions(&subject, goals_rad));
}

static void finds(int servos_n, bool echo, int ms_max)
{
    const servos_config config = wire_fresh(servos_n);
    w.echo = echo;
    configured(&config);
    servos_prepare(&subject, w.now_us);
    TEST_ASSERT_TRUE(w.supply);
    const int ms = run_while(SERVOS_PREPARING, ms_max);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_TRUE(ms >= SERVO_BUS_BOOT_US / 1000);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    for (int i = 0; i < servos_n; i++) {
        const int32_t present = wire_get(&w.servo[i], PRESENT);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)(present - 2048) * 6.28318531f / 4096.0f,
                                 goals_rad[i]);
        TEST_ASSERT_EQUAL_UINT8(0, w.servo[i].table[DELAY]);
        TEST_ASSERT_EQUAL_INT(0, w.servo[i].torques);
    }
    TEST_ASSERT_EQUAL_INT(0, w.overruns + w.collisions);
    TEST_ASSERT_TRUE(w.unread_max <= 512); /* what the board keeps */
    TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.damaged);
    TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.timeouts);
    TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.stray);
    if (echo) {
        TEST_ASSERT_UINT32_WITHIN(1, (uint32_t)w.log_n, subject.bus.counts.echoes);
    } else {
        TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.echoes);
    }
}

static void all_are_found_with_and_without_an_echo(void)
{
    finds(1, false, 520);
    finds(1, true, 520);
    finds(8, false, 550);
    finds(8, true, 550);
    finds(100, false, 1200);
    finds(100, true, 1200);
    finds(128, true, 1200);
}

/* First torque off for all, then the watchdogs; and not one servo is asked before it has booted. */
static void all_let_go_before_anything_else(void)
{
    const servos_config config = wire_fresh(3);
    const uint32_t start_us = w.now_us;
    prepared(&config);
    TEST_ASSERT_EQUAL_INT(0, logged(3, TORQUE, 0));
    TEST_ASSERT_EQUAL_INT(1, logged(3, WATCHDOG, 0));
    TEST_ASSERT_EQUAL_HEX8(0xFE, w.log[0].id);
    TEST_ASSERT_EQUAL_HEX8(0xFE, w.log[1].id);
    TEST_ASSERT_TRUE(w.log[0].at_us - start_us >= SERVO_BUS_BOOT_US);
}

/* Until torque comes the positions stay fresh. */
static void an_arm_that_sinks_is_followed(void)
{
    const servos_config config = wire_fresh(40);
    prepared(&config);
    wire_set(&w.servo[39], PRESENT, 1500);
    run_ms(20);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, (1500 - 2048) * 6.28318531f / 4096.0f, goals_rad[39]);
}

/* Turned by hand more than once around: told as it is, or at least as far beyond every limit. */
static void positions_beyond_a_turn_are_told(void)
{
    static const int32_t UNITS[] = {-3000, 4095, 5000, 30000, 1000000, -1000000};
    const servos_config config = wire_fresh(6);
    for (int i = 0; i < 6; i++) {
        wire_set(&w.servo[i], PRESENT, UNITS[i]);
    }
    prepared(&config);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-4f, (float)(UNITS[i] - 2048) * 6.28318531f / 4096.0f,
                                 goals_rad[i]);
    }
    TEST_ASSERT_TRUE(goals_rad[4] > 40.0f && goals_rad[5] < -40.0f);
}

static void a_missing_servo_is_named(void)
{
    for (int missing = 0; missing < 8; missing += 7) {
        const servos_config config = wire_fresh(8);
        w.servo[missing].table[ID] = 99;
        fails(&config);
        trouble_is(SERVO_TROUBLE_SILENT, missing, missing + 1, 0);
        TEST_ASSERT_EQUAL_UINT32(SERVO_BUS_TRIES, subject.bus.counts.timeouts);
    }
}

static void one_that_talks_at_another_rate_is_silent_or_garbled(void)
{
    const servos_config config = wire_fresh(2);
    w.servo[1].table[BAUD] = 1;
    fails(&config);
    trouble_is(SERVO_TROUBLE_SILENT, 1, 2, 0);
    const servos_config again = wire_fresh(2);
    w.servo[1].garbled_n = 1000;
    w.echo = true;
    fails(&again);
    trouble_is(SERVO_TROUBLE_GARBLED, 1, 2, 0);
}

static void noise_now_and_then_only_costs_time(void)
{
    const servos_config config = wire_fresh(20);
    for (int i = 0; i < 20; i++) {
        w.servo[i].garbled_n = i % 4 == 1   ? 2
                               : i % 4 == 2 ? 1
                                            : 0; /* no more than two for one question */
        w.servo[i].mute_n = i % 4 >= 2 ? 1 : 0;
        w.servo[i].deaf_n = i % 4 == 0 ? 4 : 0; /* two of them before it is asked itself */
    }
    prepared(&config);
    TEST_ASSERT_TRUE(subject.bus.counts.timeouts >= 20);
    TEST_ASSERT_EQUAL_UINT32(15, subject.bus.counts.damaged);
}

/* An answer that is lost from a Sync Read is asked for again, and only that one. */
static void missing_positions_are_asked_for_again(void)
{
    const servos_config config = wire_fresh(10);
    configured(&config);
    servos_prepare(&subject, w.now_us);
    while (logged(0x82, PRESENT, 0) < 0) {
        TEST_ASSERT_EQUAL_INT(SERVOS_PREPARING, subject.state);
        w.servo[4].mute_n = subject.bus.script != NULL && subject.bus.step == 7 ? 1 : 0;
        tick();
    }
    run_while(SERVOS_PREPARING, 100);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    const wire_record *again = &w.log[logged(0x82, PRESENT, 1)];
    TEST_ASSERT_EQUAL_UINT16(10 + 4 + 1, again->bytes_n);
    TEST_ASSERT_EQUAL_UINT8(5, again->first[2]);
}

static void a_hardware_error_is_told(void)
{
    const servos_config config = wire_fresh(3);
    w.servo[1].table[HARDWARE] = 0x20; /* overload */
    fails(&config);
    trouble_is(SERVO_TROUBLE_HARDWARE, 1, 2, 0x20);
}

static void a_refusal_is_told(void)
{
    const servos_config config = wire_fresh(3);
    w.servo[2].error = 0x07;
    fails(&config);
    trouble_is(SERVO_TROUBLE_STATUS, 2, 3, 7);
}

/* That its own packet came damaged is nothing the servo is to blame for. */
static void a_crc_error_reported_by_a_servo_is_a_miss(void)
{
    const servos_config config = wire_fresh(3);
    w.servo[2].error = 0x03;
    fails(&config);
    trouble_is(SERVO_TROUBLE_GARBLED, 2, 3, 0);
}

static void other_models_and_modes_are_refused(void)
{
    const servos_config config = wire_fresh(2);
    w.servo[0].table[MODEL] = 350 & 0xFF; /* an XL-320 */
    w.servo[0].table[MODEL + 1] = 350 >> 8;
    fails(&config);
    trouble_is(SERVO_TROUBLE_MODEL, 0, 1, 350);
    for (int mode = 0; mode < 20; mode++) {
        const servos_config again = wire_fresh(2);
        w.servo[1].table[MODE] = (uint8_t)mode;
        if (mode >= 3 && mode <= 5) {
            prepared(&again);
        } else {
            fails(&again);
            trouble_is(SERVO_TROUBLE_MODE, 1, 2, (uint32_t)mode);
        }
    }
}

static void late_answers_are_strays_and_do_no_harm(void)
{
    const servos_config config = wire_fresh(2);
    w.servo[0].late_us =
        1700; /* later than anyone waits: but the same is being asked again by then */
    configured(&config);
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 2000);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_TRUE(subject.bus.counts.stray > 0);
    TEST_ASSERT_EQUAL_UINT8(0, w.servo[0].table[DELAY]);
}

static void what_cannot_be_driven_is_said_at_once(void)
{
    servo_trouble trouble;
    servos_config config = wire_fresh(4);
    config.bus_baud = 250000;
    TEST_ASSERT_FALSE(servos_check(&config, &trouble));
    TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_BAUD, trouble.kind);
    config.bus_baud = 57600;
    TEST_ASSERT_TRUE(servos_check(&config, &trouble));
    config.servos_n = 100; /* 89 ms for one set of goals, and the watchdogs strike at 100 */
    TEST_ASSERT_FALSE(servos_check(&config, NULL));
    config.bus_baud = 1000000;
    TEST_ASSERT_TRUE(servos_check(&config, NULL));
    config.servos_n = SERVO_COUNT_MAX + 1;
    TEST_ASSERT_FALSE(servos_check(&config, &trouble));
    TEST_ASSERT_EQUAL_INT(SERVO_TROUBLE_COUNT, trouble.kind);
    config.servos_n = 0;
    TEST_ASSERT_FALSE(servos_check(&config, NULL));
    config.servos_n = 1;
    w.baud_max = 500000; /* the board cannot */
    fails(&config);
    trouble_is(SERVO_TROUBLE_BAUD, -1, 0, 0);
}

static void every_trouble_has_its_own_text(void)
{
    for (int i = 0; i <= SERVO_TROUBLES_N; i++) {
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(
                strcmp(servo_trouble_text((uint8_t)i), servo_trouble_text((uint8_t)j)) != 0);
        }
    }
}

/* As delivered 57,600 baud; a tick of 10 ms. */
static void slow_lines_and_slow_ticks_only_take_longer(void)
{
    servos_config config = wire_fresh(8);
    config.bus_baud = 57600;
    for (int i = 0; i < 8; i++) {
        w.servo[i].table[BAUD] = 1;
    }
    w.echo = true;
    prepared(&config);
    TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.timeouts);
    wire_fresh(8);
    config.bus_baud = 4000000;
    configured(&config);
    servos_prepare(&subject, w.now_us);
    for (int i = 0; i < 200 && subject.state == SERVOS_PREPARING; i++) {
        wire_until(w.now_us + 10000);
        servos_tick(&subject, w.now_us);
    }
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_EQUAL_UINT32(0, subject.bus.counts.timeouts);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(all_are_found_with_and_without_an_echo);
    RUN_TEST(all_let_go_before_anything_else);
    RUN_TEST(an_arm_that_sinks_is_followed);
    RUN_TEST(positions_beyond_a_turn_are_told);
    RUN_TEST(a_missing_servo_is_named);
    RUN_TEST(one_that_talks_at_another_rate_is_silent_or_garbled);
    RUN_TEST(noise_now_and_then_only_costs_time);
    RUN_TEST(missing_positions_are_asked_for_again);
    RUN_TEST(a_hardware_error_is_told);
    RUN_TEST(a_refusal_is_told);
    RUN_TEST(a_crc_error_reported_by_a_servo_is_a_miss);
    RUN_TEST(other_models_and_modes_are_refused);
    RUN_TEST(late_answers_are_strays_and_do_no_harm);
    RUN_TEST(what_cannot_be_driven_is_said_at_once);
    RUN_TEST(every_trouble_has_its_own_text);
    RUN_TEST(slow_lines_and_slow_ticks_only_take_longer);
    return UNITY_END();
}
