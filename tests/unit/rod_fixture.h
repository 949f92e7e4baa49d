/* rod_fixture.h - two rods through rod.h, and what tests do with them. */
#ifndef LIMBER_ROD_FIXTURE_H
#define LIMBER_ROD_FIXTURE_H

#include "rod.h"
#include "test_support.h"
#include "unity.h"

static rod one, twin;
static rod_params params;
static vec3 nodes[ROD_MAX_LINKS + 1];

static const rod_pose AT_ORIGIN = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

/* What every test of an elastic rod starts from. */
static inline void elastic_params(int links_n, float damper)
{
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.links_n = links_n;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.spring[i] = 4.0f;
        params.damper[i] = damper;
        params.length_m[i] = 0.05f;
    }
}

static inline void rest(rod *r, const rod_pose *base, int ticks_n)
{
    for (int i = 0; i < ticks_n; i++) {
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, base));
    }
}

static inline void follow(rod *r, double from_s, int ticks_n)
{
    for (int i = 0; i < ticks_n; i++) {
        const rod_pose hand = hand_at(from_s + (double)r->params.tick_s * i);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &hand));
    }
}

/* A rod in full swing. */
static inline void swing(rod *r)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(r, &params, NULL));
    follow(r, 0.0, 100);
    TEST_ASSERT_TRUE(fabsf(rod_angles(r)[0][ROD_THETA]) > 0.01f);
}

#endif
