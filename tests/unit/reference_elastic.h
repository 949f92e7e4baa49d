/* reference_elastic.h - the elastic rod of firmware/core/MODEL.md a second time, for tests: what acts on its nodes.
 * Double, in newtons and absolute positions, dense matrices, libm; it shares no line with the core. */
#ifndef LIMBER_REFERENCE_ELASTIC_H
#define LIMBER_REFERENCE_ELASTIC_H

#include "reference_model.h"

enum { REF_GHOST, REF_BASE, REF_NODE_1, REF_POINTS_MAX = REF_MAX + 2 };

typedef struct {
    int n;
    double h;
    double length[REF_MAX], mass[REF_MAX], drag[REF_MAX], spring[REF_MAX], damper[REF_MAX];
    double fall; /* m/s^2 */
    /* Ghost, base and nodes at two times; the nodes' speeds; the links' pulls */
    ref_vec at[REF_POINTS_MAX], at_before[REF_POINTS_MAX];
    ref_vec speed[REF_MAX], speed_before[REF_MAX];
    double pull[REF_MAX], pull_before[REF_MAX];
    matrix3 axes; /* of the base */
    double spin;  /* of the base about its z in the last step, rad */
    /* Of the last step: its matrix, the worst length before and after each Newton step, relative */
    ref_square matrix;
    double length_error[4];
    int newton_n;
} ref_elastic;

static inline double ref_dot(ref_vec a, ref_vec b)
{
    return a.at[0] * b.at[0] + a.at[1] * b.at[1] + a.at[2] * b.at[2];
}

static inline void ref_elastic_init(ref_elastic *rod, const rod_params *p)
{
    memset(rod, 0, sizeof *rod);
    rod->n = (int)p->links_n;
    rod->h = 2.0 / 3.0 * (double)p->tick_s;
    rod->fall = (double)p->gravity_m_s2;
    for (int i = 0; i < rod->n; i++) {
        rod->length[i] = (double)p->length_m[i];
        rod->mass[i] = (double)p->mass_kg[i];
        rod->drag[i] = (double)p->drag[i];
        rod->spring[i] = (double)p->spring[i];
        rod->damper[i] = (double)p->damper[i];
    }
}

/* (4 x - x_before) / 3 */
static inline ref_vec ref_bar(ref_vec now, ref_vec before)
{
    return ref_plus(ref_scaled(now, 4.0 / 3.0), -1.0 / 3.0, before);
}

/* What joint j's curvature takes of a point: with ghost, base and nodes in one row,
 * (P_j - P_{j-1}) / l_j - (P_{j-1} - P_{j-2}) / l_{j-1}, l_0 = l_1. */
static inline double ref_share(const ref_elastic *rod, int j, int point)
{
    const double after = 1.0 / rod->length[j], before = 1.0 / rod->length[j > 0 ? j - 1 : 0];
    return point == j + 2 ? after : point == j + 1 ? -(after + before) : point == j ? before : 0.0;
}

static inline ref_vec ref_curvature(const ref_elastic *rod, int j, const ref_vec *at)
{
    ref_vec sum = {{0.0, 0.0, 0.0}};
    for (int point = 0; point < rod->n + 2; point++) {
        sum = ref_plus(sum, ref_share(rod, j, point), at[point]);
    }
    return sum;
}

/* Link i from its near end to its far one. */
static inline ref_vec ref_link(const ref_vec *at, int i)
{
    return ref_plus(at[REF_NODE_1 + i], -1.0, at[REF_BASE + i]);
}

static inline ref_vec ref_unit(ref_vec v)
{
    return ref_scaled(v, 1.0 / ref_norm(v));
}

/* The angle of a joint whose curvature is this long: 2 asin(kappa / 2), no more than 143 degrees. */
static inline double ref_bend(ref_vec curvature)
{
    return 2.0 * asin(sqrt(fmin(0.9, 0.25 * ref_dot(curvature, curvature))));
}

static inline ref_vec ref_cross(ref_vec a, ref_vec b)
{
    return (ref_vec){{a.at[1] * b.at[2] - a.at[2] * b.at[1], a.at[2] * b.at[0] - a.at[0] * b.at[2],
                      a.at[0] * b.at[1] - a.at[1] * b.at[0]}};
}

/* How each link turns, and the base as link 0, when its ends move: across itself as they do, about itself as it
 * must for no joint to twist, which is to have no turn along the middle of its two links. */
static inline void ref_angular_speeds(const ref_elastic *rod, const ref_vec *at,
                                      const ref_vec *speed, double base_spin, ref_vec *omega)
{
    ref_vec unit_before = {{0.0, 0.0, 0.0}};
    for (int i = 0; i <= rod->n; i++) { /* link i ends at point i + 1 */
        const ref_vec unit = ref_unit(ref_plus(at[i + 1], -1.0, at[i]));
        const ref_vec rate = ref_plus(speed[i + 1], -1.0, speed[i]);
        omega[i] = ref_scaled(ref_cross(unit, rate), 1.0 / rod->length[i > 0 ? i - 1 : 0]);
        double spin = base_spin;
        if (i > 0) {
            const ref_vec middle = ref_plus(unit, 1.0, unit_before);
            const ref_vec gained = ref_plus(omega[i - 1], -1.0, omega[i]);
            spin = ref_dot(gained, middle) / ref_dot(unit, middle);
        }
        omega[i] = ref_plus(omega[i], spin, unit);
        unit_before = unit;
    }
}

