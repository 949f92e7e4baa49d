/* test_rod_material.c - from a blank to coefficients: bounds, what an elastic chain has of each cell of the rod, and
 * what contour has of the chain. Against beam theory: tests/sim/test_material.c. */
#include "rod.h"
#include "test_support.h"
#include "unity.h"

static rod_params params;

void setUp(void)
{
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
}

void tearDown(void) {}

static const rod_blank TUBE = {.youngs_modulus_pa = 127e9f,
                               .density_kg_m3 = 1500.0f,
                               .diameter_m = {0.012f, 0.003f},
                               .bore = 0.8f,
                               .damping_ratio = 0.02f,
                               .length_m = 1.6f,
                               .drag_n_s_m2 = 0.05f};

/* A steel wire of 6 mm. */
static const rod_blank WIRE = {.youngs_modulus_pa = 206e9f,
                               .density_kg_m3 = 7850.0f,
                               .diameter_m = {0.006f, 0.006f},
                               .damping_ratio = 0.05f,
                               .length_m = 0.9f,
                               .drag_n_s_m2 = 0.03f};

static void fill(const rod_blank *blank, int32_t model, int links_n)
{
    params.model = model;
    params.links_n = links_n;
    rod_blank_fill(blank, &params);
}

static void expect_close(double relative, double wanted, float got)
{
    TEST_ASSERT_DOUBLE_WITHIN(relative * wanted, wanted, (double)got);
}

/* --- the blank --- */

static void test_every_number_of_a_blank_has_bounds(void)
{
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        const rod_blank_field *field = &rod_blank_fields[i];
        for (int end = 0; end < field->values_n; end++) {
            const float allowed[] = {field->min, field->max};
            const float refused[] = {nextafterf(field->min, -1e9f), nextafterf(field->max, 1e30f),
                                     -1e9f, INFINITY, NAN};
            rod_blank blank = TUBE;
            rod_blank_refusal why;
            for (int k = 0; k < 2; k++) {
                rod_blank_set(field, &blank, end, allowed[k]);
                TEST_ASSERT_TRUE_MESSAGE(rod_blank_check(&blank, &why), field->name);
                TEST_ASSERT_EQUAL_HEX32(bits_of(allowed[k]),
                                        bits_of(rod_blank_get(field, &blank, end)));
            }
            for (int k = 0; k < 5; k++) {
                rod_blank_set(field, &blank, end, refused[k]);
                TEST_ASSERT_FALSE_MESSAGE(rod_blank_check(&blank, NULL), field->name);
                TEST_ASSERT_FALSE(rod_blank_check(&blank, &why));
                TEST_ASSERT_EQUAL_PTR(field, why.field);
                TEST_ASSERT_EQUAL_INT(end, why.end);
                TEST_ASSERT_EQUAL_HEX32(bits_of(refused[k]), bits_of(why.value));
            }
        }
    }
}

static void test_fields_are_where_they_say(void)
{
    rod_blank blank = {.youngs_modulus_pa = 1.0f,
                       .density_kg_m3 = 2.0f,
                       .diameter_m = {3.0f, 4.0f},
                       .bore = 5.0f,
                       .damping_ratio = 6.0f,
                       .length_m = 7.0f,
                       .drag_n_s_m2 = 8.0f};
    float wanted = 1.0f;
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        for (int end = 0; end < rod_blank_fields[i].values_n; end++, wanted += 1.0f) {
            TEST_ASSERT_EQUAL_FLOAT(wanted, rod_blank_get(&rod_blank_fields[i], &blank, end));
        }
    }
    TEST_ASSERT_EQUAL_FLOAT(9.0f, wanted);
}

/* --- elastic --- */

static double diameter(const rod_blank *b, double s)
{
    return (double)b->diameter_m[0] +
           ((double)b->diameter_m[1] - (double)b->diameter_m[0]) * s / (double)b->length_m;
}

