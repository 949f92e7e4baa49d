/* Where the print is wrong or open (firmware/core/MODEL.md has the table): each row shown to fail as
 * printed, and to hold as it is here. "Eq." is the paper's. */
#include "driven_rod.h"
#include "penta.h"

static const rod_pose STILL = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
static const vec3 Y = {0.0f, 1.0f, 0.0f};
static rod r;

void setUp(void) {}

void tearDown(void) {}

enum { SNAKE_N = ROD_MAX_LINKS < 50 ? ROD_MAX_LINKS : 50 };

/* B = 2 mu - 2 dt^2 A of a free contour of SNAKE_N elements with no drag, mu = 0.2 at 100 Hz; alpha = 0,
 * so that A is sign * D2' beta D2: printed with +1, derived from Eqs. 2 and 3 with -1. */
static void b_of_eq5(ref_square b, double beta, double sign)
{
    float alpha_rows[SNAKE_N] = {0.0f}, beta_rows[SNAKE_N] = {0.0f};
    memset(b, 0, sizeof(ref_square));
    for (int i = 0; i < SNAKE_N; i++) {
        b[i][i] = 2.0 * 0.2;
        beta_rows[i] = i > 0 ? (float)beta : 0.0f; /* a free end has no second difference */
    }
    ref_add_inner(b, SNAKE_N, -2.0 * 1e-4 * sign, alpha_rows, beta_rows);
}

static void eq5_as_printed_has_beta_with_the_opposite_sign_of_alpha(void)
{
    enum { N = 8 };
    uint32_t seed = 5;
    float alpha[N + 1] = {0.0f}, beta[N + 1] = {0.0f}, minus_alpha[N + 1] = {0.0f};
    for (int i = 1; i < N; i++) { /* alpha_i ties i to i-1, beta_i sits at i */
        alpha[i] = (float)random_between(&seed, 1.0, 2.0);
        beta[i] = i < N - 1 ? (float)random_between(&seed, 1.0, 2.0) : 0.0f;
        minus_alpha[i] = -alpha[i];
    }
    static ref_square mixed;
    ref_add_inner(mixed, N, 1.0, minus_alpha, beta); /* -D1' alpha D1 + D2' beta D2 */
    for (int i = 1; i < N - 1; i++) {                /* the row exactly as printed */
        const float printed[5] = {
            i > 1 ? beta[i - 1] : 0.0f, alpha[i] - 2.0f * beta[i - 1] - 2.0f * beta[i],
            -alpha[i + 1] - alpha[i] + beta[i - 1] + 4.0f * beta[i] + beta[i + 1],
            alpha[i + 1] - 2.0f * beta[i] - 2.0f * beta[i + 1], beta[i + 1]};
        for (int band = 0; band < 5; band++) {
            const int j = i + band - 2;
            if (j >= 0 && j < N) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, mixed[i][j], (double)printed[band]);
            }
        }
    }
}

static int first_bad_pivot(double beta, double sign)
{
    static ref_square b;
    float diagonal[SNAKE_N], off1[SNAKE_N] = {0.0f}, off2[SNAKE_N] = {0.0f};
    penta factor;
    b_of_eq5(b, beta, sign);
    for (int i = 0; i < SNAKE_N; i++) {
        diagonal[i] = (float)b[i][i];
        off1[i] = i > 0 ? (float)b[i][i - 1] : 0.0f;
        off2[i] = i > 1 ? (float)b[i][i - 2] : 0.0f;
    }
    return penta_factor(&factor, SNAKE_N, diagonal, off1, off2);
}

/* D2' D2 has eigenvalues up to 16 (from below, as the contour gets longer). */
static void eq5_as_printed_is_indefinite_from_beta_dt2_of_a_sixteenth_of_mu(void)
{
    TEST_ASSERT_EQUAL_INT(0, first_bad_pivot(125.0, 1.0));
    TEST_ASSERT_GREATER_THAN_INT(0, first_bad_pivot(126.0, 1.0));
    TEST_ASSERT_EQUAL_INT(0, first_bad_pivot(1e6, -1.0));
}

