/* test_pose_resample.c - the base between poses: where it is, how smoothly it moves, where it stops. */
#include <stdio.h>

#include "pose_fixture.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { TICK_US = 1000, INTERVAL_US = 8000, AGE_US = 2000 };

/* A screw: straight on and round an axis, both even. */
static rod_pose screw(double t_s, double mps, double radps)
{
    rod_pose pose = {{(float)(mps * t_s), (float)(0.5 * mps * t_s), 0.25f},
                     quat_about((vec3){1.0f, -2.0f, 0.5f}, radps * t_s)};
    return pose;
}

/* A hand that shakes: 0.1 m and 0.5 rad, 2 Hz. */
static rod_pose shaken(double t_s)
{
    const double phase = 2.0 * PI * 2.0 * t_s;
    return (rod_pose){{(float)(0.1 * sin(phase)), (float)(0.03 * cos(phase)), 0.0f},
                      quat_about((vec3){0.0f, 1.0f, 0.3f}, 0.5 * cos(phase))};
}

static void send(pose_input *in, uint32_t captured_us, uint16_t seq, rod_pose pose)
{
    pose_sample sample = sample_at(captured_us + AGE_US, seq, pose);
    sample.age_us = AGE_US;
    TEST_ASSERT_EQUAL(POSE_ACCEPTED, pose_input_receive(in, &sample, captured_us + AGE_US));
}

static double off_m(const rod_pose *a, const rod_pose *b)
{
    return length_double(vec3_sub(a->position_m, b->position_m));
}

static void check_even_motion(pose_mode mode, uint32_t start_us, double late_s)
{
    pose_input in = started(mode, start_us);
    sync_clocks(&in, start_us);
    uint16_t seq = 65530;
    uint32_t next_us = 0;
    for (uint32_t t_us = 0; t_us < 600000; t_us += TICK_US) {
        for (; next_us + AGE_US <= t_us; next_us += INTERVAL_US) {
            send(&in, start_us + next_us, seq++, screw(1e-6 * (double)next_us, 3.0, 20.0));
        }
        const pose_tick tick = pose_input_tick(&in, start_us + t_us);
        if (t_us < 100000) {
            continue;
        }
        const rod_pose truth = screw(1e-6 * (double)t_us - late_s, 3.0, 20.0);
        TEST_ASSERT_DOUBLE_WITHIN(2e-6, 0.0, off_m(&tick.base, &truth));
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.0f, pose_angle(tick.base.orientation, truth.orientation));
    }
}

static void test_even_motion_is_predicted_exactly(void)
{
    check_even_motion(POSE_PREDICT, 0, 0.0);
    check_even_motion(POSE_PREDICT, UINT32_MAX - 300000u, 0.0);
}

static void test_interpolating_is_late_by_one_interval_and_the_age(void)
{
    check_even_motion(POSE_INTERPOLATE, 0, 1e-6 * (INTERVAL_US + AGE_US));
    check_even_motion(POSE_INTERPOLATE, UINT32_MAX - 300000u, 1e-6 * (INTERVAL_US + AGE_US));
}

/* The source falls silent in full motion: even slowing, a stop at the cap, no way back. */
static void check_silence(uint32_t interval_us, double cap_s)
{
    pose_input in = started(POSE_PREDICT, 0);
    uint16_t seq = 0;
    uint32_t t_us = 0, last_us = 0;
    for (uint32_t next_us = 0; t_us < 400000; t_us += TICK_US) {
        for (; next_us + AGE_US <= t_us; next_us += interval_us) {
            send(&in, next_us, seq++, screw(1e-6 * (double)next_us, 3.0, 20.0));
            last_us = next_us;
        }
        pose_input_tick(&in, t_us);
    }
    rod_pose before = pose_input_tick(&in, t_us).base;
    double speed_before = 1e9;
    for (int i = 0; i < 200; i++) {
        t_us += TICK_US;
        const rod_pose now = pose_input_tick(&in, t_us).base;
        const double speed = 1e3 * off_m(&now, &before);
        TEST_ASSERT_TRUE((double)now.position_m.x >= (double)before.position_m.x - 1e-6);
        TEST_ASSERT_TRUE(speed <= speed_before + 1e-2);
        before = now;
        speed_before = speed;
    }
    const rod_pose end = screw(1e-6 * (double)last_us + cap_s, 3.0, 20.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, off_m(&before, &end));
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, 0.0f, pose_angle(before.orientation, end.orientation));
}

static void test_a_silent_source_leaves_the_base_at_the_cap(void)
{
    check_silence(8000, 0.002 + 1.5 * 0.008);
    check_silence(4000, 0.002 + 1.5 * 0.004);
    check_silence(25000, 0.020); /* the horizon */
}

