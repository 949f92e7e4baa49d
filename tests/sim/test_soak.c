/* test_soak.c - hours on the virtual clock with a thousandth of all bytes spoiled, and worse now and then.
 *
 *     test_soak [HOURS]     simulated, 0.1 by default
 */
#include "device_fixture.h"

static double hours = 0.1;

void setUp(void)
{
    bench_new(8);
}

void tearDown(void)
{
    free(b);
}

/* Once a minute the line stands still, long enough for HOLD, now and then for LIMP. */
static bool is_silent(uint32_t ms)
{
    const uint32_t in_minute = ms % 60000u;
    const uint32_t length = (ms / 60000u) % 10u == 9u ? 7000u : 200u;
    return in_minute >= 30000u && in_minute < 30000u + length;
}

static void stay_armed(uint32_t ms)
{
    const int state = state_now();
    if (ms % 500u != 0 || is_silent(ms)) {
        return;
    }
    if (state == SUPERVISOR_DISARMED || state == SUPERVISOR_LIMP) {
        ask_simply(MESSAGE_ARM);
    }
}

static void test_hours_of_noise_end_active_with_everything_counted(void)
{
    const uint32_t ticks_n = (uint32_t)(hours * 3600.0 * 1000.0);
    b->host.injection.faults[0] =
        (injected_fault){.kind = INJECT_NOISE, .duration_s = 1e9, .amount = 0.001};
    b->host.injection.faults_n = 1;
    while (b->seen_n[MESSAGE_HELLO] == 0 || b->newest[MESSAGE_HELLO].hello.request_id == 0) {
        say_hello(100.0f);
    }
    uint32_t poses_n = 0, active_n = 0;
    for (uint32_t ms = 0; ms < ticks_n; ms++) {
        if (ms % 10u == 0 && !is_silent(ms)) {
            const trig_pair t = trig_sincos(0.003f * (float)(ms % 2094396u)); /* whole turns */
            pose_at(0.1f * t.sin);
            poses_n++;
        }
        stay_armed(ms);
        tick();
        active_n += state_now() == SUPERVISOR_ACTIVE;
        TEST_ASSERT_TRUE(state_now() != SUPERVISOR_FAULT && state_now() != SUPERVISOR_ESTOP);
    }
    const pose_input *in = &b->host.device.poses;
    uint32_t counted = in->sequence.lost;
    for (int i = 0; i < POSE_VERDICTS_N; i++) {
        counted += in->count[i];
    }
    const frame_counts *frames = &b->host.device.link.decoder.counts;
    printf("%.2f hours: %u poses, %u accepted, %u lost, %u holds, %.1f %% of the time ACTIVE; "
           "frames: %u good, %u "
           "crc, %u cobs, %u short, %u long\n",
           hours, poses_n, in->count[POSE_ACCEPTED], in->sequence.lost, b->host.device.holds,
           100.0 * active_n / ticks_n, frames->good, frames->crc, frames->cobs, frames->too_short,
           frames->too_long);
    /* what was spoiled before the first pose came through, or after the last, leaves no gap to count */
    TEST_ASSERT_UINT32_WITHIN(4, poses_n, counted);
    TEST_ASSERT_TRUE(in->count[POSE_ACCEPTED] > poses_n / 10u * 9u);
    TEST_ASSERT_TRUE(frames->crc + frames->cobs > poses_n / 50u);
    TEST_ASSERT_EQUAL_UINT32(0, in->count[POSE_NOT_FINITE] + in->count[POSE_BAD_QUATERNION] +
                                    in->count[POSE_TELEPORT] + in->count[POSE_TOO_FAST]);
    TEST_ASSERT_EQUAL_UINT32(0, b->host.device.deadline_misses);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
}

int main(int argc, char **argv)
{
    hours = argc > 1 ? atof(argv[1]) : hours;
    UNITY_BEGIN();
    RUN_TEST(test_hours_of_noise_end_active_with_everything_counted);
    return UNITY_END();
}