/* By Simpson's rule, which is exact for a frustum. */
static double frustum_kg(const rod_blank *b, double from, double to)
{
    const double wall = 1.0 - (double)b->bore * (double)b->bore;
    const double area = pow(diameter(b, from), 2) + 4.0 * pow(diameter(b, 0.5 * (from + to)), 2) +
                        pow(diameter(b, to), 2);
    return (double)b->density_kg_m3 * 0.25 * PI * wall * area / 6.0 * (to - from);
}

static void test_each_link_has_its_part_of_the_rod(void)
{
    static const rod_blank *const BLANKS[] = {&TUBE, &WIRE};
    for (int k = 0; k < 2 * ROD_MAX_LINKS; k++) {
        const rod_blank *b = BLANKS[k & 1];
        const int links_n = 1 + k / 2;
        const double length = (double)b->length_m, l = length / links_n;
        fill(b, ROD_MODEL_ELASTIC, links_n);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_params_check(&params, NULL));
        const double omega = 2.0 * PI * (double)rod_params_first_mode_hz(&params);
        for (int i = 0; i < links_n; i++) {
            const double half = i == 0 ? 0.5 : 1.0, end = i + 1 == links_n ? 0.5 : 1.0;
            const double second_moment =
                PI / 64.0 * pow(diameter(b, i * l), 4) * (1.0 - pow((double)b->bore, 4));
            const double spring = (double)b->youngs_modulus_pa * second_moment / (l * half);
            expect_close(1e-6, l, params.length_m[i]);
            expect_close(2e-6, spring, params.spring[i]);
            expect_close(5e-6, frustum_kg(b, (i + 0.5) * l, fmin((i + 1.5) * l, length)),
                         params.mass_kg[i]);
            expect_close(1e-6, (double)b->drag_n_s_m2 * l * end, params.drag[i]);
            expect_close(1e-5, 2.0 * (double)b->damping_ratio * spring / omega, params.damper[i]);
        }
    }
}

/* All of the rod is somewhere: the half link that the hand holds still, and the nodes. */
static void test_no_mass_is_lost(void)
{
    for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
        const double length = (double)TUBE.length_m;
        double sum = frustum_kg(&TUBE, 0.0, 0.5 * length / links_n);
        fill(&TUBE, ROD_MODEL_ELASTIC, links_n);
        for (int i = 0; i < links_n; i++) {
            sum += (double)params.mass_kg[i];
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * sum, frustum_kg(&TUBE, 0.0, length), sum);
    }
}

static void test_what_does_not_follow_from_a_blank_stays(void)
{
    for (int32_t model = 0; model < ROD_MODEL_COUNT; model++) {
        params.tick_s = 0.002f;
        params.gravity_m_s2 = 1.6f;
        params.hold_n = 2;
        params.scheme = ROD_SCHEME_PAPER;
        params.limit_rad[3] = 0.3f;
        fill(&TUBE, model, 9);
        TEST_ASSERT_EQUAL_FLOAT(0.002f, params.tick_s);
        TEST_ASSERT_EQUAL_FLOAT(1.6f, params.gravity_m_s2);
        TEST_ASSERT_EQUAL_INT(2, params.hold_n);
        TEST_ASSERT_EQUAL_INT(ROD_SCHEME_PAPER, params.scheme);
        TEST_ASSERT_EQUAL_FLOAT(0.3f, params.limit_rad[3]);
        TEST_ASSERT_EQUAL_INT(9, params.links_n);
        TEST_ASSERT_EQUAL_INT(model, params.model);
        TEST_ASSERT_EQUAL_FLOAT(params.spring[8], params.spring[ROD_MAX_LINKS - 1]);
        TEST_ASSERT_EQUAL_FLOAT(params.coupling[8], params.coupling[9]);
    }
}

/* --- contour --- */

static double sum_of(const float *list)
{
    double sum = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        sum += (double)list[i];
    }
    return sum;
}

