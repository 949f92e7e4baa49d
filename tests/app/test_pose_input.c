/* test_pose_input.c - which poses are believed, and what is counted. */
#include "pose_fixture.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const rod_pose origin = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

static void expect(const pose_input *in, pose_verdict verdict, uint32_t n)
{
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(n, in->count[verdict], pose_verdict_text(verdict));
    TEST_ASSERT_EQUAL_UINT32(in->received, counted(in));
}

static void test_parameters_outside_their_bounds_are_refused(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    const float nan = float_of(0x7fc00000u);
    const pose_input_params good = pose_input_defaults();
    pose_input_params bad[] = {good, good, good, good, good, good, good, good, good, good};
    bad[0].mode = (pose_mode)2;
    bad[1].hold_us = 19999;
    bad[2].hold_us = 200001;
    bad[3].horizon_us = 100001;
    bad[4].speed_max_mps = 0.0f;
    bad[5].speed_max_mps = 100.1f;
    bad[6].speed_max_mps = nan;
    bad[7].turn_max_radps = nan;
    bad[8].turn_max_radps = -1.0f;
    bad[9].turn_max_radps = 1000.5f;
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_FALSE(pose_input_set(&in, &bad[i]));
        TEST_ASSERT_FALSE(pose_input_init(&in, &bad[i], 0));
        TEST_ASSERT_EQUAL_MEMORY(&good, &in.params, sizeof good);
    }
    pose_input_params edge = good;
    edge.hold_us = 20000, edge.horizon_us = 0, edge.speed_max_mps = 100.0f;
    TEST_ASSERT_TRUE(pose_input_set(&in, &edge));
}

static void test_session_and_sequence(void)
{
    pose_input in;
    const pose_input_params params = pose_input_defaults();
    pose_input_init(&in, &params, 0);
    TEST_ASSERT_EQUAL(POSE_WRONG_SESSION, receive(&in, 1000, 0, origin));
    pose_input_open(&in, SESSION);
    pose_sample other = sample_at(1000, 0, origin);
    other.session = SESSION + 1;
    TEST_ASSERT_EQUAL(POSE_WRONG_SESSION, pose_input_receive(&in, &other, 1000));
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, 2000, 65534, origin));
    TEST_ASSERT_EQUAL(POSE_DUPLICATE, receive(&in, 3000, 65534, origin));
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, 4000, 2, origin)); /* 65535, 0, 1 are missing */
    TEST_ASSERT_EQUAL_UINT32(3, in.sequence.lost);
    TEST_ASSERT_EQUAL(POSE_LATE, receive(&in, 5000, 0, origin));
    TEST_ASSERT_EQUAL(POSE_DUPLICATE, receive(&in, 6000, 0, origin));
    TEST_ASSERT_EQUAL(POSE_DUPLICATE, receive(&in, 7000, 65534, origin));
    TEST_ASSERT_EQUAL_UINT32(2, in.sequence.lost);
    TEST_ASSERT_EQUAL(POSE_LATE, receive(&in, 8000, (uint16_t)(2 - 32), origin));
    TEST_ASSERT_EQUAL(POSE_LATE, receive(&in, 9000, (uint16_t)(2 + 32768), origin));
    TEST_ASSERT_EQUAL_UINT32(2, in.sequence.lost);
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, 10000, (uint16_t)(2 + 32767), origin));
    TEST_ASSERT_EQUAL_UINT32(2 + 32766, in.sequence.lost);
    pose_input_open(&in, SESSION + 1);
    other.seq = 1;
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, pose_input_receive(&in, &other, 11000));
    expect(&in, POSE_ACCEPTED, 4);
    expect(&in, POSE_WRONG_SESSION, 2);
    expect(&in, POSE_DUPLICATE, 3);
    expect(&in, POSE_LATE, 3);
}

