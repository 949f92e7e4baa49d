/* test_bus_faults.c - the model servo bus when time passes and things go wrong: baud rates, supply, watchdog, two who
 * talk at once, answers lost, damaged and late. */
#include "bus_fixture.h"

#define PING_ANSWER_BYTES 14.0
#define PING_BYTES 10.0
#define FACTORY_DELAY_S 500e-6 /* Return Delay Time 250 */

void setUp(void)
{
    bus_new(4, 1000000);
}

void tearDown(void)
{
    bus_free();
}

/* --- time ------------------------------------------------------------------------------------------------ */

static void test_bytes_take_their_time(void)
{
    static const uint32_t BAUDS[] = {57600, 1000000, 4000000};
    for (int i = 0; i < 3; i++) {
        bus_free();
        bus_new(1, BAUDS[i]);
        const double byte_s = 10.0 / BAUDS[i];
        const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
        TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
        pass(PING_BYTES * byte_s - 1e-6);
        TEST_ASSERT_TRUE(bus_wire_sending(&bench->model.wire, bench->now_s));
        pass(2e-6);
        TEST_ASSERT_FALSE(bus_wire_sending(&bench->model.wire, bench->now_s));
        listen_for(FACTORY_DELAY_S + byte_s - 2e-6);
        TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
        listen_for(2e-6);
        TEST_ASSERT_EQUAL_UINT(1, bench->heard_n);
        listen_for((PING_ANSWER_BYTES - 1.0) * byte_s);
        TEST_ASSERT_EQUAL_UINT(13, bench->heard_n);
    }
}

static void test_return_delay_is_kept(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_RETURN_DELAY, 1, 0));
    const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    listen_for((PING_BYTES + PING_ANSWER_BYTES) * 1e-5 + 1e-6);
    TEST_ASSERT_EQUAL_INT(1, bench->statuses_n);
}

static void test_another_baud_rate_is_not_understood(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_BAUD, 1, 1)); /* 57600; told at the old rate */
    TEST_ASSERT_EQUAL_INT(0, ping(1));
    TEST_ASSERT_EQUAL_INT(1, ping(2));
    bus_wire_start(&bench->model.wire, 57600);
    TEST_ASSERT_EQUAL_INT(1, ping(1));
    TEST_ASSERT_EQUAL_INT(0, ping(2));
    bench->model.any_baud = true;
    TEST_ASSERT_EQUAL_INT(1, ping(2));
}

/* --- supply ---------------------------------------------------------------------------------------------- */

static void test_without_supply_ram_is_forgotten_and_booting_takes_300_ms(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_RETURN_DELAY, 1, 7));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2048));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_BUS_WATCHDOG, 1, 100));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_TRUE(servo_plant_has_torque(&bench->plant));
    bench->plant.powered = false;
    TEST_ASSERT_FALSE(servo_plant_has_torque(&bench->plant));
    TEST_ASSERT_EQUAL_INT(0, ping(1));
    bench->plant.powered = true;
    pass(0.29);
    const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    listen_for(0.02);
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    TEST_ASSERT_EQUAL_UINT32(0, read_from(1, DXL_X_TORQUE, 1));
    TEST_ASSERT_EQUAL_UINT32(0, read_from(1, DXL_X_GOAL_POSITION, 4));
    TEST_ASSERT_EQUAL_UINT32(0, read_from(1, DXL_X_BUS_WATCHDOG, 1));
    TEST_ASSERT_EQUAL_UINT32(7, read_from(1, DXL_X_RETURN_DELAY, 1));
    TEST_ASSERT_EQUAL_INT32(2048, position(1));
    TEST_ASSERT_FALSE(servo_plant_has_torque(&bench->plant));
}

static void test_reboot_forgets_likewise(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2048));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    const size_t n = dxl_reboot(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    listen_for(0.01);
    TEST_ASSERT_EQUAL_INT(0, error_of_only_answer());
    TEST_ASSERT_FALSE(servo_plant_has_torque(&bench->plant));
    const size_t ping_n = dxl_ping(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, ping_n, bench->now_s));
    listen_for(0.28);
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    pass(0.02);
    TEST_ASSERT_EQUAL_UINT32(0, read_from(1, DXL_X_TORQUE, 1));
}

