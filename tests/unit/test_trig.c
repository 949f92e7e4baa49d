/* test_trig.c - how wrong the core's trigonometry is, measured against long double.
 *
 * As it comes it samples; with the argument "exhaustive" it takes every float of the ranges of sincos
 * and asin, which takes minutes. Either way it prints what it found and holds trig.h's figures to it,
 * from both sides: a figure that is exceeded is wrong, and so is one that is far from what happens. */
#include "test_support.h"
#include "trig.h"
#include "unity.h"

#include <float.h>
#include <stdbool.h>
#include <stdio.h>

static bool exhaustive;

void setUp(void) {}
void tearDown(void) {}

/* --- measuring --------------------------------------------------------------------------------- */

typedef struct {
    double absolute, ulps;
    float absolute_at[2], ulps_at[2]; /* the arguments; the second one of atan2 only */
} worst_error;

/* The distance between floats around a value: 2^-23 of its power of two, never under a subnormal. */
static double last_place(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= 0x7ff0000000000000u;
    double power_of_two;
    memcpy(&power_of_two, &bits, sizeof power_of_two);
    return power_of_two > 0x1p-126 ? power_of_two * 0x1p-23 : 0x1p-149;
}

static void record(worst_error *worst, float got, long double wanted, float first, float second)
{
    const double error = fabs((double)((long double)got - wanted));
    const double ulps = error / last_place((double)wanted);
    if (!(error <= worst->absolute)) { /* so that NaN counts */
        worst->absolute = error;
        worst->absolute_at[0] = first;
        worst->absolute_at[1] = second;
    }
    if (!(ulps <= worst->ulps)) {
        worst->ulps = ulps;
        worst->ulps_at[0] = first;
        worst->ulps_at[1] = second;
    }
}

/* The figures of trig.h. A sample comes close to the worst case; 1.3 is for what it
 * misses. No ulps: nothing is stated. */
static void expect_figures(const char *what, const worst_error *worst, double absolute, double ulps)
{
    printf("%-26s worst %.4g at (%.9g, %.9g), %.4g ulp at (%.9g, %.9g)\n", what, worst->absolute,
           (double)worst->absolute_at[0], (double)worst->absolute_at[1], worst->ulps,
           (double)worst->ulps_at[0], (double)worst->ulps_at[1]);
    TEST_ASSERT_TRUE_MESSAGE(worst->absolute <= absolute, what);
    TEST_ASSERT_TRUE_MESSAGE(worst->absolute >= absolute / 1.3, what);
    if (ulps > 0.0) {
        TEST_ASSERT_TRUE_MESSAGE(worst->ulps <= ulps, what);
        TEST_ASSERT_TRUE_MESSAGE(worst->ulps >= ulps / 1.3, what);
    }
}

/* Every how many floats are looked at: odd, so that every bit of the mantissa moves. */
static uint32_t stride(void)
{
    return exhaustive ? 1u : HOST_OR_BOARD(509u, 16411u);
}

static void measure_sincos(worst_error *worst, float from, float to, uint32_t step)
{
    for (uint32_t bits = bits_of(from); bits <= bits_of(to); bits += step) {
        for (uint32_t sign = 0; sign < 2; sign++) {
            const float x = float_of(sign << 31 | bits);
            const trig_pair got = trig_sincos(x);
            record(worst, got.sin, sinl((long double)x), x, 0.0f);
            record(worst, got.cos, cosl((long double)x), x, 0.0f);
        }
    }
}

static void test_sincos_is_as_good_as_stated(void)
{
    worst_error worst = {0.0, 0.0, {0.0f, 0.0f}, {0.0f, 0.0f}};
    measure_sincos(&worst, 0.0f, 0.25f * TRIG_PI, stride());
    expect_figures("sincos |x| <= pi/4", &worst, 5.9e-8, 0.99);
    measure_sincos(&worst, 0.25f * TRIG_PI, TRIG_PI, stride() / 16 | 1);
    expect_figures("sincos |x| <= pi", &worst, 7.8e-8, 1.5);

    /* Near a far zero the last place is tiny, and the error is not: only the absolute one is stated. */
    measure_sincos(&worst, TRIG_PI, 8192.0f, stride() / 4 | 1);
    expect_figures("sincos |x| <= 8192", &worst, 7.9e-8, 0.0);
}

