/* test_rod_shape.c - shapes to take: how far the rod goes towards one, how it gets there and back, and what it survives. */
#include <float.h>

#include "rod_fixture.h"

enum { LINKS_N = 6 };

static rod_joint arc[ROD_MAX_LINKS];

/* Joints alike, well damped, without gravity; and a bend to the side and up. */
static void take_rod(int model)
{
    elastic_params(LINKS_N, 0.0f);
    params.model = model;
    params.tick_s = 0.002f;
    params.gravity_m_s2 = 0.0f;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.spring[i] = 10.0f;
        params.damper[i] = 0.4f;
        params.mass_kg[i] = 0.02f;
        params.inertia[i] = 0.02f;
        params.coupling[i] = 0.0f;
        arc[i][ROD_THETA] = 0.3f;
        arc[i][ROD_PHI] = -0.1f;
    }
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
}

void setUp(void)
{
    take_rod(ROD_MODEL_ELASTIC);
}

void tearDown(void) {}

static void ask(float strength_nm, float blend_s)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK,
                          rod_set_shape(&one, (const rod_joint *)arc, strength_nm, blend_s));
}

static int ticks_in(double seconds)
{
    return (int)lround(seconds / (double)params.tick_s);
}

/* How far the joint is on its way, 1 where it is there; the least and the most of all joints. */
typedef struct {
    double least, most;
} reached;

static reached shares(void)
{
    reached r = {HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 2 * LINKS_N; i++) {
        const double share = (double)rod_angles(&one)[i / 2][i % 2] / (double)arc[i / 2][i % 2];
        r.least = fmin(r.least, share);
        r.most = fmax(r.most, share);
    }
    return r;
}

/* The most that any joint turns in one of the next ticks, rad. */
static double largest_turn(int ticks_n)
{
    double largest = 0.0;
    for (int n = 0; n < ticks_n; n++) {
        rod_joint before[LINKS_N];
        memcpy(before, rod_angles(&one), sizeof before);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &AT_ORIGIN));
        for (int i = 0; i < 2 * LINKS_N; i++) {
            const float turn = rod_angles(&one)[i / 2][i % 2] - before[i / 2][i % 2];
            largest = worse(largest, fabs((double)turn));
        }
    }
    return largest;
}

/* --- how far ---------------------------------------------------------------------------------------- */

static void strong_shapes_are_taken_to_a_hundredth(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        ask(1e5f, 0.5f);
        rest(&one, &AT_ORIGIN, ticks_in(2.0));
        const reached r = shares();
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, r.least);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, r.most);
    }
}

/* Two springs against each other: s / (s + k). */
static void weak_shapes_of_contour_are_taken_in_part(void)
{
    static const float strength_nm[] = {1.0f, 10.0f, 90.0f};
    for (int i = 0; i < 3; i++) {
        take_rod(ROD_MODEL_CONTOUR);
        ask(strength_nm[i], 0.1f);
        rest(&one, &AT_ORIGIN, ticks_in(2.0));
        const double share = (double)strength_nm[i] / ((double)strength_nm[i] + 10.0);
        const reached r = shares();
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, share, r.least);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, share, r.most);
    }
}

/* The links' directions are pulled, and each joint has all links beyond it to bend it: with N links the chain
 * (k D'D + s) x = s x_shape for the sums x of the joints' angles, D the differences. */
static double elastic_share_of_tip(double strength_nm)
{
    double x[LINKS_N] = {0.0};
    for (int round = 0; round < 2000; round++) { /* Gauss and Seidel */
        for (int i = 0; i < LINKS_N; i++) {
            const double before = i > 0 ? x[i - 1] : 0.0, after = i + 1 < LINKS_N ? x[i + 1] : 0.0;
            const double springs = i + 1 < LINKS_N ? 20.0 : 10.0;
            x[i] = (strength_nm * (i + 1) + 10.0 * (before + after)) / (strength_nm + springs);
        }
    }
    return x[LINKS_N - 1] / LINKS_N;
}

