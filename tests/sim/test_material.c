/* test_material.c - rods made of a material against the beams they stand for, tapered and hollow ones too: how far they
 * bend, how fast they ring, how they die out; and what contour has of them. The beams are computed in double, on
 * a grid as fine as it takes, and not from the coefficients. */
#include "beam_fixture.h"

void setUp(void) {}

void tearDown(void) {}

static const rod_pose UPRIGHT = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
static const double G_M_S2 = 9.81;

/* Steel, 0.9 m, 6 mm at the butt; the rest as given. */
static rod_blank blade(double tip, double bore)
{
    return (rod_blank){.youngs_modulus_pa = 206e9f,
                       .density_kg_m3 = 7850.0f,
                       .diameter_m = {0.006f, (float)(0.006 * tip)},
                       .bore = (float)bore,
                       .damping_ratio = 0.02f,
                       .length_m = 0.9f};
}

static rod_params params_of(const rod_blank *blank, int32_t model, int links_n)
{
    rod_params params;
    rod_params_defaults(&params);
    params.model = model;
    params.links_n = links_n;
    params.gravity_m_s2 = 0.0f;
    rod_blank_fill(blank, &params);
    return params;
}

/* --- the beam --- */

enum { CELLS_N = 4000 };

typedef struct {
    double cell_m, bending_nm2[CELLS_N + 1], mass_kg_m[CELLS_N + 1];
} continuum;

static const continuum *continuum_of(const rod_blank *b)
{
    static continuum c;
    const double hollow = (double)b->bore * (double)b->bore;
    c.cell_m = (double)b->length_m / CELLS_N;
    for (int i = 0; i <= CELLS_N; i++) {
        const double share = (double)i / CELLS_N;
        const double d =
            (1.0 - share) * (double)b->diameter_m[0] + share * (double)b->diameter_m[1];
        c.bending_nm2[i] =
            (double)b->youngs_modulus_pa * PI / 64.0 * pow(d, 4) * (1.0 - hollow * hollow);
        c.mass_kg_m[i] = (double)b->density_kg_m3 * PI / 4.0 * d * d * (1.0 - hollow);
    }
    return &c;
}

/* Running integral by the trapezoidal rule, from the clamp or from the tip. */
static void integrate(const continuum *c, const double *y, bool from_tip, double *sum)
{
    double s = 0.0;
    for (int n = 0; n <= CELLS_N; n++) {
        const int i = from_tip ? CELLS_N - n : n;
        const int before = from_tip ? i + 1 : i - 1;
        s += n == 0 ? 0.0 : 0.5 * c->cell_m * (y[before] + y[i]);
        sum[i] = s;
    }
}

/* Where a load q(s), N/m, and a force at the tip push it: EI y'' = M, M'' = q. */
static void push(const continuum *c, const double *load, double tip_n, double *y)
{
    static double shear[CELLS_N + 1], moment[CELLS_N + 1], slope[CELLS_N + 1];
    integrate(c, load, true, shear);
    for (int i = 0; i <= CELLS_N; i++) {
        shear[i] += tip_n;
    }
    integrate(c, shear, true, moment);
    for (int i = 0; i <= CELLS_N; i++) {
        moment[i] /= c->bending_nm2[i];
    }
    integrate(c, moment, false, slope);
    integrate(c, slope, false, y);
}

static double tip_compliance(const rod_blank *b)
{
    static const double none[CELLS_N + 1];
    static double y[CELLS_N + 1];
    push(continuum_of(b), none, 1.0, y);
    return y[CELLS_N];
}

static double droop_of_beam(const rod_blank *b)
{
    static double load[CELLS_N + 1], y[CELLS_N + 1];
    const continuum *c = continuum_of(b);
    for (int i = 0; i <= CELLS_N; i++) {
        load[i] = G_M_S2 * c->mass_kg_m[i];
    }
    push(c, load, 0.0, y);
    return y[CELLS_N];
}

/* Its first frequency: loaded by its own inertia again and again it takes the shape of its slowest mode. */
static double omega_of_beam(const rod_blank *b)
{
    static double load[CELLS_N + 1], y[CELLS_N + 1];
    const continuum *c = continuum_of(b);
    double squared = 0.0;
    for (int i = 0; i <= CELLS_N; i++) {
        y[i] = (double)i / CELLS_N;
    }
    for (int pass = 0; pass < 12; pass++) {
        double work = 0.0, kinetic = 0.0;
        const double tip = y[CELLS_N];
        for (int i = 0; i <= CELLS_N; i++) {
            load[i] = c->mass_kg_m[i] * y[i] / tip;
        }
        push(c, load, 0.0, y);
        for (int i = 0; i <= CELLS_N; i++) {
            const double weight = i == 0 || i == CELLS_N ? 0.5 : 1.0;
            work += weight * load[i] * y[i];
            kinetic += weight * c->mass_kg_m[i] * y[i] * y[i];
        }
        squared = work / kinetic;
    }
    return sqrt(squared);
}

