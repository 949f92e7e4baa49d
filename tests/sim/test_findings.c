/* What the paper found with its four links of 30 mm (its Section 4), and what firmware/core/MODEL.md
 * states in numbers: each as a test that fails on either side of them. */
#include "driven_rod.h"

static rod r;
static ref_rod naive;

void setUp(void) {}

void tearDown(void) {}

/* --- the circle: radius 0.15 m, 2.39 s a turn, 6 turns at 100 Hz -------------------------------- */

enum { TURN_TICKS = 239, CIRCLE_TICKS = 6 * TURN_TICKS };

typedef struct {
    double amplitude[4], lag_deg[4]; /* of theta_i; lags against joint 1 */
    double phase_deg;                /* of theta_1 */
    double deflection[4];            /* amplitude of theta_1 + ... + theta_i */
    double ripple;                   /* of theta_1 about its final wave, 0.2 to 0.6 s, RMS */
} response;

static response circle(int scheme, double spring, double damper, double coupling)
{
    static double theta[CIRCLE_TICKS][4];
    const double w = 2.0 * PI / TURN_TICKS;
    rod_params params = uniform_rod(4, 100.0, spring, damper, coupling);
    params.scheme = scheme;
    start_rod(&r, &params, base_at(0.15, 0.0, 0.0));
    for (int n = 1; n < CIRCLE_TICKS; n++) {
        step_rod(&r, base_at(0.15 * cos(w * n), 0.15 * sin(w * n), 0.0));
        for (int i = 0; i < 4; i++) {
            theta[n][i] = rod_angle(&r, i, ROD_THETA);
        }
    }
    /* the wave's cosine and sine parts, over the last three whole turns */
    double c[4] = {0.0}, s[4] = {0.0};
    for (int n = CIRCLE_TICKS - 3 * TURN_TICKS; n < CIRCLE_TICKS; n++) {
        for (int i = 0; i < 4; i++) {
            c[i] += theta[n][i] * cos(w * n) * 2.0 / (3 * TURN_TICKS);
            s[i] += theta[n][i] * sin(w * n) * 2.0 / (3 * TURN_TICKS);
        }
    }
    response result = {.phase_deg = atan2(s[0], c[0]) * 180.0 / PI};
    double c_sum = 0.0, s_sum = 0.0, squares = 0.0;
    for (int i = 0; i < 4; i++) {
        c_sum += c[i];
        s_sum += s[i];
        result.amplitude[i] = hypot(c[i], s[i]);
        result.lag_deg[i] = atan2(s[i], c[i]) * 180.0 / PI - result.phase_deg;
        result.deflection[i] = hypot(c_sum, s_sum);
    }
    for (int n = 20; n <= 60; n++) {
        squares += pow(theta[n][0] - c[0] * cos(w * n) - s[0] * sin(w * n), 2.0);
    }
    result.ripple = sqrt(squares / 41.0);
    return result;
}

static void softer_rods_bend_further_and_lag_more_towards_the_tip(void)
{
    static const struct {
        double spring, amplitude[4], lag_deg[4];
    } stated[] = {
        {10.0, {0.0538, 0.0437, 0.0375, 0.0345}, {0.0, 2.9, 5.3, 6.7}},
        {80.0, {0.0292, 0.0125, 0.0056, 0.0031}, {0.0, 0.8, 1.7, 2.5}},
        {2000.0, {0.0031, 0.0001, 0.0, 0.0}, {0.0, 0.1, 0.1, 0.2}},
    };
    double tip_of_softer = 1.0;
    for (int k = 0; k < 3; k++) {
        const response measured = circle(ROD_SCHEME_MIDPOINT, stated[k].spring, 1.0, 100.0);
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(6e-5, stated[k].amplitude[i], measured.amplitude[i]);
            TEST_ASSERT_DOUBLE_WITHIN(0.06, stated[k].lag_deg[i], measured.lag_deg[i]);
            TEST_ASSERT_TRUE(i == 0 || measured.deflection[i] > measured.deflection[i - 1]);
        }
        TEST_ASSERT_TRUE(measured.deflection[3] < 0.5 * tip_of_softer);
        tip_of_softer = measured.deflection[3];
    }
}

static void damping_takes_out_ripples_and_leaves_the_wave(void)
{
    const response ringing = circle(ROD_SCHEME_MIDPOINT, 80.0, 0.2, 20.0);
    const response damped = circle(ROD_SCHEME_MIDPOINT, 80.0, 8.0, 20.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0597, ringing.amplitude[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0586, damped.amplitude[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 10.4, damped.phase_deg - ringing.phase_deg);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.026, ringing.ripple);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, 0.0002, damped.ripple);
}

