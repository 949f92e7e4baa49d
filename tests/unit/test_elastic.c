/* elastic.c and elastic_step.c: what must hold of the motion whatever the numbers are (test_elastic_step.c
 * compares the numbers). */
#include "elastic_fixture.h"

static elastic_state twin;

/* --- geometry ---------------------------------------------------------------------------------- */

static void links_keep_their_length_through_teleports(void)
{
    params.damper[0] = 0.1f;
    params.gravity_m_s2 = 9.81f;
    for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n += 21) {
        int restored_n = 0;
        rod_pose last = ORIGIN;
        params.links_n = links_n;
        lay(&state, &ORIGIN, STRAIGHT);
        for (int i = 0; i < HOST_OR_BOARD(2000, 200); i++) {
            const rod_pose hand =
                random_below(&seed, 10) == 0 ? random_pose(&seed, 600.0) : hand_at(0.001 * i);
            const bool found = step(&state, &last, &hand);
            restored_n += !found;
            for (int k = 0; k < links_n; k++) {
                TEST_ASSERT_DOUBLE_WITHIN(2.0 * EPS, 1.0, length_double(state.link[k]));
                TEST_ASSERT_TRUE(found || !(fabsf(state.tension[k]) > 0.0f));
            }
            last = hand;
        }
        TEST_ASSERT_TRUE(links_n == 1 || restored_n > 10);
    }
}

/* No motion so calm calls for help. */
static void a_swung_rod_finds_its_lengths(void)
{
    rod_pose last = hand_at(0.0);
    params.links_n = 10;
    lay(&state, &last, STRAIGHT);
    for (int i = 1; i < 1000; i++) {
        const rod_pose hand = hand_at(0.001 * i);
        TEST_ASSERT_TRUE(step(&state, &last, &hand));
        last = hand;
    }
    TEST_ASSERT_TRUE(fabsf(state.angle_rad[0][ROD_THETA]) > 0.01f);
}

/* Angles and what they gained, and the base's motion, there and back; and the nodes' speeds are what the nodes
 * have gone in the tick. Away from the pole, where theta loses its digits. */
static void lay_and_increments_are_inverse(void)
{
    for (int round = 0; round < HOST_OR_BOARD(300, 20); round++) {
        rod_joint angle[ROD_MAX_LINKS], increment[ROD_MAX_LINKS], found[ROD_MAX_LINKS];
        double now[ROD_MAX_LINKS][2], before[ROD_MAX_LINKS][2];
        point_double there[ROD_MAX_LINKS + 1], then[ROD_MAX_LINKS + 1];
        const int n = params.links_n = 1 + random_below(&seed, 12);
        params.tick_s = round % 2 ? 0.001f : 0.003f; /* one step, or three */
        const rod_pose base = random_pose(&seed, 1.0);
        const rod_pose base_before = {
            vec3_add(base.position_m, random_vec3(&seed, 0.003)),
            quat_multiply(base.orientation, quat_about(random_vec3(&seed, 1.0), 0.02))};
        const rod_motion motion = kinematics_motion(&base_before, &base);
        for (int i = 0; i < n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                angle[i][axis] = (float)random_between(&seed, -1.2, 1.2);
                increment[i][axis] = (float)random_between(&seed, -0.05, 0.05);
                now[i][axis] = (double)angle[i][axis];
                before[i][axis] = now[i][axis] - (double)increment[i][axis];
            }
        }
        prepare();
        elastic_lay(&model, &base, &motion, (const rod_joint *)angle, (const rod_joint *)increment,
                    &state);
        elastic_increments(&model, &base, &motion, &state, found);
        const matrix3 axes = matrix3_of(base.orientation),
                      old = matrix3_of(base_before.orientation);
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(8.0 * EPS,
                                      (axes.at[axis][2] - old.at[axis][2]) / model.steps_n,
                                      (double)(&state.axis_step.x)[axis]);
        }
        elastic_nodes(&model, &state, &base, nodes);
        nodes_double(&base, (const joint_double *)now, params.length_m, n, there);
        nodes_double(&base_before, (const joint_double *)before, params.length_m, n, then);
        for (int i = 0; i < n; i++) {
            TEST_ASSERT_EQUAL_MEMORY(angle[i], state.angle_rad[i], sizeof(rod_joint));
            for (int axis = 0; axis < 3; axis++) {
                const double rounding = 8.0 * EPS * (2.0 + 0.1 * (i + 1));
                TEST_ASSERT_DOUBLE_WITHIN(rounding, there[i + 1][axis],
                                          (double)(&nodes[i + 1].x)[axis]);
                TEST_ASSERT_DOUBLE_WITHIN(rounding / (double)params.tick_s,
                                          (there[i + 1][axis] - then[i + 1][axis]) /
                                              (double)params.tick_s,
                                          (double)(&state.speed_m_s[i].x)[axis]);
            }
            for (int axis = 0; axis < 2; axis++) {
                TEST_ASSERT_DOUBLE_WITHIN(8.0 * EPS * (i + 2) / cos(1.25),
                                          (double)increment[i][axis], (double)found[i][axis]);
            }
        }
    }
}