/* A full cone's tip yields by 64 F L^3 / (3 pi E d^3 d_tip), and sinks by rho g A L^4 (1 + 2 t) / (24 EI), t the tip's
 * share of the thickness; a uniform beam rings at 1.8751^2 / L^2 sqrt(EI / rho A). */
static void the_reference_is_right(void)
{
    for (int i = 1; i <= 8; i++) {
        const double tip = 0.125 * i;
        const rod_blank b = blade(tip, 0.0);
        const double length = (double)b.length_m, thick = (double)b.diameter_m[0];
        const double bending = continuum_of(&b)->bending_nm2[0];
        const double yields =
            64.0 * pow(length, 3) /
            (3.0 * PI * (double)b.youngs_modulus_pa * pow(thick, 3) * (double)b.diameter_m[1]);
        const double weight = G_M_S2 * continuum_of(&b)->mass_kg_m[0];
        const double sinks = weight * pow(length, 4) * (1.0 + 2.0 * tip) / (24.0 * bending);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, tip_compliance(&b) / yields);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, droop_of_beam(&b) / sinks);
    }
    const rod_blank b = blade(1.0, 0.5);
    const continuum *c = continuum_of(&b);
    const double per_length = BEAM_ROOT[0] / (double)b.length_m;
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-6, 1.0,
        omega_of_beam(&b) / (per_length * per_length * sqrt(c->bending_nm2[0] / c->mass_kg_m[0])));
}

/* --- the rod --- */

static void pull_tip(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)nodes_m;
    forces_newton[nodes_n - 1].x = *(const float *)context;
}

/* How far aside the tip comes to rest, m, of a rod that is much damped; sideways gravity where force is 0. */
static double tip_at_rest(const rod_blank *blank, int links_n, float force_n, double gravity_m_s2)
{
    static const quat LEVEL = {0.0f, 0.70710678f, 0.0f,
                               0.70710678f}; /* gravity along +x of the base */
    const bool level = gravity_m_s2 > 0.0;
    const rod_pose clamp = {{0.0f, 0.0f, 0.0f}, level ? LEVEL : UPRIGHT.orientation};
    rod_blank damped = *blank;
    damped.damping_ratio = 0.7f;
    rod_params params = params_of(&damped, ROD_MODEL_ELASTIC, links_n);
    params.gravity_m_s2 = (float)gravity_m_s2;
    rod *r = beam_start(&params, clamp);
    rod_set_force(r, pull_tip, &force_n);
    for (int n = 0; n < 2500; n++) {
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &clamp));
    }
    const vec3 tip = beam_tip(r);
    return level ? -(double)tip.z : (double)tip.x;
}

/* How far chains of N links are from their beams, %: of the tip under a force there and under the rod's own weight,
 * and of the first frequency. What beam theory says of a uniform one is 1/2N^2, 1/N^2 and -0.84/(N/10)^2; the
 * tapered ones' come from the matrices, by numpy. A bore changes none of them. */
static const struct {
    int links_n;
    double tip, bore, yields, sinks, rings;
} CHAINS[] = {
    {10, 1.0, 0.0, 0.500, 1.000, -0.837},    {20, 1.0, 0.8, 0.125, 0.250, -0.211},
    {50, 1.0, 0.0, 0.020, 0.040, -0.034},    {10, 0.5, 0.0, -0.008, 0.136, -0.516},
    {20, 0.5, 0.0, -0.001, 0.034, -0.130},   {50, 0.5, 0.6, 0.000, 0.005, -0.021},
    {10, 0.25, 0.9, -0.222, -0.370, -0.415}, {20, 0.25, 0.0, -0.027, -0.094, -0.104},
    {50, 0.25, 0.0, -0.003, -0.015, -0.017},
};
enum { CHAINS_N = sizeof CHAINS / sizeof *CHAINS };

/* Small deflections: 0.4 % of the length, the elastica's own error 1e-5; float32's 2e-7 m in that, 1e-4. */
static void rods_bend_as_their_beams(void)
{
    for (int i = 0; i < CHAINS_N; i++) {
        const rod_blank b = blade(CHAINS[i].tip, CHAINS[i].bore);
        const double aim_m = 0.004 * (double)b.length_m;
        const double compliance = tip_compliance(&b);
        const float force_n = (float)(aim_m / compliance);
        const double yields_m = tip_at_rest(&b, CHAINS[i].links_n, force_n, 0.0);
        TEST_ASSERT_DOUBLE_WITHIN(2e-4, 1.0 + 0.01 * CHAINS[i].yields,
                                  yields_m / ((double)force_n * compliance));
        const double per_g_m = droop_of_beam(&b), gravity = G_M_S2 * aim_m / per_g_m;
        const double sinks_m = tip_at_rest(&b, CHAINS[i].links_n, 0.0f, gravity);
        TEST_ASSERT_DOUBLE_WITHIN(2e-4, 1.0 + 0.01 * CHAINS[i].sinks, sinks_m / aim_m);
        printf("N = %2d, tip %.2f, bore %.1f: yields %+.3f %%, sinks %+.3f %%\n", CHAINS[i].links_n,
               CHAINS[i].tip, CHAINS[i].bore, 100.0 * (yields_m / aim_m - 1.0),
               100.0 * (sinks_m / aim_m - 1.0));
    }
}

