/* beam_fixture.h - uniform beams and chains of the elastic model; their modes from the matrices, in double; and how
 * they ring, as measured. Tests only. */
#ifndef LIMBER_BEAM_FIXTURE_H
#define LIMBER_BEAM_FIXTURE_H

#include <complex.h>

#include "../unit/test_support.h"
#include "rod.h"
#include "unity.h"

/* A clamped beam (MODEL.md, Section 5), or a chain where bending_nm2 is 0. */
typedef struct {
    int links_n;
    double length_m, bending_nm2, mass_kg_m; /* L, EI, rho A */
    double gravity_m_s2;
    double damping_ratio; /* of the first mode, by dampers in proportion to the springs */
    double rate_hz;
} beam;

/* 1.8751, 4.6941, 7.8548: roots of cos x cosh x = -1 */
static const double BEAM_ROOT[3] = {1.87510406871196, 4.69409113297417, 7.85475743823761};

static inline double beam_omega(const beam *b, int mode)
{
    const double per_length = BEAM_ROOT[mode] / b->length_m;
    return per_length * per_length * sqrt(b->bending_nm2 / b->mass_kg_m);
}

static inline rod_params beam_params(const beam *b)
{
    rod_params params;
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.links_n = b->links_n;
    params.tick_s = (float)(1.0 / b->rate_hz);
    params.gravity_m_s2 = (float)b->gravity_m_s2;
    const double link_m = b->length_m / b->links_n;
    for (int i = 0; i < b->links_n; i++) {
        const double spring = (i == 0 ? 2.0 : 1.0) * b->bending_nm2 / link_m;
        const double damper =
            b->damping_ratio > 0.0 ? 2.0 * b->damping_ratio * spring / beam_omega(b, 0) : 0.0;
        params.length_m[i] = (float)link_m;
        params.mass_kg[i] = (float)((i == b->links_n - 1 ? 0.5 : 1.0) * b->mass_kg_m * link_m);
        params.spring[i] = (float)spring;
        params.damper[i] = (float)damper;
        params.drag[i] = 0.0f;
    }
    return params;
}

static inline rod *beam_start(const rod_params *params, rod_pose base)
{
    static rod r;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &base));
    return &r;
}

static inline vec3 beam_tip(const rod *r)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1];
    const int nodes_n = rod_nodes(r, nodes_m);
    return nodes_m[nodes_n - 1];
}

/* --- modes from the matrices ------------------------------------------------------------------------ */

typedef struct {
    double omega;                /* rad/s */
    double shape[ROD_MAX_LINKS]; /* sideways, of the nodes; the tip's is 1 */
} beam_mode;

typedef double beam_matrix[ROD_MAX_LINKS][ROD_MAX_LINKS];

/* a += factor d d', where d has `n` entries that belong to nodes `first` and on; those before node 1 stand still. */
static inline void beam_add(beam_matrix a, int first, const double *d, int n, double factor)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            if (first + i >= 0 && first + j >= 0) {
                a[first + i][first + j] += factor * d[i] * d[j];
            }
        }
    }
}

/* Springs, and weight that hangs (gravity along the rod, towards its tip). */
static inline void beam_stiffness(const rod_params *p, double hanging_m_s2, beam_matrix a)
{
    double tension = 0.0;
    memset(a, 0, sizeof(beam_matrix));
    for (int i = p->links_n - 1; i >= 0; i--) {
        const double here = 1.0 / (double)p->length_m[i];
        const double before = 1.0 / (double)p->length_m[i > 0 ? i - 1 : 0];
        const double curvature[3] = {before, -(before + here), here};
        const double stretch[2] = {-1.0, 1.0};
        tension += hanging_m_s2 * (double)p->mass_kg[i];
        beam_add(a, i - 2, curvature, 3, (double)p->spring[i]);
        beam_add(a, i - 1, stretch, 2, tension * here);
    }
}

/* One rotation of Jacobi's method: a[p][q] becomes 0. */
static inline void beam_rotate(beam_matrix a, beam_matrix v, int n, int p, int q)
{
    const double phi = 0.5 * atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
    const double c = cos(phi), s = sin(phi);
    for (int k = 0; k < n; k++) {
        const double at_p = a[k][p], at_q = a[k][q], v_p = v[k][p], v_q = v[k][q];
        a[k][p] = c * at_p - s * at_q;
        a[k][q] = s * at_p + c * at_q;
        v[k][p] = c * v_p - s * v_q;
        v[k][q] = s * v_p + c * v_q;
    }
    for (int k = 0; k < n; k++) {
        const double at_p = a[p][k], at_q = a[q][k];
        a[p][k] = c * at_p - s * at_q;
        a[q][k] = s * at_p + c * at_q;
    }
}

