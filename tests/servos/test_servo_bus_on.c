/* test_servo_bus_on.c - goals, and the watch over the servos that follow them. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

enum { READ = 0x02, SYNC_WRITE = 0x83 };

static int32_t goal_of(int servo)
{
    return wire_get(&w.servo[servo], GOAL);
}

static void all_to(float goal_rad, int servos_n)
{
    for (int i = 0; i < servos_n; i++) {
        goals_rad[i] = goal_rad;
    }
    servos_goals(&subject, goals_rad);
}

/* Nearest unit of 4096 a turn, 2048 in the middle, over the whole range, by exact arithmetic in double. */
static void goals_are_rounded_to_the_nearest_unit(void)
{
    const servos_config config = wire_fresh(8);
    for (int i = 0; i < 8; i++) {
        w.servo[i].table[MODE] = 4;
    }
    turned_on(&config);
    uint32_t seed = 5;
    for (int round = 0; round < HOST_OR_BOARD(2000, 100); round++) {
        float sent[8];
        for (int i = 0; i < 8; i++) {
            sent[i] = (float)random_between(&seed, -8.0, 8.0);
        }
        servos_goals(&subject, sent);
        run_ms(4);
        for (int i = 0; i < 8; i++) {
            const double exact = 2048.0 + (double)sent[i] * 4096.0 / (2.0 * PI);
            TEST_ASSERT_TRUE(fabs(exact - (double)goal_of(i)) <=
                             0.5005); /* a float has that much */
        }
        w.log_n = 0;
    }
}

static void positions_and_goals_are_each_other_s_inverse(void)
{
    const servos_config config = wire_fresh(1);
    w.servo[0].table[MODE] = 4;
    turned_on(&config);
    for (int32_t units = 2048 - 5215; units <= 2048 + 5215; units += HOST_OR_BOARD(1, 97)) {
        const float rad = (float)(units - 2048) * 1.53398079e-3f;
        servos_goals(&subject, &rad);
        run_ms(3);
        TEST_ASSERT_EQUAL_INT32(units, goal_of(0));
        w.log_n = 0;
    }
}

/* Whatever the goals, no byte has to be stuffed in: so the packet always takes the time that was reckoned with. */
static void goals_never_need_stuffing(void)
{
    uint8_t packet[64];
    for (int32_t units = 2048 - 5215; units <= 2048 + 5215; units++) {
        for (int id = 0; id <= 252; id += 84) {
            dxl_sync_open(packet, GOAL, 4);
            for (int i = 0; i < 2; i++) {
                packet[12 + 5 * i] = (uint8_t)(id == 168 ? 0xFC : id);
                dxl_put_u32(packet + 13 + 5 * i, (uint32_t)units);
            }
            TEST_ASSERT_EQUAL_UINT(24, dxl_seal(packet, sizeof packet, 0xFE, SYNC_WRITE, 14));
        }
    }
}

static void odd_goals_are_clamped_or_left_alone(void)
{
    const servos_config config = wire_fresh(4);
    for (int i = 0; i < 4; i++) {
        w.servo[i].table[MODE] = 4;
    }
    turned_on(&config);
    const int32_t before = goal_of(3);
    const float odd[] = {9.0f, -1e30f, float_of(0x7F800000u), float_of(0x7FC00000u)};
    servos_goals(&subject, odd);
    run_ms(4);
    TEST_ASSERT_EQUAL_INT32(2048 + 5215, goal_of(0));
    TEST_ASSERT_EQUAL_INT32(2048 - 5215, goal_of(1));
    TEST_ASSERT_EQUAL_INT32(2048 + 5215, goal_of(2));
    TEST_ASSERT_EQUAL_INT32(before, goal_of(3));
}

static void the_newest_goals_win(void)
{
    const servos_config config = wire_fresh(100);
    turned_on(&config);
    for (int i = 1; i <= 20; i++) {
        all_to(0.01f * (float)i, 100);
    }
    run_ms(6);
    TEST_ASSERT_EQUAL_INT32(2048 + 130, goal_of(0)); /* 0.2 rad */
    TEST_ASSERT_EQUAL_INT32(2048 + 130, goal_of(99));
    TEST_ASSERT_TRUE(w.servo[50].moves <= 1);
}

