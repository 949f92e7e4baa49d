/* reference_model.h - the contour rod of firmware/core/MODEL.md a second time, for tests: double, dense
 * matrices, rotation matrices, libm. Literal, and as slow as that is; it shares no line with the core,
 * so that where the two agree a mistake would have to have been made twice. */
#ifndef LIMBER_REFERENCE_MODEL_H
#define LIMBER_REFERENCE_MODEL_H

#include "rod.h"
#include "test_support.h"

enum { REF_MAX = HOST_OR_BOARD(64, 16) };

typedef double ref_square[REF_MAX][REF_MAX];

typedef struct {
    double at[3];
} ref_vec;

typedef struct {
    ref_vec position;
    matrix3 axes; /* base -> world */
} ref_pose;

static inline ref_vec ref_plus(ref_vec a, double scale, ref_vec b)
{
    return (ref_vec){
        {a.at[0] + scale * b.at[0], a.at[1] + scale * b.at[1], a.at[2] + scale * b.at[2]}};
}

static inline ref_vec ref_scaled(ref_vec a, double scale)
{
    return (ref_vec){{scale * a.at[0], scale * a.at[1], scale * a.at[2]}};
}

static inline double ref_norm(ref_vec a)
{
    return sqrt(a.at[0] * a.at[0] + a.at[1] * a.at[1] + a.at[2] * a.at[2]);
}

static inline ref_vec ref_to_world(matrix3 axes, ref_vec v)
{
    ref_vec result = {{0.0, 0.0, 0.0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            result.at[i] += axes.at[i][j] * v.at[j];
        }
    }
    return result;
}

static inline ref_vec ref_from_world(matrix3 axes, ref_vec v)
{
    ref_vec result = {{0.0, 0.0, 0.0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            result.at[i] += axes.at[j][i] * v.at[j];
        }
    }
    return result;
}

static inline ref_pose ref_pose_of(rod_pose pose)
{
    return (ref_pose){
        {{(double)pose.position_m.x, (double)pose.position_m.y, (double)pose.position_m.z}},
        matrix3_of(pose.orientation)};
}

/* A link's direction in its parent's axes (Eq. 6) ... */
static inline ref_vec ref_direction(const double angle[2])
{
    return (ref_vec){{cos(angle[1]) * sin(angle[0]), sin(angle[1]), cos(angle[1]) * cos(angle[0])}};
}

/* ... and back, for a unit vector: where it is the parent's +-y, theta is open and stays as it was. */
static inline void ref_angles(ref_vec direction, double angle[2])
{
    const double *d = direction.at;
    if (d[0] * d[0] + d[2] * d[2] >= 1e-12) {
        angle[0] = atan2(d[0], d[2]);
    }
    angle[1] = asin(fmax(-1.0, fmin(1.0, d[1])));
}

static inline double ref_wrap(double angle) /* to (-pi, pi] */
{
    return angle - 2.0 * PI * ceil((angle - PI) / (2.0 * PI));
}

/* A third scheme, beside those of rod_params.h: how much the base's last motion turned the joints is
 * remembered, instead of being seen again from where they are now. */
enum { REF_NAIVE = ROD_SCHEME_COUNT };

typedef struct {
    int n, hold, scheme;
    double dt;
    double length[REF_MAX], mu[REF_MAX], gamma[REF_MAX], c[REF_MAX], k[REF_MAX], limit[REF_MAX];
    ref_square K, M;
    double x[REF_MAX][2], g[REF_MAX][2], remembered[REF_MAX][2];
    ref_pose before_last, last;
} ref_rod;

/* to += scale (D1' diag(beta) D1 + D2' diag(eta) D2), each row of D1 and D2 times itself. Row i of D1
 * is x_i - x_{i-1}, x_0 = 0 (Eq. 7); row i of D2 is x_{i+1} - 2 x_i + x_{i-1} (Eq. 2), without the last. */
static inline void ref_add_inner(ref_square to, int n, double scale, const float *beta,
                                 const float *eta)
{
    for (int row = 0; row < n; row++) {
        double d1[REF_MAX] = {0.0}, d2[REF_MAX] = {0.0};
        d1[row] = 1.0;
        if (row > 0) {
            d1[row - 1] = -1.0;
        }
        if (row + 1 < n) {
            d2[row + 1] = 1.0;
            d2[row] = -2.0;
            if (row > 0) {
                d2[row - 1] = 1.0;
            }
        }
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                to[i][j] +=
                    scale * ((double)beta[row] * d1[i] * d1[j] + (double)eta[row] * d2[i] * d2[j]);
            }
        }
    }
}

static inline void ref_init(ref_rod *rod, const rod_params *p, int scheme, ref_pose base)
{
    const bool paper = scheme == ROD_SCHEME_PAPER;
    memset(rod, 0, sizeof *rod);
    rod->n = (int)p->links_n;
    rod->hold = (int)p->hold_n;
    rod->scheme = scheme;
    rod->dt = (double)p->tick_s;
    rod->before_last = rod->last = base;
    const double dt = rod->dt;
    for (int i = 0; i < rod->n; i++) {
        rod->length[i] = (double)p->length_m[i];
        rod->mu[i] = (double)p->inertia[i];
        rod->gamma[i] = (double)p->drag[i];
        rod->c[i] = (double)p->damper[i];
        rod->k[i] = (double)p->spring[i];
        rod->limit[i] = (double)p->limit_rad[i];
        rod->K[i][i] = rod->k[i];
        rod->M[i][i] = paper ? rod->mu[i] + 0.5 * rod->gamma[i] * dt
                             : rod->mu[i] + 0.5 * (rod->gamma[i] + rod->c[i]) * dt +
                                   0.25 * dt * dt * rod->k[i];
    }
    ref_add_inner(rod->K, rod->n, 1.0, p->coupling, p->smoothing);
    ref_add_inner(rod->M, rod->n, (paper ? 1.0 : 0.25) * dt * dt, p->coupling, p->smoothing);
}

