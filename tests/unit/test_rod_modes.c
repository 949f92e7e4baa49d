/* test_rod_modes.c - the first natural frequency of elastic rods, and the tick that resolves it. */
#include "rod_params.h"
#include "test_support.h"
#include "unity.h"

static rod_params params;

void setUp(void) {}
void tearDown(void) {}

/* An elastic rod whose lists run geometrically: x[i] = first * ratio^i. */
static void lay_geometric(int links_n, const double first[3], const double ratio[3])
{
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.links_n = links_n;
    for (int i = 0; i < links_n; i++) {
        params.length_m[i] = (float)(first[0] * pow(ratio[0], i));
        params.spring[i] = (float)(first[1] * pow(ratio[1], i));
        params.mass_kg[i] = (float)(first[2] * pow(ratio[2], i));
    }
}

static void expect_first_mode(double wanted_hz)
{
    const double got_hz = (double)rod_params_first_mode_hz(&params);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5 * wanted_hz, wanted_hz, got_hz);
    /* six ticks a period, to what 2 pi is more */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * got_hz, 2.0 * PI * got_hz,
                              (double)rod_params_resolving_rate_hz(&params));
}

/* Against the least eigenvalue of M^-1/2 D' K D M^-1/2, D the curvatures of MODEL.md, Section 5, by numpy in float64. */
static void test_first_mode_is_that_of_the_matrices(void)
{
    static const struct {
        int links_n;
        double first[3], ratio[3], wanted_hz; /* length, spring, mass */
    } RODS[] = {
        {1, {0.06, 10.0, 0.02}, {1, 1, 1}, 59.31354528}, /* sqrt(k / m) / 2 pi l */
        {10, {0.06, 10.0, 0.02}, {1, 1, 1}, 1.73110049},
        {64, {0.01, 100.0, 0.001}, {1, 1, 1}, 4.1888874},
        {20, {0.1, 50.0, 0.05}, {0.95, 0.8, 0.9}, 0.87786774},
        {64, {1e-3, 1e6, 1e-6}, {1, 1, 1}, 132464.2504}, /* where the bounds are */
        {64, {10.0, 1e-3, 1e3}, {1, 1, 1}, 1.32464251e-8},
    };
    for (size_t i = 0; i < sizeof RODS / sizeof *RODS; i++) {
        lay_geometric(RODS[i].links_n, RODS[i].first, RODS[i].ratio);
        expect_first_mode(RODS[i].wanted_hz);
    }
    lay_geometric(6, (double[]){0.1, 100.0, 0.01}, (double[]){1, 1, 1});
    params.spring[2] = 0.5f; /* soft in the middle, heavy at the tip */
    params.mass_kg[5] = 1.0f;
    expect_first_mode(0.27689484);
    params.spring[2] = 100.0f;
    params.mass_kg[5] = 0.01f;
    params.mass_kg[0] = 1.0f;
    expect_first_mode(10.08014199);
}

static void test_first_mode_where_there_is_none(void)
{
    lay_geometric(4, (double[]){0.1, 100.0, 0.01}, (double[]){1, 1, 1});
    params.spring[2] = 0.0f; /* a hinge */
    TEST_ASSERT_EQUAL_FLOAT(0.0f, rod_params_first_mode_hz(&params));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, rod_params_resolving_rate_hz(&params));
    params.spring[2] = 1e-42f;
    TEST_ASSERT_TRUE(rod_params_first_mode_hz(&params) >= 0.0f); /* whatever it is, a number */
    params.spring[2] = 100.0f;
    params.model = ROD_MODEL_CONTOUR;
    TEST_ASSERT_EQUAL_FLOAT(0.0f, rod_params_first_mode_hz(&params));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_first_mode_is_that_of_the_matrices);
    RUN_TEST(test_first_mode_where_there_is_none);
    return UNITY_END();
}