/* At the rate that servos_period_s states, in whole ticks: all goals get through, and the watch goes on. */
static void goals_at_the_stated_period_all_get_through(void)
{
    static const int COUNTS[] = {8, 100};
    for (int k = 0; k < 2; k++) {
        const servos_config config = wire_fresh(COUNTS[k]);
        w.echo = k == 1;
        turned_on(&config);
        const int period_ms = (int)ceilf(servos_period_s(&config) * 1000.0f);
        TEST_ASSERT_EQUAL_INT(k == 0 ? 1 : 2, period_ms);
        const int before = count_logged(SYNC_WRITE, GOAL), asked = count_logged(READ, HARDWARE);
        for (int i = 0; i < 100; i++) {
            all_to(0.001f * (float)i, COUNTS[k]);
            run_ms(period_ms);
        }
        const int sent = count_logged(SYNC_WRITE, GOAL) - before;
        const int asks = count_logged(READ, HARDWARE) - asked;
        TEST_ASSERT_TRUE(sent >=
                         90); /* each question takes the place of one, the next brings newer ones */
        TEST_ASSERT_TRUE(asks >= 100 * period_ms / 21);
        TEST_ASSERT_TRUE(servos_healthy(&subject));
        TEST_ASSERT_EQUAL_INT(0, w.servo[0].strikes);
    }
}

/* The bound of servos_period_s: 100 servos, 514 bytes, 1.3 ms at 4 Mbaud, and a question. */
static void the_period_is_what_the_bus_can_carry(void)
{
    servos_config config = wire_fresh(100);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.0016f, servos_period_s(&config));
    config.bus_baud = 1000000;
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.00565f, servos_period_s(&config));
    config.kind = SERVOS_NONE;
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, servos_period_s(&config));
}

/* Without goals every servo is asked in turn, and none of their watchdogs strikes. */
static void without_goals_the_watch_goes_on(void)
{
    const servos_config config = wire_fresh(8);
    turned_on(&config);
    run_ms(100);
    w.log_n = 0;
    run_ms(80);
    int asked[9] = {0};
    for (int i = 0; i < w.log_n; i++) {
        TEST_ASSERT_EQUAL_HEX8(READ, w.log[i].instruction);
        asked[w.log[i].id]++;
    }
    for (int i = 1; i <= 8; i++) {
        TEST_ASSERT_TRUE(asked[i] >= 4);
    }
    TEST_ASSERT_EQUAL_INT(0, w.servo[7].strikes);
}

/* How long until it is known, at full rate of goals. */
static int found_out_ms(int servos_n)
{
    int ms = 0;
    while (servos_healthy(&subject)) {
        all_to(0.0f, servos_n);
        tick();
        TEST_ASSERT_TRUE_MESSAGE(ms++ < 5000, "never found out");
    }
    tick();
    return ms;
}

static void a_servo_that_falls_silent_is_found_out(void)
{
    const servos_config config = wire_fresh(8);
    turned_on(&config);
    w.servo[5].table[ID] = 77;
    TEST_ASSERT_TRUE(found_out_ms(8) <= (8 + SERVO_BUS_MISSES_MAX) * 22);
    trouble_is(SERVO_TROUBLE_SILENT, 5, 6, 0);
}

static void a_line_that_goes_bad_is_found_out(void)
{
    const servos_config config = wire_fresh(3);
    turned_on(&config);
    w.servo[1].garbled_n = 100;
    TEST_ASSERT_TRUE(found_out_ms(3) <= (3 + SERVO_BUS_MISSES_MAX) * 22);
    trouble_is(SERVO_TROUBLE_GARBLED, 1, 2, 0);
}

static void two_misses_are_forgiven(void)
{
    const servos_config config = wire_fresh(3);
    turned_on(&config);
    for (int i = 0; i < 10; i++) {
        w.servo[i % 3].mute_n = SERVO_BUS_MISSES_MAX - 1;
        run_ms(60);
        TEST_ASSERT_TRUE(servos_healthy(&subject));
    }
    TEST_ASSERT_TRUE(subject.bus.counts.timeouts >= 20);
}

