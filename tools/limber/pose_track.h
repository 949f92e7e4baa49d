/* pose_track.h - the base poses of a run as the device used them, tick by tick: a track (TUM) that limber-sim replay
 * and limber stream take.
 *
 *     pose_track_open(&t, path);
 *     pose_track_begin(&t, &s);             a session has begun: the device is told to send POSE_LOG
 *     pose_track_add(&t, &m->pose_log);     for each that comes
 *     pose_track_end(&t, &s);               before the session ends: what it sends is as before
 *     pose_track_close(&t);                 then outputs_finish (output.h)
 *
 * A track of NULL, or one whose path was NULL, does nothing in all of them. POSE_LOG comes in every tick from the
 * session's first pose on, with every bit of its float32; the file keeps all bits, and times of whole ticks from
 * 0. Replayed at the device's tick rate with its parameters it comes to the device's angles, but for what the
 * device did to them afterwards: limits, blends, goals at the rate of a servo bus, going straight when poses stay
 * away. It costs the line 53 bytes a tick: a device whose line has no room for that refuses.
 */
#ifndef LIMBER_POSE_TRACK_H
#define LIMBER_POSE_TRACK_H

#include <stdbool.h>
#include <stdint.h>

#include "output.h"
#include "session.h"

typedef struct {
    output out;
    bool asked; /* pose_log was 0 before we came */
    bool begun;
    uint32_t first_tick, last_tick;
    double tick_hz; /* of the first session */
    uint64_t rows_n,
        missing_n; /* missing: ticks that the line had no room for, between the first and the last */
    uint64_t restarts_n; /* times the rod was laid straight on the way: a replay does not */
} pose_track;

/* SIM_OK, or SIM_BAD_INPUT after complaining. */
int pose_track_open(pose_track *t, const char *path);

/* SIM_OK, or LIMBER_DEVICE after complaining: the device cannot, or will not. */
int pose_track_begin(pose_track *t, session *s);

void pose_track_add(pose_track *t, const message_pose_log *pose);

/* Complains of nothing: a device that is gone forgets it by itself. */
void pose_track_end(pose_track *t, session *s);

/* The file waits for outputs_finish; one without poses is no file. SIM_OK, or SIM_BAD_INPUT if the disk refuses. */
int pose_track_close(pose_track *t);

#endif
