/* One step of elastic_step.c against the same mathematics in double (reference_elastic_step.h). */
#include <float.h>

#include "elastic.h"
#include "reference_elastic_step.h"
#include "unity.h"

static const double EPS = (double)FLT_EPSILON;

static uint32_t seed;
static rod_params params;
static elastic model;
static elastic_state state;
static rod_pose from, to;
static ref_elastic ref;

void setUp(void)
{
    seed = 57;
}

void tearDown(void) {}

static double between(double low, double high)
{
    return random_between(&seed, low, high);
}

static ref_vec ref_of(vec3 v)
{
    return (ref_vec){{(double)v.x, (double)v.y, (double)v.z}};
}

/* A metre of rod of 0.1 to 0.4 kg in n links, so soft that its bending shows. */
static void random_params(int n, bool damped)
{
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.links_n = n;
    params.tick_s = (float)random_magnitude(&seed, 1e-4, 1e-3);
    params.gravity_m_s2 = (float)(random_below(&seed, 2) * 9.81);
    const double drag_max = random_below(&seed, 2) * 0.5;
    for (int i = 0; i < n; i++) {
        params.length_m[i] = (float)(between(0.5, 1.5) / n);
        params.mass_kg[i] = (float)(between(0.1, 0.4) / n);
        params.drag[i] = (float)between(0.0, drag_max);
        params.spring[i] = (float)between(0.0, 8.0);
        params.damper[i] = (float)between(0.0, damped ? 0.3 / n : 0.0);
    }
    int row_n;
    TEST_ASSERT_EQUAL_INT(ROD_OK, elastic_prepare(&model, &params, false, &row_n));
    ref_elastic_init(&ref, &params);
}

/* A vector of the same length, turned by up to `angle`. */
static vec3 turned(vec3 v, double angle)
{
    return quat_rotate(quat_about(random_vec3(&seed, 1.0), between(0.0, angle)), v);
}

/* BDF2's memory is off its last value by a third of the last change. */
static vec3 step_to(vec3 last, vec3 bar)
{
    return vec3_scale(vec3_sub(bar, last), 3.0f);
}

/* A chain that is going to be bent by up to `bend` in each joint if nothing acts, moving at some 3 m/s and 3 rad/s,
 * with pulls of some newtons. By itself it would keep its lengths; speeds that are `unlike` it do not. */
static void random_state(double bend, double unlike)
{
    const double dt = (double)params.tick_s, reach = 3.0 * dt;
    const vec3 z = {0.0f, 0.0f, 1.0f};
    memset(&state, 0, sizeof state);
    from = random_pose(&seed, 1.0);
    to.position_m = vec3_add(from.position_m, random_vec3(&seed, reach));
    to.orientation =
        quat_multiply(quat_about(random_vec3(&seed, 1.0), between(0.0, reach)), from.orientation);
    vec3 far_m = random_vec3(&seed, reach);
    state.base_step_m = step_to(from.position_m, vec3_sub(to.position_m, far_m));
    vec3 link = quat_rotate(to.orientation, z);
    vec3 turn = vec3_cross(random_vec3(&seed, reach), link);
    state.axis_step = step_to(quat_rotate(from.orientation, z), vec3_sub(link, turn));
    state.spin_step = (float)between(-reach, reach);
    for (int i = 0; i < params.links_n; i++) {
        link = turned(link, bend);
        turn = vec3_cross(random_vec3(&seed, reach), link);
        state.link[i] = turned(link, reach);
        state.link_step[i] = step_to(state.link[i], vec3_sub(link, turn));
        far_m = vec3_add_scaled(far_m, turn, params.length_m[i]);
        const vec3 speed_bar = vec3_add(vec3_scale(far_m, model.per_h), random_vec3(&seed, unlike));
        state.speed_m_s[i] = vec3_add(speed_bar, random_vec3(&seed, 20.0 * dt));
        state.speed_step[i] = step_to(state.speed_m_s[i], speed_bar);
        const double pull = 5.0 * (double)(model.h_s * model.h_s);
        state.tension[i] = (float)between(-pull, pull);
        state.tension_step[i] = (float)between(-0.5 * pull, 0.5 * pull);
    }
}

