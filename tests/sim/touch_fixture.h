/* touch_fixture.h - a rod, a hand and things to touch: what the tests of touching start from, and what they measure. The
 * rod lies along x at first, held out level; the hand moves it, objects stay where they are. Tests only. */
#ifndef LIMBER_TOUCH_FIXTURE_H
#define LIMBER_TOUCH_FIXTURE_H

#include "../unit/test_support.h"
#include "rod.h"
#include "unity.h"

static rod r;
static rod_params params;
static scene objects;
static rod_pose hand;
static vec3 nodes_m[ROD_MAX_LINKS + 1];

static const vec3 UP = {0.0f, 0.0f, 1.0f}, DOWN = {0.0f, 0.0f, -1.0f};

/* --- rods -------------------------------------------------------------------------------------------- */

/* The preset of that name, or the default rod where there is none, finer where links_n is more than suits it. */
static inline void take_rod(const char *name, int model, int links_n, double rate_hz)
{
    const rod_preset *preset = rod_preset_find(name);
    if (preset != NULL) {
        rod_preset_fill(preset, model, links_n > 0 ? links_n : preset->links_n, &params);
    } else {
        rod_params_defaults(&params);
        params.model = model;
        params.links_n = links_n > 0 ? links_n : params.links_n;
    }
    params.tick_s = (float)(1.0 / rate_hz);
}

static inline double rod_length_m(void)
{
    double length_m = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        length_m += (double)params.length_m[i];
    }
    return length_m;
}

/* From the z axis to a direction. */
static inline quat turn_to(vec3 direction)
{
    const vec3 about = {-direction.y, direction.x, 0.0f};
    const double sine = length_double(about);
    return sine < 1e-9 ? quat_about((vec3){1.0f, 0.0f, 0.0f}, direction.z > 0.0f ? 0.0 : PI)
                       : quat_about(about, atan2(sine, (double)direction.z));
}

static inline void hold_rod(vec3 direction)
{
    memset(&objects, 0, sizeof objects);
    hand = (rod_pose){{0.0f, 0.0f, 0.0f}, turn_to(direction)};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, &params, NULL));
    rod_set_scene(&r, &objects);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &hand));
}

/* --- objects ----------------------------------------------------------------------------------------- */

static inline void put(int index, scene_object object)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&objects, index, &object, NULL));
}

static inline void take_away(int index)
{
    put(index, (scene_object){.kind = SCENE_NONE});
}

/* An object of a kind whose nearest surface is at `place_m`, seen from the free side that `out` points to: a half-space, a
 * ball of 10 cm, a pole of 5 cm across the x axis, a box with a face that is too large to get round. */
static inline scene_object thing(int kind, vec3 place_m, vec3 out, float friction)
{
    scene_object o = {
        .kind = kind, .place_m = place_m, .orientation = turn_to(out), .friction = friction};
    if (kind == SCENE_SPHERE) {
        o.radius_m = 0.1f;
    } else if (kind == SCENE_CAPSULE) {
        o.radius_m = 0.05f;
        o.half_m.z = 0.4f;
        o.orientation = turn_to((vec3){0.0f, 1.0f, 0.0f});
    } else if (kind == SCENE_BOX) {
        o.radius_m = 0.005f;
        o.half_m = (vec3){0.1f, 0.1f, 0.05f};
    }
    const float depth_m = kind == SCENE_BOX ? o.half_m.z + o.radius_m : o.radius_m;
    o.place_m = vec3_add_scaled(place_m, out, -depth_m);
    return o;
}

/* --- what must hold after every tick ------------------------------------------------------------------ */

/* How far the deepest node is inside anything, in links. */
static inline double deepest_links(void)
{
    double deepest = 0.0;
    TEST_ASSERT_EQUAL_INT(params.links_n + 1, rod_nodes(&r, nodes_m));
    for (int i = 1; i <= params.links_n; i++) {
        for (int k = 0; k < SCENE_OBJECTS_MAX; k++) {
            if (objects.body[k].object.kind != SCENE_NONE) {
                const double gap_m = (double)scene_gap_to(&objects.body[k], nodes_m[i]).gap_m;
                deepest = worse(deepest, -gap_m / (double)params.length_m[i - 1]);
            }
        }
    }
    return deepest;
}

