/* test_resample.c - from samples to ticks, as MODEL.md's "Replay" says, and what a rod makes of gaps. */
#include <math.h>

#include "angle_hash.h"
#include "file_fixture.h"
#include "replay.h"

enum { SAMPLES_MAX = 64 };

static track_sample samples[SAMPLES_MAX];
static track source;

void setUp(void)
{
    memset(samples, 0, sizeof samples);
    source = (track){.samples = samples};
    forget_complaints();
}

void tearDown(void) {}

/* A sample turned about x; the position tells which one it is. */
static void add(double t_s, double x_m, double turn_rad)
{
    track_sample *s = &samples[source.samples_n++];
    *s = (track_sample){
        t_s, {x_m, 2.0 * x_m, -x_m}, {sin(turn_rad / 2), 0, 0, cos(turn_rad / 2)}, 1};
}

static track_tick tick_at(double rate_hz, long n)
{
    track_tick tick = {0};
    track_ticks ticks = track_ticks_start(&source, rate_hz);
    for (long i = 0; i <= n; i++) {
        TEST_ASSERT_TRUE(track_ticks_next(&ticks, &tick));
    }
    return tick;
}

/* Poses are told from the origin; q and -q are the same attitude. */
static void expect_pose(const double position_m[3], const double q[4], const rod_pose *pose)
{
    const vec3 p = pose->position_m;
    quat o = pose->orientation;
    if ((double)o.x * q[0] + (double)o.y * q[1] + (double)o.z * q[2] + (double)o.w * q[3] < 0.0) {
        o = (quat){-o.x, -o.y, -o.z, -o.w};
    }
    const float got[7] = {p.x, p.y, p.z, o.x, o.y, o.z, o.w};
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_FLOAT_WITHIN(
            1e-7f, (float)(i < 3 ? position_m[i] - source.origin_m[i] : q[i - 3]), got[i]);
    }
}

static void expect_sample(size_t i, const rod_pose *pose)
{
    expect_pose(samples[i].position_m, samples[i].orientation, pose);
}

/* As a file has it. */
static double decimal(double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.3f", value);
    return strtod(text, NULL);
}

static void test_number_of_ticks(void)
{
    static const struct {
        double duration_s, rate_hz, ticks;
    } CASES[] = {
        {0.1, 100, 11},          {0.57, 100, 58}, /* 0.57 * 100 is below 57 in binary */
        {0.29, 100, 30},         {2.38, 1000, 2381},      {6.28, 1000, 6281},
        {0.05, 10, 1},           {0.0999999, 10, 1},      {0.1, 10, 2},
        {1.0 - 1e-12, 100, 101}, {1.0 - 1e-10, 100, 100}, {3600, 20000, 72000001},
        {1e-9, 20000, 1},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        source.samples_n = 0;
        add(0.0, 0.0, 0.0);
        add(CASES[i].duration_s, 0.0, 0.0);
        TEST_ASSERT_EQUAL_DOUBLE(CASES[i].ticks, track_ticks_count(&source, CASES[i].rate_hz));
    }
    for (int rate_hz = 10; rate_hz <= 2000; rate_hz++) { /* and one asks for as many as there are */
        samples[1].t_s = 0.41;
        track_ticks ticks = track_ticks_start(&source, rate_hz);
        track_tick tick;
        long n = 0;
        while (track_ticks_next(&ticks, &tick)) {
            n++;
        }
        TEST_ASSERT_EQUAL_INT((41 * rate_hz) / 100 + 1, n);
        TEST_ASSERT_FALSE(track_ticks_next(&ticks, &tick));
    }
}

