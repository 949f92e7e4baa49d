/* test_servo_requests.c - what a user may ask of one servo: who it is, another id, another rate, a turn. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

static servo_info info;

/* As delivered: id 1, 57,600 baud. */
static servos_config as_delivered(int servos_n)
{
    const servos_config config = wire_fresh(servos_n);
    for (int i = 0; i < servos_n; i++) {
        w.servo[i].table[ID] = 1;
        w.servo[i].table[BAUD] = 1;
    }
    return config;
}

static servo_request_state outcome(servo_request request, int ms_max)
{
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    TEST_ASSERT_TRUE(w.supply);
    for (int ms = 0; servos_answer(&subject, &info, &subject.trouble) == SERVO_REQUEST_BUSY; ms++) {
        TEST_ASSERT_FALSE(servos_request(&subject, &request, w.now_us)); /* one at a time */
        TEST_ASSERT_TRUE_MESSAGE(ms < ms_max, "takes too long");
        tick();
    }
    return servos_answer(&subject, &info, &subject.trouble);
}

static void done(servo_request request, int ms_max)
{
    const servo_request_state state = outcome(request, ms_max);
    TEST_ASSERT_EQUAL_STRING("no trouble", servo_trouble_text(subject.trouble.kind));
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_DONE, state);
}

static void fails(servo_request request, servo_trouble_kind kind, int id, uint32_t detail)
{
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_FAILED, outcome(request, 3000));
    trouble_is(kind, -1, id, detail);
}

static void a_servo_tells_how_it_is(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    w.servo[0].table[HARDWARE] = 0x20;
    done((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 57600}, 600);
    TEST_ASSERT_EQUAL_UINT8(1, info.id);
    TEST_ASSERT_EQUAL_UINT16(1060, info.model);
    TEST_ASSERT_EQUAL_UINT8(45, info.firmware);
    TEST_ASSERT_EQUAL_HEX8(0x20, info.hardware_error);
    TEST_ASSERT_EQUAL_UINT32(57600, info.baud);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.0f, info.position_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 11.8f, info.supply_v);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 36.0f, info.temperature_c);
}

/* Only the first has to wait until the servos have booted; ten seconds after the last the supply goes off. */
static void a_scan_is_quick_and_the_supply_goes_off_after_it(void)
{
    const servos_config config = wire_fresh(5);
    configured(&config);
    const servo_request first = {.kind = SERVO_REQUEST_PING, .id = 1};
    done(first, 600);
    for (uint8_t id = 2; id <= 5; id++) {
        done((servo_request){.kind = SERVO_REQUEST_PING, .id = id}, 12);
        TEST_ASSERT_EQUAL_UINT8(id, info.id);
    }
    fails((servo_request){.kind = SERVO_REQUEST_PING, .id = 6}, SERVO_TROUBLE_SILENT, 6, 0);
    run_ms(9990);
    TEST_ASSERT_EQUAL_INT(SERVOS_SERVICE, subject.state);
    TEST_ASSERT_TRUE(w.supply);
    run_ms(20);
    TEST_ASSERT_EQUAL_INT(SERVOS_OFF, subject.state);
    TEST_ASSERT_FALSE(w.supply);
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_FAILED, servos_answer(&subject, &info, &subject.trouble));
    done(first, 600);
}

static void silence_and_noise_are_told_apart(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    w.echo = true;
    fails((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 1000000},
          SERVO_TROUBLE_SILENT, 1, 0);
    w.servo[0].garbled_n = 3;
    fails((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 57600},
          SERVO_TROUBLE_GARBLED, 1, 0);
    done((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 57600}, 100);
    TEST_ASSERT_EQUAL_UINT32(3,
                             subject.bus.counts.damaged); /* since configured, over all restarts */
}

static void another_id(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    done((servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 42, .baud = 57600}, 800);
    TEST_ASSERT_EQUAL_UINT8(42, w.servo[0].table[ID]);
    TEST_ASSERT_EQUAL_UINT8(42, info.id);
    TEST_ASSERT_EQUAL_UINT16(1060, info.model);
    done((servo_request){.kind = SERVO_REQUEST_ID, .id = 42, .new_id = 42, .baud = 57600}, 100);
}

