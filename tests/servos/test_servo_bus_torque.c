/* test_servo_bus_torque.c - torque comes without a jump, or not at all. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

enum { SYNC_READ = 0x82, SYNC_WRITE = 0x83 };

static void held_in_place(const servos_config *config)
{
    for (int i = 0; i < config->servos_n; i++) {
        TEST_ASSERT_EQUAL_INT(1, w.servo[i].torques);
        TEST_ASSERT_EQUAL_INT32(0, w.servo[i].jump);
        TEST_ASSERT_EQUAL_INT(0, w.servo[i].moves);
        TEST_ASSERT_EQUAL_UINT8(5, w.servo[i].table[WATCHDOG]);
    }
    TEST_ASSERT_TRUE(servos_healthy(&subject));
    TEST_ASSERT_EQUAL_INT(0, w.collisions);
    TEST_ASSERT_TRUE(w.unread_max <= 512);
}

static void goals_then_torque_then_watchdog_each_read_back(void)
{
    const servos_config config = wire_fresh(100);
    turned_on(&config);
    held_in_place(&config);
    const int order[] = {
        logged(SYNC_WRITE, GOAL, 0),     logged(SYNC_READ, GOAL, 0),
        logged(SYNC_WRITE, TORQUE, 0),   logged(SYNC_READ, TORQUE, 0),
        logged(SYNC_WRITE, WATCHDOG, 0), logged(SYNC_READ, WATCHDOG, 0),
    };
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_TRUE(order[i] >= 0);
        TEST_ASSERT_TRUE(i == 0 || order[i] > order[i - 1]);
    }
    TEST_ASSERT_EQUAL_INT(4, count_logged(SYNC_READ, GOAL)); /* 30 at a time */
    TEST_ASSERT_EQUAL_UINT16(514, w.log[order[0]].bytes_n);
    TEST_ASSERT_EQUAL_INT(0, w.overruns);
}

static void one_to_many_servos_with_and_without_an_echo(void)
{
    static const int COUNTS[] = {1, 2, 8, 30, 31, 128};
    for (int i = 0; i < 12; i++) {
        const servos_config config = wire_fresh(COUNTS[i / 2]);
        w.echo = i % 2 == 1;
        turned_on(&config);
        held_in_place(&config);
    }
}

/* At every moment of the watch over the positions: no packet falls into the answers to another. */
static void torque_may_come_at_any_moment(void)
{
    servos_config config = wire_fresh(100);
    config.bus_baud = 1000000; /* where the answers of 30 take 5 ms */
    for (int ms = 0; ms < 12; ms++) {
        wire_fresh(100);
        for (int i = 0; i < 100; i++) {
            w.servo[i].table[BAUD] = 3;
        }
        prepared(&config);
        run_ms(ms);
        TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
        servos_torque(&subject, goals_rad, w.now_us);
        while (!servos_started(&subject)) {
            TEST_ASSERT_TRUE(servos_healthy(&subject));
            tick();
        }
        held_in_place(&config);
    }
}

/* Whatever goals the app has: torque first comes on in place. */
static void torque_begins_in_place_and_goals_follow(void)
{
    const servos_config config = wire_fresh(3);
    prepared(&config);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    goals_rad[1] = 0.4f;
    goals_rad[2] = float_of(0x7FC00000u);
    servos_torque(&subject, goals_rad, w.now_us);
    run_ms(100);
    TEST_ASSERT_EQUAL_INT32(0, w.servo[1].jump);
    TEST_ASSERT_EQUAL_INT32(2048 + 261, wire_get(&w.servo[1], GOAL));
    TEST_ASSERT_EQUAL_INT(0, w.servo[2].moves);
}

/* So many turns away that it has not been kept where: such a servo gets no torque. */
static void a_position_beyond_all_reach_gets_no_torque(void)
{
    for (int way = -1; way <= 1; way += 2) {
        const servos_config config = wire_fresh(3);
        w.servo[1].table[MODE] = 4;
        wire_set(&w.servo[1], PRESENT, way * 1000000);
        prepared(&config);
        TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
        servos_torque(&subject, goals_rad, w.now_us);
        run_ms(100);
        trouble_is(SERVO_TROUBLE_FAR, 1, 2, 0);
        TEST_ASSERT_FALSE(servos_healthy(&subject));
        TEST_ASSERT_EQUAL_INT(0, w.servo[0].torques);
    }
}

/* One that misses a Sync Write is found by reading back, and all are written to again. */
static void a_lost_packet_is_made_good(void)
{
    static const uint8_t ADDRESSES[] = {GOAL, TORQUE, WATCHDOG};
    for (int i = 0; i < 3; i++) {
        const servos_config config = wire_fresh(40);
        prepared(&config);
        TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
        servos_torque(&subject, goals_rad, w.now_us);
        while (!(w.sending && w.out[7] == SYNC_WRITE && w.out[8] == ADDRESSES[i])) {
            tick();
        }
        w.servo[35].deaf_n = 1;
        run_ms(100);
        TEST_ASSERT_EQUAL_INT(SERVO_BUS_ON, subject.bus.state);
        held_in_place(&config);
        TEST_ASSERT_TRUE(count_logged(SYNC_WRITE, ADDRESSES[i]) >= 2);
    }
}