/* A hand that stops, while poses go on, at the worst moment: how far does the base pass it? */
static void test_a_hand_that_stops_is_passed_by_little_and_found_again(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    uint16_t seq = 0;
    double furthest_m = 0.0;
    const double stop_s = 0.4;
    for (uint32_t t_us = 0, next_us = 0; t_us < 600000; t_us += TICK_US) {
        for (; next_us + AGE_US <= t_us; next_us += INTERVAL_US) {
            send(&in, next_us, seq++, screw(fmin(1e-6 * (double)next_us, stop_s), 3.0, 0.0));
        }
        const rod_pose base = pose_input_tick(&in, t_us).base;
        furthest_m = fmax(furthest_m, (double)base.position_m.x - 3.0 * stop_s);
        if (t_us > 440000) {
            const rod_pose there = screw(stop_s, 3.0, 0.0);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, off_m(&base, &there));
        }
    }
    /* 3 m/s for as long as nobody could know: one interval and the age; and half of that for the turn */
    TEST_ASSERT_TRUE(furthest_m < 3.0 * 1.5 * 0.010);
    TEST_ASSERT_TRUE(furthest_m > 3.0 * 0.5 * 0.010);
}

typedef struct {
    double error_mm, acceleration_mps2;
} figures;

/* RMS over a shaken hand with a tracker's noise, poses every 8 ms. */
static figures shake(pose_mode mode, double noise_m, double late_s)
{
    pose_input in = started(mode, 0);
    uint32_t seed = 11;
    uint16_t seq = 0;
    vec3 last[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    figures sum = {0.0, 0.0};
    int n = 0;
    for (uint32_t t_us = 0, next_us = 0; t_us < 2000000; t_us += TICK_US) {
        for (; next_us + AGE_US <= t_us; next_us += INTERVAL_US) {
            rod_pose pose = shaken(1e-6 * (double)next_us);
            pose.position_m = vec3_add(pose.position_m, random_vec3(&seed, noise_m));
            send(&in, next_us, seq++, pose);
        }
        const rod_pose base = pose_input_tick(&in, t_us).base;
        if (t_us > 100000) {
            const rod_pose truth = shaken(1e-6 * (double)t_us - late_s);
            const vec3 step = vec3_sub(base.position_m, last[0]);
            const vec3 step_before = vec3_sub(last[0], last[1]);
            const double acceleration = 1e6 * length_double(vec3_sub(step, step_before));
            sum.error_mm += 1e6 * off_m(&base, &truth) * off_m(&base, &truth);
            sum.acceleration_mps2 += acceleration * acceleration;
            n++;
        }
        last[1] = last[0];
        last[0] = base.position_m;
    }
    return (figures){sqrt(sum.error_mm / n), sqrt(sum.acceleration_mps2 / n)};
}

static void expect_between(double low, double high, double value)
{
    char text[80];
    snprintf(text, sizeof text, "%g is not in %g ... %g", value, low, high);
    TEST_ASSERT_TRUE_MESSAGE(low <= value && value <= high, text);
}

/* Held, the newest pose would be off by 5.3 mm and have 3550 m/s2; the hand itself has 11. */
static void test_error_and_jitter_of_both_modes(void)
{
    const double late_s = 1e-6 * (INTERVAL_US + AGE_US);
    const figures predict = shake(POSE_PREDICT, 0.0, 0.0);
    const figures interpolate = shake(POSE_INTERPOLATE, 0.0, late_s);
    const figures predict_noise = shake(POSE_PREDICT, 2e-4, 0.0);
    const figures interpolate_noise = shake(POSE_INTERPOLATE, 2e-4, late_s);
    expect_between(1.2, 1.45, predict.error_mm);
    expect_between(64.0, 78.0, predict.acceleration_mps2);
    expect_between(0.04, 0.051, interpolate.error_mm);
    expect_between(15.5, 18.5, interpolate.acceleration_mps2);
    expect_between(1.2, 1.5, predict_noise.error_mm);
    expect_between(67.0, 83.0, predict_noise.acceleration_mps2);
    expect_between(0.155, 0.19, interpolate_noise.error_mm);
    expect_between(19.0, 23.0, interpolate_noise.acceleration_mps2);
}

/* A correction takes the velocity along: no tick's step differs from the one before by a jump. */
static void test_a_late_correction_is_blended(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    uint16_t seq = 0;
    vec3 last[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (uint32_t t_us = 0, next_us = 0; t_us < 300000; t_us += TICK_US) {
        for (; next_us + AGE_US <= t_us; next_us += INTERVAL_US) {
            seq++;
            if (next_us < 100000 || next_us > 180000) { /* then 80 ms of nothing */
                send(&in, next_us, seq, screw(1e-6 * (double)next_us, 1.0, 0.0));
            }
        }
        const vec3 now = pose_input_tick(&in, t_us).base.position_m;
        if (t_us > 30000) {
            const double speed = 1e3 * length_double(vec3_sub(now, last[0]));
            const vec3 bend = vec3_sub(vec3_sub(now, last[0]), vec3_sub(last[0], last[1]));
            TEST_ASSERT_TRUE(speed < 3.0);
            TEST_ASSERT_TRUE(1e6 * length_double(bend) < 250.0);
        }
        last[1] = last[0];
        last[0] = now;
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_even_motion_is_predicted_exactly);
    RUN_TEST(test_interpolating_is_late_by_one_interval_and_the_age);
    RUN_TEST(test_a_silent_source_leaves_the_base_at_the_cap);
    RUN_TEST(test_a_hand_that_stops_is_passed_by_little_and_found_again);
    RUN_TEST(test_error_and_jitter_of_both_modes);
    RUN_TEST(test_a_late_correction_is_blended);
    return UNITY_END();
}