static void weak_shapes_of_elastic_are_taken_in_part(void)
{
    static const float strength_nm[] = {1.0f, 10.0f, 90.0f};
    for (int i = 0; i < 3; i++) {
        setUp();
        for (int k = 0; k < LINKS_N; k++) { /* small, in one plane: there angles add up */
            arc[k][ROD_THETA] = 0.02f;
            arc[k][ROD_PHI] = 0.0f;
        }
        ask(strength_nm[i], 0.1f);
        rest(&one, &AT_ORIGIN, ticks_in(2.0));
        double sum = 0.0;
        for (int k = 0; k < LINKS_N; k++) {
            sum += (double)rod_angles(&one)[k][ROD_THETA];
        }
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, elastic_share_of_tip((double)strength_nm[i]),
                                  sum / (0.02 * LINKS_N));
    }
}

/* --- the way there and back ---------------------------------------------------------------------------- */

/* Over half a second no joint turns much faster than the 0.3 rad take; another shape in mid-way and letting go are no
 * faster. */
static void changes_are_blended(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        const double even_rad = 0.3 / ticks_in(0.5);
        ask(50.0f, 0.5f);
        TEST_ASSERT_TRUE(largest_turn(ticks_in(0.25)) < 4.0 * even_rad);
        const reached half = shares();
        TEST_ASSERT_TRUE(half.least > 0.05 && half.most < 0.9);
        for (int i = 0; i < LINKS_N; i++) {
            arc[i][ROD_THETA] = -0.1f;
        }
        ask(200.0f, 0.5f);
        TEST_ASSERT_TRUE(largest_turn(ticks_in(1.0)) < 4.0 * even_rad);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_shape(&one, NULL, 0.0f, 0.5f));
        TEST_ASSERT_TRUE(largest_turn(ticks_in(1.0)) < 4.0 * even_rad);
    }
}

static void pull_aside(const vec3 *places_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)places_m;
    (void)context;
    forces_newton[nodes_n - 1].x = 5.0f;
}

/* A rod that something else has bent is asked for the bend it has: no joint leaves it on the way, by a tenth. */
static void changes_start_from_where_the_joints_stand(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        rod_set_force(&one, pull_aside, NULL);
        rest(&one, &AT_ORIGIN, ticks_in(2.0));
        memcpy(arc, rod_angles(&one), LINKS_N * sizeof *arc);
        TEST_ASSERT_TRUE(arc[0][ROD_THETA] > 0.05f);
        ask(100.0f, 0.5f);
        for (int n = 0; n < ticks_in(0.6); n++) {
            rest(&one, &AT_ORIGIN, 1);
            for (int i = 0; i < LINKS_N; i++) {
                const float off = rod_angles(&one)[i][ROD_THETA] - arc[i][ROD_THETA];
                TEST_ASSERT_TRUE(fabsf(off) < 0.1f * arc[0][ROD_THETA]);
            }
        }
    }
}

static void released_rods_are_straight_again(void)
{
    for (int i = 0; i < 4; i++) { /* by no shape, or by no strength */
        take_rod(i & 1);
        ask(1000.0f, 0.2f);
        rest(&one, &AT_ORIGIN, ticks_in(0.5));
        TEST_ASSERT_TRUE(shares().least > 0.5);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_shape(&one, i < 2 ? NULL : (const rod_joint *)arc,
                                                    i < 2 ? 5.0f : 0.0f, 0.2f));
        rest(&one, &AT_ORIGIN, ticks_in(3.0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, shares().most);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, shares().least);
    }
}

/* --- refusals ------------------------------------------------------------------------------------------ */

static void refused(float strength_nm, float blend_s)
{
    TEST_ASSERT_EQUAL_INT(ROD_E_SHAPE,
                          rod_set_shape(&one, (const rod_joint *)arc, strength_nm, blend_s));
}

