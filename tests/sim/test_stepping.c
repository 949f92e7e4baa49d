/* What firmware/core/MODEL.md says of the time stepping itself: energy, order, stability, rounding, and
 * what `scheme = paper` tends to. Each fails on either side of its number. */
#include "driven_rod.h"

static const rod_pose STILL = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
static rod r;
static ref_rod ref;

void setUp(void) {}

void tearDown(void) {}

static void start_bent(const rod_params *params, double angle_rad)
{
    start_rod(&r, params, STILL);
    bend_rod(&r, angle_rad);
}

/* The largest angle met in so many ticks. */
static double rest(int ticks)
{
    double largest = 0.0;
    for (int n = 0; n < ticks; n++) {
        step_rod(&r, STILL);
        largest = fmax(largest, largest_angle(&r));
    }
    return largest;
}

/* --- a base that rests --------------------------------------------------------------------------- */

/* What a step without damping conserves: the last increment's kinetic energy, and the elastic energy
 * half way along it. */
static double energy(const rod_params *params)
{
    double sum = 0.0;
    const contour_state *state = &r.as.contour.state[r.as.contour.current];
    ref_init(&ref, params, ROD_SCHEME_MIDPOINT, ref_pose_of(STILL));
    for (int axis = 0; axis < 2; axis++) {
        double x[REF_MAX];
        for (int i = 0; i < ref.n; i++) {
            const double g = (double)state->increment_rad[i][axis];
            x[i] = (double)state->angle_rad[i][axis] - 0.5 * g;
            sum += 0.5 * ref.mu[i] * g * g / (ref.dt * ref.dt);
        }
        for (int i = 0; i < ref.n; i++) {
            for (int j = 0; j < ref.n; j++) {
                sum += 0.5 * x[i] * ref.K[i][j] * x[j];
            }
        }
    }
    return sum;
}

static void step_adds_no_damping_energy_stays_for_100000_ticks(void)
{
    for (int option = 0; option < 4; option++) {
        rod_params params = uniform_rod(4, option & 1 ? 100.0 : 1000.0, 80.0, 0.0, 100.0);
        params.smoothing[0] = params.smoothing[1] = params.smoothing[2] = 30.0f;
        params.damper[0] = option & 2 ? 1e-3f : 0.0f; /* a trace, in one joint: enough to be seen */
        start_bent(&params, 0.5);
        r.as.contour.state[0].angle_rad[3][ROD_THETA] = 0.1f; /* so that all four modes swing */
        const double before = energy(&params);
        TEST_ASSERT_TRUE(rest(100000) < 1.4);
        const double change = energy(&params) / before - 1.0;
        if (option & 2) {
            TEST_ASSERT_TRUE(change < -0.05);
        } else { /* rounding: 0.0014 and -0.0003 */
            TEST_ASSERT_DOUBLE_WITHIN(3e-3, 0.0, change);
        }
    }
}

/* k dt^2 / mu from resolved to absurd. Half way between ticks nothing grows, at the ticks by the factor
 * sqrt(1 + k dt^2 / 4 mu) that goes with it. */
static void under_resolved_stiffness_stays_bounded_and_dies_out_when_damped(void)
{
    static const double ratio[] = {1.0, 10.0, 100.0, 1e3, 5e4};
    for (int i = 0; i < 5; i++) {
        for (int damped = 0; damped < 2; damped++) {
            const double start = 1e-3, mu = 0.2, dt = 0.1;
            const rod_params params =
                uniform_rod(1, 1.0 / dt, ratio[i] * mu / (dt * dt), damped ? 4.0 : 0.0, 0.0);
            start_bent(&params, start);
            const double before = energy(&params);
            TEST_ASSERT_TRUE(rest(10000) < 1.01 * start * sqrt(1.0 + 0.25 * ratio[i]));
            const double left = !damped ? 1.0 : ratio[i] > 1e4 ? 0.20 : 0.0;
            TEST_ASSERT_DOUBLE_WITHIN(0.01, left, energy(&params) / before);
        }
    }
}

/* A joint put on its stop with g = 0 swings out by that same factor again: into the other stop, unless
 * damping takes more than the factor gives. Resolved rods come to rest; a rod of k dt^2 / mu = 5 and
 * c = 2 at 100 Hz never does. (With g = limit - x at the stop instead, it would.) */