/* Relative, beyond what rounding of places costs. */
static inline double worst_length_error(void)
{
    double worst = 0.0;
    TEST_ASSERT_EQUAL_INT(params.links_n + 1, rod_nodes(&r, nodes_m));
    for (int i = 0; i < params.links_n; i++) {
        const double length_m = (double)params.length_m[i];
        const double far_m = length_double(nodes_m[0]) + length_double(nodes_m[i + 1]);
        const double now_m = length_double(vec3_sub(nodes_m[i + 1], nodes_m[i]));
        worst = worse(worst, (fabs(now_m - length_m) - 4.0 * UNIT_ROUNDOFF * far_m) / length_m);
    }
    return worst;
}

/* --- forces ------------------------------------------------------------------------------------------ */

/* The sum of what objects push the rod with, N. */
static inline vec3 contact_force(void)
{
    int contacts_n;
    const touch_contact *contact = rod_contacts(&r, &contacts_n);
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < contacts_n; i++) {
        sum = vec3_add(sum, contact[i].force_newton);
    }
    return sum;
}

/* --- motion ------------------------------------------------------------------------------------------ */

static inline int ticks_in(double seconds)
{
    return (int)lround(seconds / (double)params.tick_s);
}

static inline void tick(void)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &hand));
}

static inline void wait_s(double seconds)
{
    for (int n = ticks_in(seconds); n > 0; n--) {
        tick();
    }
}

/* What is seen while the rod moves. */
typedef struct {
    double deepest_links, length_error;
    double fastest_m_s; /* of the nodes, from place to place */
} sight;

static inline void look(sight *seen, const vec3 *before_m)
{
    seen->deepest_links = worse(seen->deepest_links, deepest_links());
    seen->length_error = worse(seen->length_error, worst_length_error());
    for (int i = 1; i <= params.links_n; i++) {
        const double way_m = length_double(vec3_sub(nodes_m[i], before_m[i]));
        seen->fastest_m_s = worse(seen->fastest_m_s, way_m / (double)params.tick_s);
    }
}

/* The hand goes so far on a straight line, at this speed in the mean and without a jerk; then it may wait. */
static inline sight move_hand(vec3 way_m, double speed_m_s, double wait_after_s)
{
    sight seen = {0.0, 0.0, 0.0};
    const vec3 from_m = hand.position_m;
    const int moving_n = ticks_in(length_double(way_m) / speed_m_s);
    const int ticks_n = moving_n + ticks_in(wait_after_s);
    for (int n = 1; n <= ticks_n; n++) {
        vec3 before_m[ROD_MAX_LINKS + 1];
        const double share = n < moving_n ? 0.5 - 0.5 * cos(PI * n / moving_n) : 1.0;
        hand.position_m = vec3_add_scaled(from_m, way_m, (float)share);
        (void)rod_nodes(&r, before_m);
        tick();
        look(&seen, before_m);
    }
    return seen;
}

/* The most that any joint angle goes to and fro in a time, rad. */
static inline double jitter_rad(double seconds)
{
    rod_joint least[ROD_MAX_LINKS], most[ROD_MAX_LINKS];
    double jitter = 0.0;
    const size_t bytes = (size_t)params.links_n * sizeof(rod_joint);
    memcpy(least, rod_angles(&r), bytes);
    memcpy(most, rod_angles(&r), bytes);
    for (int n = ticks_in(seconds); n > 0; n--) {
        tick();
        for (int i = 0; i < 2 * params.links_n; i++) {
            const float now = rod_angles(&r)[i / 2][i % 2];
            least[i / 2][i % 2] = fminf(least[i / 2][i % 2], now);
            most[i / 2][i % 2] = fmaxf(most[i / 2][i % 2], now);
        }
    }
    for (int i = 0; i < 2 * params.links_n; i++) {
        jitter = worse(jitter, (double)most[i / 2][i % 2] - (double)least[i / 2][i % 2]);
    }
    return jitter;
}

#endif
