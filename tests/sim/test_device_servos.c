/* test_device_servos.c - the whole device and its servos: how they get torque, how they lose it, what is refused and
 * in which words. */
#include <math.h>

#include "device_fixture.h"
#include "sim.h"

enum { LINKS_N = 3, SERVOS_N = 2 * LINKS_N };

void setUp(void)
{
    bench_new(LINKS_N);
    say_hello(100.0f);
    sway(300, 10, 0.05f);
}

void tearDown(void)
{
    free(b);
}

static bool has_torque(void)
{
    return servo_plant_has_torque(&b->host.plant);
}

static void inject_after(double wait_s, const char *text)
{
    char line[64];
    snprintf(line, sizeof line, text, b->host.elapsed_s + wait_s);
    TEST_ASSERT_EQUAL_INT(SIM_OK, injection_add(&b->host.injection, line));
}

static void inject(const char *text)
{
    inject_after(0.0, text);
}

static void set(const char *name, float value)
{
    stage(name, 0, value);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_PARAM_COMMIT, b->newest[MESSAGE_ACK].ack.answered);
}

/* The answer to the last request, waited for. */
static const message_nack *refused(uint8_t reason)
{
    for (int i = 0; i < 500; i++) {
        const message_nack *nack = &b->newest[MESSAGE_NACK].nack;
        if (b->seen_n[MESSAGE_NACK] > 0 && nack->request_id == b->request_id) {
            TEST_ASSERT_EQUAL_UINT8(reason, nack->reason);
            return nack;
        }
        sway(10, 10, 0.05f);
    }
    TEST_FAIL_MESSAGE("no refusal came");
    return NULL;
}

static void says(const char *part, const char *text)
{
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
}

static void test_torque_comes_where_the_servos_are(void)
{
    for (int i = 0; i < SERVOS_N; i++) { /* bent by hand while limp */
        b->host.plant.positions_rad[i] = 0.1f * (float)(i - 2);
    }
    ask_simply(MESSAGE_ARM);
    float before_rad[SERVOS_N];
    int with_torque_ms = 0;
    for (int i = 0; i < 3000 && state_now() != SUPERVISOR_ACTIVE; i++) {
        memcpy(before_rad, b->host.plant.positions_rad, sizeof before_rad);
        sway(1, 10, 0.05f);
        TEST_ASSERT_TRUE(!has_torque() || state_now() == SUPERVISOR_ARMING ||
                         state_now() == SUPERVISOR_ACTIVE);
        for (int k = 0; k < SERVOS_N; k++) {
            const float moved_rad = fabsf(b->host.plant.positions_rad[k] - before_rad[k]);
            /* at first by no more than a servo's resolution, then with the rod, through the blend */
            TEST_ASSERT_TRUE(moved_rad <= (with_torque_ms > 100 ? 0.0151f : 0.0016f));
        }
        with_torque_ms += has_torque();
    }
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_ARM, b->newest[MESSAGE_ACK].ack.answered);
    ticks(20);
    sway(500, 10, 0.05f);
    for (int k = 0; k < SERVOS_N; k++) {
        TEST_ASSERT_FLOAT_WITHIN(0.05f, body_goals(&b->host.device.body)[k],
                                 b->host.plant.positions_rad[k]);
    }
}

static void test_an_arm_that_is_asked_again_is_done_once(void)
{
    const unsigned answers_n = b->seen_n[MESSAGE_ACK];
    message arm = {.type = MESSAGE_ARM, .arm = {.request_id = 4711}};
    for (int i = 0; i < 4; i++) {
        say_as(&arm, (uint16_t)i);
        sway(50, 10, 0.05f);
        TEST_ASSERT_EQUAL_UINT(answers_n, b->seen_n[MESSAGE_ACK]);
    }
    sway_until_active();
    TEST_ASSERT_EQUAL_UINT(answers_n + 1, b->seen_n[MESSAGE_ACK]);
    TEST_ASSERT_EQUAL_UINT(0, b->seen_n[MESSAGE_NACK]);
    say_as(&arm, 5); /* the answer was lost, say */
    sway(10, 10, 0.05f);
    TEST_ASSERT_EQUAL_UINT(answers_n + 2, b->seen_n[MESSAGE_ACK]);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
}

static void test_a_missing_servo_is_named(void)
{
    inject("unplug@%g+5:4");
    ask_simply(MESSAGE_ARM);
    const message_nack *nack = refused(REASON_SERVO_SILENT);
    says("servo 4", nack->text);
    says("joint 2, phi", nack->text);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    sway(5000, 10, 0.05f); /* plugged in again */
    ask_simply(MESSAGE_ARM);
    sway_until_active();
}

