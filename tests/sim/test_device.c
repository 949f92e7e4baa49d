/* test_device.c - the whole device on its virtual clock: what a person who holds it relies on.
 *
 *     test_device [LOSSES]     injected losses and e-stops, 500 by default
 */
#include "device_fixture.h"

static int losses_n = 500;

void setUp(void)
{
    bench_new(8);
}

void tearDown(void)
{
    free(b);
}

static void test_comes_up_disarmed_and_says_who_it_is(void)
{
    ticks(20);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    say_hello(100.0f);
    TEST_ASSERT_EQUAL_INT(1, b->seen_n[MESSAGE_HELLO]);
    TEST_ASSERT_EQUAL_STRING("limber-sim", b->newest[MESSAGE_HELLO].hello.device);
    TEST_ASSERT_EQUAL_UINT16(8, b->newest[MESSAGE_HELLO].hello.links_n);
    TEST_ASSERT_EQUAL_HEX32(messages_layout_hash(), b->newest[MESSAGE_HELLO].hello.layout_hash);
}

static void test_another_major_version_is_refused(void)
{
    ask((message){.type = MESSAGE_HELLO, .hello = {.protocol_major = PROTOCOL_MAJOR + 1}});
    tick();
    TEST_ASSERT_EQUAL_UINT8(REASON_VERSION, b->newest[MESSAGE_NACK].nack.reason);
}

/* Pose in, angles out: in the very tick in which the pose came. */
static void test_a_pose_is_in_the_angles_within_one_tick(void)
{
    message m = {.type = MESSAGE_PARAM_SET,
                 .param_set = {.name = "angles_rate", .values_n = 1, .values = {1000.0f}}};
    get_active();
    ask(m);
    ask_simply(MESSAGE_PARAM_COMMIT);
    sway(50, 10, 0.05f);
    for (int i = 0; i < 100; i++) {
        pose_at(0.001f * (float)i);
        const unsigned before = b->seen_n[MESSAGE_ANGLES];
        tick();
        TEST_ASSERT_EQUAL_UINT(before + 1, b->seen_n[MESSAGE_ANGLES]);
        TEST_ASSERT_EQUAL_UINT16(b->pose_seq, b->newest[MESSAGE_ANGLES].angles.pose_seq);
        TEST_ASSERT_EQUAL_UINT16(0, b->newest[MESSAGE_ANGLES].angles.received_ago_us);
        ticks(9);
    }
}

static void test_no_arming_without_poses(void)
{
    say_hello(0.0f);
    ticks(300);
    ask_simply(MESSAGE_ARM);
    ticks(10);
    TEST_ASSERT_EQUAL_UINT8(REASON_NO_POSES, b->newest[MESSAGE_NACK].nack.reason);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
}

static void test_a_source_slower_than_hold_is_refused_at_once(void)
{
    say_hello(15.0f);
    TEST_ASSERT_EQUAL_UINT8(REASON_POSES_TOO_SLOW, b->newest[MESSAGE_NACK].nack.reason);
    /* one that did not say so, as soon as it is seen to be */
    say_hello(0.0f);
    sway(400, 66, 0.05f);
    ask_simply(MESSAGE_ARM);
    tick();
    TEST_ASSERT_EQUAL_UINT8(REASON_POSES_TOO_SLOW, b->newest[MESSAGE_NACK].nack.reason);
    TEST_ASSERT_EQUAL_INT(0, (int)b->host.device.holds);
}

/* Silence: HOLD within 51 ms, RELAX at 500 ms more, LIMP at last; the stream back in HOLD: ACTIVE again. */
static void test_losses_hold_within_51_ms_and_recover(void)
{
    get_active();
    uint32_t random = 1;
    for (int loss = 0; loss < losses_n; loss++) {
        random = random * 1664525u + 1013904223u;
        const int silence_ms = 60 + (int)(random >> 24);
        int held_after_ms = -1;
        for (int ms = 1; ms <= silence_ms; ms++) {
            tick();
            if (held_after_ms < 0 && state_now() == SUPERVISOR_HOLD) {
                held_after_ms = ms;
            }
        }
        /* the last pose came up to 10 ms before the silence was begun to be counted */
        TEST_ASSERT_TRUE_MESSAGE(held_after_ms > 0 && held_after_ms <= 51, "HOLD is late");
        sway(1400, 10, 0.05f);
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
    }
}

