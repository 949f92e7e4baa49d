/* contour_fixture.h - one rod in both models, contour.h's and reference_model.h's, with random
 * parameters and in a random state: what the tests of contour.c start from. */
#ifndef LIMBER_CONTOUR_FIXTURE_H
#define LIMBER_CONTOUR_FIXTURE_H

#include <float.h>

#include "contour.h"
#include "reference_model.h"
#include "unity.h"

static const double EPS = (double)FLT_EPSILON;
static const rod_pose ORIGIN = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
static const rod_motion NO_MOTION = {{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};

static uint32_t seed = 57;
static rod_params params;
static contour model;
static contour_state from, to;
static ref_rod ref;

static inline double between(double low, double high)
{
    return random_between(&seed, low, high);
}

static inline vec3 unit_vec3(void)
{
    const vec3 z = {0.0f, 0.0f, 1.0f};
    return quat_rotate(random_quat(&seed), z);
}

static inline vec3 float_of_vec(ref_vec v)
{
    return (vec3){(float)v.at[0], (float)v.at[1], (float)v.at[2]};
}

static inline void random_params(int n, int hold, int scheme, double smoothing_max)
{
    rod_params_defaults(&params);
    params.links_n = n;
    params.hold_n = hold;
    params.scheme = scheme;
    params.tick_s = (float)between(0.0005, 0.01);
    for (int i = 0; i < n; i++) { /* keeps (drag + damper) tick <= 2 inertia */
        params.length_m[i] = (float)between(0.02, 0.1);
        params.inertia[i] = (float)between(0.1, 0.5);
        params.drag[i] = (float)between(0.0, 8.0);
        params.coupling[i] = (float)between(0.0, 500.0);
        params.smoothing[i] = (float)between(0.0, smoothing_max);
        params.spring[i] = (float)between(0.0, 3000.0);
        params.damper[i] = (float)between(0.0, 8.0);
        params.limit_rad[i] = (float)between(1.0, 1.5);
    }
}

static inline void set_joint(int joint, int axis, double angle_rad, double increment_rad)
{
    from.angle_rad[joint][axis] = (float)angle_rad;
    from.increment_rad[joint][axis] = (float)increment_rad;
    ref.x[joint][axis] = (double)from.angle_rad[joint][axis];
    ref.g[joint][axis] = (double)from.increment_rad[joint][axis];
}

/* params into both models, with random angles and increments of at most these sizes. */
static inline void prepare(double angle_max, double increment_max)
{
    int row_n;
    TEST_ASSERT_EQUAL_INT(ROD_OK, contour_prepare(&model, &params, 0.0f, &row_n));
    ref_init(&ref, &params, params.scheme, ref_pose_of(ORIGIN));
    memset(&from, 0, sizeof from);
    memset(&to, 0, sizeof to);
    for (int i = 0; i < ref.n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            set_joint(i, axis, between(-angle_max, angle_max),
                      between(-increment_max, increment_max));
        }
    }
}

/* What the floats of one step may cost: every term of the right-hand side is at most M times the largest
 * angle in play, solving multiplies by at most 1 / (least inertia on the diagonal). */
static inline double step_rounding(double largest_angle)
{
    double norm = 0.0, least = 1e9;
    for (int i = 0; i < ref.n; i++) {
        double row = 0.0;
        for (int j = 0; j < ref.n; j++) {
            row += fabs(ref.M[i][j]);
        }
        norm = fmax(norm, row);
        least = fmin(least, ref.mu[i]);
    }
    return 4.0 * EPS * largest_angle * norm / least;
}

#endif