static void test_a_sick_servo_is_named(void)
{
    inject("servo@%g+5:1");
    ask_simply(MESSAGE_ARM);
    says("servo 1", refused(REASON_SERVO_HARDWARE)->text);
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

static void test_a_servo_lost_on_the_way_is_a_fault_with_its_name(void)
{
    ask_simply(MESSAGE_ARM);
    sway_until_active();
    inject("unplug@%g+5:6");
    int ms = 0;
    while (state_now() != SUPERVISOR_FAULT && ms < 1000) {
        sway(1, 10, 0.05f);
        ms++;
    }
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_FAULT, state_now());
    TEST_ASSERT_TRUE_MESSAGE(ms <= 200, "six servos are asked in turn");
    TEST_ASSERT_FALSE(has_torque());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    sway(10, 10, 0.05f);
    TEST_ASSERT_EQUAL_UINT8(FAULT_CODE_SERVO, b->newest[MESSAGE_FAULT].fault.fault);
    TEST_ASSERT_EQUAL_UINT32(6, b->newest[MESSAGE_FAULT].fault.detail);
    says("servo 6 (joint 3, phi)", b->newest[MESSAGE_FAULT].fault.text);
}

/* Whatever comes between an ARM and torque: the ARM is answered, and nothing is left on. */
static void interrupted(uint8_t type, int after_ticks)
{
    ask_simply(MESSAGE_ARM);
    const uint16_t arm_id = b->request_id;
    sway(after_ticks, 10, 0.05f);
    TEST_ASSERT_TRUE(b->host.plant.powered);
    ask_simply(type);
    sway(2, 10, 0.05f);
    TEST_ASSERT_FALSE(b->host.plant.powered);
    TEST_ASSERT_EQUAL_UINT8(REASON_STATE, b->newest[MESSAGE_NACK].nack.reason);
    TEST_ASSERT_EQUAL_UINT16(arm_id, b->newest[MESSAGE_NACK].nack.request_id);
    sway(1500, 10, 0.05f);
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

static void test_disarm_and_estop_stop_a_preparation(void)
{
    interrupted(MESSAGE_DISARM, 100);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    interrupted(MESSAGE_DISARM, 520);
    interrupted(MESSAGE_ESTOP, 300);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
}

static void test_poses_that_stop_while_it_prepares_leave_it_disarmed(void)
{
    ask_simply(MESSAGE_ARM);
    ticks(3000);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    TEST_ASSERT_EQUAL_UINT8(REASON_STATE, b->newest[MESSAGE_NACK].nack.reason);
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

static void test_nothing_changes_while_it_prepares(void)
{
    ask_simply(MESSAGE_ARM);
    sway(10, 10, 0.05f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    (void)refused(REASON_BUSY);
    ask_simply(MESSAGE_PARAM_SAVE);
    (void)refused(REASON_BUSY);
    ask_simply(MESSAGE_ARM);
    (void)refused(REASON_BUSY);
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 1}});
    (void)refused(REASON_BUSY);
    sway_until_active();
}

static void test_servos_are_set_up_over_the_wire_while_disarmed(void)
{
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 2}});
    sway(700, 10, 0.05f);
    const message_servo_info *info = &b->newest[MESSAGE_SERVO_INFO].servo_info;
    TEST_ASSERT_EQUAL_UINT16(b->request_id, info->request_id);
    TEST_ASSERT_EQUAL_UINT8(2, info->id);
    TEST_ASSERT_EQUAL_UINT16(BUS_SERVO_MODEL, info->model);
    TEST_ASSERT_EQUAL_UINT32(1000000, info->baud);
    ask((message){.type = MESSAGE_SERVO_ASSIGN, .servo_assign = {.old_id = 2, .new_id = 40}});
    sway(1000, 10, 0.05f);
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_SERVO_ASSIGN, b->newest[MESSAGE_ACK].ack.answered);
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 2}});
    says("does not answer", refused(REASON_SERVO_SILENT)->text);
    ask_simply(MESSAGE_ARM); /* the map still says 2 */
    says("servo 2", refused(REASON_SERVO_SILENT)->text);
    ask((message){.type = MESSAGE_SERVO_ASSIGN, .servo_assign = {.old_id = 40, .new_id = 2}});
    sway(1500, 10, 0.05f);
    ask((message){.type = MESSAGE_SERVO_TEST, .servo_test = {.id = 2, .turn_rad = 0.7f}});
    TEST_ASSERT_EQUAL_STRING("turn_rad", refused(REASON_BOUNDS)->field);
    ask_simply(MESSAGE_ARM);
    sway_until_active();
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 1}});
    (void)refused(REASON_STATE);
}

