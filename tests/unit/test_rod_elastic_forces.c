/* test_rod_elastic_forces.c - external forces on elastic rods: where they bend one to, and which are refused. */
#include "rod_fixture.h"

void setUp(void)
{
    elastic_params(3, 0.05f);
    params.gravity_m_s2 = 0.0f;
}

void tearDown(void) {}

typedef struct {
    int node; /* on which */
    vec3 newton;
    vec3 tip_m; /* as the last call saw it */
    int nodes_n;
} push;

static void do_push(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    push *p = context;
    p->nodes_n = nodes_n;
    p->tip_m = nodes_m[nodes_n - 1];
    forces_newton[p->node] = p->newton;
}

/* At rest every joint's spring holds the force at its lever: k alpha = F x how far beyond it, across the force, the
 * node lies. So node for node, along x as along y, and in newtons. */
static void test_a_force_on_a_node_bends_the_joints_before_it(void)
{
    for (int option = 0; option < 6; option++) {
        const int axis = option % 2, node = 1 + option / 2;
        push p = {node, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0};
        (&p.newton.x)[axis] = 2.0f;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
        rod_set_force(&one, do_push, &p);
        rest(&one, &AT_ORIGIN, 3000);
        rod_nodes(&one, nodes);
        for (int i = 0; i < 3; i++) {
            const double lever_m = (double)nodes[node].z - (double)nodes[i].z;
            const double wanted = i < node ? 2.0 * lever_m / 4.0 : 0.0;
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, wanted, (double)rod_angles(&one)[i][axis]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, (double)rod_angles(&one)[i][1 - axis]);
        }
        TEST_ASSERT_EQUAL_INT(4, p.nodes_n);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, length_double(vec3_sub(p.tip_m, nodes[3])));
    }
}

static void test_forces_without_measure_are_refused(void)
{
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 2e9f, -3e38f};
    for (int option = 0; option < 15; option++) {
        push p = {1 + option % 3, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0};
        (&p.newton.x)[option / 5] = BAD[option % 5];
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
        rest(&one, &AT_ORIGIN, 10);
        rod_set_force(&one, do_push, &p);
        twin = one;
        TEST_ASSERT_EQUAL_INT(ROD_E_FORCE, rod_step(&one, &AT_ORIGIN));
        TEST_ASSERT_EQUAL_MEMORY(&twin, &one, sizeof one);
        rod_set_force(&one, NULL, NULL);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &AT_ORIGIN));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_force_on_a_node_bends_the_joints_before_it);
    RUN_TEST(test_forces_without_measure_are_refused);
    return UNITY_END();
}
