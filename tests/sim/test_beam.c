/* test_beam.c - the elastic rod against beam theory: how far it droops, how fast it rings, how it dies out. What a
 * chain of N links may differ by is known in closed form or from its matrices, in double; so is what BDF2
 * takes from a swing. */
#include "beam_fixture.h"

void setUp(void) {}

void tearDown(void) {}

static const rod_pose UPRIGHT = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

/* 0.9 m and 90 g, as a foil's blade; EI so that its first frequency in theory is f. */
static beam blade(int links_n, double first_hz, double rate_hz)
{
    beam b = {links_n, 0.9, 1.0, 0.1, 0.0, 0.0, rate_hz};
    const double ratio = 2.0 * PI * first_hz / beam_omega(&b, 0);
    b.bending_nm2 *= ratio * ratio;
    return b;
}

/* --- droop ------------------------------------------------------------------------------------------ */

/* q L^4 / 8 EI */
static double droop_theory(const beam *b)
{
    const double l_squared = b->length_m * b->length_m;
    return b->gravity_m_s2 * b->mass_kg_m * l_squared * l_squared / (8.0 * b->bending_nm2);
}

/* g so that droop_theory is this share of the length. */
static beam drooping(int links_n, double share)
{
    beam b = blade(links_n, 1.5, 1000.0);
    b.damping_ratio = 0.7;
    b.gravity_m_s2 = 1.0;
    b.gravity_m_s2 = share * b.length_m / droop_theory(&b);
    return b;
}

/* The clamp points `below_rad` under the horizon, in any direction. */
static rod_pose clamp_at(double below_rad, double azimuth_rad)
{
    const vec3 y = {0.0f, 1.0f, 0.0f}, z = {0.0f, 0.0f, 1.0f};
    return (rod_pose){
        {0.0f, 0.0f, 0.0f},
        quat_multiply(quat_about(z, azimuth_rad), quat_about(y, 0.5 * PI + below_rad))};
}

/* How much lower than straight the tip comes to rest, m; below_rad: what the quaternion, as rounded, makes of it. */
static double droop_of(const rod_params *params, double length_m, rod_pose clamp, double *below_rad)
{
    rod *r = beam_start(params, clamp);
    for (int n = 0; n < 6000; n++) {
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &clamp));
    }
    *below_rad = -asin(matrix3_of(clamp.orientation).at[2][2]);
    return -length_m * sin(*below_rad) - (double)beam_tip(r).z;
}

static double droop_measured(const beam *b)
{
    const rod_params params = beam_params(b);
    double below_rad;
    return droop_of(&params, b->length_m, clamp_at(0.0, 0.0), &below_rad);
}

/* The elastica: EI theta'' = -q (L - s) cos theta, theta below the horizon, theta' = 0 at the tip. Classical
 * Runge-Kutta from the clamp, with the curvature there as `start`; returns the one at the tip. */
static double elastica_run(const beam *b, double below_rad, double start, double *droop_m)
{
    enum { STEPS_N = 400 };
    const double h = b->length_m / STEPS_N;
    const double load = b->gravity_m_s2 * b->mass_kg_m / b->bending_nm2;
    double y[3] = {below_rad, start, 0.0}; /* theta, theta', how far down */
    for (int n = 0; n < STEPS_N; n++) {
        static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
        double slope[3] = {0.0, 0.0, 0.0}, sum[3] = {0.0, 0.0, 0.0};
        for (int stage = 0; stage < 4; stage++) {
            const double s = (n + at[stage]) * h;
            const double theta = y[0] + at[stage] * h * slope[0];
            const double curvature = y[1] + at[stage] * h * slope[1];
            slope[0] = curvature;
            slope[1] = -load * (b->length_m - s) * cos(theta);
            slope[2] = sin(theta);
            for (int i = 0; i < 3; i++) {
                sum[i] += weight[stage] * slope[i];
            }
        }
        for (int i = 0; i < 3; i++) {
            y[i] += h / 6.0 * sum[i];
        }
    }
    *droop_m = y[2] - b->length_m * sin(below_rad);
    return y[1];
}

