/* test_rod_elastic.c - rod.h with the elastic model: what a call changes, what it must not, and what pushes the rod. */
#include "rod_fixture.h"

void setUp(void)
{
    elastic_params(6, 0.02f);
}

void tearDown(void) {}

static void set(rod *r)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(r, &params, NULL));
}

static void expect_near(const rod_joint *wanted, const rod_joint *got, int joints_n, float within)
{
    for (int i = 0; i < joints_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_FLOAT_WITHIN(within, wanted[i][axis], got[i][axis]);
        }
    }
}

/* What the joints gained in the last tick, of either model. */
static void increments(const rod *r, rod_joint *increment_rad)
{
    if (r->params.model == ROD_MODEL_ELASTIC) {
        elastic_increments(&r->as.elastic.model, &r->base, &r->motion, &r->as.elastic.state,
                           increment_rad);
        return;
    }
    memcpy(increment_rad, r->as.contour.state[r->as.contour.current].increment_rad,
           (size_t)r->params.links_n * sizeof(rod_joint));
}

/* --- parameters -------------------------------------------------------------------------------- */

static void test_same_links_keep_the_state_to_the_bit(void)
{
    swing(&one);
    const elastic_state before = one.as.elastic.state;
    params.spring[2] = 7.0f;
    params.mass_kg[3] = 0.1f;
    params.drag[1] = 1.0f;
    params.damper[0] = 0.0f;
    params.gravity_m_s2 = 1.62f;
    set(&one);
    TEST_ASSERT_EQUAL_MEMORY(&before, &one.as.elastic.state, sizeof before);
    swing(&twin);
    TEST_ASSERT_TRUE(fabsf(rod_angles(&one)[3][0] - rod_angles(&twin)[3][0]) > 0.01f);
}

/* Speeds are what nodes went in the last tick: half a tick late, at some 100 m/s^2. */
static void test_a_change_of_tick_or_length_keeps_angles_and_speeds(void)
{
    for (int option = 0; option < 2; option++) {
        setUp();
        swing(&one);
        const elastic_state before = one.as.elastic.state;
        rod_joint gained[6], wanted_gain[6];
        increments(&one, wanted_gain);
        const float longer = option ? 1.25f : 1.0f;
        params.tick_s = option ? 0.001f : 0.0025f;
        for (int i = 0; i < 6; i++) {
            params.length_m[i] *= longer;
        }
        set(&one);
        const elastic_state *now = &one.as.elastic.state;
        TEST_ASSERT_EQUAL_MEMORY(before.angle_rad, now->angle_rad, sizeof before.angle_rad);
        increments(&one, gained);
        for (int i = 0; i < 12; i++) {
            wanted_gain[i / 2][i % 2] *= params.tick_s / 0.001f;
        }
        expect_near((const rod_joint *)wanted_gain, (const rod_joint *)gained, 6, 1e-5f);
        for (int i = 0; i < 6; i++) {
            const vec3 base_m_s = vec3_scale(before.base_step_m, 1000.0f);
            const vec3 own = vec3_sub(before.speed_m_s[i], base_m_s);
            const vec3 wanted = vec3_add_scaled(base_m_s, own, longer);
            TEST_ASSERT_TRUE(i < 5 || length_double(own) > 0.8);
            TEST_ASSERT_DOUBLE_WITHIN(0.1, 0.0, length_double(vec3_sub(wanted, now->speed_m_s[i])));
        }
        follow(&one, 0.1, 50);
    }
}

static void test_new_links_are_straight_and_at_rest_and_old_ones_vanish(void)
{
    static const rod_joint STRAIGHT[ROD_MAX_LINKS];
    rod_joint before[ROD_MAX_LINKS], after[ROD_MAX_LINKS];
    swing(&one);
    swing(&twin);
    increments(&twin, before);
    params.links_n = 3;
    set(&one);
    TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), 3 * sizeof(rod_joint));
    TEST_ASSERT_EQUAL_INT(4, rod_nodes(&one, nodes));
    params.links_n = ROD_MAX_LINKS;
    set(&one);
    increments(&one, after);
    TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), 3 * sizeof(rod_joint));
    TEST_ASSERT_EQUAL_MEMORY(STRAIGHT, rod_angles(&one) + 3,
                             (ROD_MAX_LINKS - 3) * sizeof(rod_joint));
    expect_near((const rod_joint *)before, (const rod_joint *)after, 3, 1e-5f);
    expect_near(STRAIGHT, (const rod_joint *)after + 3, ROD_MAX_LINKS - 3, 1e-5f);
}