/* theta passes from pi to -pi without having turned once round. */
static void increments_are_the_shorter_way_round(void)
{
    const rod_joint angle = {3.1f, 0.0f}, increment = {-0.1f, 0.0f};
    rod_joint found;
    params.links_n = 1;
    prepare();
    elastic_lay(&model, &ORIGIN, &STILL, &angle, &increment, &state);
    elastic_increments(&model, &ORIGIN, &STILL, &state, &found);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, -0.1f, found[ROD_THETA]);
}

/* --- symmetry ---------------------------------------------------------------------------------- */

/* Along a world axis to the bit; elsewhere the links' directions are rounded, each by half a last place. */
static void straight_rod_at_rest_stays(void)
{
    static const quat ALONG_AXES[] = {{0.0f, 0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f, 0.0f},
                                      {0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f},
                                      {0.5f, 0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f, 0.5f}};
    for (int round = 0; round < 26; round++) {
        rod_pose base = random_pose(&seed, 600.0);
        params.links_n = 1 + random_below(&seed, ROD_MAX_LINKS);
        if (round < 6) {
            base.orientation = ALONG_AXES[round];
            lay(&state, &base, STRAIGHT);
            twin = state;
            rest(&state, &base, 20);
            TEST_ASSERT_EQUAL_MEMORY(&twin, &state, sizeof state);
        } else {
            lay(&state, &base, STRAIGHT);
            lay(&twin, &base, STRAIGHT);
            rest(&state, &base, HOST_OR_BOARD(1000, 50));
            TEST_ASSERT_DOUBLE_WITHIN(32.0 * EPS, 0.0, largest_difference(&twin, &state));
        }
    }
}

/* Only differences of positions count, and q and -q are one attitude: where 3 m and the hand's places have room in a
 * float together, to the bit. */
static void no_bit_depends_on_places_or_signs(void)
{
    const vec3 away = {3.0f, -1.5f, 2.0f};
    rod_pose last = ORIGIN, there_last = {away, ORIGIN.orientation};
    params.links_n = 12;
    lay(&state, &ORIGIN, STRAIGHT);
    twin = state;
    for (int i = 0; i < 300; i++) {
        rod_pose hand = hand_at(0.001 * i);
        for (int axis = 0; axis < 3; axis++) {
            (&hand.position_m.x)[axis] = floorf((&hand.position_m.x)[axis] * 0x1p20f) * 0x1p-20f;
        }
        const quat q = hand.orientation;
        const quat same = i / 3 % 2 ? (quat){-q.x, -q.y, -q.z, -q.w} : q;
        const rod_pose there = {vec3_add(hand.position_m, away), same};
        step(&state, &last, &hand);
        step(&twin, &there_last, &there);
        there_last = there;
        TEST_ASSERT_EQUAL_MEMORY(&state, &twin, sizeof state);
        last = hand;
    }
}

static rod_pose seen_from(const rod_pose *world, const rod_pose *pose)
{
    return (rod_pose){quat_rotate(world->orientation, pose->position_m),
                      quat_multiply(world->orientation, pose->orientation)};
}

/* A turned world rounds the hand's places elsewhere: by some 2e-8 m, which over the squared tick is 0.02 m/s^2 in
 * every tick, beside the hand's 10 m/s^2 that bend joints by 0.26 rad. */
static void turned_world_is_the_same(void)
{
    for (int round = 0; round < 5; round++) {
        const rod_pose world = random_pose(&seed, 1.0);
        rod_pose last = hand_at(0.0), there_last = seen_from(&world, &last);
        double largest = 0.0;
        params.links_n = 6;
        params.damper[0] = params.damper[1] = 0.01f;
        lay(&state, &last, STRAIGHT);
        lay(&twin, &there_last, STRAIGHT);
        for (int i = 1; i < 300; i++) {
            const rod_pose hand = hand_at(0.001 * i), there = seen_from(&world, &hand);
            step(&state, &last, &hand);
            step(&twin, &there_last, &there);
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0, largest_difference(&state, &twin));
            last = hand, there_last = there;
            largest = worse(largest, fabs((double)state.angle_rad[0][ROD_THETA]));
        }
        TEST_ASSERT_TRUE(largest > 0.2);
    }
}

/* A base that falls as BDF2 has a free body fall takes gravity from the rod: it swings as if there were none. Not to
 * the bit: places of up to 0.2 m are rounded, and secants are taken where gravity has not acted yet. */