/* The same for the reference, which thinks in points. */
static void tell_reference(void)
{
    const ref_pose base = ref_pose_of(from);
    const ref_vec z = {{0.0, 0.0, 1.0}};
    const ref_vec axis = ref_to_world(base.axes, z);
    const ref_vec axis_before = ref_plus(axis, -1.0, ref_of(state.axis_step));
    const double squared = ref.h * ref.h;
    ref.axes = base.axes;
    ref.spin = (double)state.spin_step;
    ref.at[REF_BASE] = base.position;
    ref.at_before[REF_BASE] = ref_plus(base.position, -1.0, ref_of(state.base_step_m));
    ref.at[REF_GHOST] = ref_plus(ref.at[REF_BASE], -ref.length[0], axis);
    ref.at_before[REF_GHOST] = ref_plus(ref.at_before[REF_BASE], -ref.length[0], axis_before);
    for (int i = 0; i < ref.n; i++) {
        const ref_vec unit = ref_of(state.link[i]);
        const ref_vec unit_before = ref_plus(unit, -1.0, ref_of(state.link_step[i]));
        const int node = REF_NODE_1 + i;
        ref.at[node] = ref_plus(ref.at[node - 1], ref.length[i], unit);
        ref.at_before[node] = ref_plus(ref.at_before[node - 1], ref.length[i], unit_before);
        ref.speed[i] = ref_of(state.speed_m_s[i]);
        ref.speed_before[i] = ref_plus(ref.speed[i], -1.0, ref_of(state.speed_step[i]));
        ref.pull[i] = (double)state.tension[i] / squared;
        ref.pull_before[i] = ref.pull[i] - (double)state.tension_step[i] / squared;
    }
}

static double off(ref_vec expected, vec3 got)
{
    return ref_norm(ref_plus(expected, -1.0, ref_of(got)));
}
/* How much larger a force can be than the inertia that answers it, joints against nodes: what rounding a length
 * costs in the place of a node is that many times the length's last digit. */
static double amplification(void)
{
    double norm = 0.0, least = DBL_MAX;
    for (int i = 0; i < ref.n; i++) {
        double row = 0.0;
        for (int j = 0; j < ref.n; j++) {
            row += fabs(ref.matrix[i][j]);
        }
        norm = fmax(norm, row);
        least = fmin(least, ref.mass[i] / (ref.h * ref.h) + ref.drag[i] / ref.h);
    }
    return norm / least;
}

/* Near their bounds, float and double may take one Newton step more or less, or give up on lengths or not. */
static bool is_open(void)
{
    for (int i = 1; i <= ref.newton_n; i++) {
        const double error = ref.length_error[i];
        if ((error > 6e-7 && error < 1.6e-6) || (error > 0.7e-5 && error < 1.4e-5)) {
            return true;
        }
    }
    return false;
}

static void expect_unit_links(void)
{
    matrix3 frame = matrix3_of(to.orientation);
    double level = 1.0;
    for (int i = 0; i < ref.n; i++) {
        const float *angle = state.angle_rad[i];
        frame = matrix3_turned(&frame, (double)angle[ROD_THETA], (double)angle[ROD_PHI]);
        const ref_vec seen = {{frame.at[0][2], frame.at[1][2], frame.at[2][2]}};
        level = fmin(level, cos((double)angle[ROD_PHI])); /* near the pole phi loses digits */
        TEST_ASSERT_DOUBLE_WITHIN(8.0 * EPS * (i + 1) / level, 0.0, off(seen, state.link[i]));
        TEST_ASSERT_DOUBLE_WITHIN(2.0 * EPS, 1.0, length_double(state.link[i]));
    }
}