static void test_models_hand_on_angles_and_increments(void)
{
    rod_joint angle[6], before[6], after[6];
    swing(&one);
    for (int model = ROD_MODEL_CONTOUR; model <= ROD_MODEL_ELASTIC; model++) {
        memcpy(angle, rod_angles(&one), sizeof angle);
        increments(&one, before);
        params.model = model;
        set(&one);
        increments(&one, after);
        TEST_ASSERT_EQUAL_MEMORY(angle, rod_angles(&one), sizeof angle);
        expect_near((const rod_joint *)before, (const rod_joint *)after, 6, 1e-5f);
        follow(&one, 0.1 + 0.1 * model, 20);
    }
}

static void test_reset_and_init_leave_nothing_behind(void)
{
    swing(&one);
    rod_reset(&one);
    TEST_ASSERT_EQUAL_INT(0, rod_nodes(&one, nodes));
    memset(&twin, 0xff, sizeof twin);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&twin, &params, NULL));
    follow(&one, 0.3, 50);
    follow(&twin, 0.3, 50);
    TEST_ASSERT_EQUAL_MEMORY(&one.as.elastic.state, &twin.as.elastic.state,
                             sizeof one.as.elastic.state);
}

/* Valid one by one, but hinges between stiff pairs, and hardly a mass. */
static void make_unfactorable(rod_params *p)
{
    p->links_n = 20;
    p->tick_s = 0.1f;
    for (int i = 0; i < 20; i++) {
        p->spring[i] = i % 2 ? 1e6f : 0.0f;
        p->damper[i] = 0.0f;
        p->mass_kg[i] = 1e-6f;
    }
}

/* At 250 Hz a scene makes four steps a tick one: the rod swings on as it did, if nothing is near it, and goes back to four where
 * it is taken away. */
static void test_a_scene_changes_the_steps_and_not_the_motion(void)
{
    static scene far_away;
    const scene_object ball = {.kind = SCENE_SPHERE,
                               .place_m = {50.0f, 0.0f, 0.0f},
                               .orientation = {0.0f, 0.0f, 0.0f, 1.0f},
                               .radius_m = 1.0f};
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&far_away, 0, &ball, NULL));
    params.tick_s = 0.004f;
    swing(&one);
    swing(&twin);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_scene(&one, &far_away));
    TEST_ASSERT_EQUAL_INT(1, one.as.elastic.model.steps_n);
    float largest = 0.0f;
    for (int tick = 0; tick < 120; tick++) {
        follow(&one, 0.4 + 0.004 * tick, 1);
        follow(&twin, 0.4 + 0.004 * tick, 1);
        expect_near(rod_angles(&twin), rod_angles(&one), 6, 0.01f);
        largest = fmaxf(largest, fabsf(rod_angles(&twin)[0][ROD_THETA]));
    }
    TEST_ASSERT_TRUE(largest > 0.1f);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_scene(&one, NULL));
    TEST_ASSERT_EQUAL_INT(4, one.as.elastic.model.steps_n);
    follow(&one, 0.88, 20);
    follow(&twin, 0.88, 20);
    expect_near(rod_angles(&twin), rod_angles(&one), 6, 0.01f);
}

/* Hinges between stiff pairs: float32 loses what keeps the matrix definite in a step of 4 ms, though not in those of 1 ms. */
static void test_a_scene_whose_steps_float32_cannot_take_is_refused(void)
{
    static const scene nothing;
    params.tick_s = 0.004f;
    params.links_n = 20;
    for (int i = 0; i < params.links_n; i++) {
        params.spring[i] = i % 2 ? 250000.0f : 0.0f;
        params.mass_kg[i] = 7.4e-5f;
    }
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    rest(&one, &AT_ORIGIN, 2);
    const rod before = one;
    TEST_ASSERT_EQUAL_INT(ROD_E_PIVOT, rod_set_scene(&one, &nothing));
    TEST_ASSERT_EQUAL_MEMORY(&before, &one, sizeof one);
}