/* Delta(a -> b; x): how the held joints turn when the base goes from a to b while the links' far ends
 * stay where they are (Eqs. 9 and 10, exact). seen, where not NULL: those ends from their joints, in
 * their new parents' axes. */
static inline void ref_base_motion(const ref_rod *rod, ref_pose a, ref_pose b, double delta[][2],
                                   ref_vec seen[2])
{
    memset(delta, 0, sizeof(double[2]) * (size_t)rod->n);
    ref_vec to_far_end = ref_plus(a.position, -1.0, b.position);
    for (int i = 0; i < rod->hold && i < rod->n; i++) {
        const ref_vec link = ref_to_world(a.axes, ref_direction(rod->x[i]));
        to_far_end = ref_plus(to_far_end, rod->length[i], link);
        const double distance = ref_norm(to_far_end);
        if (seen != NULL) {
            seen[i] = ref_from_world(b.axes, to_far_end);
        }
        if (distance < 1e-6 * rod->length[i]) {
            return;
        }
        const ref_vec along = ref_scaled(to_far_end, 1.0 / distance);
        double turned[2] = {rod->x[i][0], rod->x[i][1]};
        ref_angles(ref_from_world(b.axes, along), turned);
        delta[i][0] = ref_wrap(turned[0] - rod->x[i][0]);
        delta[i][1] = ref_wrap(turned[1] - rod->x[i][1]);
        to_far_end = ref_plus(to_far_end, -rod->length[i], along);
        a.axes = matrix3_turned(&a.axes, rod->x[i][0], rod->x[i][1]);
        b.axes = matrix3_turned(&b.axes, turned[0], turned[1]);
    }
}

/* Gaussian elimination with row exchanges; both are used up, b becomes the solution. */
static inline void ref_solve(int n, ref_square a, double b[REF_MAX])
{
    for (int column = 0; column < n; column++) {
        int best = column;
        for (int row = column + 1; row < n; row++) {
            best = fabs(a[row][column]) > fabs(a[best][column]) ? row : best;
        }
        for (int j = 0; j <= n; j++) { /* entry n is b's */
            double *upper = j < n ? &a[column][j] : &b[column];
            double *lower = j < n ? &a[best][j] : &b[best];
            const double kept = *upper;
            *upper = *lower;
            *lower = kept;
        }
        for (int row = column + 1; row < n; row++) {
            const double factor = a[row][column] / a[column][column];
            for (int j = column; j < n; j++) {
                a[row][j] -= factor * a[column][j];
            }
            b[row] -= factor * b[column];
        }
    }
    for (int row = n - 1; row >= 0; row--) {
        for (int j = row + 1; j < n; j++) {
            b[row] -= a[row][j] * b[j];
        }
        b[row] /= a[row][row];
    }
}

static inline void ref_step(ref_rod *rod, ref_pose now, const rod_joint *torque)
{
    static ref_square a;
    double delta[REF_MAX][2], earlier[REF_MAX][2];
    const double dt = rod->dt;
    const bool paper = rod->scheme == ROD_SCHEME_PAPER;
    ref_base_motion(rod, rod->last, now, delta, NULL);
    ref_base_motion(rod, rod->before_last, rod->last, earlier, NULL);
    if (rod->scheme == REF_NAIVE) {
        memcpy(earlier, rod->remembered, sizeof earlier);
        memcpy(rod->remembered, delta, sizeof delta);
    }
    for (int axis = 0; axis < 2; axis++) {
        double b[REF_MAX];
        for (int i = 0; i < rod->n; i++) {
            const double mu = rod->mu[i], gamma = rod->gamma[i], c = rod->c[i];
            const double x = rod->x[i][axis], g = rod->g[i][axis], d = delta[i][axis];
            b[i] = torque != NULL ? dt * dt * (double)torque[i][axis] : 0.0;
            if (paper) { /* Eq. 5 with its sign corrected */
                const double v = x + d, w = x - g + d;
                b[i] += 2.0 * mu * v - (mu - 0.5 * gamma * dt) * w - dt * dt * rod->k[i] * v -
                        c * dt * (v - w);
                continue;
            }
            b[i] += (mu - 0.5 * gamma * dt) * (g - earlier[i][axis]) - 0.5 * c * dt * (d + g);
            for (int j = 0; j < rod->n; j++) {
                b[i] -= dt * dt * rod->K[i][j] *
                        (rod->x[j][axis] + 0.25 * (delta[j][axis] - rod->g[j][axis]));
            }
        }
        memcpy(a, rod->M, sizeof a);
        ref_solve(rod->n, a, b);
        for (int i = 0; i < rod->n; i++) {
            const double v = rod->x[i][axis] + delta[i][axis];
            const double x = paper ? b[i] : v + b[i];
            const bool stopped = fabs(x) > rod->limit[i];
            rod->g[i][axis] = stopped ? 0.0 : paper ? x - v : delta[i][axis] + b[i];
            rod->x[i][axis] = stopped ? copysign(rod->limit[i], x) : x;
        }
    }
    rod->before_last = rod->last;
    rod->last = now;
}

#endif