static void under_resolved_rod_may_lock_into_its_stops(void)
{
    static const double ratio[] = {0.5, 1.0, 5.0, 10.0};
    for (int i = 0; i < 4; i++) {
        const rod_params params = uniform_rod(4, 100.0, ratio[i] * 0.2 * 1e4, 2.0, 0.0);
        start_bent(&params, 1.4);
        (void)rest(10000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, ratio[i] < 2.0 ? 0.0 : 1.4, rest(10));
    }
}

/* (gamma + c) dt <= 2 mu, else a rod without springs would change its direction at every tick. */
static void centred_damper_saws_beyond_its_bound_and_is_refused_there(void)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        const rod_params params = uniform_rod(1, 100.0, 0.0, beyond ? 41.0 : 39.0, 0.0);
        contour model;
        contour_state from = {{{0.0f}}, {{1e-3f}}}, to;
        const rod_motion none = {{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};
        int row_n;
        TEST_ASSERT_EQUAL_INT(ROD_OK, contour_prepare(&model, &params, 0.0f, &row_n));
        TEST_ASSERT_EQUAL_INT(ROD_OK, contour_step(&model, &from, &to, &none, &none, NULL));
        TEST_ASSERT_EQUAL_INT(beyond, to.increment_rad[0][0] < 0.0f);
        TEST_ASSERT_EQUAL_INT(beyond ? ROD_E_OVERDAMPED : ROD_OK, rod_params_check(&params, NULL));
    }
}

/* Spring and damper explicit: of one link, stable at rest only for k dt^2 + 2 c dt < 4 mu. */
static void papers_scheme_is_only_conditionally_stable(void)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        rod_params params = uniform_rod(1, 100.0, beyond ? 7700.0 : 7500.0, 2.0, 0.0);
        params.scheme = ROD_SCHEME_PAPER; /* the bound: 7600 */
        start_bent(&params, 0.01);
        (void)rest(2000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, beyond ? 1.4 : 0.0, rest(10));
        params.scheme = ROD_SCHEME_MIDPOINT;
        start_bent(&params, 0.01);
        (void)rest(2000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, rest(10));
    }
}

/* --- order --------------------------------------------------------------------------------------- */

/* Bent and let go. g of a rod at rest is half the first tick's fall, else it starts half a tick late. */
static double let_go(double rate_hz)
{
    const rod_params params = uniform_rod(4, rate_hz, 200.0, 2.0, 100.0);
    start_bent(&params, 0.5);
    (void)energy(&params); /* for K */
    for (int i = 0; i < 4; i++) {
        const double torque = 0.5 * (ref.K[i][0] + ref.K[i][1] + ref.K[i][2] + ref.K[i][3]);
        r.as.contour.state[0].increment_rad[i][0] =
            (float)(0.5 * torque * ref.dt * ref.dt / ref.mu[i]);
    }
    (void)rest((int)(0.1 * rate_hz + 0.5));
    return rod_angle(&r, 0, ROD_THETA);
}

/* From 0 to 1 with three derivatives that are zero at both ends. */
static double smooth(double share)
{
    const double s = fmax(0.0, fmin(1.0, share));
    return s * s * s * s * (35.0 - 84.0 * s + 70.0 * s * s - 20.0 * s * s * s);
}

static double turned(int scheme, double rate_hz, double drag, double damper)
{
    rod_params params = uniform_rod(4, rate_hz, 200.0, damper, 20.0);
    const vec3 y = {0.0f, 1.0f, 0.0f};
    params.scheme = scheme;
    for (int i = 0; i < 4; i++) {
        params.drag[i] = (float)drag;
    }
    start_rod(&r, &params, base_turned(y, 0.0));
    for (int n = 1; n <= (int)(0.12 * rate_hz + 0.5); n++) {
        step_rod(&r, base_turned(y, 0.5 * smooth(n / rate_hz / 0.2)));
    }
    return rod_angle(&r, 0, ROD_THETA);
}

static double turned_with_drag(double rate_hz)
{
    return turned(ROD_SCHEME_MIDPOINT, rate_hz, 2.0, 5.0);
}

static double shifted(double rate_hz)
{
    const rod_params params = uniform_rod(4, rate_hz, 2000.0, 10.0, 20.0);
    start_rod(&r, &params, STILL);
    for (int n = 1; n <= (int)(0.08 * rate_hz + 0.5); n++) {
        const double s = 0.2 * smooth(n / rate_hz / 0.2);
        step_rod(&r, base_at(s, 0.0, s));
    }
    return rod_angle(&r, 0, ROD_THETA);
}