/* --- errors of the servo --------------------------------------------------------------------------------- */

static void test_overload_takes_the_torque_until_a_reboot(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2048));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    servo(1)->failing = BUS_SERVO_OVERLOAD;
    pass(0.01);
    servo(1)->failing = 0;
    TEST_ASSERT_FALSE(servo_plant_has_torque(&bench->plant));
    (void)ping(1);
    TEST_ASSERT_EQUAL_HEX8(DXL_ALERT, error_of_only_answer());
    TEST_ASSERT_EQUAL_UINT32(BUS_SERVO_OVERLOAD, read_from(1, DXL_X_HARDWARE_ERROR, 1));
    TEST_ASSERT_EQUAL_HEX8(DXL_ALERT | DXL_E_RESULT, write_to(1, DXL_X_TORQUE, 1, 1));
    (void)ping(2);
    TEST_ASSERT_EQUAL_HEX8(0, error_of_only_answer());
    (void)tell(bench->packet, dxl_reboot(bench->packet, sizeof bench->packet, 1));
    TEST_ASSERT_EQUAL_HEX8(0, write_to(1, DXL_X_TORQUE, 1, 1));
}

/* e-Manual, XL430-W250, 2.4, Bus Watchdog: the steps of its example, with a position. */
static void test_watchdog_stops_the_servo_and_refuses_goals_until_cleared(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2048));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 1000));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_BUS_WATCHDOG, 1, 30)); /* 600 ms */
    for (int i = 0; i < 4; i++) {
        (void)ping(3); /* any packet will do */
    }
    TEST_ASSERT_EQUAL_UINT32(30, read_from(1, DXL_X_BUS_WATCHDOG, 1));
    bench->plant.speed_rad_s = 1.0f;
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 3000));
    pass(0.61 - 0.5);
    TEST_ASSERT_EQUAL_UINT32(255, read_from(1, DXL_X_BUS_WATCHDOG, 1));
    const int32_t stopped = position(1);
    TEST_ASSERT_TRUE(stopped > 1000 && stopped < 3000);
    TEST_ASSERT_EQUAL_INT32(stopped, position(1));
    TEST_ASSERT_EQUAL_INT32(stopped, (int32_t)read_from(1, DXL_X_GOAL_POSITION, 4));
    TEST_ASSERT_EQUAL_INT(DXL_E_RANGE, write_to(1, DXL_X_GOAL_POSITION, 4, 2000));
    (void)tell(bench->packet, sync_write(DXL_X_GOAL_POSITION, 1, 2000));
    TEST_ASSERT_EQUAL_INT32(stopped, (int32_t)read_from(1, DXL_X_GOAL_POSITION, 4));
    TEST_ASSERT_EQUAL_INT(DXL_E_RANGE, write_to(1, DXL_X_BUS_WATCHDOG, 1, 30));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_BUS_WATCHDOG, 1, 0));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2000));
}

static void test_watchdog_sleeps_without_torque(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_BUS_WATCHDOG, 1, 1));
    pass(1.0);
    TEST_ASSERT_EQUAL_UINT32(1, read_from(1, DXL_X_BUS_WATCHDOG, 1));
}

/* --- two at once ----------------------------------------------------------------------------------------- */

static void test_two_with_one_id_are_not_understood_but_heard(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(2, DXL_X_ID, 1, 1));
    TEST_ASSERT_EQUAL_INT(0, ping(1));
    TEST_ASSERT_EQUAL_UINT(14, bench->heard_n);
    TEST_ASSERT_EQUAL_UINT32(1, bench->model.counts.shared);
    TEST_ASSERT_EQUAL_INT(2, ping(DXL_BROADCAST)); /* 3 and 4 */
}