/* Where lengths are not found, only the directions are said to be right. */
static void expect_same_state(double rounding_m, bool found)
{
    const double squared = ref.h * ref.h;
    for (int i = 0; i < ref.n; i++) {
        const ref_vec unit = ref_scaled(ref_link(ref.at, i), 1.0 / ref.length[i]);
        TEST_ASSERT_DOUBLE_WITHIN(rounding_m / ref.length[i], 0.0, off(unit, state.link[i]));
        if (!found) {
            continue;
        }
        const ref_vec speed_step = ref_plus(ref.speed[i], -1.0, ref.speed_before[i]);
        TEST_ASSERT_DOUBLE_WITHIN(rounding_m / ref.h, 0.0, off(ref.speed[i], state.speed_m_s[i]));
        TEST_ASSERT_DOUBLE_WITHIN(rounding_m / ref.h, 0.0, off(speed_step, state.speed_step[i]));
        /* a pull is the sum of what the nodes beyond it miss */
        const double rounding_n = ref.n * rounding_m * ref.mass[i];
        TEST_ASSERT_DOUBLE_WITHIN(rounding_n, ref.pull[i] * squared, (double)state.tension[i]);
        TEST_ASSERT_DOUBLE_WITHIN(rounding_n, (ref.pull[i] - ref.pull_before[i]) * squared,
                                  (double)state.tension_step[i]);
    }
}

/* Beyond 66 degrees springs are approximated to 5e-4, and towards the fold a secant multiplies what q rounds by
 * 1 / (1 - q), up to 10. Returns false where nothing is to be compared. */
static bool one_step(bool pushed, bool folded)
{
    const double roundings = folded ? 40.0 : 4.0, approximation = folded ? 5e-4 : 0.0;
    vec3 force[ROD_MAX_LINKS + 1];
    for (int i = 0; i <= ref.n; i++) {
        force[i] = random_vec3(&seed, 3.0 / ref.n);
    }
    tell_reference();
    const rod_motion any = {from.orientation, from.position_m}; /* the tick is one step */
    const elastic_outside outside = {.forces_newton = pushed ? force : NULL};
    const bool found = elastic_step(&model, &state, &any, &from, &to, &outside);
    ref_elastic_step(&ref, ref_pose_of(to), pushed ? force : NULL);
    expect_unit_links();
    if (is_open()) {
        return false;
    }
    double longest = 0.0;
    for (int i = 0; i < ref.n; i++) {
        longest = fmax(longest, ref.length[i]);
    }
    const double times = amplification();
    TEST_ASSERT_EQUAL_INT(ref.length_error[ref.newton_n] <= 1e-5, found);
    expect_same_state((roundings * EPS * times + approximation * (times - 1.0)) * longest, found);
    return true;
}

static const int SIZES[] = {1, 2, 3, 4, 10, HOST_OR_BOARD(50, 16), HOST_OR_BOARD(64, 16)};

static void many_steps(double bend, double unlike, bool damped)
{
    for (int size = 0; size < 7 && SIZES[size] <= ROD_MAX_LINKS; size++) {
        const int n = SIZES[size];
        const int rounds = n > 10 ? HOST_OR_BOARD(20, 1) : HOST_OR_BOARD(300, 4);
        int open = 0;
        for (int round = 0; round < rounds; round++) {
            random_params(n, damped);
            random_state(bend, unlike);
            open += !one_step(round % 2, false);
        }
        TEST_ASSERT_TRUE(2 * open < rounds + 2);
    }
}

static void step_agrees_with_dense_matrices_in_double(void)
{
    many_steps(0.0, 0.0, true);
    many_steps(0.3, 0.0, true);
    many_steps(1.0, 0.0, true);
}

static void step_agrees_where_speeds_do_not_keep_the_lengths(void)
{
    many_steps(0.3, 0.5, false);
    many_steps(1.0, 0.05, false);
}

static void step_agrees_in_folded_joints(void)
{
    for (int round = 0; round < HOST_OR_BOARD(600, 20); round++) {
        random_params(1 + round % 3, false);
        random_state(3.1, 0.0);
        one_step(round % 2, true);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(step_agrees_with_dense_matrices_in_double);
    RUN_TEST(step_agrees_where_speeds_do_not_keep_the_lengths);
    RUN_TEST(step_agrees_in_folded_joints);
    return UNITY_END();
}
