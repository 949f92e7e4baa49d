/* reference_elastic_step.h - one step of the rod of reference_elastic.h. */
#ifndef LIMBER_REFERENCE_ELASTIC_STEP_H
#define LIMBER_REFERENCE_ELASTIC_STEP_H

#include "reference_elastic.h"

/* The worst relative error in length. */
static inline double ref_excess(const ref_elastic *rod, const ref_vec *at, double excess[REF_MAX])
{
    double worst = 0.0;
    for (int i = 0; i < rod->n; i++) {
        excess[i] = ref_norm(ref_link(at, i)) - rod->length[i];
        worst = fmax(worst, fabs(excess[i]) / rod->length[i]);
    }
    return worst;
}

/* Pulls x along the links so that, to first order, every length is right: (G M^-1 G') x = excess, row i of
 * G being how length i changes with each node. */
static inline void ref_newton(ref_elastic *rod, ref_vec *at, double x[REF_MAX])
{
    static ref_square a;
    ref_vec unit[REF_MAX];
    memset(a, 0, sizeof a);
    for (int i = 0; i < rod->n; i++) {
        unit[i] = ref_unit(ref_link(at, i));
        a[i][i] = 1.0 / rod->mass[i];
        if (i > 0) {
            a[i][i] += 1.0 / rod->mass[i - 1];
            a[i][i - 1] = a[i - 1][i] = -ref_dot(unit[i], unit[i - 1]) / rod->mass[i - 1];
        }
    }
    ref_solve(rod->n, a, x);
    for (int i = 0; i < rod->n; i++) {
        ref_vec *const far = &at[REF_NODE_1 + i], *const near = &at[REF_BASE + i];
        *far = ref_plus(*far, -x[i] / rod->mass[i], unit[i]);
        if (i > 0) {
            *near = ref_plus(*near, x[i] / rod->mass[i - 1], unit[i]);
        }
        rod->pull[i] += x[i] / (rod->h * rod->h);
    }
}

/* 2 sin(angle / 2) along the axis of the turn between two attitudes. */
static inline ref_vec ref_turn(matrix3 from, matrix3 to)
{
    double r[3][3] = {{0.0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                r[i][j] += to.at[i][k] * from.at[j][k];
            }
        }
    }
    const ref_vec sine = {
        {0.5 * (r[2][1] - r[1][2]), 0.5 * (r[0][2] - r[2][0]), 0.5 * (r[1][0] - r[0][1])}};
    return ref_scaled(sine, 2.0 / sqrt(1.0 + r[0][0] + r[1][1] + r[2][2]));
}

/* The base and its ghost, a first link's length behind it, go to where the pose has them. */
static inline void ref_elastic_step(ref_elastic *rod, ref_pose to, const vec3 *external)
{
    static ref_square a;
    const int n = rod->n;
    const ref_vec back = {{0.0, 0.0, -rod->length[0]}};
    ref_vec bar[REF_POINTS_MAX], at[REF_POINTS_MAX], speed_bar[REF_MAX], force[REF_MAX];
    for (int point = 0; point < n + 2; point++) {
        bar[point] = ref_bar(rod->at[point], rod->at_before[point]);
    }
    at[REF_BASE] = to.position;
    at[REF_GHOST] = ref_plus(to.position, 1.0, ref_to_world(to.axes, back));
    for (int i = 0; i < n; i++) {
        speed_bar[i] = ref_bar(rod->speed[i], rod->speed_before[i]);
        at[REF_NODE_1 + i] = ref_plus(bar[REF_NODE_1 + i], rod->h, speed_bar[i]);
        const double kept = rod->pull[i];
        rod->pull[i] += rod->pull[i] - rod->pull_before[i];
        rod->pull_before[i] = kept;
    }

    const ref_vec axis = {{to.axes.at[0][2], to.axes.at[1][2], to.axes.at[2][2]}};
    const double spin = ref_dot(ref_turn(rod->axes, to.axes), axis);
    ref_forces(rod, at, bar, (spin - rod->spin / 3.0) / rod->h, external, force);
    rod->spin = spin;
    rod->axes = to.axes;
    for (int axis = 0; axis < 3; axis++) {
        double b[REF_MAX];
        for (int i = 0; i < n; i++) {
            b[i] = force[i].at[axis];
        }
        memcpy(a, rod->matrix, sizeof a);
        ref_solve(n, a, b);
        for (int i = 0; i < n; i++) {
            at[REF_NODE_1 + i].at[axis] += b[i];
        }
    }

    double excess[REF_MAX];
    rod->length_error[0] = ref_excess(rod, at, excess);
    for (rod->newton_n = 0; rod->newton_n < 3;) {
        ref_newton(rod, at, excess);
        rod->newton_n++;
        rod->length_error[rod->newton_n] = ref_excess(rod, at, excess);
        if (rod->length_error[rod->newton_n] <= 1e-6) {
            break;
        }
    }
    for (int i = 0; i < n; i++) {
        rod->speed_before[i] = rod->speed[i];
        rod->speed[i] =
            ref_scaled(ref_plus(at[REF_NODE_1 + i], -1.0, bar[REF_NODE_1 + i]), 1.0 / rod->h);
    }
    ref_vec near = at[REF_BASE]; /* what lengths still miss stays out of the speeds */
    for (int i = 0; i < n; i++) {
        const ref_vec far = at[REF_NODE_1 + i];
        const ref_vec unit = ref_unit(ref_plus(far, -1.0, near));
        at[REF_NODE_1 + i] = ref_plus(at[REF_BASE + i], rod->length[i], unit);
        near = far;
    }
    memcpy(rod->at_before, rod->at, sizeof at);
    memcpy(rod->at, at, sizeof at);
}

#endif
