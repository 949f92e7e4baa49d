/* base_path.h - how the base goes from pose to pose where a tick is several steps: on the parabola through the last
 * three poses, that is with hardly a jump in speed from tick to tick. On a straight way each tick
 * would begin with a blow. Pure; about 100 instructions a pose. */
#ifndef LIMBER_BASE_PATH_H
#define LIMBER_BASE_PATH_H

#include "kinematics.h"

typedef struct {
    const rod_pose *from;
    vec3 way_m, half_bend_m;
    quat way, half_bend; /* half of what this tick's way is longer than the last */
} base_path;

/* From `from` to `to`, having been at `before` one tick ago. `from` is kept by reference. */
base_path base_path_between(const rod_pose *before, const rod_pose *from, const rod_pose *to);

/* The pose at a share of the way, 0 ... 1. */
rod_pose base_path_pose(const base_path *path, float share);

#endif
