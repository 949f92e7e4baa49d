/* elastic.c and elastic_step.c as physics: frequency, damping, energy, momentum, weight, and the order in dt. */
#include "elastic_fixture.h"

/* --- one link, where the answers are known ------------------------------------------------------ */

static const double BEND = 0.02; /* so small that sines are angles, to 1e-4 */

static void lay_one_link(double tick_s)
{
    const rod_joint bent = {(float)BEND, 0.0f};
    params.links_n = 1;
    params.tick_s = (float)tick_s;
    params.length_m[0] = 0.5f;
    params.mass_kg[0] = 0.1f;
    params.spring[0] = 250.0f; /* 100 rad/s */
    lay(&state, &ORIGIN, &bent);
}

static double energy(void)
{
    double sum = 0.0;
    vec3 before = {0.0f, 0.0f, 1.0f};
    for (int i = 0; i < params.links_n; i++) {
        const double chord = length_double(vec3_sub(state.link[i], before));
        const double bend = 2.0 * asin(fmin(1.0, 0.5 * chord));
        sum += 0.5 * (double)params.mass_kg[i] * pow(length_double(state.speed_m_s[i]), 2.0) +
               0.5 * (double)params.spring[i] * bend * bend;
        before = state.link[i];
    }
    return sum;
}

/* omega = sqrt(k / m) / l, less omega^3 dt^2 / 3 of BDF2; the energy falls by (omega dt)^4 / 2 a tick. */
static void free_link_swings_as_bdf2_has_it(void)
{
    static const double TICKS_S[] = {0.001, 0.0005};
    for (int i = 0; i < 2; i++) {
        const double z = 100.0 * TICKS_S[i];
        const int ticks_n = (int)(20.0 / z);
        lay_one_link(TICKS_S[i]);
        rest(&state, &ORIGIN, 10); /* the start at rest is no free swing's */
        const double start = energy();
        const double phase = atan2((double)state.speed_m_s[0].x / 50.0, (double)state.link[0].x);
        rest(&state, &ORIGIN, ticks_n);
        const double lost = ticks_n * pow(z, 4.0) / 2.0;
        const double turned =
            phase - atan2((double)state.speed_m_s[0].x / 50.0, (double)state.link[0].x);
        const double expected = ticks_n * (z - pow(z, 3.0) / 3.0);
        TEST_ASSERT_DOUBLE_WITHIN(0.1 * lost, lost, 1.0 - energy() / start);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.0, remainder(turned - expected, 2.0 * PI));
    }
}

/* With damper and drag the amplitude falls as exp(-(c / l^2 + gamma) t / 2 m), to what dt^2 makes of it. */
static void damper_and_drag_take_what_they_should(void)
{
    for (int option = 1; option < 4; option++) {
        params.damper[0] = option & 1 ? 0.05f : 0.0f;
        params.drag[0] = option & 2 ? 0.2f : 0.0f;
        lay_one_link(0.0001);
        const double start = energy();
        rest(&state, &ORIGIN, 628); /* a period */
        const double rate = ((double)params.damper[0] / 0.25 + (double)params.drag[0]) / 0.1;
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, log(start / energy()) / (rate * 0.0001 * 628));
    }
}

/* A link at rest, bent by alpha: how fast it is after a tick in which a force is at it that has the torque. */
static double speed_against(double alpha, double torque)
{
    const rod_joint bent = {(float)alpha, 0.0f};
    const double newton = torque / (double)params.length_m[0];
    const vec3 force[2] = {{0.0f, 0.0f, 0.0f},
                           {(float)(newton * cos(alpha)), 0.0f, (float)(-newton * sin(alpha))}};
    lay(&state, &ORIGIN, &bent);
    TEST_ASSERT_TRUE(step_pushed(&state, &ORIGIN, &ORIGIN, force));
    const vec3 v = state.speed_m_s[0];
    return (double)v.x * cos(alpha) - (double)v.z * sin(alpha);
}

/* Where a force of the torque k alpha balances the spring, nothing moves: to the springs' approximation, and to the
 * roundoff of the link's direction. Beyond 143 degrees the torque falls with sin alpha, to none at the fold. */