/* How much an error falls when the tick is halved. */
static double gain(double (*run)(double rate_hz), double rate_hz)
{
    const double middle = run(2.0 * rate_hz);
    return (run(rate_hz) - middle) / (middle - run(4.0 * rate_hz));
}

static void step_is_of_second_order_while_the_base_rests_or_turns(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 4.0, gain(let_go, 200.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 4.0, gain(let_go, 400.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 4.0, gain(turned_with_drag, 200.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 4.0, gain(turned_with_drag, 400.0));
}

/* The two base motions of a step both start at the current angles, so what is quadratic in them leaves
 * (v dt / l)^2 of this tick less that of the last: of first order, and only while v changes. */
static void step_is_of_first_order_while_the_base_speeds_up(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.15, 2.0, gain(shifted, 400.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.15, 2.0, gain(shifted, 1600.0));
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, -0.1370, shifted(1600.0));
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, -0.1288, shifted(12800.0));
}

/* In Eq. 5 the damper sees v - w, the increment without the base's motion: c drags in the world. */
static void papers_scheme_tends_to_midpoint_with_its_damper_as_drag(void)
{
    static const double rate_hz[] = {500.0, 1000.0, 2000.0, 4000.0};
    double apart[4];
    for (int i = 0; i < 4; i++) {
        const double paper = turned(ROD_SCHEME_PAPER, rate_hz[i], 0.0, 5.0);
        apart[i] = paper - turned(ROD_SCHEME_MIDPOINT, rate_hz[i], 5.0, 0.0);
        TEST_ASSERT_DOUBLE_WITHIN(6.2 / rate_hz[i], 0.0, apart[i]);
        TEST_ASSERT_TRUE(paper < turned(ROD_SCHEME_MIDPOINT, rate_hz[i], 0.0, 5.0) - 0.1);
        TEST_ASSERT_DOUBLE_WITHIN(0.1, 2.0, i == 0 ? 2.0 : apart[i - 1] / apart[i]);
    }
}

/* --- rounding ------------------------------------------------------------------------------------ */

static void float32_stays_within_3e_6_rad_of_double_at_k_2000(void)
{
    for (int option = 0; option < 16; option++) {
        const double rate_hz = option & 1 ? 500.0 : 100.0;
        rod_params params =
            uniform_rod(option & 2 ? 20 : 4, rate_hz, 2000.0, option & 8 ? 2.0 : 10.0, 100.0);
        params.hold_n = option & 4 ? 2 : 1;
        double largest = 0.0;
        for (int n = 0; n <= (int)(10.0 * rate_hz); n++) {
            const double t = n / rate_hz;
            const vec3 axis = {(float)sin(1.3 * t), 1.0f, (float)cos(0.7 * t)};
            rod_pose base = base_turned(axis, 1.2 * sin(2.5 * t));
            base.position_m =
                base_at(0.2 * sin(5.0 * t), 0.15 * cos(4.0 * t), 0.1 * sin(6.0 * t)).position_m;
            if (n == 0) {
                start_rod(&r, &params, base);
                ref_init(&ref, &params, ROD_SCHEME_MIDPOINT, ref_pose_of(base));
                continue;
            }
            step_rod(&r, base);
            ref_step(&ref, ref_pose_of(base), NULL);
            largest = fmax(largest, largest_angle(&r));
            for (int i = 0; i < 2 * ref.n; i++) {
                TEST_ASSERT_DOUBLE_WITHIN(3e-6, ref.x[i / 2][i % 2], rod_angle(&r, i / 2, i % 2));
            }
        }
        TEST_ASSERT_TRUE(largest > 0.2);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(step_adds_no_damping_energy_stays_for_100000_ticks);
    RUN_TEST(under_resolved_stiffness_stays_bounded_and_dies_out_when_damped);
    RUN_TEST(under_resolved_rod_may_lock_into_its_stops);
    RUN_TEST(centred_damper_saws_beyond_its_bound_and_is_refused_there);
    RUN_TEST(papers_scheme_is_only_conditionally_stable);
    RUN_TEST(step_is_of_second_order_while_the_base_rests_or_turns);
    RUN_TEST(step_is_of_first_order_while_the_base_speeds_up);
    RUN_TEST(papers_scheme_tends_to_midpoint_with_its_damper_as_drag);
    RUN_TEST(float32_stays_within_3e_6_rad_of_double_at_k_2000);
    return UNITY_END();
}
