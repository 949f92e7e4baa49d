/* source.h - the poses to send: a track at its own times, the same resampled, or a live source's as they come. */
#ifndef LIMBER_SOURCE_H
#define LIMBER_SOURCE_H

#include <stdbool.h>

#include "live_source.h"
#include "mount.h"
#include "track.h"

typedef struct {
    track_options track;
    mount mount;
    double resample_hz;    /* 0: the track's own samples */
    const live_kind *live; /* poses as they come; NULL: a track */
} source_options;

typedef struct {
    rod_pose pose; /* of the base, from where it was at first: so that float32 keeps its digits */
    double t_s;    /* after the first pose */
    uint64_t captured_us; /* live: when, by limber_now_us */
} source_pose;

typedef struct {
    source_options options;
    const char *name;
    track file; /* its samples are the base's, after the mount */
    track_ticks ticks;
    size_t next;
    live_source input;
    bool begun; /* a live pose has given origin_m and first_s */
    double origin_m[3], first_s;
    track_counts counts; /* of live poses */
} source;

/* SIM_OK, or an exit code after complaining. Free it with source_free in any case. */
int source_open(source *s, const char *path, const source_options *options);
void source_free(source *s);

/* Tracks: the next pose, or false at the end. */
bool source_next(source *s, source_pose *pose);

/* Live: the next pose of what s->input has read. */
bool source_next_live(source *s, source_pose *pose);

/* Where the poses' world begins in the source's own: at its first pose, be it sent or not. NULL: none has come yet. */
const double *source_origin_m(const source *s);

/* Tracks: the usual time between poses (median), from first to last pose, and how many there are. */
double source_interval_s(const source *s);
double source_duration_s(const source *s);
double source_poses_n(const source *s);

#endif