/* Let go, they ring at the beam's frequency, less what the chain's is below it, and BDF2's (omega dt)^2 / 3; and they
 * die out with the damping ratio that was asked for. */
static void rods_ring_as_their_beams(void)
{
    for (int i = 0; i < CHAINS_N; i++) {
        const rod_blank b = blade(CHAINS[i].tip, CHAINS[i].bore);
        const rod_params params = params_of(&b, ROD_MODEL_ELASTIC, CHAINS[i].links_n);
        beam_mode first;
        beam_modes(&params, 0.0, 1, &first);
        const double omega = omega_of_beam(&b), zeta = (double)b.damping_ratio;
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, 1.0 + 0.01 * CHAINS[i].rings, first.omega / omega);
        TEST_ASSERT_DOUBLE_WITHIN(
            2e-5 * first.omega, first.omega,
            2.0 * PI * (double)rod_params_first_mode_hz(&params)); /* what zeta refers to */
        const ringing measured = beam_ring(&params, &first, UPRIGHT, 1e-3, 10.0);
        const ringing undelayed = {first.omega * sqrt(1.0 - zeta * zeta), first.omega * zeta};
        const ringing expected = bdf2_of(undelayed, 1000.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 1.0, measured.omega / expected.omega);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.0, measured.decay / expected.decay);
        const double decrement = 2.0 * PI * measured.decay / measured.omega;
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, decrement / (2.0 * PI * zeta));
        printf("N = %2d, tip %.2f, bore %.1f: %.2f Hz, rings %+.3f %%, decrement / 2 pi %.5f\n",
               CHAINS[i].links_n, CHAINS[i].tip, CHAINS[i].bore, omega / (2.0 * PI),
               100.0 * (measured.omega / omega - 1.0), decrement / (2.0 * PI));
    }
}

/* --- contour, equivalent --- */

/* Amplitude of the tip against the straight rod, per m or rad of a hand that swings at `hz`, after it has settled. */
static double swing_of(const rod_params *params, double hz, bool turns)
{
    static rod r;
    const double amplitude = turns ? 1e-3 : 1e-4, length = 0.9;
    const int period = (int)lround(1000.0 / hz), settle = 12000 / period * period;
    double re = 0.0, im = 0.0;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, params, NULL));
    for (int n = 0; n < settle + 2 * period; n++) {
        const double phase = 2.0 * PI * n / period, ease = fmin(1.0, n / 2000.0);
        const double at = amplitude * ease * ease * (3.0 - 2.0 * ease) * sin(phase);
        const rod_pose hand = {
            {turns ? 0.0f : (float)at, 0.0f, 0.0f},
            {0.0f, turns ? (float)sin(0.5 * at) : 0.0f, 0.0f, turns ? (float)cos(0.5 * at) : 1.0f}};
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &hand));
        if (n >= settle) {
            const double aside = (double)beam_tip(&r).x - (turns ? length * sin(at) : at);
            re += aside * cos(phase) / period;
            im += aside * sin(phase) / period;
        }
    }
    return hypot(re, im) / amplitude;
}

/* Pushed sideways, a contour rod's tip goes as far as the elastic one's, below its first frequency (5.3 Hz) and near
 * it; with 20 links a tick of 1 ms holds coupling down. Turned by the hand it goes less far the more links there
 * are, for only the first of them stays behind. */
static void contour_answers_a_push_but_not_a_turn(void)
{
    static const struct {
        int links_n;
        double hz, pushed, turned; /* contour / elastic */
    } CASES[] = {{4, 1, 1.014, 0.338},  {4, 4, 0.990, 0.332},  {4, 5, 0.974, 0.328},
                 {10, 1, 1.035, 0.141}, {10, 4, 0.997, 0.136}, {10, 5, 0.976, 0.134},
                 {20, 1, 1.127, 0.077}, {20, 4, 1.027, 0.070}, {20, 5, 0.965, 0.066}};
    rod_blank b = blade(1.0, 0.0);
    b.damping_ratio = 0.05f;
    for (int i = 0; i < 9; i++) {
        const double hz = CASES[i].hz;
        const rod_params real = params_of(&b, ROD_MODEL_ELASTIC, CASES[i].links_n);
        const rod_params like = params_of(&b, ROD_MODEL_CONTOUR, CASES[i].links_n);
        const double pushed = swing_of(&like, hz, false) / swing_of(&real, hz, false);
        const double turned = swing_of(&like, hz, true) / swing_of(&real, hz, true);
        TEST_ASSERT_DOUBLE_WITHIN(0.005, CASES[i].pushed, pushed);
        TEST_ASSERT_DOUBLE_WITHIN(0.005, CASES[i].turned, turned);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_reference_is_right);
    RUN_TEST(rods_bend_as_their_beams);
    RUN_TEST(rods_ring_as_their_beams);
    RUN_TEST(contour_answers_a_push_but_not_a_turn);
    return UNITY_END();
}
