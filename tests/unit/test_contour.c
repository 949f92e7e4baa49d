/* contour.c against the same mathematics in double (reference_model.h; firmware/core/MODEL.md). */
#include "contour_fixture.h"

void setUp(void)
{
    seed = 57; /* each test alone gives what it gives among the others */
}

void tearDown(void) {}

/* A motion that ends in the world's axes has begun at the pose its own shift and turn make. */
static void both_base_motions(const rod_motion *motion, rod_joint delta[2], double exact[][2],
                              ref_vec seen[2])
{
    const rod_pose start = {motion->shift_m, motion->turn};
    ref_base_motion(&ref, ref_pose_of(start), ref_pose_of(ORIGIN), exact, seen);
    contour_base_motion(&model, (const rod_joint *)from.angle_rad, motion, delta);
}

/* A joint's far end moves by at most shift + turn * distance, known to float rounding; over its new
 * distance from the axis this is the turn's error: all digits of a small motion stay. The second joint
 * adds the rounding of its place, because its parent's angles are floats: that does not shrink. */
static void base_motion_is_exact_geometry_from_nanometres_to_teleports(void)
{
    static const double size_m[] = {1e-9, 1e-6, 1e-3, 0.05, 1.0, 100.0};
    static const double turn_rad[] = {1e-8, 1e-5, 1e-2, 1.0, 3.14159, 3.2};
    for (int round = 0; round < HOST_OR_BOARD(20000, 300); round++) {
        random_params(round % 3 + 1, round / 3 % 2 + 1, ROD_SCHEME_MIDPOINT, 0.0);
        prepare(1.4, 0.0);
        const double turn = turn_rad[random_below(&seed, 6)];
        const double size = size_m[random_below(&seed, 6)];
        const rod_motion motion = {quat_about(unit_vec3(), turn),
                                   vec3_scale(unit_vec3(), (float)size)};
        double exact[REF_MAX][2] = {{0.0}};
        ref_vec seen[2];
        rod_joint delta[2];
        both_base_motions(&motion, delta, exact, seen);
        double reach = 0.0;
        for (int i = 0; i < 2; i++) {
            if (i >= ref.n || i >= ref.hold) { /* hold may exceed the number of links */
                TEST_ASSERT_EQUAL_FLOAT(0.0f, delta[i][0]);
                TEST_ASSERT_EQUAL_FLOAT(0.0f, delta[i][1]);
                continue;
            }
            reach += ref.length[i];
            const double rounding = i == 0 ? 0.0 : reach;
            const double error = 8.0 * EPS * (size + fmin(turn, 2.0) * reach + rounding);
            TEST_ASSERT_DOUBLE_WITHIN(error / hypot(seen[i].at[0], seen[i].at[2]), 0.0,
                                      ref_wrap((double)delta[i][0] - exact[i][0]));
            TEST_ASSERT_DOUBLE_WITHIN(error / ref_norm(seen[i]), exact[i][1], (double)delta[i][1]);
        }
    }
}

/* The base has gone along the first two links, which lie in one line, until the far end of link 1 or of
 * link 2 lies on its own joint (or misses it by a thousandth of its length), and has turned. */
static void far_end_on_its_joint_turns_neither_it_nor_the_next(void)
{
    for (int round = 0; round < 100; round++) {
        random_params(3, 2, ROD_SCHEME_MIDPOINT, 0.0);
        params.length_m[1] = 0.7f * params.length_m[0];
        prepare(1.2, 0.0);
        set_joint(1, 0, 0.0, 0.0);
        set_joint(1, 1, 0.0, 0.0);
        const ref_vec along = ref_direction(ref.x[0]);
        const ref_vec aside = {{along.at[2], 0.0, -along.at[0]}};
        const quat turn = quat_about(unit_vec3(), between(0.5, 2.0));
        for (int joint = 0; joint < 2; joint++) {
            for (int misses = 0; misses < 2; misses++) {
                const double l = ref.length[joint];
                const ref_vec shift = ref_plus(ref_scaled(along, -l), 1e-3 * l * misses, aside);
                const rod_motion motion = {turn, quat_rotate(turn, float_of_vec(shift))};
                double exact[REF_MAX][2];
                rod_joint delta[2];
                both_base_motions(&motion, delta, exact, NULL);
                for (int i = 0; i < 2; i++) {
                    const bool no_direction = !misses && i >= joint;
                    const float turned = trig_abs(delta[i][0]) + trig_abs(delta[i][1]);
                    TEST_ASSERT_EQUAL_INT(no_direction, !(turned > 0.0f));
                    TEST_ASSERT_DOUBLE_WITHIN(2e-3, no_direction ? 0.0 : exact[i][1],
                                              (double)delta[i][1]);
                }
            }
        }
    }
}