static void an_error_is_told_at_once(void)
{
    servos_config config = wire_fresh(3);
    turned_on(&config);
    w.servo[2].table[HARDWARE] = 0x04; /* too hot */
    TEST_ASSERT_TRUE(found_out_ms(3) <= 3 * 22);
    trouble_is(SERVO_TROUBLE_HARDWARE, 2, 3, 0x04);
    config = wire_fresh(3);
    turned_on(&config);
    w.servo[1].error = 0x01;
    TEST_ASSERT_TRUE(found_out_ms(3) <= 3 * 22);
    trouble_is(SERVO_TROUBLE_STATUS, 1, 2, 1);
}

/* The first trouble stays the one that is told, and goals go on until the app decides. */
static void the_first_trouble_is_told(void)
{
    const servos_config config = wire_fresh(3);
    turned_on(&config);
    w.servo[2].table[HARDWARE] = 0x04;
    found_out_ms(3);
    w.servo[0].table[HARDWARE] = 0x20;
    all_to(0.5f, 3);
    run_ms(50);
    trouble_is(SERVO_TROUBLE_HARDWARE, 2, 3, 0x04);
    TEST_ASSERT_EQUAL_INT32(2048 + 326, goal_of(1));
}

/* A board that never finishes a packet: the servos cannot be reached, whatever they do. */
static void a_line_that_is_stuck_is_found_out(void)
{
    const servos_config config = wire_fresh(3);
    turned_on(&config);
    run_ms(50);
    w.stuck = true;
    TEST_ASSERT_TRUE(found_out_ms(3) <= SERVO_BUS_STUCK_US / 1000 + 20);
    trouble_is(SERVO_TROUBLE_SILENT, -1, 0, 0);
    configured(&config);
    w.stuck = false;
    servos_prepare(&subject, w.now_us);
    run_ms(505);
    w.stuck = true;
    run_while(SERVOS_PREPARING, SERVO_BUS_STUCK_US / 1000 + 20);
    TEST_ASSERT_EQUAL_INT(SERVOS_FAILED, subject.state);
}

/* Noise between the packets is not an answer, and harms none. */
static void noise_between_packets_is_ignored(void)
{
    const servos_config config = wire_fresh(3);
    turned_on(&config);
    uint32_t seed = 3;
    for (int i = 0; i < 300; i++) {
        uint8_t noise[9];
        for (size_t k = 0; k < sizeof noise; k++) {
            noise[k] = (uint8_t)random_bits(&seed);
        }
        if (!w.sending && w.coming_n == 0) {
            wire_come(noise, sizeof noise, w.now_us);
        }
        all_to(0.001f * (float)i, 3);
        w.log_n = 0;
        run_ms(3);
    }
    TEST_ASSERT_TRUE(servos_healthy(&subject));
    TEST_ASSERT_INT32_WITHIN(2, 2048 + 195, goal_of(1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(goals_are_rounded_to_the_nearest_unit);
    RUN_TEST(positions_and_goals_are_each_other_s_inverse);
    RUN_TEST(goals_never_need_stuffing);
    RUN_TEST(odd_goals_are_clamped_or_left_alone);
    RUN_TEST(the_newest_goals_win);
    RUN_TEST(goals_at_the_stated_period_all_get_through);
    RUN_TEST(the_period_is_what_the_bus_can_carry);
    RUN_TEST(without_goals_the_watch_goes_on);
    RUN_TEST(a_servo_that_falls_silent_is_found_out);
    RUN_TEST(a_line_that_goes_bad_is_found_out);
    RUN_TEST(two_misses_are_forgiven);
    RUN_TEST(an_error_is_told_at_once);
    RUN_TEST(the_first_trouble_is_told);
    RUN_TEST(a_line_that_is_stuck_is_found_out);
    RUN_TEST(noise_between_packets_is_ignored);
    return UNITY_END();
}