static void torque_of_a_joint_is_k_alpha(void)
{
    const double capped = 2.0 * asin(sqrt(0.9));
    params.links_n = 1;
    params.spring[0] = 1.7f;
    for (int degrees = 2; degrees < 180; degrees += 2) {
        const double alpha = degrees * PI / 180.0;
        const double k_alpha =
            (double)params.spring[0] * (alpha < capped ? alpha : capped / sin(capped) * sin(alpha));
        const double approximation = degrees <= 66 ? 1.5e-5 : 5e-4;
        const double free_fall = speed_against(alpha, 0.0);
        const double rounding = 2.0 * EPS * fabs(speed_against(0.5 * PI, 0.0)) * 4.0;
        TEST_ASSERT_TRUE(free_fall < 0.0);
        TEST_ASSERT_DOUBLE_WITHIN(approximation * fabs(free_fall) + rounding, 0.0,
                                  speed_against(alpha, k_alpha));
    }
}

/* --- many links -------------------------------------------------------------------------------- */

static void lay_arc(int links_n, double tick_s, double bend)
{
    rod_joint bent[ROD_MAX_LINKS] = {{0.0f}};
    for (int i = 0; i < links_n; i++) {
        bent[i][ROD_THETA] = (float)bend;
        bent[i][ROD_PHI] = (float)(0.3 * bend);
    }
    params.links_n = links_n;
    params.tick_s = (float)tick_s;
    lay(&state, &ORIGIN, (const rod_joint *)bent);
}

/* The share of its energy that a rod let go as an arc has lost after half a second; it never has more. BDF2 takes it
 * from the fast modes, which this tick or that resolves more or less of. */
static double lost_share(double tick_s)
{
    lay_arc(8, tick_s, 0.3);
    const double start = energy();
    for (int i = 0; i < (int)(0.5 / tick_s); i++) {
        rest(&state, &ORIGIN, 1);
        TEST_ASSERT_TRUE(energy() < start * 1.001);
    }
    return 1.0 - energy() / start;
}

static void free_rod_never_gains_energy(void)
{
    const double coarse = lost_share(0.001), fine = lost_share(0.0005);
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 0.004, fine);
    TEST_ASSERT_DOUBLE_WITHIN(0.006, 0.018, coarse);
}

enum { PLACES_N = 50 };

/* Where the tip of a rod comes through whose base goes smoothly aside and back, turning. */
static void record_tip(double tick_s, vec3 *tip_m)
{
    rod_pose last = ORIGIN;
    lay_arc(4, tick_s, 0.0);
    const int ticks_n = (int)lround(0.2 / tick_s);
    for (int i = 1; i <= ticks_n; i++) {
        const double share = pow(sin(PI * i / ticks_n), 4.0);
        const rod_pose hand = {
            {(float)(0.3 * share), 0.0f, 0.0f},
            quat_about((vec3){0.3f, 1.0f, 1.0f}, share * sin(2.4 * i / ticks_n))};
        step(&state, &last, &hand);
        last = hand;
        if (i % (ticks_n / PLACES_N) == 0) {
            elastic_nodes(&model, &state, &last, nodes);
            *tip_m++ = nodes[4];
        }
    }
}

static double rms_difference(const vec3 *a, const vec3 *b)
{
    double sum = 0.0;
    for (int i = 0; i < PLACES_N; i++) {
        sum += pow(length_double(vec3_sub(a[i], b[i])), 2.0);
    }
    return sqrt(sum / PLACES_N);
}

/* Four times less error at half the tick. A damper, of which the matrix holds more than acts, costs a little of that:
 * what it does to a bent rod that gains speed as a whole is of first order. */
static void error_falls_with_the_square_of_the_tick(void)
{
    static vec3 tip_m[3][PLACES_N];
    for (int damped = 0; damped < 2; damped++) {
        for (int i = 0; i < 3; i++) {
            setUp();
            params.gravity_m_s2 = 9.81f;
            for (int k = 0; k < 4; k++) {
                params.spring[k] = 32.0f;
                params.damper[k] = damped ? 0.08f : 0.0f;
            }
            record_tip(0.001 / (1 << i), tip_m[i]);
        }
        const double coarse = rms_difference(tip_m[0], tip_m[1]);
        const double fine = rms_difference(tip_m[1], tip_m[2]);
        TEST_ASSERT_DOUBLE_WITHIN(0.3, damped ? 3.6 : 4.0, coarse / fine);
    }
}

/* Springs and pulls act between nodes, so the nodes' momentum is the forces', across the first link: that pulls
 * along itself only. The first two joints, which have the base at one end, have no springs. */