/* There the damper sees the motion in the world (test_stepping.c): it drags, and the finding is lost. */
static void in_the_papers_scheme_damping_moves_the_wave(void)
{
    const response ringing = circle(ROD_SCHEME_PAPER, 80.0, 0.2, 20.0);
    const response damped = circle(ROD_SCHEME_PAPER, 80.0, 8.0, 20.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.090, ringing.amplitude[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.670, damped.amplitude[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 145.0, damped.phase_deg - ringing.phase_deg);
}

/* --- the base at rest --------------------------------------------------------------------------- */

static void with_the_base_still_any_shape_straightens(void)
{
    uint32_t seed = 3;
    for (int option = 0; option < 24; option++) {
        static const int sizes[] = {1, 4, 20};
        rod_params params = uniform_rod(sizes[option % 3], 500.0, 80.0, 0.0, 100.0);
        params.hold_n = option & 1 ? 2 : 1;
        for (int i = 0; i < params.links_n; i++) {
            params.drag[i] = option & 2 ? 2.0f : 0.0f;
            params.damper[i] = option & 4 ? 2.0f : 0.0f;
            params.smoothing[i] = option & 8 ? 20.0f : 0.0f;
        }
        start_rod(&r, &params, random_pose(&seed, 1.0));
        const rod_pose base = r.base;
        for (int i = 0; i < params.links_n; i++) {
            r.as.contour.state[0].angle_rad[i][0] = (float)random_between(&seed, -1.4, 1.4);
            r.as.contour.state[0].angle_rad[i][1] = (float)random_between(&seed, -1.4, 1.4);
            r.as.contour.state[0].increment_rad[i][0] = (float)random_between(&seed, -0.05, 0.05);
        }
        for (int n = 0; n < 5000; n++) {
            step_rod(&r, base);
        }
        if (option & 6) { /* a float quaternion's own conjugate undoes it to rounding only */
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, largest_angle(&r));
        } else { /* with neither drag nor damper it goes on swinging */
            TEST_ASSERT_TRUE(largest_angle(&r) > 0.05);
        }
    }
}

static void links_keep_their_length_however_hard_they_are_shaken(void)
{
    rod_params params = uniform_rod(10, 500.0, 80.0, 0.2, 20.0);
    vec3 nodes[11];
    double largest = 0.0;
    start_rod(&r, &params, base_at(0.0, 0.0, 0.0));
    for (int n = 1; n < 1000; n++) {
        step_rod(&r, base_at(0.3 * sin(0.05 * n), 0.2 * sin(0.04 * n), 0.1 * sin(0.07 * n)));
        TEST_ASSERT_EQUAL_INT(11, rod_nodes(&r, nodes));
        for (int i = 0; i < 10; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.03, length_double(vec3_sub(nodes[i + 1], nodes[i])));
        }
        largest = fmax(largest, largest_angle(&r));
    }
    TEST_ASSERT_TRUE(largest > 1.0);
}

/* --- tick rates: 0.1 m sideways in 50 ms, half a cosine ----------------------------------------- */

static void tick_rates_agree_on_a_sideways_jump(void)
{
    static const struct {
        double rate_hz, peak, settled_s, paper_peak;
    } stated[] = {
        {100.0, 0.685, 0.230, 0.560},  {250.0, 0.805, 0.196, 0.536},  {500.0, 0.823, 0.194, 0.618},
        {1000.0, 0.832, 0.195, 0.703}, {2000.0, 0.836, 0.195, 0.745},
    };
    for (int row = 0; row < 5; row++) {
        const double rate_hz = stated[row].rate_hz;
        for (int scheme = ROD_SCHEME_MIDPOINT; scheme <= ROD_SCHEME_PAPER; scheme++) {
            static double theta[2001];
            const int ticks = (int)rate_hz;
            double peak = 0.0;
            rod_params params = uniform_rod(4, rate_hz, 2000.0, 10.0, 20.0);
            params.scheme = scheme;
            start_rod(&r, &params, base_at(0.0, 0.0, 0.0));
            for (int n = 1; n <= ticks; n++) {
                step_rod(&r, base_at(0.1 * raised_cosine(n / rate_hz / 0.05), 0.0, 0.0));
                theta[n] = fabs(rod_angle(&r, 0, ROD_THETA));
                peak = fmax(peak, theta[n]);
            }
            int last = ticks;
            while (theta[last] <= 0.02 * peak) {
                last--;
            }
            if (scheme == ROD_SCHEME_MIDPOINT) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-3, stated[row].peak, peak);
                TEST_ASSERT_DOUBLE_WITHIN(1e-3, stated[row].settled_s, last / rate_hz);
            } else {
                TEST_ASSERT_DOUBLE_WITHIN(1e-3, stated[row].paper_peak, peak);
            }
        }
    }
}