static void test_positions_linear_attitudes_the_shorter_way(void)
{
    static const double TURNS[] = {0.3, 1.5707963, 3.0, -2.0, 3.4, 6.0}; /* over pi: q to -q */
    for (size_t i = 0; i < sizeof TURNS / sizeof *TURNS; i++) {
        source = (track){.samples = samples, .origin_m = {1.0, -4e6, 0.0}};
        add(7.0, 1.0, 0.0);
        add(7.2, -2.0, TURNS[i]);
        for (long n = 0; n <= 40; n++) {
            const double u = (double)n / 40.0, *far = samples[1].orientation;
            const double side = far[3] < 0.0 ? -1.0 : 1.0;
            double q[4] = {u * side * far[0], 0.0, 0.0, 1.0 - u + u * side * far[3]};
            const double norm = hypot(q[0], q[3]);
            q[0] /= norm;
            q[3] /= norm;
            const double place[3] = {1.0 - 3.0 * u, 2.0 - 6.0 * u, -1.0 + 3.0 * u};
            const track_tick tick = tick_at(200.0, n);
            expect_pose(place, q, &tick.base);
            TEST_ASSERT_EQUAL(n == 0, tick.restart);
        }
    }
}

static void test_on_a_sample_the_pose_is_the_samples(void)
{
    for (int i = 0; i < 50; i++) {
        add(decimal(17.003 + 0.01 * i), 0.1 * i * i, 0.05 * i);
    }
    for (long n = 0; n < 50; n++) {
        const track_tick tick = tick_at(100.0, n);
        expect_sample((size_t)n, &tick.base);
    }
}

static void test_held_over_gaps_longer_than_a_quarter_second(void)
{
    static const struct {
        double gap_s;
        bool held;
    } CASES[] = {{0.2499, false}, {0.25, false}, {0.2501, true}, {0.5, true}, {100.0, true}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const double far_s = 0.5 + CASES[i].gap_s;
        source.samples_n = 0;
        add(0.4, 0.0, 0.0);
        add(0.5, 1.0, 0.5);
        add(far_s, 2.0, 0.5);
        add(far_s + 0.1, 3.0, 0.5);
        track_ticks ticks = track_ticks_start(&source, 1000.0);
        track_tick tick;
        int restarts = 0;
        for (long n = 0; track_ticks_next(&ticks, &tick); n++) {
            const double t_s = 0.4 + (double)n / 1000.0;
            const bool inside = t_s > 0.5 + 1e-9 && t_s < far_s - 1e-9;
            if (CASES[i].held && inside) {
                expect_sample(1, &tick.base);
            } else if (inside) {
                TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)(1.0 + (t_s - 0.5) / CASES[i].gap_s),
                                         tick.base.position_m.x);
            } else if (t_s > far_s) {
                TEST_ASSERT_TRUE(tick.base.position_m.x >= 2.0f);
            }
            if (n > 0 && tick.restart) {
                restarts++; /* at the first tick that is not before the far sample */
                TEST_ASSERT_TRUE(t_s > far_s - 1e-9 && t_s < far_s + 1e-3 - 1e-9);
            }
        }
        TEST_ASSERT_EQUAL_INT(CASES[i].held, restarts);
    }
}

/* A far sample exactly on a tick is that tick's, although in binary t0 + n / rate may be a rounding
 * before it. */
static void test_restart_on_a_far_sample_that_is_on_a_tick(void)
{
    static const double RATES_HZ[] = {10, 40, 100, 125, 200, 500, 1000};
    for (size_t r = 0; r < sizeof RATES_HZ / sizeof *RATES_HZ; r++) {
        for (int start = 0; start < 400; start++) {
            const double rate_hz = RATES_HZ[r], start_s = decimal(0.1 + 1.337 * start);
            const long far_n = (long)rate_hz * 3 / 10 + 1 + start % 50;
            source.samples_n = 0;
            add(start_s, 0.0, 0.0);
            add(decimal(start_s + (double)far_n / rate_hz), 1.0, 0.5);
            track_ticks ticks = track_ticks_start(&source, rate_hz);
            track_tick tick;
            char shown[80];
            snprintf(shown, sizeof shown, "%g Hz from %.3f s: tick %ld", rate_hz, start_s, far_n);
            for (long n = 0; n <= far_n; n++) {
                TEST_ASSERT_TRUE_MESSAGE(track_ticks_next(&ticks, &tick), shown);
                TEST_ASSERT_EQUAL_MESSAGE(n == 0 || n == far_n, tick.restart, shown);
                expect_sample(n == far_n, &tick.base);
            }
        }
    }
}

