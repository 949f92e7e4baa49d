/* test_rod_forces.c - external forces: where they bend a rod to, and which are refused. */
#include "rod_fixture.h"

void setUp(void)
{
    rod_params_defaults(&params);
}

void tearDown(void) {}

static void start(rod *r, const rod_pose *base)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(r, &params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, base));
}

typedef struct {
    vec3 each; /* newton, on every node from 1 on */
    int calls_n;
    vec3 tip_m; /* as the last call saw it */
} wind;

static void blow(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    wind *w = context;
    w->calls_n++;
    w->tip_m = nodes_m[nodes_n - 1];
    for (int i = 0; i < nodes_n; i++) {
        TEST_ASSERT_EQUAL_MEMORY(&NONE, &forces_newton[i], sizeof NONE);
        forces_newton[i] = i > 0 ? w->each : (vec3){1e30f, 1e30f, NAN}; /* pushes the hand alone */
    }
}

static void test_the_force_function_sees_the_last_step(void)
{
    wind w = {{1.0f, 2.0f, 3.0f}, 0, {0.0f, 0.0f, 0.0f}};
    start(&one, &AT_ORIGIN);
    rod_set_force(&one, blow, &w);
    for (int i = 1; i <= 50; i++) {
        const int tip = rod_nodes(&one, nodes) - 1;
        const rod_pose hand = hand_at(0.001 * i);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &hand));
        TEST_ASSERT_EQUAL_INT(i, w.calls_n);
        TEST_ASSERT_EQUAL_MEMORY(&nodes[tip], &w.tip_m, sizeof w.tip_m);
    }
    rod_reset(&one); /* keeps it; the next step but one calls it */
    rest(&one, &AT_ORIGIN, 2);
    TEST_ASSERT_EQUAL_INT(51, w.calls_n);
    rod_set_force(&one, NULL, NULL);
    rest(&one, &AT_ORIGIN, 2);
    TEST_ASSERT_EQUAL_INT(51, w.calls_n);
}

/* k theta = l F cos theta, toward the force. At rest a rod stops short: a step under half the angle's
 * last place no longer moves it, and the spring's share of a step is k dt^2 / mu of what is missing. */
static void test_one_joint_leans_on_the_wind(void)
{
    params.links_n = 1;
    params.length_m[0] = 0.1f;
    params.coupling[0] = 0.0f;
    params.damper[0] = 8.0f; /* critical */
    params.tick_s = 0.004f;
    for (int direction = 0; direction < 4; direction++) {
        const float newton = direction % 2 ? -8.0f : 8.0f;
        const int axis = direction / 2;
        wind w = {{0.0f, 0.0f, 0.0f}, 0, {0.0f, 0.0f, 0.0f}};
        (&w.each.x)[axis] = newton; /* x bends theta, y bends phi */
        start(&one, &AT_ORIGIN);
        rod_set_force(&one, blow, &w);
        rest(&one, &AT_ORIGIN, 1000);
        const double bend = 0.1 * (double)newton / 80.0;
        const double wanted = bend * cos(bend * cos(bend)); /* two rounds of the fixed point */
        const double allowed = fabs(wanted) * UNIT_ROUNDOFF * 0.2 / (80.0 * 0.004 * 0.004);
        const float *angles = rod_angles(&one)[0];
        TEST_ASSERT_DOUBLE_WITHIN(allowed, wanted, (double)angles[axis]);
        TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, (double)angles[1 - axis]);
    }
}