/* The largest its middle gets, from at most 1e-3 everywhere. */
static double free_contour_in_100_ticks(double beta, double sign)
{
    static ref_square b;
    double now[REF_MAX], before[REF_MAX], next[REF_MAX], largest = 0.0;
    uint32_t seed = 7;
    for (int i = 0; i < SNAKE_N; i++) {
        now[i] = before[i] = random_between(&seed, -1e-3, 1e-3);
    }
    for (int tick = 0; tick < 100; tick++) {
        b_of_eq5(b, beta, sign);
        for (int i = 0; i < SNAKE_N; i++) {
            next[i] = 4.0 * 0.2 * now[i] - 2.0 * 0.2 * before[i];
        }
        ref_solve(SNAKE_N, b, next);
        memcpy(before, now, sizeof now);
        memcpy(now, next, sizeof next);
        largest = fmax(largest, fabs(now[SNAKE_N / 2]));
    }
    return largest;
}

static void eq5_as_printed_lets_the_free_contour_grow(void)
{
    TEST_ASSERT_TRUE(free_contour_in_100_ticks(1.0, 1.0) > 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, free_contour_in_100_ticks(1.0, -1.0));
}

static void gamma_is_a_drag_and_no_time_step(void)
{
    for (int option = 0; option < 4; option++) {
        const double rate_hz = option & 1 ? 500.0 : 1000.0, gamma = option & 2 ? 0.5 : 1.0;
        rod_params params = uniform_rod(1, rate_hz, 80.0, 0.0, 0.0);
        double last = 0.5, peak = 0.0;
        int crossings = 0;
        params.drag[0] = (float)gamma;
        start_rod(&r, &params, STILL);
        bend_rod(&r, last);
        for (int n = 1; n <= (int)rate_hz; n++) {
            step_rod(&r, STILL);
            const double now = rod_angle(&r, 0, ROD_THETA);
            crossings += (now < 0.0) != (last < 0.0);
            peak = n > 0.84 * rate_hz ? fmax(peak, fabs(now)) : 0.0; /* the last half wave's */
            last = now;
        }
        /* sqrt(k / mu) = 20 rad/s passes zero 6 times a second, whatever gamma and dt are; gamma
         * takes exp(-gamma t / 2 mu), t being six half waves at the last peak */
        TEST_ASSERT_EQUAL_INT(6, crossings);
        const double left = exp(-gamma * (6.0 * PI / 20.0) / (2.0 * 0.2));
        TEST_ASSERT_DOUBLE_WITHIN(0.03, 1.0, peak / (0.5 * left));
    }
}

/* A hand that turns steadily at w drags its rod behind, k theta = -gamma w; the joint is at rest. */
static void drag_acts_in_the_world_and_the_damper_on_the_joint(void)
{
    for (int drags = 0; drags < 2; drags++) {
        rod_params params = uniform_rod(1, 500.0, 80.0, drags ? 0.0 : 1.0, 0.0);
        params.drag[0] = drags ? 1.0f : 0.0f;
        start_rod(&r, &params, STILL);
        for (int n = 1; n <= 5000; n++) {
            step_rod(&r, base_turned(Y, 2.0 * n / 500.0));
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, drags ? -2.0 / 80.0 : 0.0, rod_angle(&r, 0, ROD_THETA));
    }
}

/* How far first * second carries the z axis from the link's own direction. */
static double off_the_link(matrix3 first, matrix3 second, const double angle[2])
{
    const ref_vec z = {{0.0, 0.0, 1.0}};
    const matrix3 turn = matrix3_product(&first, &second);
    return ref_norm(ref_plus(ref_to_world(turn, z), -1.0, ref_direction(angle)));
}