static void momentum_is_the_external_forces(void)
{
    static vec3 force[ROD_MAX_LINKS + 1];
    for (int round = 0; round < 20; round++) {
        rod_joint bent[ROD_MAX_LINKS] = {{0.0f}};
        double expected[2] = {0.0, 0.0}, found[2] = {0.0, 0.0};
        const int n = params.links_n = 3 + random_below(&seed, 8);
        params.tick_s = 5e-4f; /* in which the first link hardly turns, by 1e-3 */
        params.spring[0] = params.spring[1] = 0.0f;
        for (int i = 0; i < n; i++) {
            for (int axis = 0; axis < 2 && i >= 2; axis++) {
                bent[i][axis] = (float)random_between(&seed, -0.2, 0.2);
            }
            force[i + 1] = random_vec3(&seed, 1.0);
            expected[0] += (double)force[i + 1].x;
            expected[1] += (double)force[i + 1].y;
        }
        lay(&state, &ORIGIN, (const rod_joint *)bent);
        TEST_ASSERT_TRUE(step_pushed(&state, &ORIGIN, &ORIGIN, force));
        for (int i = 0; i < n; i++) {
            const double per_h = (double)params.mass_kg[i] / (double)model.h_s;
            found[0] += per_h * (double)state.speed_m_s[i].x;
            found[1] += per_h * (double)state.speed_m_s[i].y;
        }
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(0.02, expected[axis], found[axis]);
        }
    }
}

/* A link carries the weight beyond it, hanging or standing. */
static void links_pull_by_the_weight_beyond_them(void)
{
    params.links_n = 10;
    params.gravity_m_s2 = 98.1f; /* more than the rounding of places pulls */
    params.spring[0] = 200.0f;   /* stands */
    for (int hanging = 0; hanging < 2; hanging++) {
        const rod_pose base = {ORIGIN.position_m,
                               hanging ? (quat){1.0f, 0.0f, 0.0f, 0.0f} : ORIGIN.orientation};
        double weight = 0.0;
        lay(&state, &base, STRAIGHT);
        rest(&state, &base, 50);
        for (int i = 9; i >= 0; i--) {
            const double pull = (double)state.tension[i] / pow((double)model.h_s, 2.0);
            weight += 98.1 * (double)params.mass_kg[i];
            TEST_ASSERT_DOUBLE_WITHIN(1e-3 * weight, hanging ? weight : -weight, pull);
        }
    }
}

/* A rod that gravity and the turn have bent goes round with its base as one piece: its dampers have nothing to
 * resist, and whatever they are the shape is the same. */
static void dampers_do_not_see_a_bent_rod_go_round(void)
{
    const quat tilt = quat_about((vec3){0.0f, 1.0f, 0.0f}, 1.0);
    rod_joint shape[2][6];
    params.links_n = 6;
    params.gravity_m_s2 = 9.81f;
    for (int i = 0; i < 6; i++) {
        params.length_m[i] = 0.05f;
    }
    for (int option = 0; option < 2; option++) {
        rod_pose last = {ORIGIN.position_m, tilt};
        for (int i = 0; i < 6; i++) {
            params.damper[i] = option ? 0.2f : 0.05f;
        }
        lay(&state, &last, STRAIGHT);
        for (int i = 1; i <= 8000; i++) {
            const double t = 0.001 * i; /* comes up to speed in a second */
            const double turned = t < 1.0 ? 2.5 * t * t : 5.0 * t - 2.5;
            const quat turn = quat_about((vec3){0.0f, 0.0f, 1.0f}, fmod(turned, 4.0 * PI));
            const rod_pose hand = {ORIGIN.position_m, quat_multiply(turn, tilt)};
            step(&state, &last, &hand);
            last = hand;
        }
        memcpy(shape[option], state.angle_rad, sizeof shape[option]);
    }
    TEST_ASSERT_TRUE(fabsf(shape[0][0][ROD_THETA]) > 0.1f);
    for (int i = 0; i < 6; i++) {
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_FLOAT_WITHIN(2e-4f, shape[0][i][axis], shape[1][i][axis]);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(free_link_swings_as_bdf2_has_it);
    RUN_TEST(damper_and_drag_take_what_they_should);
    RUN_TEST(torque_of_a_joint_is_k_alpha);
    RUN_TEST(free_rod_never_gains_energy);
    RUN_TEST(error_falls_with_the_square_of_the_tick);
    RUN_TEST(momentum_is_the_external_forces);
    RUN_TEST(links_pull_by_the_weight_beyond_them);
    RUN_TEST(dampers_do_not_see_a_bent_rod_go_round);
    return UNITY_END();
}