/* An arc of joints bent alike swings at sqrt(sum k / sum mu), and dies out as each joint does. */
static void test_contours_arc_swings_as_the_rod_does(void)
{
    for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
        static rod r;
        fill(&WIRE, ROD_MODEL_ELASTIC, links_n);
        const double omega = 2.0 * PI * (double)rod_params_first_mode_hz(&params);
        const double bend = (double)params.spring[links_n - 1];
        fill(&WIRE, ROD_MODEL_CONTOUR, links_n);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, &params, NULL));
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * omega, omega,
                                  sqrt(sum_of(params.spring) / sum_of(params.inertia)));
        TEST_ASSERT_EQUAL_FLOAT(0.0f, params.coupling[0]);
        for (int i = 0; i < links_n; i++) {
            const double inertia = (double)params.inertia[i];
            TEST_ASSERT_TRUE(inertia > 0.0);
            expect_close(1e-5, 2.0 * (double)WIRE.damping_ratio * omega * inertia,
                         params.damper[i]);
            expect_close(1e-6, links_n > 1 ? bend : 0.5 * bend, params.spring[i]);
            expect_close(2e-4, (double)WIRE.drag_n_s_m2 / 0.221955 * inertia, params.drag[i]);
        }
    }
}

/* What the hand moves is joint 1, by u / l. Pushed at 1 m/s^2, mu_1 / l bends the arc so far that its tip is where
 * the chain's is, which is sum m C of the chain's compliances C. */
static void test_contours_arc_bends_as_far_as_the_rod(void)
{
    static const rod_blank *const BLANKS[] = {&TUBE, &WIRE};
    for (int k = 0; k < 2 * ROD_MAX_LINKS; k++) {
        const rod_blank *b = BLANKS[k & 1];
        const int links_n = 1 + k / 2;
        const double l = (double)b->length_m / links_n;
        double tip_m = 0.0, arms_m = 0.0;
        fill(b, ROD_MODEL_ELASTIC, links_n);
        for (int joint = 0; joint < links_n; joint++) {
            double moment = 0.0;
            for (int node = joint; node < links_n; node++) {
                moment += (double)params.mass_kg[node] * (node + 1 - joint) * l;
            }
            tip_m += moment / (double)params.spring[joint] * (links_n - joint) * l;
            arms_m += (links_n - joint) * l;
        }
        fill(b, ROD_MODEL_CONTOUR, links_n);
        const double angle = (double)params.inertia[0] / l / sum_of(params.spring);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5 * tip_m, tip_m, angle * arms_m);
    }
}

/* Coupling is what the tick resolves, at most 4 N^2 k. */
static void test_contours_coupling_is_resolved(void)
{
    int held_down_n = 0, free_n = 0;
    for (int links_n = 2; links_n <= ROD_MAX_LINKS; links_n++) {
        fill(&WIRE, ROD_MODEL_CONTOUR, links_n);
        TEST_ASSERT_TRUE((double)rod_params_resolving_rate_hz(&params) < 1000.1);
        const double wanted = 4.0 * links_n * links_n * (double)params.spring[1];
        TEST_ASSERT_TRUE((double)params.coupling[1] <= 1.00001 * wanted);
        const bool all = (double)params.coupling[1] > 0.99999 * wanted;
        free_n += all;
        held_down_n += !all;
    }
    TEST_ASSERT_TRUE(free_n > 0 && held_down_n > 0);
    rod_blank short_one = WIRE;
    short_one.length_m = 0.1f; /* 420 Hz: no tick of 1 ms resolves the springs themselves */
    fill(&short_one, ROD_MODEL_CONTOUR, 5);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, params.coupling[2]);
    TEST_ASSERT_TRUE(rod_params_resolving_rate_hz(&params) > 1000.0f);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_number_of_a_blank_has_bounds);
    RUN_TEST(test_fields_are_where_they_say);
    RUN_TEST(test_each_link_has_its_part_of_the_rod);
    RUN_TEST(test_no_mass_is_lost);
    RUN_TEST(test_what_does_not_follow_from_a_blank_stays);
    RUN_TEST(test_contours_arc_swings_as_the_rod_does);
    RUN_TEST(test_contours_arc_bends_as_far_as_the_rod);
    RUN_TEST(test_contours_coupling_is_resolved);
    return UNITY_END();
}