/* Bending energy less the wind's work: what a rod at rest has least of. */
static double energy(const rod_pose *base, joint_double *x, vec3 force)
{
    static point_double at[ROD_MAX_LINKS + 1];
    nodes_double(base, (const joint_double *)x, params.length_m, params.links_n, at);
    double sum = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        sum -= (double)force.x * at[i + 1][0] + (double)force.y * at[i + 1][1] +
               (double)force.z * at[i + 1][2];
        for (int axis = 0; axis < 2; axis++) {
            const double before = i > 0 ? x[i - 1][axis] : 0.0;
            const double first = x[i][axis] - before;
            const double second =
                i + 1 < params.links_n ? x[i + 1][axis] - x[i][axis] - first : 0.0;
            sum += 0.5 * (double)params.spring[i] * x[i][axis] * x[i][axis] +
                   0.5 * (double)params.coupling[i] * first * first +
                   0.5 * (double)params.smoothing[i] * second * second;
        }
    }
    return sum;
}

/* A rod comes to rest where the energy has no slope in any angle: so its springs and its torques are
 * their energies' derivatives, in any attitude of the base. Where it stops short, half a last place of
 * 0.25 rad times mu / dt^2 is left over: 2e-4 N m of some 3 N m. */
static void test_a_rod_leans_on_the_wind(void)
{
    const rod_pose base = {{1.0f, -2.0f, 0.5f}, {0.1f, -0.7f, 0.5f, 0.5f}};
    wind w = {{-9.0f, 4.0f, 8.0f}, 0, {0.0f, 0.0f, 0.0f}};
    params.links_n = 5;
    params.tick_s = 0.004f;
    for (int i = 0; i < params.links_n; i++) {
        params.length_m[i] = 0.1f + 0.01f * (float)i;
        params.spring[i] = 30.0f - (float)i;
        params.coupling[i] = 40.0f + (float)i;
        params.smoothing[i] = 15.0f + (float)i;
        params.damper[i] = 4.0f;
    }
    start(&one, &base);
    rod_set_force(&one, blow, &w);
    rest(&one, &base, 2000);

    static joint_double x[ROD_MAX_LINKS];
    for (int i = 0; i < params.links_n; i++) {
        x[i][ROD_THETA] = (double)rod_angles(&one)[i][ROD_THETA];
        x[i][ROD_PHI] = (double)rod_angles(&one)[i][ROD_PHI];
    }
    TEST_ASSERT_TRUE(fabs(x[0][ROD_THETA]) > 0.03 &&
                     fabs(x[0][ROD_PHI]) > 0.03); /* bent, and free */
    for (int i = 0; i < 2 * params.links_n; i++) {
        const double here = x[i / 2][i % 2];
        x[i / 2][i % 2] = here + 1e-5;
        const double above = energy(&base, x, w.each);
        x[i / 2][i % 2] = here - 1e-5;
        const double below = energy(&base, x, w.each);
        x[i / 2][i % 2] = here;
        TEST_ASSERT_DOUBLE_WITHIN(2e-4, 0.0, (above - below) / 2e-5);
    }
}

static void test_bad_forces_are_refused(void)
{
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 1e12f, 3e38f};
    start(&one, &AT_ORIGIN);
    start(&twin, &AT_ORIGIN);
    for (int i = 0; i < 40;
         i++) { /* bent from the second on: a force along a straight rod turns nothing */
        const rod_pose hand = hand_at(0.001 * i);
        for (size_t k = 0; i > 0 && k < 3 * sizeof BAD / sizeof BAD[0]; k++) {
            wind w = {{0.0f, 0.0f, 0.0f}, 0, {0.0f, 0.0f, 0.0f}};
            (&w.each.x)[k % 3] = BAD[k / 3];
            rod_set_force(&one, blow, &w);
            TEST_ASSERT_EQUAL_INT(ROD_E_FORCE, rod_step(&one, &hand));
        }
        rod_set_force(&one, NULL, NULL);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &hand));
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&twin, &hand));
        TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), 4 * sizeof(rod_joint));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_force_function_sees_the_last_step);
    RUN_TEST(test_one_joint_leans_on_the_wind);
    RUN_TEST(test_a_rod_leans_on_the_wind);
    RUN_TEST(test_bad_forces_are_refused);
    return UNITY_END();
}