static void test_talking_into_an_answer_spoils_both(void)
{
    const size_t n = dxl_read(bench->packet, sizeof bench->packet, 1, 0, 100);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    pass((double)n * 1e-5 + FACTORY_DELAY_S + 200e-6);
    const size_t write_n = dxl_write(bench->packet, sizeof bench->packet, 2, 65, 1, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, write_n, bench->now_s));
    listen_for(0.1);
    TEST_ASSERT_EQUAL_INT(0, bench->statuses_n);
    TEST_ASSERT_EQUAL_UINT(111, bench->heard_n);
    TEST_ASSERT_EQUAL_UINT32(1, bench->model.wire.clashes);
    TEST_ASSERT_EQUAL_UINT32(0, read_from(2, 65, 1));
}

static void test_answering_into_a_packet_spoils_both(void)
{
    const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    pass((double)n * 1e-5 + 100e-6);
    const size_t long_n = sync_write(DXL_X_GOAL_POSITION, 20, 1000); /* 1.1 ms */
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, long_n, bench->now_s));
    listen_for(0.1);
    TEST_ASSERT_EQUAL_INT(0, bench->statuses_n);
    TEST_ASSERT_EQUAL_UINT32(0, bench->model.counts.goals);
    TEST_ASSERT_TRUE(bench->model.wire.clashes > 0);
}

static void test_an_aborted_packet_is_not_obeyed_and_the_next_one_is(void)
{
    const size_t n = sync_write(DXL_X_GOAL_POSITION, 4, 1000);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    pass(155e-6);
    bus_wire_abort(&bench->model.wire, bench->now_s);
    pass(4e-6);
    TEST_ASSERT_TRUE(bus_wire_sending(&bench->model.wire, bench->now_s)); /* the byte under way */
    const size_t off_n =
        dxl_write(bench->packet, sizeof bench->packet, DXL_BROADCAST, DXL_X_TORQUE, 1, 0);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, off_n, bench->now_s));
    listen_for(0.1);
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    TEST_ASSERT_EQUAL_UINT32(0, bench->model.counts.goals);
    TEST_ASSERT_EQUAL_UINT32(1, bench->model.counts.writes);
}

static void test_own_echo(void)
{
    bench->model.wire.echo = true;
    TEST_ASSERT_EQUAL_INT(1, ping(1));
    TEST_ASSERT_EQUAL_UINT(10 + 14, bench->heard_n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bench->packet, bench->heard, 10);
}

static void test_no_room_takes_nothing(void)
{
    static const uint8_t BYTES[BUS_WIRE_TO_SERVOS_BYTES];
    TEST_ASSERT_TRUE(
        bus_wire_send(&bench->model.wire, BYTES, BUS_WIRE_TO_SERVOS_BYTES - 5, bench->now_s));
    TEST_ASSERT_FALSE(bus_wire_send(&bench->model.wire, BYTES, 6, bench->now_s));
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, BYTES, 5, bench->now_s));
}

/* --- by script ------------------------------------------------------------------------------------------- */

static void script(const char *text)
{
    injection all = {.faults_n = 0};
    TEST_ASSERT_EQUAL_INT(0, injection_add(&all, text));
    bus_model_inject(&bench->model, &all, bench->now_s);
}

static void test_script_unplugs_and_overloads_servos(void)
{
    script("unplug@0+1000:2");
    TEST_ASSERT_EQUAL_INT(3, ping(DXL_BROADCAST));
    TEST_ASSERT_EQUAL_INT(0, ping(2));
    script("servo@0+1000:3");
    pass(0.31); /* 2 boots */
    TEST_ASSERT_EQUAL_INT(4, ping(DXL_BROADCAST));
    TEST_ASSERT_EQUAL_HEX8(0, bench->statuses[1].error);
    TEST_ASSERT_EQUAL_HEX8(DXL_ALERT, bench->statuses[2].error);
    script("servo@0+1000");
    TEST_ASSERT_EQUAL_UINT32(BUS_SERVO_OVERLOAD, read_from(1, DXL_X_HARDWARE_ERROR, 1));
    script("unplug@1000:1");
    TEST_ASSERT_EQUAL_INT(1, ping(1));
}