static void eq6_z_lies_along_the_link_in_one_order_and_sign_only(void)
{
    const double angle[2] = {0.5, 0.4};
    const matrix3 about_y = matrix3_about_y(0.5);
    const matrix3 plus = matrix3_about_x(0.4), minus = matrix3_about_x(-0.4);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, off_the_link(about_y, minus, angle));
    TEST_ASSERT_TRUE(off_the_link(plus, about_y, angle) > 0.7); /* as printed */
    TEST_ASSERT_TRUE(off_the_link(minus, about_y, angle) > 0.05);
    TEST_ASSERT_TRUE(off_the_link(about_y, plus, angle) > 0.5);

    /* so that here a straight joint continues the link before it */
    const rod_joint bend[2] = {{0.5f, 0.4f}, {0.0f, 0.0f}};
    const float length_m[2] = {1.0f, 1.0f};
    const ref_vec along = ref_direction(angle);
    vec3 node[3];
    kinematics_nodes(&STILL, bend, length_m, 2, node);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0 * along.at[0], (double)node[2].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0 * along.at[1], (double)node[2].y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.0 * along.at[2], (double)node[2].z);
}

static void theta_turns_about_y_and_phi_about_x(void)
{
    const double theta_only[2] = {0.5, 0.0}, phi_only[2] = {0.0, 0.4};
    const matrix3 none = matrix3_about_x(0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, off_the_link(matrix3_about_y(0.5), none, theta_only));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, off_the_link(matrix3_about_x(-0.4), none, phi_only));
    TEST_ASSERT_TRUE(off_the_link(matrix3_about_x(0.5), none, theta_only) > 0.5); /* as printed */
    TEST_ASSERT_TRUE(off_the_link(matrix3_about_y(0.4), none, phi_only) > 0.5);
}

/* 1/2 c thetadot^2 does not contain theta. With thetadot = (theta - theta_before) / dt its gradient is
 * c g / dt^2, which brakes by the factor 1 - c / mu in a tick, however short. As the dissipation
 * function it is, it brakes by exp(-c t / mu). */
static void eq8_is_a_dissipation_function_as_an_energy_it_would_brake_per_tick(void)
{
    double printed_left[2];
    for (int i = 0; i < 2; i++) {
        const double rate_hz = i == 0 ? 500.0 : 1000.0, c = 0.1, mu = 0.2;
        const rod_params params = uniform_rod(1, rate_hz, 0.0, c, 0.0);
        start_rod(&r, &params, STILL);
        r.as.contour.state[r.as.contour.current].increment_rad[0][0] =
            (float)(1.0 / rate_hz); /* 1 rad/s */
        printed_left[i] = 1.0;
        for (int n = 0; n < (int)(0.2 * rate_hz); n++) {
            step_rod(&r, STILL);
            printed_left[i] *= 1.0 - c / mu;
        }
        const double left =
            (double)r.as.contour.state[r.as.contour.current].increment_rad[0][0] * rate_hz;
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, exp(-c * 0.2 / mu), left);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 2.0, log(printed_left[1]) / log(printed_left[0]));
}

static void base_motion(const double angle[2], quat turn, vec3 shift_m, rod_joint delta[2])
{
    const rod_params params = uniform_rod(1, 100.0, 80.0, 0.0, 0.0); /* a link of 0.03 m */
    const rod_joint x[1] = {{(float)angle[0], (float)angle[1]}};
    const rod_motion motion = {turn, shift_m};
    contour model;
    int row_n;
    TEST_ASSERT_EQUAL_INT(ROD_OK, contour_prepare(&model, &params, 0.0f, &row_n));
    contour_base_motion(&model, x, &motion, delta);
}

static void eq9_gives_absolute_angles_and_the_complement_of_phi(void)
{
    const double angle[2] = {0.3, 0.2}; /* and a base that does not move */
    const ref_vec p = ref_direction(angle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.3, -atan(p.at[0] / p.at[2]));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -(0.5 * PI - 0.2), -acos(p.at[1]));
    rod_joint delta[2];
    base_motion(angle, STILL.orientation, STILL.position_m, delta);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, delta[0][ROD_THETA]);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, delta[0][ROD_PHI]);
}

static void eq9_arctan_loses_the_quadrant(void)
{
    const double straight[2] = {0.0, 0.0};
    const ref_vec z = {{0.0, 0.0, 1.0}};
    const ref_vec seen = ref_from_world(matrix3_about_y(2.5), z); /* the base turned by 2.5 rad */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, PI - 2.5, atan(seen.at[0] / seen.at[2]));
    rod_joint delta[2];
    base_motion(straight, quat_about(Y, -2.5), STILL.position_m, delta);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -2.5, (double)delta[0][ROD_THETA]);
}