static void test_refusals_change_nothing(void)
{
    const rod_pose bad_poses[] = {{{NAN, 0.0f, 0.0f}, AT_ORIGIN.orientation},
                                  {{0.0f, 1001.0f, 0.0f}, AT_ORIGIN.orientation},
                                  {AT_ORIGIN.position_m, {0.0f, 0.0f, 0.5f, 0.5f}}};
    swing(&one);
    twin = one;
    for (int i = 0; i <= ROD_FIELDS_N; i++) {
        rod_params bad = params;
        rod_error expected = ROD_E_PIVOT;
        if (i < ROD_FIELDS_N) {
            rod_field_set(&rod_fields[i], &bad, 2, NAN);
            expected = rod_fields[i].error;
        } else {
            make_unfactorable(&bad);
        }
        TEST_ASSERT_EQUAL_INT(expected, rod_set_params(&one, &bad, NULL));
        TEST_ASSERT_EQUAL_INT(expected, rod_init(&one, &bad, NULL));
        TEST_ASSERT_EQUAL_MEMORY(&twin, &one, sizeof one);
    }
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(ROD_E_POSE, rod_step(&one, &bad_poses[i]));
        TEST_ASSERT_EQUAL_MEMORY(&twin, &one, sizeof one);
    }
}

/* --- what is seen from outside ------------------------------------------------------------------ */

static void test_nodes_are_those_of_the_angles_and_of_the_links(void)
{
    static vec3 seen[ROD_MAX_LINKS + 1];
    static const int LINKS_N[] = {1, 2, 20, ROD_MAX_LINKS};
    for (int size = 0; size < 4; size++) {
        params.links_n = LINKS_N[size];
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
        for (int i = 0; i < 100; i++) {
            follow(&one, 0.001 * i, 1);
            TEST_ASSERT_EQUAL_INT(params.links_n + 1, rod_nodes(&one, nodes));
            kinematics_nodes(&one.base, rod_angles(&one), params.length_m, params.links_n, seen);
            vec3 end = one.base.position_m;
            for (int k = 0; k <= params.links_n; k++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, length_double(vec3_sub(nodes[k], seen[k])));
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, length_double(vec3_sub(nodes[k], end)));
                if (k < params.links_n) {
                    end = vec3_add_scaled(end, one.as.elastic.state.link[k], params.length_m[k]);
                }
            }
        }
    }
}

static void test_hostile_ticks_are_counted(void)
{
    const rod_pose away = {{0.0f, 5.0f, 0.0f}, {0.0f, 1.0f, 0.0f, 0.0f}};
    swing(&one);
    TEST_ASSERT_EQUAL_UINT32(0, rod_restored_n(&one));
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &away));
    TEST_ASSERT_EQUAL_UINT32(1, rod_restored_n(&one));
    rod_reset(&one);
    TEST_ASSERT_EQUAL_UINT32(1, rod_restored_n(&one)); /* since rod_init */
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    TEST_ASSERT_EQUAL_UINT32(0, rod_restored_n(&one));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_same_links_keep_the_state_to_the_bit);
    RUN_TEST(test_a_change_of_tick_or_length_keeps_angles_and_speeds);
    RUN_TEST(test_new_links_are_straight_and_at_rest_and_old_ones_vanish);
    RUN_TEST(test_models_hand_on_angles_and_increments);
    RUN_TEST(test_reset_and_init_leave_nothing_behind);
    RUN_TEST(test_a_scene_changes_the_steps_and_not_the_motion);
    RUN_TEST(test_a_scene_whose_steps_float32_cannot_take_is_refused);
    RUN_TEST(test_refusals_change_nothing);
    RUN_TEST(test_nodes_are_those_of_the_angles_and_of_the_links);
    RUN_TEST(test_hostile_ticks_are_counted);
    return UNITY_END();
}
