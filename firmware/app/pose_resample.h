/* pose_resample.h - from poses that come when they come to one pose at every tick, smoothly.
 *
 * Between ticks the base is taken to move on along a line: the newest pose, carried on at the velocity
 * and the rate of turn that led to it from the pose before. Predicting, the line is read now; it leads
 * the newest pose by the time since its capture, which adds no delay. Interpolating, it is read late by
 * the usual age of a pose plus one interval of the source, so between two poses that are both known.
 *
 * When the next pose tells where the line should have been, the base does not jump: it leaves with the
 * position and the velocity it has and joins the new line after blend_s along a cubic. So velocity
 * has no steps, which the rod would feel as blows: its inertia acts on the acceleration of the base.
 *
 * A line is not followed for ever: from one interval (and the usual age) past the newest pose on, or
 * from 2/3 of the horizon if that is sooner, it slows evenly and stops at the horizon. A source that
 * falls silent leaves the base standing there; nothing swings back.
 *
 * The caller owns the state. Pure, no heap, no libm; poses and lengths must be finite (pose_input sees to
 * that), orientations of unit length; they come out so to 1e-6. A tick: two sincos at most.
 * Not for interrupts. Times in float are seconds; moments are int64 us.
 */
#ifndef LIMBER_POSE_RESAMPLE_H
#define LIMBER_POSE_RESAMPLE_H

#include <stdbool.h>
#include <stdint.h>

#include "kinematics.h"

/* A moving base, in world axes. */
typedef struct {
    rod_pose pose;
    vec3 velocity_mps, turn_radps;
} pose_motion;

/* How the line is read: late by delay_s; slowing from slow_s past the newest pose on, and standing at
 * stop_s >= slow_s. blend_s > 0: what a correction takes. No line is faster than speed_max_mps and
 * turn_max_radps, and no correction starts faster than twice that. */
typedef struct {
    float delay_s, slow_s, stop_s, blend_s;
    float speed_max_mps, turn_max_radps;
} pose_rules;

/* Treat the members as private. */
typedef struct {
    bool started;
    pose_motion line; /* the newest pose and how it moved */
    int64_t captured_us;
    pose_rules rules;
    pose_motion base; /* as last given, and when */
    int64_t given_us;
    /* what the base is off the line by, and how fast that changes, when the line was laid */
    vec3 gap_m, gap_mps, gap_rad, gap_radps;
    int64_t joined_us;
} pose_resample;

/* Stands at this pose from now on; whatever was before is gone. */
void pose_resample_start(pose_resample *r, const rod_pose *pose, int64_t captured_us,
                         int64_t now_us);

/* A newer pose, and its velocity (pose_velocity). The base leaves from where it was last given. */
void pose_resample_add(pose_resample *r, const pose_motion *newest, int64_t captured_us,
                       const pose_rules *rules);

/* The base at a tick; moments must not run backwards. Undefined before pose_resample_start. */
const pose_motion *pose_resample_at(pose_resample *r, int64_t now_us);

/* The even motion that leads from one pose to another in elapsed_s > 0, the shorter way round. */
pose_motion pose_velocity(const rod_pose *from, const rod_pose *to, float elapsed_s);

/* The angle between two orientations, rad, 0 ... pi. */
float pose_angle(quat from, quat to);

/* Brought to unit length; must not be zero. */
quat pose_unit(quat q);

#endif