static void eq10_rows_are_swapped_and_the_sign_is_minus(void)
{
    const double l = 0.03, theta = 0.3, phi = 0.2, angle[2] = {theta, phi};
    for (int axis = 0; axis < 3; axis++) { /* the base moves by l / 1000 along x, y or z */
        double d[3] = {0.0, 0.0, 0.0};
        rod_joint delta[2];
        d[axis] = 1e-3 * l;
        const double first = /* exactly as printed */
            (-sin(phi) * sin(theta) * d[0] + cos(phi) * d[1] - cos(theta) * sin(phi) * d[2]) / l;
        const double second = (cos(theta) * d[0] - sin(theta) * d[2]) / (l * cos(phi));
        base_motion(angle, STILL.orientation, (vec3){(float)-d[0], (float)-d[1], (float)-d[2]},
                    delta);
        const double dtheta = (double)delta[0][ROD_THETA], dphi = (double)delta[0][ROD_PHI];
        TEST_ASSERT_DOUBLE_WITHIN(2e-6, -second, dtheta);
        TEST_ASSERT_DOUBLE_WITHIN(2e-6, -first, dphi);
        TEST_ASSERT_TRUE(hypot(first - dtheta, second - dphi) > 1e-4);
        TEST_ASSERT_TRUE(hypot(second - dtheta, first - dphi) > 1e-4); /* swapped back only */
        TEST_ASSERT_TRUE(hypot(-first - dtheta, -second - dphi) > 1e-4);
    }
}

static void eq7_with_theta_0_is_not_bisymmetric_and_ties_joint_1_to_the_hand(void)
{
    for (int tied = 0; tied < 2; tied++) {
        rod_params params = uniform_rod(4, 1000.0, 0.0, 0.0, 100.0);
        params.coupling[0] = tied ? 100.0f : 0.0f;
        static ref_rod ref;
        ref_init(&ref, &params, ROD_SCHEME_MIDPOINT, ref_pose_of(STILL));
        for (int i = 0; i < 16; i++) { /* seen from the other corner */
            const int row = i / 4, column = i % 4;
            const double mirrored = ref.K[3 - row][3 - column] - ref.K[row][column];
            const double expected = i == 0 ? -100.0 : i == 15 ? 100.0 : 0.0;
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, tied ? expected : 0.0, mirrored);
        }
        /* bent the same at all joints: only the hand can pull */
        start_rod(&r, &params, STILL);
        bend_rod(&r, 0.3);
        for (int n = 0; n < 100; n++) {
            step_rod(&r, STILL);
        }
        TEST_ASSERT_EQUAL_INT(tied, fabs(rod_angle(&r, 0, ROD_THETA) - 0.3) > 1e-6);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(eq5_as_printed_has_beta_with_the_opposite_sign_of_alpha);
    RUN_TEST(eq5_as_printed_is_indefinite_from_beta_dt2_of_a_sixteenth_of_mu);
    RUN_TEST(eq5_as_printed_lets_the_free_contour_grow);
    RUN_TEST(gamma_is_a_drag_and_no_time_step);
    RUN_TEST(drag_acts_in_the_world_and_the_damper_on_the_joint);
    RUN_TEST(eq6_z_lies_along_the_link_in_one_order_and_sign_only);
    RUN_TEST(theta_turns_about_y_and_phi_about_x);
    RUN_TEST(eq8_is_a_dissipation_function_as_an_energy_it_would_brake_per_tick);
    RUN_TEST(eq9_gives_absolute_angles_and_the_complement_of_phi);
    RUN_TEST(eq9_arctan_loses_the_quadrant);
    RUN_TEST(eq10_rows_are_swapped_and_the_sign_is_minus);
    RUN_TEST(eq7_with_theta_0_is_not_bisymmetric_and_ties_joint_1_to_the_hand);
    return UNITY_END();
}