static void rod_that_falls_with_its_base_feels_no_weight(void)
{
    const double g = 9.81, h = 0.001 * 2.0 / 3.0;
    const rod_joint bent[4] = {{0.3f, 0.1f}, {-0.2f, 0.2f}, {0.4f, -0.3f}, {0.1f, 0.2f}};
    double z = 0.0, z_before = 0.0, v = 0.0, v_before = 0.0;
    rod_pose last = ORIGIN;
    lay(&state, &ORIGIN, bent);
    params.gravity_m_s2 = (float)g;
    lay(&twin, &ORIGIN, bent);
    const float fall_m = model.fall_m;
    for (int i = 0; i < 200; i++) {
        const double v_next = (4.0 * v - v_before) / 3.0 - h * g;
        const double z_next = (4.0 * z - z_before) / 3.0 + h * v_next;
        v_before = v, v = v_next, z_before = z, z = z_next;
        const rod_pose falling = {{0.0f, 0.0f, (float)z}, ORIGIN.orientation};
        model.fall_m = 0.0f;
        step(&state, &ORIGIN, &ORIGIN);
        model.fall_m = fall_m;
        step(&twin, &last, &falling);
        TEST_ASSERT_DOUBLE_WITHIN(2e-4, 0.0, largest_difference(&state, &twin));
        last = falling;
    }
    TEST_ASSERT_TRUE(z < -0.15);
}

/* A tick beyond 2 ms is as many steps as keep each within 1 ms, and no other motion: 4 ms and a quarter of it are exact. */
static void long_tick_is_many_steps(void)
{
    const rod_joint bent[4] = {{0.3f, 0.1f}, {-0.2f, 0.2f}, {0.4f, -0.3f}, {0.1f, 0.2f}};
    for (int ms = 1; ms <= 100; ms++) {
        TEST_ASSERT_EQUAL_INT(ms <= 2 ? 1 : ms, elastic_steps_n((float)(0.001 * ms), false));
        TEST_ASSERT_EQUAL_INT(ms <= 4 ? 1 : ms, elastic_steps_n((float)(0.001 * ms), true));
    }
    lay(&twin, &ORIGIN, bent);
    rest(&twin, &ORIGIN, 40);
    params.tick_s *= 4.0f;
    lay(&state, &ORIGIN, bent);
    rest(&state, &ORIGIN, 10);
    TEST_ASSERT_EQUAL_MEMORY(&twin, &state, sizeof state);
    TEST_ASSERT_TRUE(length_double(state.speed_m_s[3]) > 0.1);
}

/* --- what float32 cannot do ---------------------------------------------------------------------------------- */

/* Hinges between stiff pairs, and hardly a mass: float32 cannot see what keeps the matrix definite. */
static void stiffness_that_float32_cannot_factor_is_refused(void)
{
    int row_n = 0;
    params.links_n = 20;
    params.tick_s = 0.1f;
    for (int i = 0; i < 20; i++) {
        params.spring[i] = i % 2 ? 1e6f : 0.0f;
        params.mass_kg[i] = 1e-6f;
    }
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_params_check(&params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_E_PIVOT, elastic_prepare(&model, &params, false, &row_n));
    TEST_ASSERT_TRUE(row_n >= 1 && row_n <= 20);
}

/* Forces as large as rod.h lets pass, and teleports under them. */
static void no_force_takes_a_rod_out_of_the_finite(void)
{
    static vec3 force[ROD_MAX_LINKS + 1];
    rod_pose last = ORIGIN;
    params.links_n = 20;
    params.tick_s = 0.01f;
    for (int i = 0; i < 20; i++) {
        params.mass_kg[i] = 1e-6f;
    }
    lay(&state, &ORIGIN, STRAIGHT);
    for (int i = 0; i < HOST_OR_BOARD(1000, 50); i++) {
        const rod_pose hand = i % 3 == 0 ? random_pose(&seed, 1000.0) : last;
        for (int k = 0; k < 21; k++) {
            force[k] = random_vec3(&seed, random_magnitude(&seed, 1e-3, 3e8));
        }
        step_pushed(&state, &last, &hand, force);
        last = hand;
        for (int k = 0; k < 20; k++) {
            TEST_ASSERT_DOUBLE_WITHIN(2.0 * EPS, 1.0, length_double(state.link[k]));
            TEST_ASSERT_TRUE(isfinite(length_double(state.speed_m_s[k])));
        }
    }
    rest(&state, &last, HOST_OR_BOARD(1000, 100));
    TEST_ASSERT_TRUE(length_double(state.speed_m_s[19]) < 1e3);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(links_keep_their_length_through_teleports);
    RUN_TEST(a_swung_rod_finds_its_lengths);
    RUN_TEST(lay_and_increments_are_inverse);
    RUN_TEST(increments_are_the_shorter_way_round);
    RUN_TEST(straight_rod_at_rest_stays);
    RUN_TEST(no_bit_depends_on_places_or_signs);
    RUN_TEST(turned_world_is_the_same);
    RUN_TEST(rod_that_falls_with_its_base_feels_no_weight);
    RUN_TEST(long_tick_is_many_steps);
    RUN_TEST(stiffness_that_float32_cannot_factor_is_refused);
    RUN_TEST(no_force_takes_a_rod_out_of_the_finite);
    return UNITY_END();
}