static void what_is_out_of_bounds_is_refused_and_changes_nothing(void)
{
    static const float angle_rad[] = {3.1415930f, -3.1415930f, NAN, INFINITY};
    swing(&one);
    twin = one;
    for (int i = 0; i < 8; i++) {
        float *angle = &arc[LINKS_N - 1][i & 1];
        const float good = *angle;
        *angle = angle_rad[i / 2];
        refused(1.0f, 1.0f);
        *angle = good;
    }
    const float strengths_nm[] = {-1e-30f, nextafterf(ROD_SHAPE_STRENGTH_MAX_NM, INFINITY), NAN};
    const float blends_s[] = {-1e-30f, nextafterf(ROD_SHAPE_BLEND_MAX_S, INFINITY), NAN};
    for (int i = 0; i < 3; i++) {
        refused(strengths_nm[i], 1.0f);
        refused(1.0f, blends_s[i]);
    }
    follow(&one, 1.0, 50);
    follow(&twin, 1.0, 50);
    TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), LINKS_N * sizeof(rod_joint));
    arc[LINKS_N][ROD_THETA] = NAN; /* beyond the last joint, not read */
    ask(ROD_SHAPE_STRENGTH_MAX_NM, ROD_SHAPE_BLEND_MAX_S);
}

static void papers_scheme_takes_no_shape(void)
{
    take_rod(ROD_MODEL_CONTOUR);
    params.scheme = ROD_SCHEME_PAPER;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
    refused(1.0f, 1.0f);
}

/* --- what it survives ---------------------------------------------------------------------------------- */

static void shapes_survive_a_reset_other_parameters_and_the_other_model(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        ask(4000.0f, 0.2f);
        rod_reset(&one);
        rest(&one, &AT_ORIGIN, ticks_in(1.0));
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, shares().least);
        for (int i = 0; i < LINKS_N; i++) {
            params.spring[i] = 20.0f;
        }
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        rest(&one, &AT_ORIGIN, ticks_in(1.0));
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, shares().least);
        params.model = ROD_MODEL_COUNT - 1 - model;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        rest(&one, &AT_ORIGIN, ticks_in(1.0));
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, shares().least);
    }
}

static void another_number_of_links_forgets_it(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        ask(1000.0f, 0.0f);
        rest(&one, &AT_ORIGIN, ticks_in(1.0));
        params.links_n = LINKS_N + 1;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        rest(&one, &AT_ORIGIN, ticks_in(4.0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, shares().most);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, shares().least);
    }
}

static void shapes_are_held_up_by_objects(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        static scene wall;
        const scene_object plane = {.kind = SCENE_PLANE,
                                    .place_m = {0.05f, 0.0f, 0.0f},
                                    .orientation = quat_about((vec3){0.0f, 1.0f, 0.0f}, -0.5 * PI)};
        take_rod(model);
        TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&wall, 0, &plane, NULL));
        rod_set_scene(&one, &wall);
        ask(50.0f, 0.2f);
        rest(&one, &AT_ORIGIN, ticks_in(3.0));
        int contacts_n;
        const touch_contact *contact = rod_contacts(&one, &contacts_n);
        TEST_ASSERT_TRUE(contacts_n > 0 && contact[0].force_newton.x < -0.1f);
        (void)rod_nodes(&one, nodes);
        for (int i = 0; i <= LINKS_N; i++) {
            TEST_ASSERT_TRUE(nodes[i].x < 0.05f + 0.01f * params.length_m[0]);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(strong_shapes_are_taken_to_a_hundredth);
    RUN_TEST(weak_shapes_of_contour_are_taken_in_part);
    RUN_TEST(weak_shapes_of_elastic_are_taken_in_part);
    RUN_TEST(changes_are_blended);
    RUN_TEST(changes_start_from_where_the_joints_stand);
    RUN_TEST(released_rods_are_straight_again);
    RUN_TEST(what_is_out_of_bounds_is_refused_and_changes_nothing);
    RUN_TEST(papers_scheme_takes_no_shape);
    RUN_TEST(shapes_survive_a_reset_other_parameters_and_the_other_model);
    RUN_TEST(another_number_of_links_forgets_it);
    RUN_TEST(shapes_are_held_up_by_objects);
    return UNITY_END();
}