/* Whoever misses packets - goals, torque or watchdog - never has torque and another goal than its place. */
static void lost_packets_never_make_a_jump(void)
{
    for (int lost = 0; lost < 12; lost++) {
        const servos_config config = wire_fresh(4);
        prepared(&config);
        TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
        servos_torque(&subject, goals_rad, w.now_us);
        while (logged(SYNC_WRITE, GOAL, 0) < 0 && lost > 0) {
            tick();
        }
        w.servo[2].deaf_n = lost % 4 + 1;
        w.servo[1].mute_n = lost % 3;
        for (int ms = 0; subject.bus.state == SERVO_BUS_STARTING && ms < 500; ms++) {
            tick();
        }
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_EQUAL_INT32(0, w.servo[i].jump);
            TEST_ASSERT_EQUAL_INT(0, w.servo[i].moves);
        }
        if (subject.bus.state == SERVO_BUS_ON) {
            held_in_place(&config);
        } else {
            TEST_ASSERT_FALSE(servos_healthy(&subject));
        }
    }
}

static void never_on(const servos_config *config, uint8_t address, servo_trouble_kind kind,
                     uint32_t detail)
{
    prepared(config);
    w.servo[3].stuck_at = address;
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    run_ms(200);
    TEST_ASSERT_EQUAL_INT(SERVOS_ON, subject.state);
    TEST_ASSERT_FALSE(servos_healthy(&subject));
    trouble_is(kind, 3, 4, detail);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(address == GOAL               ? 0
                              : i == 3 && address == TORQUE ? 0
                                                            : 1,
                              w.servo[i].torques);
        TEST_ASSERT_EQUAL_UINT8(0, w.servo[i].table[TORQUE]); /* all have been told to let go */
        TEST_ASSERT_EQUAL_INT(0, w.servo[i].moves);
    }
}

static void what_a_servo_does_not_take_stops_all(void)
{
    servos_config config = wire_fresh(4);
    never_on(&config, GOAL, SERVO_TROUBLE_READ_BACK, 9999);
    TEST_ASSERT_EQUAL_INT(3, count_logged(SYNC_WRITE, GOAL));
    TEST_ASSERT_EQUAL_INT(0, count_logged(SYNC_WRITE, TORQUE));
    config = wire_fresh(4);
    never_on(&config, TORQUE, SERVO_TROUBLE_READ_BACK, 0);
    config = wire_fresh(4);
    never_on(&config, WATCHDOG, SERVO_TROUBLE_READ_BACK, 0);
}

/* Its watchdog struck before and was not cleared: the servo refuses goals, and gets no torque. */
static void a_struck_watchdog_gets_no_torque(void)
{
    const servos_config config = wire_fresh(4);
    prepared(&config);
    w.servo[3].table[WATCHDOG] = 0xFF;
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    run_ms(200);
    trouble_is(SERVO_TROUBLE_READ_BACK, 3, 4, 9999);
    TEST_ASSERT_EQUAL_INT(0, w.servo[0].torques);
}

/* And after a strike in motion, preparing anew clears it. */
static void preparing_clears_a_struck_watchdog(void)
{
    const servos_config config = wire_fresh(4);
    turned_on(&config);
    wire_until(w.now_us + 500000u); /* this device stands still for half a second */
    run_ms(10);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(1, w.servo[i].strikes);
        TEST_ASSERT_EQUAL_HEX8(0xFF, w.servo[i].table[WATCHDOG]);
    }
    hal_supply(NULL, true); /* the supply never goes off: a board without that switch */
    subject.state = SERVOS_OFF;
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 2000);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    run_ms(100);
    TEST_ASSERT_EQUAL_INT(SERVO_BUS_ON, subject.bus.state);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX8(5, w.servo[i].table[WATCHDOG]);
        TEST_ASSERT_EQUAL_INT32(0, w.servo[i].jump);
    }
}

/* In position mode, beyond one turn: the servo would refuse the goal, so no torque. */
static void a_position_out_of_the_mode_s_reach_gets_no_torque(void)
{
    const servos_config config = wire_fresh(4);
    wire_set(&w.servo[3], PRESENT, 5000);
    prepared(&config);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    run_ms(200);
    trouble_is(SERVO_TROUBLE_READ_BACK, 3, 4, 9999);
    const servos_config again = wire_fresh(4);
    wire_set(&w.servo[3], PRESENT, 5000);
    w.servo[3].table[MODE] = 4;
    turned_on(&again);
    held_in_place(&again);
}

/* Goals that come while torque is on its way: torque still comes on in place, the newest go out after. */
static void goals_on_the_way_wait(void)
{
    const servos_config config = wire_fresh(8);
    prepared(&config);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    while (!servos_started(&subject)) {
        TEST_ASSERT_TRUE(subject.bus.state == SERVO_BUS_STARTING);
        goals_rad[5] += 0.01f;
        servos_goals(&subject, goals_rad);
        tick();
    }
    run_ms(5);
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_INT32(0, w.servo[i].jump);
        TEST_ASSERT_FLOAT_WITHIN(0.001f, goals_rad[i],
                                 (float)(wire_get(&w.servo[i], GOAL) - 2048) * 1.5339808e-3f);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(goals_then_torque_then_watchdog_each_read_back);
    RUN_TEST(one_to_many_servos_with_and_without_an_echo);
    RUN_TEST(torque_may_come_at_any_moment);
    RUN_TEST(torque_begins_in_place_and_goals_follow);
    RUN_TEST(a_position_beyond_all_reach_gets_no_torque);
    RUN_TEST(a_lost_packet_is_made_good);
    RUN_TEST(lost_packets_never_make_a_jump);
    RUN_TEST(what_a_servo_does_not_take_stops_all);
    RUN_TEST(a_struck_watchdog_gets_no_torque);
    RUN_TEST(preparing_clears_a_struck_watchdog);
    RUN_TEST(a_position_out_of_the_mode_s_reach_gets_no_torque);
    RUN_TEST(goals_on_the_way_wait);
    return UNITY_END();
}
