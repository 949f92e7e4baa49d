/* servo_blend.c - see servo_blend.h. */
#include "servo_blend.h"

#include <float.h>

void servo_blend_none(servo_blend *blend)
{
    blend->servos_n = 0;
    blend->period = blend->periods_n = 0;
}

static void start(servo_blend *blend, const servo_map *map, uint32_t time_us)
{
    blend->servos_n = map->servos_n;
    blend->period = 0;
    /* rounded up: never quicker than asked for */
    const float periods = (float)time_us * 1e-6f / map->period_s;
    blend->periods_n = (int32_t)(periods + 0.999f);
    blend->per_period = blend->periods_n > 0 ? 1.0f / (float)blend->periods_n : 0.0f;
}

void servo_blend_from_rest(servo_blend *blend, const servo_map *map, uint32_t time_us)
{
    start(blend, map, time_us);
    blend->from_motion = false;
    for (int i = 0; i < map->servos_n; i++) {
        blend->from_rad[i] = map->goals_rad[i];
    }
}

void servo_blend_from_motion(servo_blend *blend, const servo_map *map, const float *targets_rad,
                             uint32_t time_us)
{
    start(blend, map, time_us);
    blend->from_motion = true;
    for (int i = 0; i < map->servos_n; i++) {
        const float difference_rad = map->goals_rad[i] - targets_rad[i];
        /* a target that is not a number must not spoil those that follow it */
        blend->from_rad[i] = trig_abs(difference_rad) <= FLT_MAX ? difference_rad : 0.0f;
    }
}

void servo_blend_mix(servo_blend *blend, float *targets_rad)
{
    if (servo_blend_done(blend)) {
        return;
    }
    blend->period++;
    if (servo_blend_done(blend)) {
        return; /* weight 1, without its rounding */
    }
    const float s = (float)blend->period * blend->per_period;
    const float weight = s * s * s * (10.0f + s * (6.0f * s - 15.0f));
    const float rest = 1.0f - weight;
    for (int i = 0; i < blend->servos_n; i++) {
        if (blend->from_motion) {
            targets_rad[i] += rest * blend->from_rad[i];
        } else {
            targets_rad[i] = weight * targets_rad[i] + rest * blend->from_rad[i];
        }
    }
}

bool servo_blend_done(const servo_blend *blend)
{
    return blend->period >= blend->periods_n;
}