static int good_of_1000(const char *text)
{
    int good = 0;
    if (text != NULL) {
        script(text);
    }
    for (int i = 0; i < 1000; i++) {
        const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
        TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
        listen_for(2e-3);
        good += bench->statuses_n;
    }
    return good;
}

/* 0.2 of 1000: sigma is 12.6. */
static void test_answers_get_lost_and_damaged_as_often_as_asked_for(void)
{
    TEST_ASSERT_EQUAL_INT(1000, good_of_1000(NULL));
    TEST_ASSERT_INT_WITHIN(50, 800, good_of_1000("lose@0+1000:0.2"));
    TEST_ASSERT_EQUAL_INT(0, good_of_1000("lose@0+1000:1"));
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    TEST_ASSERT_INT_WITHIN(50, 800, good_of_1000("garble@0+1000:0.2"));
    TEST_ASSERT_EQUAL_INT(0, good_of_1000("garble@0+1000:1"));
    TEST_ASSERT_EQUAL_UINT(14, bench->heard_n);
}

static void test_the_same_again_is_the_same(void)
{
    const int first = good_of_1000("garble@0+1000:0.3");
    bus_free();
    bus_new(4, 1000000);
    TEST_ASSERT_EQUAL_INT(first, good_of_1000("garble@0+1000:0.3"));
}

static void test_answers_come_late(void)
{
    script("slow@0+1000:0.02");
    const size_t n = dxl_ping(bench->packet, sizeof bench->packet, 1);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    listen_for(0.02);
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    listen_for(0.002);
    TEST_ASSERT_EQUAL_INT(1, bench->statuses_n);
}

/* A hundred thousand bytes of noise, rich in headers: nobody turns, and the bus works afterwards. */
static void test_noise_does_nothing(void)
{
    static const uint8_t OFTEN[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0xFE, 0x03, 0x83, 0x40, 0x74};
    uint64_t random = 1;
    for (int i = 0; i < 1000; i++) {
        uint8_t noise[100];
        for (size_t k = 0; k < sizeof noise; k++) {
            const double r = injection_random(&random);
            noise[k] = r < 0.5 ? OFTEN[(int)(r * 20.0)] : (uint8_t)(r * 512.0);
        }
        TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, noise, sizeof noise, bench->now_s));
        pass(2e-3);
    }
    listen_for(0.1);
    TEST_ASSERT_EQUAL_UINT32(0, bench->model.counts.goals);
    TEST_ASSERT_FALSE(servo_plant_has_torque(&bench->plant));
    (void)ping(1); /* may end what noise has begun */
    TEST_ASSERT_EQUAL_INT(4, ping(DXL_BROADCAST));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bytes_take_their_time);
    RUN_TEST(test_return_delay_is_kept);
    RUN_TEST(test_another_baud_rate_is_not_understood);
    RUN_TEST(test_without_supply_ram_is_forgotten_and_booting_takes_300_ms);
    RUN_TEST(test_reboot_forgets_likewise);
    RUN_TEST(test_overload_takes_the_torque_until_a_reboot);
    RUN_TEST(test_watchdog_stops_the_servo_and_refuses_goals_until_cleared);
    RUN_TEST(test_watchdog_sleeps_without_torque);
    RUN_TEST(test_two_with_one_id_are_not_understood_but_heard);
    RUN_TEST(test_talking_into_an_answer_spoils_both);
    RUN_TEST(test_answering_into_a_packet_spoils_both);
    RUN_TEST(test_an_aborted_packet_is_not_obeyed_and_the_next_one_is);
    RUN_TEST(test_own_echo);
    RUN_TEST(test_no_room_takes_nothing);
    RUN_TEST(test_script_unplugs_and_overloads_servos);
    RUN_TEST(test_answers_get_lost_and_damaged_as_often_as_asked_for);
    RUN_TEST(test_the_same_again_is_the_same);
    RUN_TEST(test_answers_come_late);
    RUN_TEST(test_noise_does_nothing);
    return UNITY_END();
}