static void theta_stays_where_the_new_direction_is_the_pole(void)
{
    static const double off_pole[] = {0.0, 1e-8, 5e-7, 2e-6, 1e-4, 1e-2};
    random_params(1, 1, ROD_SCHEME_MIDPOINT, 0.0);
    params.length_m[0] = 0.0625f; /* exact, so that the shift can be */
    prepare(0.0, 0.0);
    for (int i = 0; i < 12; i++) {
        const double off = off_pole[i / 2], pole = i % 2 ? 1.0 : -1.0;
        const vec3 to_pole = {(float)(0.0625 * off), (float)(0.0625 * pole), 0.0f};
        const rod_motion motion = {NO_MOTION.turn, vec3_sub(to_pole, (vec3){0.0f, 0.0f, 0.0625f})};
        rod_joint delta[2];
        contour_base_motion(&model, (const rod_joint *)from.angle_rad, &motion, delta);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, off < 1e-6 ? 0.0 : 0.5 * PI, (double)delta[0][0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, pole * (0.5 * PI - atan(off)), (double)delta[0][1]);
    }
}

/* Eq. 10 has dphi in its first row and dtheta in its second, for a far end that moves; a base that
 * moves by d in its own axes moves the far end by -d. What is left falls with the square of the size. */
static void small_shift_is_eq_10_rows_swapped_and_minus(void)
{
    for (int round = 0; round < 50; round++) {
        random_params(1, 1, ROD_SCHEME_MIDPOINT, 0.0);
        prepare(1.0, 0.0);
        const double l = ref.length[0], theta = ref.x[0][0], phi = ref.x[0][1];
        const vec3 unit = unit_vec3();
        double worst[2];
        for (int i = 0; i < 2; i++) {
            const double size = i == 0 ? 1e-2 : 1e-3;
            const vec3 d = vec3_scale(unit, (float)(size * l));
            const double dx = (double)d.x, dy = (double)d.y, dz = (double)d.z;
            const double row1 =
                (-sin(phi) * sin(theta) * dx + cos(phi) * dy - cos(theta) * sin(phi) * dz) / l;
            const double row2 = (cos(theta) * dx - sin(theta) * dz) / (l * cos(phi));
            const rod_motion motion = {NO_MOTION.turn, vec3_scale(d, -1.0f)};
            rod_joint delta[2];
            contour_base_motion(&model, (const rod_joint *)from.angle_rad, &motion, delta);
            worst[i] = fmax(fabs((double)delta[0][0] + row2), fabs((double)delta[0][1] + row1));
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * size * size / pow(cos(phi), 2.0), 0.0, worst[i]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(25.0, 100.0, worst[0] / worst[1]);
    }
}

static void one_step(int n, int hold, int scheme, double smoothing_max, bool pushed)
{
    random_params(n, hold, scheme, smoothing_max);
    prepare(0.9, 0.1);
    rod_pose base[3];
    rod_joint torque[ROD_MAX_LINKS];
    base[0] = random_pose(&seed, 2.0);
    for (int i = 1; i < 3; i++) { /* steps of up to a third of a link and of 0.3 rad */
        const vec3 step = vec3_scale(unit_vec3(), (float)between(0.0, 0.3) * params.length_m[0]);
        base[i].position_m = vec3_add(base[i - 1].position_m, step);
        base[i].orientation =
            quat_multiply(base[i - 1].orientation, quat_about(unit_vec3(), between(0.0, 0.3)));
    }
    for (int i = 0; i < n; i++) {
        torque[i][0] = (float)between(-500.0, 500.0);
        torque[i][1] = (float)between(-500.0, 500.0);
    }
    const rod_motion previous = kinematics_motion(&base[0], &base[1]);
    const rod_motion now = kinematics_motion(&base[1], &base[2]);
    const rod_joint *q = pushed ? (const rod_joint *)torque : NULL;
    TEST_ASSERT_EQUAL_INT(ROD_OK, contour_step(&model, &from, &to, &previous, &now, q));

    ref.before_last = ref_pose_of(base[0]);
    ref.last = ref_pose_of(base[1]);
    ref_step(&ref, ref_pose_of(base[2]), q);
    /* node 1 is rounded as a point at l_1, and link 2 is seen from there */
    const bool two_held = hold == 2 && n > 1;
    const double rounding =
        step_rounding(2.0) * (two_held ? 1.0 + ref.length[0] / ref.length[1] : 1.0);
    for (int i = 0; i < n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(rounding, ref.x[i][axis], (double)to.angle_rad[i][axis]);
            TEST_ASSERT_DOUBLE_WITHIN(rounding, ref.g[i][axis], (double)to.increment_rad[i][axis]);
        }
    }
}

