/* test_pendulum.c - the elastic rod without springs: pendulums of one link and of two, and a hanging chain. */
#include "beam_fixture.h"

void setUp(void) {}

void tearDown(void) {}

static const double G = 9.81;

/* A clamp that points down: upside down about x, so the base's x is the world's. */
static const rod_pose DOWN = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f, 0.0f}};

/* Point masses alike, or the beam's (half a mass at the tip). */
static rod_params chain_params(int links_n, double length_m, bool last_is_half, double rate_hz)
{
    const beam b = {links_n, length_m, 0.0, 0.1, G, 0.0, rate_hz};
    rod_params params = beam_params(&b);
    if (!last_is_half) {
        params.mass_kg[links_n - 1] *= 2.0f;
    }
    return params;
}

static void expect_swing(const rod_params *params, int mode, double omega, double share)
{
    beam_mode modes[3];
    beam_modes(params, G, mode + 1, modes);
    TEST_ASSERT_DOUBLE_WITHIN(share, 1.0, modes[mode].omega / omega);
    const ringing measured = beam_ring(params, &modes[mode], DOWN, 3e-4, 10.0);
    const ringing expected = bdf2_of((ringing){modes[mode].omega, 0.0}, beam_step_rate_hz(params));
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 1.0, measured.omega / expected.omega);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, expected.decay, measured.decay);
}

static void one_link_swings_at_the_root_of_g_by_l(void)
{
    static const double length_m[] = {0.05, 0.3, 2.0};
    for (int i = 0; i < 3; i++) {
        const rod_params params = chain_params(1, length_m[i], false, 1000.0);
        expect_swing(&params, 0, sqrt(G / length_m[i]), 1e-6);
    }
}

/* omega^2 = (2 -+ sqrt 2) g / l */
static void two_links_swing_at_both_frequencies(void)
{
    const rod_params params = chain_params(2, 0.6, false, 1000.0);
    for (int mode = 0; mode < 2; mode++) {
        expect_swing(&params, mode, sqrt((2.0 + (mode == 0 ? -1.0 : 1.0) * sqrt(2.0)) * G / 0.3),
                     1e-6);
    }
}

/* Half the zeros of Bessel's J0 times sqrt(g / L). */
static void hanging_chain_swings_as_bessel_says(void)
{
    static const double half_zero[] = {1.20241278, 2.76003905, 4.32686398};
    const rod_params params = chain_params(50, 1.0, true, 1000.0);
    for (int mode = 0; mode < 3; mode++) {
        expect_swing(&params, mode, half_zero[mode] * sqrt(G), 0.007);
    }
}

/* Let go at rest from 90 degrees, a pendulum's period is 1.18034 times that of small swings: from the
 * arithmetic-geometric mean of 1 and cos 45 degrees. Ten swings at 1 kHz, between passages downwards. */
static void large_swings_take_longer_by_the_elliptic_integral(void)
{
    const double length_m = 0.5;
    const rod_params params = chain_params(1, length_m, false, 1000.0);
    const rod_pose level = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.70710678f, 0.0f, 0.70710678f}};
    double a = 1.0, b = sqrt(0.5);
    for (int i = 0; i < 6; i++) {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    const double period_s = 2.0 * PI * sqrt(length_m / G) / a;
    rod *r = beam_start(&params, level);
    double first_s = 0.0, last_s = 0.0, before_m = length_m, largest_m = 0.0;
    int passages_n = 0;
    for (int n = 1; passages_n < 11; n++) {
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &level));
        const double x_m = (double)beam_tip(r).x;
        largest_m = fmax(largest_m, -x_m);
        if (before_m > 0.0 && x_m <= 0.0) {
            last_s = (n - x_m / (x_m - before_m)) * 1e-3;
            first_s = passages_n++ == 0 ? last_s : first_s;
        }
        before_m = x_m;
    }
    TEST_ASSERT_DOUBLE_WITHIN(2e-4, period_s, (last_s - first_s) / 10.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0, largest_m / length_m);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_link_swings_at_the_root_of_g_by_l);
    RUN_TEST(two_links_swing_at_both_frequencies);
    RUN_TEST(hanging_chain_swings_as_bessel_says);
    RUN_TEST(large_swings_take_longer_by_the_elliptic_integral);
    return UNITY_END();
}
