/* test_pose_stream.c - what the supervisor is told of the stream, and the sequence at length. */
#include "pose_fixture.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const rod_pose origin = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

static void test_silence_restarts_and_never_aliases(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    TEST_ASSERT_FALSE(pose_input_tick(&in, 0).valid);
    TEST_ASSERT_EQUAL(POSE_STREAM_NONE, pose_input_stream(&in).state);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, pose_input_stream(&in).silent_us);
    receive(&in, 1000, 0, origin);
    TEST_ASSERT_TRUE(pose_input_tick(&in, 1000).restart);
    receive(&in, 251000, 1, origin); /* 0.25 s: not yet */
    TEST_ASSERT_FALSE(pose_input_tick(&in, 251000).restart);
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, 501001, 2, pose_at(90.0f, 0.0f, 0.0f)));
    TEST_ASSERT_TRUE(pose_input_tick(&in, 501001).restart);

    /* three hours, in steps of 20 min: the wraps of the clock in between are no news */
    uint32_t t_us = 501001;
    for (int i = 1; i <= 9; i++) {
        t_us += 1200000000u;
        pose_input_tick(&in, t_us);
        const pose_stream stream = pose_input_stream(&in);
        TEST_ASSERT_EQUAL(0, stream.good_us);
        TEST_ASSERT_EQUAL_UINT32(i <= 3 ? 1200000000u * (uint32_t)i : UINT32_MAX, stream.silent_us);
    }
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, receive(&in, t_us, 3, pose_at(-90.0f, 0.0f, 0.0f)));
    TEST_ASSERT_TRUE(pose_input_tick(&in, t_us).restart);
    TEST_ASSERT_EQUAL_UINT32(3, in.restarts);
}

static void test_good_is_counted_from_the_last_gap(void)
{
    pose_input in = started(POSE_PREDICT, UINT32_MAX - 100000u);
    uint32_t t_us = UINT32_MAX - 100000u;
    uint16_t seq = 0;
    for (int i = 0; i < 50; i++, t_us += 8000) {
        receive(&in, t_us, seq++, origin);
        TEST_ASSERT_EQUAL_UINT32(8000u * (uint32_t)i, pose_input_stream(&in).good_us);
    }
    t_us -= 8000;
    pose_input_tick(&in, t_us + 49999);
    TEST_ASSERT_EQUAL(POSE_STREAM_GOOD, pose_input_stream(&in).state);
    pose_input_tick(&in, t_us + 50000);
    TEST_ASSERT_EQUAL(POSE_STREAM_SILENT, pose_input_stream(&in).state);
    TEST_ASSERT_EQUAL_UINT32(0, pose_input_stream(&in).good_us);
    receive(&in, t_us + 50000, seq++, origin);
    pose_input_tick(&in, t_us + 57000);
    TEST_ASSERT_EQUAL_UINT32(7000, pose_input_stream(&in).good_us);
    TEST_ASSERT_EQUAL_UINT32(8000, pose_input_stream(&in).interval_us);
    TEST_ASSERT_EQUAL_UINT32(42000 / 8, pose_input_stream(&in).jitter_us);
}

static void test_a_source_too_slow_for_the_timeout_is_named_at_once(void)
{
    const uint32_t interval_us[] = {66000, 50001, 50000, 25000, 300000, 2000};
    for (int i = 0; i < 6; i++) {
        pose_input in = started(POSE_PREDICT, 0);
        for (uint16_t n = 0; n < 40; n++) {
            if (n % 3 != 2) { /* every third is lost: that is not the source's fault */
                receive(&in, interval_us[i] * n, n, origin);
            }
            const bool slow = pose_input_stream(&in).state == POSE_STREAM_SLOW;
            TEST_ASSERT_EQUAL(interval_us[i] > 50000 && n >= 3, slow);
        }
        TEST_ASSERT_EQUAL_UINT32(interval_us[i], pose_input_stream(&in).interval_us);
        for (uint16_t n = 0; n < 8; n++) {
            receive(&in, interval_us[i] * 39u + 40000u * (n + 1u), (uint16_t)(40 + n), origin);
        }
        TEST_ASSERT_NOT_EQUAL(POSE_STREAM_SLOW, pose_input_stream(&in).state);
    }
    /* a stall of a good source is a stall */
    pose_input in = started(POSE_PREDICT, 0);
    for (uint16_t n = 0; n < 60; n++) {
        receive(&in, 8000u * n + (n > 20 ? 240000u : 0u) + (n > 40 ? 3000000u : 0u), n, origin);
        TEST_ASSERT_EQUAL(POSE_STREAM_GOOD, pose_input_stream(&in).state);
    }
}

/* The same rules the plain way: a set of all seqs received, and a 32-bit seq that never wraps. */
static void test_sequence_against_a_plain_reference(void)
{
    enum { SENT_N = 70000 };
    static bool came[SENT_N / 4];
    uint32_t seed = 3;
    for (int round = 0; round < 3; round++) {
        pose_input in = started(POSE_PREDICT, 0);
        memset(came, 0, sizeof came);
        const int sent_n = SENT_N / 4, first = 65536 - 9000 * round;
        int newest = -1, first_came = -1, duplicate = 0, late = 0, fresh = 0, early = 0;
        for (int sent = 0; sent < sent_n; sent++) {
            /* now and then lost; or sent again, or held back, by up to 31 */
            int n = sent;
            const int dice = random_below(&seed, 20);
            n -= dice == 0 || dice == 1 ? random_below(&seed, 32) : 0;
            if (n < 0 || dice == 2 || dice == 3) {
                continue;
            }
            const uint32_t t_us = 1000u * (uint32_t)sent;
            const pose_verdict verdict = receive(&in, t_us, (uint16_t)(first + n), origin);
            if (n < first_came) { /* from before the first: nobody missed it */
                TEST_ASSERT_EQUAL(POSE_LATE, verdict);
                early++;
                continue;
            }
            if (n <= newest) {
                TEST_ASSERT_EQUAL(came[n] ? POSE_DUPLICATE : POSE_LATE, verdict);
                duplicate += came[n] ? 1 : 0;
                late += came[n] ? 0 : 1;
            } else {
                TEST_ASSERT_EQUAL(POSE_ACCEPTED, verdict);
                fresh++;
                newest = n;
                first_came = first_came < 0 ? n : first_came;
            }
            came[n] = true;
        }
        int missing = 0;
        for (int n = first_came; n <= newest; n++) {
            missing += came[n] ? 0 : 1;
        }
        TEST_ASSERT_EQUAL_UINT32((uint32_t)fresh, in.count[POSE_ACCEPTED]);
        TEST_ASSERT_EQUAL_UINT32((uint32_t)duplicate, in.count[POSE_DUPLICATE]);
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(late + early), in.count[POSE_LATE]);
        TEST_ASSERT_EQUAL_UINT32(in.received, counted(&in));
        TEST_ASSERT_EQUAL_UINT32((uint32_t)missing, in.sequence.lost);
        TEST_ASSERT_EQUAL_INT(newest + 1 - first_came, fresh + late + missing);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_silence_restarts_and_never_aliases);
    RUN_TEST(test_good_is_counted_from_the_last_gap);
    RUN_TEST(test_a_source_too_slow_for_the_timeout_is_named_at_once);
    RUN_TEST(test_sequence_against_a_plain_reference);
    return UNITY_END();
}