static void step_agrees_with_dense_matrices_in_double(void)
{
    static const int sizes[] = {1, 2, 3, 4, 10, HOST_OR_BOARD(50, 16)};
    for (int size = 0; size < 6 && sizes[size] <= ROD_MAX_LINKS; size++) {
        for (int option = 0; option < 16; option++) {
            const int n = sizes[size];
            const int rounds = n > 10 ? HOST_OR_BOARD(20, 1) : HOST_OR_BOARD(300, 3);
            const int scheme = option & 1 ? ROD_SCHEME_PAPER : ROD_SCHEME_MIDPOINT;
            for (int round = 0; round < rounds; round++) {
                one_step(n, option & 2 ? 2 : 1, scheme, option & 4 ? 200.0 : 0.0, option & 8);
            }
        }
    }
}

static void stop_holds_a_joint_at_its_limit_and_takes_its_speed(void)
{
    for (int option = 0; option < 4; option++) {
        const double sign = option & 1 ? 1.0 : -1.0;
        const int stopped = option & 2 ? 3 : 2; /* theta_2 or phi_2 */
        random_params(3, 1, ROD_SCHEME_MIDPOINT, 0.0);
        params.tick_s = 0.001f; /* too short for the spring to hold the joint */
        prepare(0.1, 0.001);
        set_joint(1, stopped - 2, 0.99 * sign * ref.limit[1], 0.1 * sign);
        TEST_ASSERT_EQUAL_INT(ROD_OK,
                              contour_step(&model, &from, &to, &NO_MOTION, &NO_MOTION, NULL));
        ref.limit[1] = 1e9; /* without its stop: the others have noticed nothing */
        ref_step(&ref, ref_pose_of(ORIGIN), NULL);
        for (int i = 0; i < 6; i++) {
            const double angle =
                i == stopped ? sign * (double)params.limit_rad[1] : ref.x[i / 2][i % 2];
            const double increment = i == stopped ? 0.0 : ref.g[i / 2][i % 2];
            const double rounding = i == stopped ? 0.0 : step_rounding(1.0);
            TEST_ASSERT_DOUBLE_WITHIN(rounding, angle, (double)to.angle_rad[i / 2][i % 2]);
            TEST_ASSERT_DOUBLE_WITHIN(rounding, increment, (double)to.increment_rad[i / 2][i % 2]);
        }
        TEST_ASSERT_TRUE(fabs(ref.x[1][stopped - 2]) > (double)params.limit_rad[1]);
    }
}

static double work_of(const rod_pose *base, const joint_double *angles, const vec3 *force)
{
    point_double node[REF_MAX + 1];
    double work = 0.0;
    nodes_double(base, angles, params.length_m, ref.n, node);
    for (int i = 0; i <= ref.n; i++) {
        work += (double)force[i].x * node[i][0] + (double)force[i].y * node[i][1] +
                (double)force[i].z * node[i][2];
    }
    return work;
}

