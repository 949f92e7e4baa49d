/* test_servo_bus_off.c - off, at any moment: no supply, and torque-off to all. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

static void is_torque_off(const wire_record *r)
{
    TEST_ASSERT_EQUAL_HEX8(0x03, r->instruction);
    TEST_ASSERT_EQUAL_HEX8(0xFE, r->id);
    TEST_ASSERT_EQUAL_UINT16(TORQUE, r->address);
    TEST_ASSERT_EQUAL_UINT16(13, r->bytes_n);
    TEST_ASSERT_EQUAL_HEX8(0, r->first[0]);
}

/* The next three packets, one a tick at 4 Mbaud, and nothing after them. */
static void tells_all_to_let_go(void)
{
    const uint32_t start_us = w.now_us;
    w.log_n = 0;
    servos_off(&subject);
    TEST_ASSERT_EQUAL_INT(SERVOS_OFF, subject.state);
    TEST_ASSERT_FALSE(w.supply);
    TEST_ASSERT_TRUE(w.sending);
    run_ms(100);
    TEST_ASSERT_EQUAL_INT(3, w.log_n);
    for (int i = 0; i < 3; i++) {
        is_torque_off(&w.log[i]);
        TEST_ASSERT_TRUE(w.log[i].at_us - start_us < 1000u * (uint32_t)i + 100u);
    }
}

static void off_in_the_middle_of_a_hundred_goals(void)
{
    const servos_config config = wire_fresh(100);
    for (int echo = 0; echo < 2; echo++) {
        wire_fresh(100);
        w.echo = echo == 1;
        turned_on(&config);
        while (!(w.sending && w.out_n == 514)) {
            servos_goals(&subject, goals_rad);
            tick();
        }
        tells_all_to_let_go();
    }
}

/* Every tick of the way from off to on. */
static void off_at_any_moment(void)
{
    const servos_config config = wire_fresh(8);
    for (int ms = 0; ms < 640; ms += HOST_OR_BOARD(1, 16)) {
        wire_fresh(8);
        configured(&config);
        servos_prepare(&subject, w.now_us);
        for (int i = 0; i < ms; i++) {
            tick();
            if (subject.state == SERVOS_PREPARED && i > ms / 2) {
                servos_positions(&subject, goals_rad);
                servos_torque(&subject, goals_rad, w.now_us);
            }
        }
        tells_all_to_let_go();
    }
}

static void off_without_ever_having_been_on(void)
{
    const servos_config config = wire_fresh(3);
    configured(&config);
    TEST_ASSERT_FALSE(w.supply);
    tells_all_to_let_go();
}

/* A slow line: 13 bytes take 2.3 ms, so the three come as fast as it carries them. */
static void off_on_a_slow_line(void)
{
    servos_config config = wire_fresh(3);
    config.bus_baud = 57600;
    configured(&config);
    servos_off(&subject);
    run_ms(20);
    TEST_ASSERT_EQUAL_INT(3, w.log_n);
}

/* A rate that there is not: nothing is sent, nothing breaks. */
static void off_with_a_rate_that_the_board_cannot(void)
{
    servos_config config = wire_fresh(3);
    config.bus_baud = 0;
    configured(&config);
    servos_off(&subject);
    run_ms(5);
    TEST_ASSERT_EQUAL_INT(0, w.log_n);
    TEST_ASSERT_FALSE(w.supply);
}

static void on_again_after_off(void)
{
    const servos_config config = wire_fresh(8);
    for (int i = 0; i < 3; i++) {
        turned_on(&config);
        w.log_n = 0;
        servos_off(&subject);
        TEST_ASSERT_TRUE(servos_healthy(&subject));
        run_ms(i);
        servos_prepare(&subject, w.now_us);
        run_while(SERVOS_PREPARING, 1000);
        TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
        TEST_ASSERT_EQUAL_INT32(0, w.servo[7].jump);
    }
}

static void goals_and_torque_do_nothing_in_other_states(void)
{
    const servos_config config = wire_fresh(3);
    configured(&config);
    servos_torque(&subject, goals_rad, w.now_us);
    servos_goals(&subject, goals_rad);
    TEST_ASSERT_FALSE(servos_positions(&subject, goals_rad));
    run_ms(5);
    TEST_ASSERT_EQUAL_INT(SERVOS_OFF, subject.state);
    TEST_ASSERT_EQUAL_INT(0, w.log_n);
    turned_on(&config);
    servos_prepare(&subject, w.now_us);
    TEST_ASSERT_EQUAL_INT(SERVOS_ON, subject.state);
}

static void no_servos_are_always_well(void)
{
    const servos_config config = {.kind = SERVOS_NONE};
    wire_fresh(0);
    configured(&config);
    TEST_ASSERT_TRUE(servos_check(&config, NULL));
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 2);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_FALSE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    servos_goals(&subject, goals_rad);
    run_ms(5);
    TEST_ASSERT_TRUE(servos_healthy(&subject));
    servos_off(&subject);
    TEST_ASSERT_EQUAL_INT(0, w.log_n + w.starts);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(off_in_the_middle_of_a_hundred_goals);
    RUN_TEST(off_at_any_moment);
    RUN_TEST(off_without_ever_having_been_on);
    RUN_TEST(off_on_a_slow_line);
    RUN_TEST(off_with_a_rate_that_the_board_cannot);
    RUN_TEST(on_again_after_off);
    RUN_TEST(goals_and_torque_do_nothing_in_other_states);
    RUN_TEST(no_servos_are_always_well);
    return UNITY_END();
}