static void measure_asin(worst_error *worst, float from, float to, uint32_t step)
{
    for (uint32_t bits = bits_of(from); bits <= bits_of(to); bits += step) {
        for (uint32_t sign = 0; sign < 2; sign++) {
            const float x = float_of(sign << 31 | bits);
            record(worst, trig_asin(x), asinl((long double)x), x, 0.0f);
        }
    }
}

static void test_asin_is_as_good_as_stated(void)
{
    worst_error worst = {0.0, 0.0, {0.0f, 0.0f}, {0.0f, 0.0f}};
    measure_asin(&worst, 0.0f, 0.5f, stride());
    expect_figures("asin |x| <= 0.5", &worst, 3.51e-8, 0.68);
    measure_asin(&worst, 0.5f, 1.0f, stride() / 16 | 1);
    expect_figures("asin |x| <= 1", &worst, 1.7e-7, 2.5);
}

/* Points by random mantissas, on either side of both diagonals and near the axes, in all quadrants. */
static void test_atan2_is_as_good_as_stated(void)
{
    const long points_n = exhaustive ? 300000000L : HOST_OR_BOARD(1500000L, 100000L);
    worst_error worst = {0.0, 0.0, {0.0f, 0.0f}, {0.0f, 0.0f}};
    uint32_t seed = 2018;
    for (long i = 0; i < points_n; i++) {
        const uint32_t signs = random_bits(&seed);
        const uint32_t exponent = signs % 16 < 10 ? 127 - signs % 4 : 127 - signs % 16;
        const float shorter = float_of(exponent << 23 | random_bits(&seed) >> 9);
        const float longer = float_of(127u << 23 | random_bits(&seed) >> 9);
        const float a = signs & 0x100 ? -shorter : shorter;
        const float b = signs & 0x200 ? -longer : longer;
        const float y = signs & 0x400 ? a : b;
        const float x = signs & 0x400 ? b : a;
        record(&worst, trig_atan2(y, x), atan2l((long double)y, (long double)x), y, x);
    }
    expect_figures("atan2", &worst, 2.7e-7, 3.0);
}

/* --- what has no error at all ------------------------------------------------------------------ */

#define EXPECT_SAME(expected, actual)                                                              \
    TEST_ASSERT_EQUAL_HEX32(bits_of((expected) + 0.0f), bits_of((actual) + 0.0f)) /* -0 is 0 */

static void test_symmetries_are_exact(void)
{
    for (uint32_t bits = 1; bits <= bits_of(8192.0f); bits += 65537u) {
        const float x = float_of(bits);
        const trig_pair positive = trig_sincos(x), negative = trig_sincos(-x);
        EXPECT_SAME(-positive.sin, negative.sin);
        EXPECT_SAME(positive.cos, negative.cos);
        EXPECT_SAME(-trig_asin(x), trig_asin(-x));
        EXPECT_SAME(-trig_atan2(x, 1.0f), trig_atan2(-x, 1.0f));
        EXPECT_SAME(-trig_atan2(x, -1.0f), trig_atan2(-x, -1.0f));
    }
}

static void test_quadrants_of_sincos(void)
{
    const float eighth = 0.25f * TRIG_PI;
    static const int SINE[8] = {1, 1, 1, 1, -1, -1, -1, -1};
    static const int COSINE[8] = {1, 1, -1, -1, -1, -1, 1, 1};
    for (int turn = -3; turn <= 3; turn++) {
        for (int octant = 0; octant < 8; octant++) {
            const trig_pair t = trig_sincos(((float)(8 * turn + octant) + 0.5f) * eighth);
            TEST_ASSERT_TRUE(t.sin * (float)SINE[octant] > 0.3f);
            TEST_ASSERT_TRUE(t.cos * (float)COSINE[octant] > 0.3f);
        }
    }
    EXPECT_SAME(0.0f, trig_sincos(0.0f).sin);
    EXPECT_SAME(1.0f, trig_sincos(0.0f).cos);
    EXPECT_SAME(1.0f, trig_sincos(-0.0f).cos);
    EXPECT_SAME(1.0f, trig_sincos(TRIG_HALF_PI).sin);
    EXPECT_SAME(-1.0f, trig_sincos(TRIG_PI).cos);
}