static void torques_are_the_derivative_of_the_forces_work(void)
{
    static const int sizes[] = {1, 2, 10};
    const double h = 1e-5;
    for (int round = 0; round < HOST_OR_BOARD(300, 9); round++) {
        random_params(sizes[round % 3], 1, ROD_SCHEME_MIDPOINT, 0.0);
        prepare(1.4, 0.0);
        const rod_pose base = random_pose(&seed, 1.0);
        vec3 node[REF_MAX + 1], force[REF_MAX + 1];
        rod_joint torque[REF_MAX];
        double angles[REF_MAX][2];
        for (int i = 0; i <= ref.n; i++) {
            force[i] = random_vec3(&seed, 10.0);
        }
        kinematics_nodes(&base, (const rod_joint *)from.angle_rad, params.length_m, ref.n, node);
        contour_torques(&model, (const rod_joint *)from.angle_rad, &base, node, force, torque);
        memcpy(angles, ref.x, sizeof angles);
        for (int i = 0; i < ref.n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                angles[i][axis] = ref.x[i][axis] + h;
                const double after = work_of(&base, (const joint_double *)angles, force);
                angles[i][axis] = ref.x[i][axis] - h;
                const double before = work_of(&base, (const joint_double *)angles, force);
                angles[i][axis] = ref.x[i][axis];
                /* 10 forces of up to 17 N at up to 1 m, and nodes rounded at up to 2 m */
                TEST_ASSERT_DOUBLE_WITHIN(8.0 * EPS * 17.0 * ref.n, (after - before) / (2.0 * h),
                                          (double)torque[i][axis]);
            }
        }
    }
}

/* beta_1 = k = 0 and eta far above mu: M is singular but for an inertia that float32 cannot see. */
static void matrix_that_float32_cannot_factor_is_refused_with_its_row(void)
{
    int row_n;
    rod_params_defaults(&params);
    params.links_n = 3;
    params.tick_s = 0.1f;
    for (int i = 0; i < 3; i++) {
        params.inertia[i] = 1e-6f;
        params.spring[i] = params.damper[i] = params.coupling[i] = 0.0f;
        params.smoothing[i] = 1e6f;
    }
    TEST_ASSERT_EQUAL_INT(ROD_E_PIVOT, contour_prepare(&model, &params, 0.0f, &row_n));
    TEST_ASSERT_EQUAL_INT(3, row_n);
    params.smoothing[0] = params.smoothing[1] = 1e-3f;
    TEST_ASSERT_EQUAL_INT(ROD_OK, contour_prepare(&model, &params, 0.0f, &row_n));
}

static void step_that_is_not_finite_says_so(void)
{
    for (int option = 0; option < 4; option++) {
        random_params(4, 2, option & 1 ? ROD_SCHEME_PAPER : ROD_SCHEME_MIDPOINT, 0.0);
        prepare(0.5, 0.0);
        rod_joint torque[4] = {{0.0f}};
        torque[2][1] = option & 2 ? (float)NAN : 3e38f;
        const rod_error error =
            contour_step(&model, &from, &to, &NO_MOTION, &NO_MOTION, (const rod_joint *)torque);
        TEST_ASSERT_EQUAL_INT(option & 2 ? ROD_E_NOT_FINITE : ROD_OK, error);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(base_motion_is_exact_geometry_from_nanometres_to_teleports);
    RUN_TEST(far_end_on_its_joint_turns_neither_it_nor_the_next);
    RUN_TEST(theta_stays_where_the_new_direction_is_the_pole);
    RUN_TEST(small_shift_is_eq_10_rows_swapped_and_minus);
    RUN_TEST(step_agrees_with_dense_matrices_in_double);
    RUN_TEST(stop_holds_a_joint_at_its_limit_and_takes_its_speed);
    RUN_TEST(torques_are_the_derivative_of_the_forces_work);
    RUN_TEST(matrix_that_float32_cannot_factor_is_refused_with_its_row);
    RUN_TEST(step_that_is_not_finite_says_so);
    return UNITY_END();
}