static void test_a_servo_is_tested_and_left_limp(void)
{
    const float before_rad = b->host.plant.positions_rad[2];
    float most_rad = 0.0f;
    ask((message){.type = MESSAGE_SERVO_TEST, .servo_test = {.id = 3, .turn_rad = 0.3f}});
    for (int i = 0; i < 4000; i++) {
        sway(1, 10, 0.05f);
        most_rad = fmaxf(most_rad, b->host.plant.positions_rad[2] - before_rad);
    }
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_SERVO_TEST, b->newest[MESSAGE_ACK].ack.answered);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 0.3f, most_rad);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, before_rad, b->host.plant.positions_rad[2]);
    TEST_ASSERT_FALSE(has_torque());
    sway(10000, 10, 0.05f);
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

/* A test that ends well says something about the servo. */
static void test_a_test_finds_a_servo_that_gives_up_and_one_that_does_not_turn(void)
{
    inject_after(1.2, "servo@%g+9:3");
    ask((message){.type = MESSAGE_SERVO_TEST, .servo_test = {.id = 3, .turn_rad = 0.4f}});
    says("hardware error", refused(REASON_SERVO_HARDWARE)->text);
    TEST_ASSERT_FALSE(b->host.plant.powered);
    b->host.plant.speed_rad_s = 0.02f;
    ask((message){.type = MESSAGE_SERVO_TEST, .servo_test = {.id = 2, .turn_rad = 0.4f}});
    says("does not turn as told", refused(REASON_SERVO)->text);
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

static void test_requests_without_an_id_are_refused(void)
{
    const message arm = {.type = MESSAGE_ARM};
    say_as(&arm, 1);
    sway(10, 10, 0.05f);
    TEST_ASSERT_EQUAL_STRING("request_id", b->newest[MESSAGE_NACK].nack.field);
    TEST_ASSERT_FALSE(b->host.plant.powered);
    const message stop = {.type = MESSAGE_ESTOP}; /* but for these */
    say_as(&stop, 2);
    sway(10, 10, 0.05f);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
}

static void test_a_test_ends_with_a_disarm(void)
{
    ask((message){.type = MESSAGE_SERVO_TEST, .servo_test = {.id = 3, .turn_rad = 0.5f}});
    const uint16_t test_id = b->request_id;
    for (int i = 0; i < 2000 && !has_torque(); i++) {
        sway(1, 10, 0.05f);
    }
    TEST_ASSERT_TRUE(has_torque());
    ask_simply(MESSAGE_DISARM);
    sway(1, 10, 0.05f);
    TEST_ASSERT_FALSE(b->host.plant.powered);
    sway(2, 10, 0.05f);
    TEST_ASSERT_EQUAL_UINT16(test_id, b->newest[MESSAGE_NACK].nack.request_id);
}

static void test_without_servos_it_arms_and_drives_nothing(void)
{
    set("servo_kind", SERVOS_NONE);
    ask_simply(MESSAGE_ARM);
    for (int i = 0; i < 1300; i++) {
        sway(1, 10, 0.05f);
        TEST_ASSERT_FALSE(b->host.plant.powered);
    }
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 1}});
    (void)refused(REASON_STATE);
    ask_simply(MESSAGE_DISARM);
    sway(10, 10, 0.05f);
    ask((message){.type = MESSAGE_SERVO_PING, .servo_ping = {.id = 1}});
    TEST_ASSERT_EQUAL_STRING("servo_kind", refused(REASON_UNSUPPORTED)->field);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_torque_comes_where_the_servos_are);
    RUN_TEST(test_an_arm_that_is_asked_again_is_done_once);
    RUN_TEST(test_a_missing_servo_is_named);
    RUN_TEST(test_a_sick_servo_is_named);
    RUN_TEST(test_a_servo_lost_on_the_way_is_a_fault_with_its_name);
    RUN_TEST(test_disarm_and_estop_stop_a_preparation);
    RUN_TEST(test_poses_that_stop_while_it_prepares_leave_it_disarmed);
    RUN_TEST(test_nothing_changes_while_it_prepares);
    RUN_TEST(test_servos_are_set_up_over_the_wire_while_disarmed);
    RUN_TEST(test_a_servo_is_tested_and_left_limp);
    RUN_TEST(test_a_test_finds_a_servo_that_gives_up_and_one_that_does_not_turn);
    RUN_TEST(test_requests_without_an_id_are_refused);
    RUN_TEST(test_a_test_ends_with_a_disarm);
    RUN_TEST(test_without_servos_it_arms_and_drives_nothing);
    return UNITY_END();
}