/* By shooting: more curvature at the clamp leaves more at the tip. */
static double droop_elastica(const beam *b, double below_rad)
{
    double low = 0.0, high = 8.0 / b->length_m, droop_m = 0.0;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (elastica_run(b, below_rad, middle, &droop_m) > 0.0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return droop_m;
}

/* 1.00 % more at N = 10, 0.04 % at 50: q L^4 / 8 EI (1 + 1 / N^2), and the clamp's direction in float32, 1e-7 L. */
static void droop_is_beam_theorys_and_one_over_n_squared(void)
{
    static const int links_n[] = {1, 2, 3, 5, 10, 20, 50};
    for (int i = 0; i < 7; i++) {
        const beam b = drooping(links_n[i], 0.002);
        const double error = droop_measured(&b) / droop_theory(&b) - 1.0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0 / (links_n[i] * links_n[i]), error);
        TEST_ASSERT_TRUE(links_n[i] < 10 || error < 0.012);
        TEST_ASSERT_TRUE(links_n[i] < 50 || error < 0.001);
    }
}

/* Small deflection ends where the elastica leaves the straight line: the rod goes with the elastica. */
static void droop_follows_the_elastica_from_0_1_to_50_percent(void)
{
    static const double share[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.2, 0.5};
    for (int i = 0; i < 8; i++) {
        const beam b = drooping(50, share[i]);
        const double measured = droop_measured(&b), elastica = droop_elastica(&b, 0.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0 + 1.0 / 2500.0, measured / elastica);
    }
}

/* No world axis is spared the rounding of directions of length 1: some 1e-7 of the rod's length. */
static void droop_of_a_tilted_clamp_is_the_elasticas_too(void)
{
    for (int i = 0; i < 8; i++) {
        const beam b = drooping(i & 1 ? 50 : 10, i & 2 ? 0.05 : 0.005);
        const rod_params params = beam_params(&b);
        double below_rad;
        const double measured =
            droop_of(&params, b.length_m, clamp_at(i & 4 ? -0.7 : 0.4, 0.6 + i), &below_rad);
        const double elastica = droop_elastica(&b, below_rad);
        TEST_ASSERT_DOUBLE_WITHIN(5e-4, 1.0 + 1.0 / (b.links_n * b.links_n), measured / elastica);
    }
}

/* k_1 = EI / l like the others and the clamp is half a link too soft: 21 % and -9.4 % at N = 10, what rigid-body
 * and Cosserat engines were measured to give. */
static void without_the_stiff_clamp_ten_links_droop_a_fifth_too_far(void)
{
    const beam b = drooping(10, 0.002);
    rod_params params = beam_params(&b);
    double below_rad;
    params.spring[0] *= 0.5f;
    params.damper[0] *= 0.5f;
    const double droop_m = droop_of(&params, b.length_m, clamp_at(0.0, 0.0), &below_rad);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.21, droop_m / droop_theory(&b));

    const beam ringing_one = blade(10, 3.0, 1000.0);
    beam_mode first;
    params = beam_params(&ringing_one);
    params.spring[0] *= 0.5f;
    beam_modes(&params, 0.0, 1, &first);
    const ringing measured = beam_ring(&params, &first, UPRIGHT, 1e-3, 10.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.001, 0.9058, measured.omega / beam_omega(&ringing_one, 0));
}

/* --- frequencies ------------------------------------------------------------------------------------ */

static void first_frequency_is_beam_theorys(void)
{
    static const struct {
        int links_n;
        double bound;
    } rods[] = {{10, 0.012}, {20, 0.004}, {50, 0.002}};
    static const double first_hz[] = {2.0, 5.0, 8.0};
    for (int i = 0; i < 9; i++) {
        const beam b = blade(rods[i / 3].links_n, first_hz[i % 3], 1000.0);
        const rod_params params = beam_params(&b);
        beam_mode first;
        beam_modes(&params, 0.0, 1, &first);
        const ringing measured = beam_ring(&params, &first, UPRIGHT, 1e-3, 10.0);
        TEST_ASSERT_DOUBLE_WITHIN(rods[i / 3].bound, 1.0, measured.omega / beam_omega(&b, 0));
    }
}

