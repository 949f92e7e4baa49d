/* motions.c - see motions.h. */
#include "motions.h"

/* The hand starts a leg at rest and ends it at rest, the way hands do (minimum jerk). */
static float ease(float u)
{
    return u * u * u * (u * (u * 6.0f - 15.0f) + 10.0f);
}

/* The hand's attitude: first tilted about the world's y, then about its x; the rod points up. */
static quat tilted(float about_y_rad, float about_x_rad)
{
    const trig_pair y = trig_sincos(0.5f * about_y_rad);
    const trig_pair x = trig_sincos(0.5f * about_x_rad);
    return quat_multiply((quat){x.sin, 0.0f, 0.0f, x.cos}, (quat){0.0f, y.sin, 0.0f, y.cos});
}

/* Where a hand is that visits corners one after the other, each leg as long as the next. */
static vec3 along_corners(const vec3 *corners, int legs_n, float u)
{
    const float legs = u * (float)legs_n;
    const int leg = legs < (float)(legs_n - 1) ? (int)legs : legs_n - 1;
    const vec3 way = vec3_sub(corners[leg + 1], corners[leg]);
    return vec3_add(corners[leg], vec3_scale(way, ease(legs - (float)leg)));
}

enum { CIRCULAR_N = 239, LINEAR_N = 227, RECTANGULAR_N = 309, SHAKING_N = 629, STAR_N = 291 };

static rod_pose circular(int sample)
{
    const trig_pair turn = trig_sincos(2.0f * TRIG_PI * (float)sample / (float)CIRCULAR_N);
    return (rod_pose){{0.15f * turn.cos, 0.15f * turn.sin, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
}

static rod_pose linear(int sample)
{
    static const vec3 CORNERS[] = {{-0.25f, 0.0f, 0.0f},
                                   {0.25f, 0.0f, 0.0f},
                                   {-0.25f, 0.0f, 0.0f},
                                   {0.25f, 0.0f, 0.0f},
                                   {-0.25f, 0.0f, 0.0f}};
    const vec3 p = along_corners(CORNERS, 4, (float)sample / (float)(LINEAR_N - 1));
    return (rod_pose){p, tilted(1.2f * p.x, 0.0f)};
}

static rod_pose rectangular(int sample)
{
    static const vec3 CORNERS[] = {{-0.2f, -0.15f, 0.0f},
                                   {0.2f, -0.15f, 0.0f},
                                   {0.2f, 0.15f, 0.0f},
                                   {-0.2f, 0.15f, 0.0f},
                                   {-0.2f, -0.15f, 0.0f}};
    const vec3 p = along_corners(CORNERS, 4, (float)sample / (float)(RECTANGULAR_N - 1));
    return (rod_pose){p, tilted(p.x, -p.y)};
}

/* Three shakes a second from the wrist, growing and dying away again. */
static rod_pose shaking(int sample)
{
    const float u = (float)sample / (float)(SHAKING_N - 1);
    const float swell = ease(u < 0.5f ? 2.0f * u : 2.0f - 2.0f * u);
    const float phase = 2.0f * TRIG_PI * 3.0f * (float)sample / (float)MOTION_RATE_HZ;
    const trig_pair side = trig_sincos(phase);
    const trig_pair slow = trig_sincos(0.31f * phase);
    return (rod_pose){
        {0.08f * swell * side.sin, 0.03f * swell * slow.sin, 0.02f * swell * slow.cos},
        tilted(0.35f * swell * side.sin, -0.2f * swell * slow.sin)};
}

static rod_pose star(int sample)
{
    /* a pentagram of radius 0.2 m: every second corner of a pentagon */
    vec3 corners[6];
    for (int i = 0; i < 6; i++) {
        const trig_pair turn = trig_sincos(0.8f * TRIG_PI * (float)(i % 5));
        corners[i] = (vec3){0.2f * turn.sin, 0.2f * turn.cos, 0.0f};
    }
    const vec3 p = along_corners(corners, 5, (float)sample / (float)(STAR_N - 1));
    return (rod_pose){p, tilted(1.5f * p.x, -1.5f * p.y)};
}

/* The rod lies level along +x; the hand goes down, rests, goes sideways, rests, comes up and rests. */
enum { PRESSING_N = 451 };

static rod_pose pressing(int sample)
{
    static const vec3 CORNERS[] = {{0.0f, 0.0f, 0.0f},   {0.0f, 0.0f, -0.25f}, {0.0f, 0.0f, -0.25f},
                                   {0.0f, 0.2f, -0.25f}, {0.0f, 0.2f, -0.25f}, {0.0f, 0.2f, 0.0f},
                                   {0.0f, 0.2f, 0.0f}};
    const vec3 p = along_corners(CORNERS, 6, (float)sample / (float)(PRESSING_N - 1));
    return (rod_pose){p, tilted(0.5f * TRIG_PI, 0.0f)};
}

const motion motion_pressing = {
    "pressing", "the rod level, 0.25 m down, 0.2 m sideways and up again", PRESSING_N, pressing};

const motion motions[MOTIONS_N] = {
    {"circular", "one turn of a 0.15 m circle, the hand kept upright", CIRCULAR_N, circular},
    {"linear", "0.5 m to and fro, twice", LINEAR_N, linear},
    {"rectangular", "round a 0.4 by 0.3 m rectangle, resting at the corners", RECTANGULAR_N,
     rectangular},
    {"shaking", "shaken from the wrist at 3 Hz, growing and dying away", SHAKING_N, shaking},
    {"star", "a five-pointed star of 0.2 m radius", STAR_N, star},
};