/* The modes_n slowest modes, slowest first. */
static inline void beam_modes(const rod_params *p, double hanging_m_s2, int modes_n,
                              beam_mode *modes)
{
    static beam_matrix a, v;
    const int n = p->links_n;
    beam_stiffness(p, hanging_m_s2, a);
    memset(v, 0, sizeof v);
    for (int i = 0; i < n; i++) {
        v[i][i] = 1.0;
        for (int j = 0; j < n; j++) {
            a[i][j] /= sqrt((double)p->mass_kg[i] * (double)p->mass_kg[j]);
        }
    }
    for (int sweep = 0; sweep < 12; sweep++) {
        for (int i = 0; i < n; i++) {
            for (int j = i + 1; j < n; j++) {
                beam_rotate(a, v, n, i, j);
            }
        }
    }
    double above = 0.0;
    for (int m = 0; m < modes_n; m++) {
        int slowest = 0;
        for (int i = 0; i < n; i++) {
            if (a[i][i] > above &&
                (a[slowest][slowest] <= above || a[i][i] < a[slowest][slowest])) {
                slowest = i;
            }
        }
        above = a[slowest][slowest];
        modes[m].omega = sqrt(above);
        const double tip = v[n - 1][slowest] / sqrt((double)p->mass_kg[n - 1]);
        for (int i = 0; i < n; i++) {
            modes[m].shape[i] = v[i][slowest] / sqrt((double)p->mass_kg[i]) / tip;
        }
    }
}

/* --- how it rings ----------------------------------------------------------------------------------- */

typedef struct {
    double omega; /* rad/s */
    double decay; /* 1/s: the swing falls as exp(-decay t) */
} ringing;

/* What BDF2 makes of a swing that would go as exp(lambda t). */
static inline ringing bdf2_of(ringing true_one, double rate_hz)
{
    const double complex x = (-true_one.decay + (double complex)I * true_one.omega) / rate_hz;
    const double complex z = (2.0 + csqrt(1.0 + 2.0 * x)) / (3.0 - 2.0 * x);
    return (ringing){carg(z) * rate_hz, -log(cabs(z)) * rate_hz};
}

static inline double beam_step_rate_hz(const rod_params *params)
{
    return elastic_steps_n(params->tick_s, false) / (double)params->tick_s;
}

typedef struct {
    const rod_params *params;
    const beam_mode *mode;
    vec3 sideways;
    double push_m_s; /* the speed that the tip is given */
} blow;

static inline void beam_blow(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    const blow *b = context;
    (void)nodes_m;
    for (int i = 1; i < nodes_n; i++) {
        const double momentum =
            (double)b->params->mass_kg[i - 1] * b->mode->shape[i - 1] * b->push_m_s;
        forces_newton[i] = vec3_scale(b->sideways, (float)(momentum / (double)b->params->tick_s));
    }
}

/* How far the rod is out in the shape of the mode: the tip's share, m. */
static inline double beam_swing(const rod *r, const blow *b)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1];
    double sum = 0.0, norm = 0.0;
    (void)rod_nodes(r, nodes_m);
    for (int i = 0; i < b->params->links_n; i++) {
        const double weight = (double)b->params->mass_kg[i] * b->mode->shape[i];
        sum += weight * (double)vec3_dot(nodes_m[i + 1], b->sideways);
        norm += weight * b->mode->shape[i];
    }
    return sum / norm;
}

/* A blow in the shape of the mode, then what is left alone: x(n + m) = a x(n) - b x(n - m) with m about a quarter of
 * a period, a = 2 rho^m cos(omega m), b = rho^2m, by least squares. amplitude_m: of the tip. */
static inline ringing beam_ring(const rod_params *params, const beam_mode *mode, rod_pose base,
                                double amplitude_m, double periods_n)
{
    enum { SAMPLES_MAX = 40000, SETTLE = 12 };
    static double x[SAMPLES_MAX];
    const double rate_hz = 1.0 / (double)params->tick_s;
    blow b = {params, mode, quat_frame(base.orientation).x, amplitude_m * mode->omega};
    rod *r = beam_start(params, base);
    rod_set_force(r, beam_blow, &b);
    const int samples_n = (int)(periods_n * 2.0 * PI / mode->omega * rate_hz);
    TEST_ASSERT_TRUE(samples_n <= SAMPLES_MAX);
    for (int n = 0; n < SETTLE + samples_n; n++) {
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &base));
        rod_set_force(r, NULL, NULL);
        x[n < SETTLE ? 0 : n - SETTLE] = beam_swing(r, &b);
    }
    const double quarter = 0.5 * PI / mode->omega * rate_hz;
    const int m = (int)fmax(1.0, round(quarter));
    double now_now = 0.0, now_old = 0.0, old_old = 0.0, new_now = 0.0, new_old = 0.0;
    for (int n = m; n + m < samples_n; n++) {
        now_now += x[n] * x[n];
        now_old += x[n] * x[n - m];
        old_old += x[n - m] * x[n - m];
        new_now += x[n + m] * x[n];
        new_old += x[n + m] * x[n - m];
    }
    const double determinant = now_now * old_old - now_old * now_old;
    const double a_fit = (new_now * old_old - new_old * now_old) / determinant;
    const double b_fit = (new_now * now_old - new_old * now_now) / determinant;
    TEST_ASSERT_TRUE(b_fit > 0.0);
    return (ringing){acos(a_fit / (2.0 * sqrt(b_fit))) / m * rate_hz,
                     -0.5 * log(b_fit) / m * rate_hz};
}

#endif