/* In theory -0.84, -4.1, -8.3 % at N = 10 and -0.03, -0.17, -0.36 % at 50; then BDF2 takes its (omega dt)^2 / 3. */
static void three_frequencies_are_the_matrices_through_bdf2(void)
{
    static const double below_theory[2][3] = {{0.008367, 0.040888, 0.082574},
                                              {0.000338, 0.001714, 0.003609}};
    for (int i = 0; i < 6; i++) {
        const beam b = blade(i < 3 ? 10 : 50, 3.0, 1000.0);
        const rod_params params = beam_params(&b);
        beam_mode modes[3];
        beam_modes(&params, 0.0, 3, modes);
        const double omega = modes[i % 3].omega;
        TEST_ASSERT_DOUBLE_WITHIN(2e-6, 1.0 - below_theory[i / 3][i % 3],
                                  omega / beam_omega(&b, i % 3));
        const ringing measured = beam_ring(&params, &modes[i % 3], UPRIGHT, 1e-3, 10.0);
        const ringing expected = bdf2_of((ringing){omega, 0.0}, beam_step_rate_hz(&params));
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0, measured.omega / expected.omega);
    }
}

/* Frequencies fall by (omega dt)^2 / 3 of themselves and of each swing 2 pi (omega dt)^3 / 4 is lost, to the
 * next order; dt is a step: 2 ms at 500 Hz, else at most 1 ms, which takes 0.35 % and 0.16 % of 16 Hz. */
static void ticks_cost_what_bdf2_takes(void)
{
    static const double rate_hz[] = {100.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0};
    for (int i = 0; i < 6; i++) {
        const beam b = blade(20, 16.0, rate_hz[i]);
        const rod_params params = beam_params(&b);
        beam_mode first;
        beam_modes(&params, 0.0, 1, &first);
        const double step_rate_hz = beam_step_rate_hz(&params);
        const double turn = first.omega / step_rate_hz, turn_cubed = turn * turn * turn;
        const ringing measured = beam_ring(&params, &first, UPRIGHT, 1e-3, 20.0);
        const ringing expected = bdf2_of((ringing){first.omega, 0.0}, step_rate_hz);
        TEST_ASSERT_DOUBLE_WITHIN(0.03 * turn * turn + 1e-5, turn * turn / 3.0,
                                  1.0 - measured.omega / first.omega);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0, measured.omega / expected.omega);
        const double lost = 2.0 * PI * measured.decay / measured.omega;
        TEST_ASSERT_DOUBLE_WITHIN(4.0 * turn_cubed * turn * turn + 1e-5, 0.5 * PI * turn_cubed,
                                  lost);
    }
}

/* With dampers c = 2 zeta k / omega_1 a swing falls by exp(2 pi zeta), and what BDF2 takes. */
static void logarithmic_decrement_is_two_pi_zeta(void)
{
    static const double zeta[] = {0.002, 0.01, 0.03, 0.1};
    for (int i = 0; i < 8; i++) {
        beam b = blade(i < 4 ? 10 : 50, 3.0, 1000.0);
        b.damping_ratio = zeta[i % 4];
        const rod_params params = beam_params(&b);
        beam_mode first;
        beam_modes(&params, 0.0, 1, &first);
        const double true_ratio = zeta[i % 4] * first.omega / beam_omega(&b, 0);
        const ringing undelayed = {first.omega * sqrt(1.0 - true_ratio * true_ratio),
                                   first.omega * true_ratio};
        const ringing expected = bdf2_of(undelayed, beam_step_rate_hz(&params));
        const ringing measured = beam_ring(&params, &first, UPRIGHT, 1e-3, 5.0);
        const double decrement = 2.0 * PI * measured.decay / measured.omega;
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.0, measured.decay / expected.decay);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 1.0, decrement / (2.0 * PI * zeta[i % 4]));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(droop_is_beam_theorys_and_one_over_n_squared);
    RUN_TEST(droop_follows_the_elastica_from_0_1_to_50_percent);
    RUN_TEST(droop_of_a_tilted_clamp_is_the_elasticas_too);
    RUN_TEST(without_the_stiff_clamp_ten_links_droop_a_fifth_too_far);
    RUN_TEST(first_frequency_is_beam_theorys);
    RUN_TEST(three_frequencies_are_the_matrices_through_bdf2);
    RUN_TEST(ticks_cost_what_bdf2_takes);
    RUN_TEST(logarithmic_decrement_is_two_pi_zeta);
    return UNITY_END();
}
