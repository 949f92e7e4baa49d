/* test_device_params.c - what the device can be told, and what it does with what it should not believe. */
#include <math.h>

#include "device_fixture.h"
#include "saved_params.h"

void setUp(void)
{
    bench_connected(6);
}

void tearDown(void)
{
    free(b);
}

static void test_every_parameter_tells_what_it_is(void)
{
    const int params_n = params_count();
    for (int i = 0; i < params_n; i++) {
        ask((message){.type = MESSAGE_PARAM_LIST, .param_list = {.index = (uint16_t)i}});
        tick();
        const message_param_info *info = &b->newest[MESSAGE_PARAM_INFO].param_info;
        TEST_ASSERT_EQUAL_UINT16(i, info->index);
        TEST_ASSERT_EQUAL_UINT16(params_n, info->params_n);
        TEST_ASSERT_TRUE(info->minimum <= info->initial && info->initial <= info->maximum);
        TEST_ASSERT_TRUE(strlen(info->name) > 0 && strlen(info->text) > 0);
        message get = {.type = MESSAGE_PARAM_GET};
        strcpy(get.param_get.name, info->name);
        ask(get);
        tick();
        TEST_ASSERT_EQUAL_UINT16(info->entries_n,
                                 b->newest[MESSAGE_PARAM_VALUE].param_value.values_n);
    }
    ask((message){.type = MESSAGE_PARAM_LIST, .param_list = {.index = (uint16_t)params_n}});
    tick();
    (void)refused_at_once(REASON_INDEX);
}

/* Attacks on every parameter: refused by name with value and bounds, and nothing has changed. */
static void test_bad_values_are_refused_and_the_old_ones_stay(void)
{
    for (int i = 0; i < params_count(); i++) {
        params_info info;
        TEST_ASSERT_TRUE(params_describe(b->host.device.params.in_force.rod.links_n, i, &info));
        const float step = info.kind == PARAM_NUMBER ? 1e-3f * (1.0f + fabsf(info.max)) : 1.0f;
        const float bad[] = {info.min - step, info.max + step, NAN, INFINITY, -INFINITY};
        for (int k = 0; k < 5; k++) {
            const params_set before = b->host.device.params.staged;
            stage(info.name, 0, bad[k]);
            const message_nack *nack = &b->newest[MESSAGE_NACK].nack;
            TEST_ASSERT_EQUAL_UINT16(b->request_id, nack->request_id);
            TEST_ASSERT_EQUAL_STRING(info.name, nack->field);
            if (info.flags & PARAM_READ_ONLY) {
                TEST_ASSERT_EQUAL_UINT8(REASON_READ_ONLY, nack->reason);
            } else {
                TEST_ASSERT_EQUAL_UINT8(k < 2 ? REASON_BOUNDS : REASON_NOT_FINITE, nack->reason);
                TEST_ASSERT_EQUAL_FLOAT(info.min, nack->minimum);
                TEST_ASSERT_EQUAL_FLOAT(info.max, nack->maximum);
            }
            TEST_ASSERT_EQUAL_MEMORY(&before, &b->host.device.params.staged, sizeof before);
        }
    }
    stage("links", 0, 2.5f);
    (void)refused_at_once(REASON_NOT_WHOLE);
    stage("nonsense", 0, 1.0f);
    (void)refused_at_once(REASON_NAME);
    stage("spring", 300, 1.0f);
    (void)refused_at_once(REASON_ENTRIES);
}

static void test_a_set_is_taken_whole_or_not_at_all(void)
{
    const params_set before = b->host.device.params.in_force;
    stage("spring", 0, 300.0f);
    TEST_ASSERT_EQUAL_MEMORY(&before, &b->host.device.params.in_force, sizeof before);
    stage("inertia", 2, 1e-6f);
    stage("damper", 2, 100.0f); /* each may be; together the damper would saw */
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    const message_nack *nack = refused_at_once(REASON_COMBINATION);
    TEST_ASSERT_EQUAL_STRING("damper", nack->field);
    TEST_ASSERT_EQUAL_INT(2, nack->entry);
    TEST_ASSERT_EQUAL_MEMORY(&before, &b->host.device.params.in_force, sizeof before);
    stage("inertia", 2, 0.2f);
    stage("damper", 2, 1.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_PARAM_COMMIT, b->newest[MESSAGE_ACK].ack.answered);
    TEST_ASSERT_EQUAL_FLOAT(300.0f, b->host.device.params.in_force.rod.spring[5]);
    TEST_ASSERT_EQUAL_FLOAT(300.0f, rod_params_of(&b->host.device.body.rod)->spring[5]);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, b->host.device.params.in_force.rod.damper[2]);
}