/* Dampers take the power sum c |omega_j - omega_{j-1}|^2. Omega is linear in the speeds, so the force on a node is
 * -sum c (omega_j - omega_{j-1}) . d(omega_j - omega_{j-1}) / d(its speed): column by column. That leaves open
 * what acts along a link, which its pull takes up again: it is of the moment across the joint's middle,
 * torque x middle / cos^2(half the bend), that the link's ends see. */
static inline void ref_damp(const ref_elastic *rod, const ref_vec *at, const ref_vec *speed,
                            double base_spin, ref_vec force[REF_MAX])
{
    ref_vec omega[REF_MAX + 1], column[REF_MAX + 1], unit[REF_MAX + 1];
    ref_angular_speeds(rod, at, speed, base_spin, omega);
    for (int i = 0; i <= rod->n; i++) {
        unit[i] = ref_unit(ref_plus(at[i + 1], -1.0, at[i]));
    }
    for (int j = 1; j <= rod->n; j++) {
        const ref_vec middle = ref_scaled(ref_plus(unit[j], 1.0, unit[j - 1]), 0.5);
        const ref_vec against = ref_plus(omega[j], -1.0, omega[j - 1]);
        const ref_vec moment =
            ref_scaled(ref_cross(against, middle), rod->damper[j - 1] / ref_dot(middle, middle));
        for (int link = j; link >= 1 && link >= j - 1; link--) { /* outer, then inner */
            const double outer = link == j ? 1.0 : -1.0;
            const double along = outer * ref_dot(moment, unit[link]) / rod->length[link - 1];
            force[link - 1] = ref_plus(force[link - 1], -along, unit[link]);
            if (link > 1) {
                force[link - 2] = ref_plus(force[link - 2], along, unit[link]);
            }
        }
    }
    for (int i = 0; i < rod->n; i++) {
        for (int axis = 0; axis < 3; axis++) {
            ref_vec one[REF_POINTS_MAX];
            memset(one, 0, sizeof one);
            one[REF_NODE_1 + i].at[axis] = 1.0;
            ref_angular_speeds(rod, at, one, 0.0, column);
            for (int j = 1; j <= rod->n; j++) {
                const ref_vec against = ref_plus(omega[j], -1.0, omega[j - 1]);
                const ref_vec share = ref_plus(column[j], -1.0, column[j - 1]);
                force[i].at[axis] -= rod->damper[j - 1] * ref_dot(against, share);
            }
        }
    }
}

/* The forces at `at`, where the nodes are if nothing acts, and the system they move. */
static inline void ref_forces(ref_elastic *rod, const ref_vec *at, const ref_vec *bar,
                              double base_spin, const vec3 *external, ref_vec force[REF_MAX])
{
    const double h = rod->h;
    ref_vec speed[REF_POINTS_MAX] = {{{0.0}}};
    for (int point = 0; point < rod->n + 2; point++) {
        speed[point] = ref_scaled(ref_plus(at[point], -1.0, bar[point]), 1.0 / h);
    }
    memset(rod->matrix, 0, sizeof rod->matrix);
    for (int i = 0; i < rod->n; i++) {
        force[i] = ref_scaled(speed[REF_NODE_1 + i], -rod->drag[i]);
        force[i].at[2] -= rod->mass[i] * rod->fall;
        if (external != NULL) {
            const vec3 f = external[i + 1];
            force[i] = ref_plus(force[i], 1.0, (ref_vec){{(double)f.x, (double)f.y, (double)f.z}});
        }
        rod->matrix[i][i] = rod->mass[i] / (h * h) + rod->drag[i] / h;
    }
    ref_damp(rod, at, speed, base_spin, force);
    for (int i = 0; i < rod->n; i++) {
        const ref_vec along = ref_unit(ref_link(at, i));
        /* the least of the next step's, the last's and the one before's */
        const double earlier = 2.0 * rod->pull_before[i] - rod->pull[i];
        const double lasting = fmin(rod->pull[i], fmin(rod->pull_before[i], earlier));
        const double held = fmax(0.0, lasting) / rod->length[i];
        force[i] = ref_plus(force[i], -rod->pull[i], along);
        rod->matrix[i][i] += held;
        if (i > 0) {
            force[i - 1] = ref_plus(force[i - 1], rod->pull[i], along);
            rod->matrix[i - 1][i - 1] += held;
            rod->matrix[i][i - 1] -= held;
            rod->matrix[i - 1][i] -= held;
        }
    }
    for (int j = 0; j < rod->n; j++) {
        const ref_vec curvature = ref_curvature(rod, j, at);
        const double bend = ref_bend(curvature), half_cos = cos(0.5 * bend);
        const double k = rod->spring[j] * (bend > 1e-8 ? bend / sin(bend) : 1.0);
        const double c = rod->damper[j] / (half_cos * half_cos);
        for (int row = 0; row < rod->n; row++) {
            const double share = ref_share(rod, j, REF_NODE_1 + row);
            force[row] = ref_plus(force[row], -share * k, curvature);
            for (int i = 0; i < rod->n; i++) {
                rod->matrix[row][i] += share * ref_share(rod, j, REF_NODE_1 + i) * (k + c / h);
            }
        }
    }
}

#endif
