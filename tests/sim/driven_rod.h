/* driven_rod.h - rods that are alike at every joint, and motions of their base, for tests. */
#ifndef LIMBER_DRIVEN_ROD_H
#define LIMBER_DRIVEN_ROD_H

#include "../unit/reference_model.h"
#include "unity.h"

/* Links of 30 mm and inertia 0.2, as in the paper's Section 4; no drag. */
static inline rod_params uniform_rod(int links_n, double rate_hz, double spring, double damper,
                                     double coupling)
{
    rod_params params;
    rod_params_defaults(&params);
    params.links_n = links_n;
    params.tick_s = (float)(1.0 / rate_hz);
    for (int i = 0; i < links_n; i++) {
        params.spring[i] = (float)spring;
        params.damper[i] = (float)damper;
        params.coupling[i] = (float)coupling;
    }
    return params;
}

static inline rod_pose base_at(double x_m, double y_m, double z_m)
{
    return (rod_pose){{(float)x_m, (float)y_m, (float)z_m}, {0.0f, 0.0f, 0.0f, 1.0f}};
}

static inline rod_pose base_turned(vec3 axis, double angle_rad)
{
    return (rod_pose){{0.0f, 0.0f, 0.0f}, quat_about(axis, angle_rad)};
}

/* From 0 to 1 as the argument does, along half a cosine. */
static inline double raised_cosine(double share)
{
    return 0.5 - 0.5 * cos(PI * fmax(0.0, fmin(1.0, share)));
}

static inline void start_rod(rod *r, const rod_params *params, rod_pose base)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(r, params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &base));
}

/* At rest, but bent: rod.h has no such thing, a test may reach in. */
static inline void bend_rod(rod *r, double angle_rad)
{
    for (int i = 0; i < r->params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            r->as.contour.state[r->as.contour.current].angle_rad[i][axis] = (float)angle_rad;
        }
    }
}

static inline void step_rod(rod *r, rod_pose base)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &base));
}

static inline double rod_angle(const rod *r, int joint, int axis)
{
    return (double)rod_angles(r)[joint][axis];
}

/* Over all joints and both axes. */
static inline double largest_angle(const rod *r)
{
    double largest = 0.0;
    for (int i = 0; i < r->params.links_n; i++) {
        largest = fmax(largest, fmax(fabs(rod_angle(r, i, 0)), fabs(rod_angle(r, i, 1))));
    }
    return largest;
}

#endif