static void an_id_that_another_has_is_refused(void)
{
    const servos_config config = as_delivered(2);
    configured(&config);
    w.servo[1].table[ID] = 2;
    fails((servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 2, .baud = 57600},
          SERVO_TROUBLE_TAKEN, 2, 0);
    w.servo[1].garbled_n = 3; /* two of them, already */
    fails((servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 2, .baud = 57600},
          SERVO_TROUBLE_TAKEN, 2, 0);
    w.servo[1].mute_n = 2;
    fails((servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 2, .baud = 57600},
          SERVO_TROUBLE_TAKEN, 2, 0);
    TEST_ASSERT_EQUAL_UINT8(1, w.servo[0].table[ID]);
}

static void an_id_that_does_not_stick_is_found_out(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    w.servo[0].stuck_at = ID;
    fails((servo_request){.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 9, .baud = 57600},
          SERVO_TROUBLE_SILENT, 9, 0);
}

/* From the factory's rate to the configured one, and at once all is as if it had always been so. */
static void another_rate(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    for (int code = 0; code < 8; code++) {
        const uint32_t from = WIRE_BAUDS[w.servo[0].table[BAUD]];
        done(
            (servo_request){
                .kind = SERVO_REQUEST_BAUD, .id = 1, .baud = from, .new_baud = WIRE_BAUDS[code]},
            1000);
        TEST_ASSERT_EQUAL_UINT8(code, w.servo[0].table[BAUD]);
        TEST_ASSERT_EQUAL_UINT32(WIRE_BAUDS[code], info.baud);
    }
    done((servo_request){.kind = SERVO_REQUEST_BAUD, .id = 1, .baud = 4500000, .new_baud = 4000000},
         1000);
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 1000);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_EQUAL_UINT32(4000000, w.baud);
}

/* A rate that servo or board do not know is refused before the servo could be lost to it. */
static void a_rate_out_of_reach_is_refused(void)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    w.baud_max = 2000000;
    fails((servo_request){.kind = SERVO_REQUEST_BAUD, .id = 1, .baud = 57600, .new_baud = 250000},
          SERVO_TROUBLE_BAUD, 1, 250000);
    fails((servo_request){.kind = SERVO_REQUEST_BAUD, .id = 1, .baud = 57600, .new_baud = 3000000},
          SERVO_TROUBLE_BAUD, 1, 3000000);
    fails((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 19200}, SERVO_TROUBLE_BAUD,
          1, 19200);
    fails((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 4000000}, SERVO_TROUBLE_BAUD,
          1, 4000000);
    TEST_ASSERT_EQUAL_UINT8(1, w.servo[0].table[BAUD]);
    done((servo_request){.kind = SERVO_REQUEST_PING, .id = 1, .baud = 57600}, 600);
}

/* There and back in small steps, and it lets go. */
static void turns(float asked_rad, int32_t expected_units)
{
    const servos_config config = as_delivered(1);
    configured(&config);
    const uint32_t start_us = w.now_us;
    const servo_request request = {
        .kind = SERVO_REQUEST_TEST, .id = 1, .baud = 57600, .turn_rad = asked_rad};
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    int32_t furthest = 0, before = 2048, stride = 0;
    while (servos_answer(&subject, &info, &subject.trouble) == SERVO_REQUEST_BUSY) {
        tick();
        const int32_t now = wire_get(&w.servo[0], PRESENT);
        furthest = abs(now - 2048) > abs(furthest) ? now - 2048 : furthest;
        stride = abs(now - before) > stride ? abs(now - before) : stride;
        before = now;
    }
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_DONE, servos_answer(&subject, &info, &subject.trouble));
    TEST_ASSERT_INT32_WITHIN(9, expected_units, furthest);
    TEST_ASSERT_TRUE(stride <= 13);
    TEST_ASSERT_INT32_WITHIN(1, 2048, wire_get(&w.servo[0], PRESENT));
    TEST_ASSERT_EQUAL_INT(1, w.servo[0].torques);
    TEST_ASSERT_EQUAL_INT32(0, w.servo[0].jump);
    TEST_ASSERT_EQUAL_UINT8(0, w.servo[0].table[TORQUE]);
    TEST_ASSERT_EQUAL_INT(0, w.servo[0].strikes);
    TEST_ASSERT_TRUE(w.now_us - start_us < 2000000u + SERVO_BUS_BOOT_US);
}

static void a_test_turns_it_there_and_back(void)
{
    turns(0.3f, 196);
    turns(-0.3f, -196);
    turns(5.0f, 326); /* no further than 0.5 rad */
}