static void test_numbers(void)
{
    const float nan = float_of(0x7fc00000u), infinite = float_of(0x7f800000u);
    const float bad[] = {nan, infinite, -infinite};
    pose_input in = started(POSE_PREDICT, 0);
    uint16_t seq = 0;
    for (int field = 0; field < 7; field++) {
        for (int i = 0; i < 3; i++) {
            rod_pose pose = origin;
            float *const fields[] = {&pose.position_m.x,  &pose.position_m.y,  &pose.position_m.z,
                                     &pose.orientation.x, &pose.orientation.y, &pose.orientation.z,
                                     &pose.orientation.w};
            *fields[field] = bad[i];
            TEST_ASSERT_EQUAL(POSE_NOT_FINITE, receive(&in, 1000, seq++, pose));
        }
    }
    TEST_ASSERT_EQUAL(POSE_NOT_FINITE, receive(&in, 1000, seq++, pose_at(0.0f, 500.1f, 0.0f)));
    const float length[] = {0.0f, 0.9899f, 1.0101f, 3e38f, -1.02f};
    for (int i = 0; i < 5; i++) {
        rod_pose pose = origin;
        pose.orientation.w = length[i];
        TEST_ASSERT_EQUAL(POSE_BAD_QUATERNION, receive(&in, 1000, seq++, pose));
    }
    const float good[] = {0.9901f, 1.0099f, -1.0099f};
    for (int i = 0; i < 3; i++) {
        rod_pose pose = origin;
        pose.orientation.w = good[i];
        TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, 1000u * (uint32_t)i + 1000u, seq++, pose));
        const pose_tick tick = pose_input_tick(&in, 1000u * (uint32_t)i + 1000u);
        /* of unit length, and on the side of the last */
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, tick.base.orientation.w);
    }
    expect(&in, POSE_NOT_FINITE, 22);
    expect(&in, POSE_BAD_QUATERNION, 5);
    TEST_ASSERT_EQUAL_UINT32(0, in.sequence.lost); /* they came */
}

static void check_age(bool synced, uint32_t now_us)
{
    pose_input in = started(POSE_PREDICT, now_us);
    if (synced) {
        sync_clocks(&in, now_us);
    }
    const struct {
        uint32_t sent_us, age_us;
        pose_verdict synced, alone;
    } cases[] = {
        {now_us, 50000, POSE_ACCEPTED, POSE_ACCEPTED},
        {now_us, 50001, POSE_STALE, POSE_STALE},
        {now_us, UINT32_MAX, POSE_STALE, POSE_STALE},
        {now_us - 30000, 20000, POSE_ACCEPTED, POSE_ACCEPTED},
        {now_us - 30000, 20001, POSE_STALE, POSE_ACCEPTED},
        {now_us + 5000, 0, POSE_ACCEPTED, POSE_ACCEPTED},
        {now_us + 5001, 0, POSE_FUTURE, POSE_ACCEPTED},
        {now_us + 10000, 5000, POSE_ACCEPTED, POSE_ACCEPTED},
        {now_us + 2000000000, 5000, POSE_FUTURE, POSE_ACCEPTED},
        {now_us - 2000000000, 5000, POSE_STALE, POSE_ACCEPTED},
    };
    for (uint16_t i = 0; i < 10; i++) {
        pose_input one = in; /* each is a first pose: only its age matters */
        pose_sample sample = sample_at(cases[i].sent_us, i, origin);
        sample.age_us = cases[i].age_us;
        const pose_verdict wanted = synced ? cases[i].synced : cases[i].alone;
        TEST_ASSERT_EQUAL(wanted, pose_input_receive(&one, &sample, now_us));
        expect(&one, wanted, 1);
    }
}

static void test_age_on_both_sides_of_its_bounds_and_of_the_wrap(void)
{
    const uint32_t moments_us[] = {0, 1, 1000000, 0x7fffffffu, 0x80000000u, UINT32_MAX - 3000u};
    for (int i = 0; i < 6; i++) {
        check_age(false, moments_us[i]);
        check_age(true, moments_us[i]);
    }
}

static void test_steps_no_hand_can_do(void)
{
    for (int i = 0; i < 6; i++) {
        /* 10 ms: 20 m/s and 20 mm reach 0.22 m; 150 rad/s and 0.1 rad reach 1.6 rad */
        pose_input in = started(POSE_PREDICT, 0);
        receive(&in, UINT32_MAX - 4000u, 0, origin);
        rod_pose pose = pose_at(0.0f, i == 0 ? 0.2199f : i == 1 ? 0.2201f : 0.0f, 0.0f);
        if (i >= 2) {
            const double angle = i == 2 ? 1.599 : i == 3 ? 1.601 : i == 4 ? -1.599 : -1.601;
            pose.orientation = quat_about((vec3){1.0f, 2.0f, -1.0f}, angle);
        }
        const pose_verdict wanted[] = {POSE_ACCEPTED, POSE_TELEPORT, POSE_ACCEPTED,
                                       POSE_TOO_FAST, POSE_ACCEPTED, POSE_TOO_FAST};
        TEST_ASSERT_EQUAL(wanted[i], receive(&in, 5999, 1, pose));
        expect(&in, wanted[i], wanted[i] == POSE_ACCEPTED ? 2 : 1);
    }
    pose_input in = started(POSE_PREDICT, 0);
    receive(&in, 1000, 0, origin);
    pose_sample again = sample_at(1000, 1, origin); /* newer, but captured at the same time */
    TEST_ASSERT_EQUAL(POSE_LATE, pose_input_receive(&in, &again, 2000));
    again.seq = 2, again.sent_us = 999;
    TEST_ASSERT_EQUAL(POSE_LATE, pose_input_receive(&in, &again, 3000));
    again.seq = 3, again.sent_us = 1001;
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, pose_input_receive(&in, &again, 4000));
}

