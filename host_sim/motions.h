/* motions.h - hand motions made here, at 100 Hz: the paper's five (its Table 1), and one to touch things with.
 *
 * Computed with the core's own trigonometry in float32, so the files are the same on every machine.
 */
#ifndef LIMBER_MOTIONS_H
#define LIMBER_MOTIONS_H

#include "kinematics.h"

typedef struct {
    const char *name;
    const char *what;
    int samples_n; /* at MOTION_RATE_HZ */
    rod_pose (*pose)(int sample);
} motion;

#define MOTION_RATE_HZ 100

enum { MOTIONS_N = 5 };
extern const motion motions[MOTIONS_N];

/* For the scenes in scenes/, which lie under its way. */
extern const motion motion_pressing;

#endif