static void test_silence_ends_limp_and_needs_a_fresh_arm(void)
{
    get_active();
    ticks(52);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_HOLD, state_now());
    ticks(501);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_RELAX, state_now());
    ticks(5001);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_LIMP, state_now());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    sway(1000, 10, 0.05f);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_LIMP, state_now());
    ask_simply(MESSAGE_ARM);
    sway_until_active();
}

static void test_estop_takes_the_torque_within_one_tick(void)
{
    get_active();
    for (int i = 0; i < losses_n; i++) {
        TEST_ASSERT_TRUE(b->host.plant.powered);
        ask_simply(MESSAGE_ESTOP);
        tick();
        TEST_ASSERT_FALSE(b->host.plant.powered);
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
        ask_simply(MESSAGE_ARM);
        sway(50, 10, 0.05f);
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
        ask_simply(MESSAGE_CLEAR_FAULT);
        sway(300, 10, 0.05f);
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
        ask_simply(MESSAGE_ARM);
        sway_until_active();
    }
}

static void test_estop_is_obeyed_from_a_stranger(void)
{
    get_active();
    b->session = 77;
    ask_simply(MESSAGE_ESTOP);
    tick();
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
}

static void test_a_servo_error_is_a_fault_that_is_told_once(void)
{
    get_active();
    b->host.injection.faults[0] =
        (injected_fault){.kind = INJECT_SERVO, .start_s = b->host.elapsed_s, .duration_s = 0.01};
    b->host.injection.faults_n = 1;
    sway(100, 10, 0.05f);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_FAULT, state_now());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    TEST_ASSERT_EQUAL_UINT(1, b->seen_n[MESSAGE_FAULT]);
    TEST_ASSERT_EQUAL_UINT8(FAULT_CODE_SERVO, b->newest[MESSAGE_FAULT].fault.fault);
}

/* No goal ever moves faster, or changes its speed faster, than the parameters allow: a hundred presets
 * while the hand moves. */
static void test_presets_change_without_a_jump(void)
{
    get_active();
    const device_params *p = &b->host.device.params.in_force.device;
    const servo_map *map = &b->host.device.body.map;
    float last[SERVOS_MAX], speed[SERVOS_MAX];
    memcpy(last, servo_map_goals(map), sizeof last);
    memset(speed, 0, sizeof speed);
    bool first = true;
    for (int change = 0; change < 100; change++) {
        message m = {.type = MESSAGE_PRESET};
        strcpy(m.preset.name, rod_presets[change % ROD_PRESETS_N].name);
        ask(m);
        for (int i = 0; i < 300; i++) {
            sway(1, 1, 0.1f);
            if (!b->host.device.body.goals_new) {
                continue;
            }
            const float dt = map->period_s;
            for (int s = 0; s < map->servos_n; s++) {
                const float now = (servo_map_goals(map)[s] - last[s]) / dt;
                TEST_ASSERT_TRUE(now <= p->servo_rate_radps * 1.001f &&
                                 now >= -p->servo_rate_radps * 1.001f);
                const float change_of_speed = (now - speed[s]) / dt;
                const float most = p->servo_acceleration_radps2 * 1.001f + 0.5f;
                TEST_ASSERT_TRUE(first || (change_of_speed <= most && change_of_speed >= -most));
                speed[s] = now;
                last[s] = servo_map_goals(map)[s];
            }
            first = false;
        }
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
    }
    TEST_ASSERT_EQUAL_UINT(0, b->seen_n[MESSAGE_NACK]);
    TEST_ASSERT_EQUAL_UINT32(100, b->host.device.params.generation);
}

int main(int argc, char **argv)
{
    losses_n = argc > 1 ? atoi(argv[1]) : losses_n;
    UNITY_BEGIN();
    RUN_TEST(test_comes_up_disarmed_and_says_who_it_is);
    RUN_TEST(test_another_major_version_is_refused);
    RUN_TEST(test_a_pose_is_in_the_angles_within_one_tick);
    RUN_TEST(test_no_arming_without_poses);
    RUN_TEST(test_a_source_slower_than_hold_is_refused_at_once);
    RUN_TEST(test_losses_hold_within_51_ms_and_recover);
    RUN_TEST(test_silence_ends_limp_and_needs_a_fresh_arm);
    RUN_TEST(test_estop_takes_the_torque_within_one_tick);
    RUN_TEST(test_estop_is_obeyed_from_a_stranger);
    RUN_TEST(test_a_servo_error_is_a_fault_that_is_told_once);
    RUN_TEST(test_presets_change_without_a_jump);
    return UNITY_END();
}
