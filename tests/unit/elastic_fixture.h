/* elastic_fixture.h - one elastic rod, or two, without rod.h: what the tests of its properties start from. */
#ifndef LIMBER_ELASTIC_FIXTURE_H
#define LIMBER_ELASTIC_FIXTURE_H

#include <float.h>

#include "elastic.h"
#include "test_support.h"
#include "unity.h"

static const double EPS = (double)FLT_EPSILON;
static const rod_pose ORIGIN = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
static const rod_motion STILL = {{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};
static const rod_joint STRAIGHT[ROD_MAX_LINKS];

static uint32_t seed;
static rod_params params;
static elastic model;
static elastic_state state;
static vec3 nodes[ROD_MAX_LINKS + 1];

/* A whip of four links without anything that would take energy from it. */
void setUp(void)
{
    seed = 57;
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.gravity_m_s2 = 0.0f;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.length_m[i] = 0.1f;
        params.spring[i] = 2.0f;
        params.damper[i] = 0.0f;
    }
}

void tearDown(void) {}

static inline void prepare(void)
{
    int row_n;
    TEST_ASSERT_EQUAL_INT(ROD_OK, elastic_prepare(&model, &params, false, &row_n));
}

static inline void lay(elastic_state *s, const rod_pose *base, const rod_joint *angle_rad)
{
    prepare();
    elastic_lay(&model, base, &STILL, angle_rad, STRAIGHT, s);
}

/* Return whether the lengths were found. */
static inline bool step_pushed(elastic_state *s, const rod_pose *from, const rod_pose *to,
                               const vec3 *forces_newton)
{
    const elastic_outside outside = {.forces_newton = forces_newton};
    return elastic_step(&model, s, &STILL, from, to, &outside);
}

static inline bool step(elastic_state *s, const rod_pose *from, const rod_pose *to)
{
    return step_pushed(s, from, to, NULL);
}

static inline void rest(elastic_state *s, const rod_pose *base, int ticks_n)
{
    for (int i = 0; i < ticks_n; i++) {
        step(s, base, base);
    }
}

static inline double largest_difference(const elastic_state *a, const elastic_state *b)
{
    double largest = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            const double difference = (double)a->angle_rad[i][axis] - (double)b->angle_rad[i][axis];
            largest = worse(largest, fabs(difference));
        }
    }
    return largest;
}

#endif