/* --- a thrust: the base pushed along the rod at constant speed; k = 80, c = 0.2, beta = 20 ------- */

typedef struct {
    double growth_per_s;  /* of theta_1's peaks, from 0.2 s on */
    double largest, left; /* of theta_1; left in the last second */
    double stopped_s;     /* when it met its stop, or 0 */
} flutter;

static flutter thrust(int scheme, double speed_m_s, int links_n, double rate_hz, double start_rad,
                      double seconds)
{
    flutter result = {0.0, 0.0, 0.0, 0.0};
    double before = 0.0, last = 0.0, first_peak = 0.0, first_s = 0.0;
    rod_params params = uniform_rod(links_n, rate_hz, 80.0, 0.2, 20.0);
    params.scheme = scheme == REF_NAIVE ? ROD_SCHEME_MIDPOINT : scheme;
    start_rod(&r, &params, base_at(0.0, 0.0, 0.0));
    bend_rod(&r, start_rad);
    ref_init(&naive, &params, REF_NAIVE, ref_pose_of(r.base));
    for (int i = 0; i < links_n; i++) {
        naive.x[i][0] = naive.x[i][1] = start_rad;
    }
    for (int n = 1; n <= (int)(seconds * rate_hz); n++) {
        const double t = n / rate_hz;
        const rod_pose base = base_at(0.0, 0.0, speed_m_s * t);
        step_rod(&r, base);
        ref_step(&naive, ref_pose_of(base), NULL);
        const double now =
            fabs(scheme == REF_NAIVE ? naive.x[0][ROD_THETA] : rod_angle(&r, 0, ROD_THETA));
        if (t > 0.2 && last >= before && last >= now && last < 0.02) {
            first_s = first_peak > 0.0 ? first_s : t;
            first_peak = first_peak > 0.0 ? first_peak : last;
            result.growth_per_s = log(last / first_peak) / fmax(1e-9, t - first_s);
        }
        result.largest = fmax(result.largest, now);
        result.left = t > seconds - 1.0 ? fmax(result.left, now) : 0.0;
        if (now >= 1.399 && !(result.stopped_s > 0.0)) {
            result.stopped_s = t;
        }
        before = last;
        last = now;
    }
    return result;
}

static void a_thrust_dies_out(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.02, -0.5, thrust(0, 1.0, 1, 5000.0, 1e-10, 2.0).growth_per_s);
    const flutter measured = thrust(ROD_SCHEME_MIDPOINT, 1.0, 4, 100.0, 0.01, 10.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.001, 0.0223, measured.largest);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 2.3e-4, measured.left);
}

/* (mu v / l - c) / 2 mu per second: both put the base's motion into both time levels. */
static void a_thrust_makes_the_papers_scheme_and_the_naive_one_flutter(void)
{
    for (int scheme = ROD_SCHEME_PAPER; scheme <= REF_NAIVE; scheme++) {
        static const double speed_m_s[] = {0.02, 0.03, 0.04, 1.0};
        for (int i = 0; i < 4; i++) { /* neither grows nor shrinks at v = c l / mu = 0.03 m/s */
            const double growth = (0.2 * speed_m_s[i] / 0.03 - 0.2) / (2.0 * 0.2);
            const double s = i < 3 ? 5.0 : 1.2;
            const flutter measured = thrust(scheme, speed_m_s[i], 1, 5000.0, 1e-10, s);
            TEST_ASSERT_DOUBLE_WITHIN(0.06, growth, measured.growth_per_s);
        }
        const flutter hard = thrust(scheme, 1.0, 4, 100.0, 0.01, 1.0);
        TEST_ASSERT_DOUBLE_WITHIN(0.011, scheme == ROD_SCHEME_PAPER ? 0.33 : 0.26, hard.stopped_s);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(softer_rods_bend_further_and_lag_more_towards_the_tip);
    RUN_TEST(damping_takes_out_ripples_and_leaves_the_wave);
    RUN_TEST(in_the_papers_scheme_damping_moves_the_wave);
    RUN_TEST(with_the_base_still_any_shape_straightens);
    RUN_TEST(links_keep_their_length_however_hard_they_are_shaken);
    RUN_TEST(tick_rates_agree_on_a_sideways_jump);
    RUN_TEST(a_thrust_dies_out);
    RUN_TEST(a_thrust_makes_the_papers_scheme_and_the_naive_one_flutter);
    return UNITY_END();
}