static void test_a_tracker_that_really_is_elsewhere_is_followed(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    uint16_t seq = 0;
    uint32_t t_us = 0;
    for (; seq < 10; seq++, t_us += 4000) {
        receive(&in, t_us, seq, origin);
    }
    TEST_ASSERT_TRUE(pose_input_tick(&in, t_us).restart);
    TEST_ASSERT_FALSE(pose_input_tick(&in, t_us).restart); /* once */
    for (int i = 0; i < 4; i++, t_us += 4000) {
        TEST_ASSERT_EQUAL(POSE_TELEPORT, receive(&in, t_us, seq++, pose_at(5.0f, 0.0f, 0.0f)));
        TEST_ASSERT_FALSE(pose_input_tick(&in, t_us).restart);
    }
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, t_us, seq++, pose_at(5.0f, 0.0f, 0.0f)));
    const pose_tick tick = pose_input_tick(&in, t_us);
    TEST_ASSERT_TRUE(tick.restart);
    TEST_ASSERT_EQUAL_FLOAT(5.0f, tick.base.position_m.x);
    TEST_ASSERT_EQUAL_UINT32(1, in.reanchored);
    TEST_ASSERT_EQUAL_UINT32(2, in.restarts);

    /* glitches that do not agree never take over, not even between good poses */
    for (int i = 0; i < 40; i++) {
        t_us += 4000;
        const float x = i % 2 == 0 ? 50.0f : -50.0f;
        TEST_ASSERT_EQUAL(POSE_TELEPORT, receive(&in, t_us, seq++, pose_at(x, 0.0f, 0.0f)));
    }
    for (int i = 0; i < 40; i++) {
        t_us += 4000;
        receive(&in, t_us, seq++,
                i % 4 == 0 ? pose_at(5.0f, 0.0f, 0.0f) : pose_at(9.0f, 0.0f, 0.0f));
    }
    TEST_ASSERT_EQUAL_UINT32(1, in.reanchored);
    TEST_ASSERT_EQUAL_UINT32(in.received, counted(&in));
}

static void test_a_sender_whose_clock_is_set_back_is_not_locked_out(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    for (uint16_t i = 0; i < 30; i++) {
        pose_sample sample = sample_at(4000u * i - (i >= 20 ? 3600000000u / 4u : 0u), i, origin);
        pose_input_receive(&in, &sample, 4000u * i);
    }
    expect(&in, POSE_LATE, 4);
    expect(&in, POSE_ACCEPTED, 26);
    TEST_ASSERT_EQUAL_UINT32(1, in.reanchored);
}

static void test_everything_has_a_text(void)
{
    for (int i = 0; i <= POSE_VERDICTS_N; i++) {
        TEST_ASSERT_GREATER_THAN(5, (int)strlen(pose_verdict_text((pose_verdict)i)));
        TEST_ASSERT_GREATER_THAN(3, (int)strlen(pose_stream_text((pose_stream_state)i)));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_parameters_outside_their_bounds_are_refused);
    RUN_TEST(test_session_and_sequence);
    RUN_TEST(test_numbers);
    RUN_TEST(test_age_on_both_sides_of_its_bounds_and_of_the_wrap);
    RUN_TEST(test_steps_no_hand_can_do);
    RUN_TEST(test_a_tracker_that_really_is_elsewhere_is_followed);
    RUN_TEST(test_a_sender_whose_clock_is_set_back_is_not_locked_out);
    RUN_TEST(test_everything_has_a_text);
    return UNITY_END();
}
