/* capsule.h - a replay in a nutshell: the rod's parameters, what is around it, and the exact float32 pose of every tick.
 *
 * Written by `limber-sim replay --capsule`, read by the emulated board's test, which must come to the
 * same hash. A test's file, not a wire format: structs as they lie in memory. Both ends are little-endian
 * with 4-byte int32 and float and no padding, which the assertions below hold them to.
 */
#ifndef LIMBER_CAPSULE_H
#define LIMBER_CAPSULE_H

#include <stdint.h>

#include "rod.h"

#define CAPSULE_MAGIC UINT32_C(0x4c4d4232) /* "LMB2" */

typedef struct {
    uint32_t magic;
    uint32_t ticks_n;
    rod_params params;
    scene_object object[SCENE_OBJECTS_MAX]; /* as the rod meets them */
    float shape_strength_nm, shape_blend_s; /* 0 N m: no shape */
    rod_joint shape_rad[ROD_MAX_LINKS];
} capsule_header;

typedef struct {
    uint32_t restart; /* 1: the rod starts anew at this tick */
    rod_pose base;
} capsule_tick;

_Static_assert(sizeof(capsule_header) == 8 + 4 * (6 + 9 * ROD_MAX_LINKS) +
                                             4 * (13 * SCENE_OBJECTS_MAX) +
                                             4 * (2 + 2 * ROD_MAX_LINKS),
               "no padding");
_Static_assert(sizeof(capsule_tick) == 32, "no padding");

/* The rod as the replay began with it; `objects` belongs to the rod from then on. */
static inline rod_error capsule_begin(const capsule_header *header, scene *objects, rod *r)
{
    rod_error error = rod_init(r, &header->params, NULL);
    for (int i = 0; i < SCENE_OBJECTS_MAX && error == ROD_OK; i++) {
        error = scene_put(objects, i, &header->object[i], NULL);
    }
    if (error == ROD_OK && scene_objects_n(objects) > 0) {
        error = rod_set_scene(r, objects);
    }
    return error == ROD_OK && header->shape_strength_nm > 0.0f
               ? rod_set_shape(r, header->shape_rad, header->shape_strength_nm,
                               header->shape_blend_s)
               : error;
}

#endif