static void test_several_gaps_between_two_ticks_restart_once(void)
{
    for (int i = 0; i < 8; i++) {
        add(0.3 * i, i, 0.0);
    }
    const double rate_hz = 1.0 / 0.9;
    for (long n = 0; n < 3; n++) {
        const track_tick tick = tick_at(rate_hz, n);
        TEST_ASSERT_TRUE(tick.restart);
        expect_sample((size_t)(3 * n), &tick.base);
    }
}

static replay run(double rate_hz)
{
    rod_params params;
    replay r;
    rod_params_defaults(&params);
    params.tick_s = (float)(1.0 / rate_hz);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, replay_run(&source, &params, rate_hz, NULL, &r),
                                  complaint);
    return r;
}

static bool is_straight(const replay *r, long n)
{
    float most = 0.0f;
    for (int i = 0; i < 2 * r->params.links_n; i++) {
        most = fmaxf(most, fabsf(replay_angles(r, n)[i]));
    }
    return !(most > 0.0f);
}

/* Times in 1/256 s, so that they are exact: after the gap all is as if the track began there. */
static void test_a_rod_restarts_straight_and_at_rest(void)
{
    for (int i = 0; i < 60; i++) {
        add((i < 30 ? i : i + 70) / 256.0, 0.02 * sin(0.4 * i), 0.3 * sin(0.3 * i));
    }
    replay whole = run(128.0);
    TEST_ASSERT_EQUAL_INT(65, whole.ticks_n);
    TEST_ASSERT_EQUAL_INT(1, whole.restarts);
    for (long n = 0; n < whole.ticks_n; n++) {
        TEST_ASSERT_EQUAL(n == 0 || n == 50, is_straight(&whole, n)); /* sample 30 is tick 50 */
        TEST_ASSERT_EQUAL(n == 0 || n == 50, whole.ticks[n].restart);
    }
    memmove(samples, samples + 30, 30 * sizeof *samples);
    source.samples_n = 30;
    replay rest = run(128.0);
    TEST_ASSERT_EQUAL_INT(15, rest.ticks_n);
    TEST_ASSERT_EQUAL_MEMORY(replay_angles(&rest, 0), replay_angles(&whole, 50),
                             15 * 8 * sizeof(float));
    replay_free(&whole);
    replay_free(&rest);
}

static void test_one_sample_is_one_straight_row(void)
{
    add(5.0, 1.0, 0.5);
    for (double rate_hz = 10.0; rate_hz <= 20000.0; rate_hz *= 10.0) {
        replay r = run(rate_hz);
        static const float ZEROS[8];
        TEST_ASSERT_EQUAL_INT(1, r.ticks_n);
        TEST_ASSERT_TRUE(is_straight(&r, 0));
        TEST_ASSERT_EQUAL_HEX64(angle_hash_add(ANGLE_HASH_START, ZEROS, 8), r.hash);
        expect_sample(0, &r.ticks[0].base);
        replay_free(&r);
    }
}

static void test_two_samples_at_very_low_and_very_high_rates(void)
{
    add(5.0, 0.0, 0.0);
    add(5.2, 0.1, 0.2);
    static const long RATES_HZ[] = {10, 1000, 20000};
    for (int i = 0; i < 3; i++) {
        replay r = run((double)RATES_HZ[i]);
        TEST_ASSERT_EQUAL_INT(RATES_HZ[i] / 5 + 1, r.ticks_n);
        TEST_ASSERT_FALSE(is_straight(&r, 1));
        expect_sample(0, &r.ticks[0].base);
        expect_sample(1, &r.ticks[r.ticks_n - 1].base);
        replay_free(&r);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_number_of_ticks);
    RUN_TEST(test_positions_linear_attitudes_the_shorter_way);
    RUN_TEST(test_on_a_sample_the_pose_is_the_samples);
    RUN_TEST(test_held_over_gaps_longer_than_a_quarter_second);
    RUN_TEST(test_restart_on_a_far_sample_that_is_on_a_tick);
    RUN_TEST(test_several_gaps_between_two_ticks_restart_once);
    RUN_TEST(test_a_rod_restarts_straight_and_at_rest);
    RUN_TEST(test_one_sample_is_one_straight_row);
    RUN_TEST(test_two_samples_at_very_low_and_very_high_rates);
    return UNITY_END();
}