static void test_a_rate_that_does_not_fit_the_line_is_refused_with_the_arithmetic(void)
{
    b->host.device.config.line_baud = 1000000;
    stage("angles_rate", 0, 1000.0f); /* 6 links: 51 bytes each, 51,000 of 80,000 a second */
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    TEST_ASSERT_EQUAL_FLOAT(1000.0f, b->host.device.params.in_force.device.angles_hz);
    stage("nodes_rate", 0, 300.0f); /* 107 bytes each: 83,100 */
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    const message_nack *nack = refused_at_once(REASON_LINE_RATE);
    TEST_ASSERT_EQUAL_FLOAT(83100.0f, nack->value);
    TEST_ASSERT_EQUAL_FLOAT(80000.0f, nack->maximum);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, b->host.device.params.in_force.device.nodes_hz);
}

static void test_what_needs_disarmed_waits_for_it(void)
{
    sway(300, 10, 0.05f);
    ask_simply(MESSAGE_ARM);
    sway_until_active();
    stage("links", 0, 4.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    TEST_ASSERT_EQUAL_STRING("links", refused_at_once(REASON_DISARMED_ONLY)->field);
    ask_simply(MESSAGE_PARAM_SAVE);
    tick();
    (void)refused_at_once(REASON_STATE);
    ask_simply(MESSAGE_DISARM);
    ticks(2);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    TEST_ASSERT_EQUAL_INT(4, b->host.device.params.in_force.rod.links_n);
    TEST_ASSERT_EQUAL_INT(8, b->host.device.body.map.servos_n);
}

/* The same request again is answered again and not done again. */
static void test_requests_are_done_once(void)
{
    stage("spring", 0, 300.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    for (int again = 0; again < 3; again++) {
        const message m = {.type = MESSAGE_PARAM_COMMIT,
                           .param_commit = {.request_id = b->request_id}};
        say_as(&m, b->request_id);
        tick();
    }
    TEST_ASSERT_EQUAL_UINT32(1, b->host.device.params.generation);
    TEST_ASSERT_EQUAL_UINT32(3, b->host.device.commands_repeated);
    TEST_ASSERT_EQUAL_UINT(5, b->seen_n[MESSAGE_ACK]);
}

static void restart(void)
{
    host_device *h = &b->host;
    h->flash.writes_left = -1;
    h->flash.cut = false;
    bench_start(6);
    say_hello(100.0f);
    ticks(5);
}

static void test_settings_outlive_a_restart(void)
{
    TEST_ASSERT_TRUE(saved_params_bytes_max() <= DEVICE_SETTINGS_BYTES);
    stage("spring", 3, 321.0f);
    stage("pose_hold", 0, 80.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    save();
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_PARAM_SAVE, b->newest[MESSAGE_ACK].ack.answered);
    restart();
    TEST_ASSERT_EQUAL_FLOAT(321.0f, b->host.device.params.in_force.rod.spring[3]);
    TEST_ASSERT_EQUAL_FLOAT(80.0f, b->host.device.params.in_force.device.pose_hold_ms);
    TEST_ASSERT_EQUAL_INT(SETTINGS_NEWEST, b->host.device.settings.origin);
}

/* Power goes at every word of a save: afterwards it is the old settings or the new ones, never a mixture and
 * never the defaults. */
static void test_a_power_cut_while_saving_leaves_old_or_new(void)
{
    stage("spring", 0, 100.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
    save();
    int old_n = 0, new_n = 0;
    for (long cut = 0; cut < 400; cut += 3) {
        const float old_value = b->host.device.params.in_force.rod.spring[0];
        const float new_value = 200.0f + (float)cut;
        stage("spring", 0, new_value);
        ask_simply(MESSAGE_PARAM_COMMIT);
        tick();
        b->host.flash.writes_left = cut;
        ask_simply(MESSAGE_PARAM_SAVE);
        for (int i = 0; i < 400 && !b->host.flash.cut; i++) {
            device_tick(&b->host.device);
            b->host.elapsed_s += 1e-3;
        }
        restart();
        const rod_params *rod = &b->host.device.params.in_force.rod;
        const bool is_old = !(rod->spring[0] < old_value || rod->spring[0] > old_value);
        const bool is_new = !(rod->spring[0] < new_value || rod->spring[0] > new_value);
        TEST_ASSERT_TRUE(is_old || is_new);
        for (int joint = 1; joint < 6; joint++) {
            TEST_ASSERT_EQUAL_FLOAT(rod->spring[0], rod->spring[joint]);
        }
        old_n += is_old;
        new_n += is_new;
    }
    TEST_ASSERT_TRUE(old_n > 10 && new_n > 10);
}

/* seq wraps every 65,536 poses, the clocks every 71 minutes; nothing happens. */
static void test_wraps_go_unnoticed(void)
{
    b->host.elapsed_s = 4294.0; /* the device's clock wraps in 0.97 s ... */
    b->ahead_us = 0xFFF00000u;  /* ... and the PC's elsewhere */
    bench_start(6);
    b->pose_seq = 65500;
    say_hello(100.0f);
    sway(300, 10, 0.05f);
    ask_simply(MESSAGE_ARM);
    sway(5000, 10, 0.05f);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
    TEST_ASSERT_EQUAL_UINT32(530, b->host.device.poses.count[POSE_ACCEPTED]);
    TEST_ASSERT_EQUAL_UINT32(0, b->host.device.poses.sequence.lost);
    TEST_ASSERT_EQUAL_UINT32(0, b->host.device.holds);
}

/* Late, repeated, from the future, from elsewhere: each is counted by its cause, and all of them are. */
static void test_every_pose_is_accounted_for(void)
{
    const uint16_t odd[] = {1, 1, 0, 5};
    unsigned sent_n = 0;
    for (int round = 0; round < 50; round++) {
        for (int k = 0; k < 4; k++, sent_n++) {
            const message m = {
                .type = MESSAGE_POSE,
                .pose = {.position_m = {k == 3 && round % 7 == 0 ? 50.0f : 0.0f, 0.0f, 0.0f},
                         .quaternion_xyzw = {0.0f, 0.0f, round % 11 == 0 ? NAN : 0.0f, 1.0f},
                         .age_us = k == 0 && round % 5 == 0 ? 60000 : 0}};
            b->pose_seq = (uint16_t)(b->pose_seq + odd[k]);
            say_as(&m, b->pose_seq);
            ticks(10);
        }
    }
    const pose_input *in = &b->host.device.poses;
    uint32_t sum = 0;
    for (int i = 0; i < POSE_VERDICTS_N; i++) {
        sum += in->count[i];
    }
    TEST_ASSERT_EQUAL_UINT32(sent_n, sum);
    TEST_ASSERT_TRUE(in->count[POSE_DUPLICATE] > 0 && in->count[POSE_STALE] > 0 &&
                     in->count[POSE_NOT_FINITE] > 0 && in->count[POSE_TELEPORT] > 0 &&
                     in->sequence.lost > 0);
}

/* One value out of its bounds is told as that, values that do not go together as that, whatever the rod's numbers. */
static void test_a_refusal_by_the_rod_keeps_its_kind(void)
{
    params_refusal why;
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_refusal bounds = {rod_fields[i].error, &rod_fields[i], 0, 1.0f, 2.0f, 3.0f};
        TEST_ASSERT_FALSE(params_refuse_rod(bounds.error, &bounds, &why));
        TEST_ASSERT_EQUAL_INT_MESSAGE(REASON_BOUNDS, why.reason, rod_fields[i].name);
        TEST_ASSERT_EQUAL_STRING(rod_fields[i].name, why.field);
    }
    const rod_refusal together[] = {
        {ROD_E_OVERDAMPED, rod_field_find("damper"), 0, 3.0f, 0.0f, 2.0f},
        {ROD_E_PIVOT, NULL, 1, 0.0f, 0.0f, 0.0f},
    };
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_FALSE(params_refuse_rod(together[i].error, &together[i], &why));
        TEST_ASSERT_EQUAL_INT(REASON_COMBINATION, why.reason);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_parameter_tells_what_it_is);
    RUN_TEST(test_bad_values_are_refused_and_the_old_ones_stay);
    RUN_TEST(test_a_set_is_taken_whole_or_not_at_all);
    RUN_TEST(test_a_rate_that_does_not_fit_the_line_is_refused_with_the_arithmetic);
    RUN_TEST(test_what_needs_disarmed_waits_for_it);
    RUN_TEST(test_requests_are_done_once);
    RUN_TEST(test_settings_outlive_a_restart);
    RUN_TEST(test_a_power_cut_while_saving_leaves_old_or_new);
    RUN_TEST(test_wraps_go_unnoticed);
    RUN_TEST(test_every_pose_is_accounted_for);
    RUN_TEST(test_a_refusal_by_the_rod_keeps_its_kind);
    return UNITY_END();
}