static void test_axes_of_atan2(void)
{
    static const float ZEROS[2] = {0.0f, -0.0f};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++) {
            EXPECT_SAME(0.0f, trig_atan2(ZEROS[i], ZEROS[k]));
        }
        EXPECT_SAME(0.0f, trig_atan2(ZEROS[i], 3.0f));
        EXPECT_SAME(TRIG_PI, trig_atan2(ZEROS[i], -3.0f)); /* -0 counts as 0: pi, never -pi */
        EXPECT_SAME(TRIG_HALF_PI, trig_atan2(3.0f, ZEROS[i]));
        EXPECT_SAME(-TRIG_HALF_PI, trig_atan2(-3.0f, ZEROS[i]));
    }
    EXPECT_SAME(0.25f * TRIG_PI, trig_atan2(2.0f, 2.0f));
    EXPECT_SAME(-0.75f * TRIG_PI, trig_atan2(-2.0f, -2.0f));
}

/* A power of two changes no mantissa, so it must change no angle: the rod's links may be any size. */
static void test_atan2_sees_no_scale(void)
{
    uint32_t seed = 57;
    for (int i = 0; i < 2000; i++) {
        const float y = (float)random_between(&seed, -2.0, 2.0);
        const float x = (float)random_between(&seed, -2.0, 2.0);
        const uint32_t angle = bits_of(trig_atan2(y, x));
        TEST_ASSERT_EQUAL_HEX32(angle, bits_of(trig_atan2(y * 0x1p+120f, x * 0x1p+120f)));
        TEST_ASSERT_EQUAL_HEX32(angle, bits_of(trig_atan2(y * 0x1p-90f, x * 0x1p-90f)));
    }
}

static void test_asin_clamps(void)
{
    static const float BEYOND[] = {1.0f, 1.0000001f, 1.5f, FLT_MAX, INFINITY};
    for (size_t i = 0; i < sizeof BEYOND / sizeof BEYOND[0]; i++) {
        EXPECT_SAME(TRIG_HALF_PI, trig_asin(BEYOND[i]));
        EXPECT_SAME(-TRIG_HALF_PI, trig_asin(-BEYOND[i]));
    }
}

static void test_not_a_number_stays_one(void)
{
    static const float OTHERS[] = {0.0f, -0.0f, 1.0f, -1.0f, FLT_MAX, NAN};
    TEST_ASSERT_TRUE(isnan(trig_sincos(NAN).sin));
    TEST_ASSERT_TRUE(isnan(trig_sincos(NAN).cos));
    TEST_ASSERT_TRUE(isnan(trig_asin(NAN)));
    TEST_ASSERT_TRUE(isnan(trig_asin(-NAN)));
    for (size_t i = 0; i < sizeof OTHERS / sizeof OTHERS[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(isnan(trig_atan2(NAN, OTHERS[i])), "y");
        TEST_ASSERT_TRUE_MESSAGE(isnan(trig_atan2(OTHERS[i], NAN)), "x");
    }
}

int main(int argc, char **argv)
{
    exhaustive = argc > 1 && strcmp(argv[1], "exhaustive") == 0;
    UNITY_BEGIN();
    RUN_TEST(test_sincos_is_as_good_as_stated);
    RUN_TEST(test_asin_is_as_good_as_stated);
    RUN_TEST(test_atan2_is_as_good_as_stated);
    RUN_TEST(test_symmetries_are_exact);
    RUN_TEST(test_quadrants_of_sincos);
    RUN_TEST(test_axes_of_atan2);
    RUN_TEST(test_atan2_sees_no_scale);
    RUN_TEST(test_asin_clamps);
    RUN_TEST(test_not_a_number_stays_one);
    return UNITY_END();
}