static void a_test_of_a_broken_servo_gives_it_no_torque(void)
{
    const servos_config config = as_delivered(1);
    const servo_request request = {
        .kind = SERVO_REQUEST_TEST, .id = 1, .baud = 57600, .turn_rad = 0.2f};
    configured(&config);
    w.servo[0].table[HARDWARE] = 0x01;
    fails(request, SERVO_TROUBLE_HARDWARE, 1, 0x01);
    w.servo[0].table[HARDWARE] = 0;
    w.servo[0].stuck_at = GOAL;
    fails(request, SERVO_TROUBLE_READ_BACK, 1, 9999);
    TEST_ASSERT_EQUAL_INT(0, w.servo[0].torques);
}

/* Lost in the middle of a turn, or told to stop: it is told to let go. */
static void a_test_that_breaks_off_lets_go(void)
{
    const servos_config config = as_delivered(1);
    const servo_request request = {
        .kind = SERVO_REQUEST_TEST, .id = 1, .baud = 57600, .turn_rad = 0.2f};
    configured(&config);
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    run_ms(1000);
    TEST_ASSERT_EQUAL_UINT8(1, w.servo[0].table[TORQUE]);
    w.servo[0].mute_n = 3;
    run_ms(100);
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_FAILED, servos_answer(&subject, &info, &subject.trouble));
    TEST_ASSERT_FALSE(w.supply); /* mute may be deaf, too */
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    run_ms(1000);
    TEST_ASSERT_EQUAL_UINT8(1, w.servo[0].table[TORQUE]);
    w.log_n = 0;
    servos_off(&subject);
    run_ms(10);
    TEST_ASSERT_EQUAL_INT(3, w.log_n);
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_NONE, servos_answer(&subject, &info, &subject.trouble));
    TEST_ASSERT_FALSE(w.supply);
}

/* Preparing ends a request: with torque from a test, first of all off. */
static void preparing_ends_a_request(void)
{
    const servos_config config = wire_fresh(1);
    const servo_request request = {.kind = SERVO_REQUEST_TEST, .id = 1, .turn_rad = 0.2f};
    configured(&config);
    TEST_ASSERT_TRUE(servos_request(&subject, &request, w.now_us));
    run_ms(1000);
    servos_prepare(&subject, w.now_us);
    TEST_ASSERT_EQUAL_INT(SERVO_REQUEST_NONE, servos_answer(&subject, &info, &subject.trouble));
    run_ms(1);
    TEST_ASSERT_EQUAL_UINT8(0, w.servo[0].table[TORQUE]);
    run_while(SERVOS_PREPARING, 1000);
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
    TEST_ASSERT_FALSE(servos_request(&subject, &request, w.now_us));
}

static void senseless_requests_are_refused(void)
{
    const servos_config config = wire_fresh(1);
    configured(&config);
    const servo_request senseless[] = {
        {.kind = SERVO_REQUEST_PING, .id = 253},
        {.kind = SERVO_REQUEST_PING, .id = 254},
        {.kind = SERVO_REQUEST_ID, .id = 1, .new_id = 254},
        {.kind = SERVO_REQUEST_TEST, .id = 1, .turn_rad = float_of(0x7FC00000u)},
        {.kind = SERVO_REQUEST_TEST + 1, .id = 1},
    };
    for (size_t i = 0; i < sizeof senseless / sizeof senseless[0]; i++) {
        TEST_ASSERT_FALSE(servos_request(&subject, &senseless[i], w.now_us));
    }
    TEST_ASSERT_EQUAL_INT(SERVOS_OFF, subject.state);
    TEST_ASSERT_FALSE(w.supply);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_servo_tells_how_it_is);
    RUN_TEST(a_scan_is_quick_and_the_supply_goes_off_after_it);
    RUN_TEST(silence_and_noise_are_told_apart);
    RUN_TEST(another_id);
    RUN_TEST(an_id_that_another_has_is_refused);
    RUN_TEST(an_id_that_does_not_stick_is_found_out);
    RUN_TEST(another_rate);
    RUN_TEST(a_rate_out_of_reach_is_refused);
    RUN_TEST(a_test_turns_it_there_and_back);
    RUN_TEST(a_test_of_a_broken_servo_gives_it_no_torque);
    RUN_TEST(a_test_that_breaks_off_lets_go);
    RUN_TEST(preparing_ends_a_request);
    RUN_TEST(senseless_requests_are_refused);
    return UNITY_END();
}
