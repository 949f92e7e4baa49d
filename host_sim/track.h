/* track.h - a recorded hand motion: reading, cleaning, and resampling to the rod's ticks.
 *
 * Files: TUM (`timestamp tx ty tz qx qy qz qw`, s and m, # comments) and CSV with named columns
 * (EuRoC's header, ns and w first, is recognised). Quaternions Hamilton, body -> world. Everything is
 * double until a pose is handed to the rod. MODEL.md, "Replay", is the contract.
 */
#ifndef LIMBER_TRACK_H
#define LIMBER_TRACK_H

#include <stdbool.h>
#include <stddef.h>

#include "kinematics.h"

typedef struct {
    double
        t_s; /* the file's own time; counted from its first sample where the file has nanoseconds */
    double position_m[3];
    double orientation[4]; /* x y z w, unit length */
    long line;
} track_sample;

/* How a file's axes and units become the rod's: metres, right-handed, z up. */
typedef struct {
    bool y_up;        /* the file's y is up: (x, y, z) -> (x, -z, y) */
    bool left_handed; /* x is mirrored, in the world and in the body, so that +z stays the rod */
    double scale;     /* metres per unit of the file */
    double max_speed_mps; /* samples that would need more are dropped; 0: none are */
} track_options;

/* What the file was like; nothing is mended silently. */
typedef struct {
    long lines;            /* samples read */
    long zero_quaternions; /* dropped */
    long repeated_times;   /* dropped: all but the last */
    long too_fast;         /* dropped, by max_speed_mps */
    long sign_flips; /* q to -q between neighbours: harmless, interpolation takes the short way */
    long not_unit;   /* quaternion more than 1 % off unit length: normalised */
    long gaps;       /* over 0.25 s: the pose is held, then the rod restarts straight */
    long jumps;      /* over 1 cm from where the hand was heading, at over 1000 m/s^2; kept */
    long first_jump_line;
} track_counts;

typedef struct {
    char *path;
    track_sample *samples;
    size_t samples_n;
    double origin_m[3]; /* the first sample: ticks are given from there, so that float32 keeps its
                           digits wherever the tracker's origin is */
    track_counts counts;
} track;

/* Returns SIM_OK, or an exit code after one line of complaint with file, line and reason. On success
 * the caller owns the track and frees it with track_free; there is at least one sample. */
int track_read(const char *path, const track_options *options, track *out);
void track_free(track *t);

/* One sample as written to one as the rod takes it: unit length, metres, right-handed, z up. False, and
 * counted, for the quaternion that is all zeros. track_read does it for a whole file. */
bool track_take_sample(track_sample *s, const track_options *options, track_counts *counts);

/* Duration from first to last sample. */
double track_duration_s(const track *t);

/* One tick of the resampled track. */
typedef struct {
    rod_pose base; /* from the track's origin */
    bool restart;  /* the rod starts anew here, straight and at rest */
} track_tick;

typedef struct {
    const track *source;
    double rate_hz;
    long ticks_n, next;
    size_t near; /* the sample at or before the next tick */
} track_ticks;

/* Ticks n = 0 ... floor(duration * rate + 1e-9), at n / rate after the first sample. */
track_ticks track_ticks_start(const track *source, double rate_hz);
bool track_ticks_next(track_ticks *ticks, track_tick *tick);

/* The number of ticks, as a double, since a hostile file can ask for more than a long counts. */
double track_ticks_count(const track *source, double rate_hz);

#endif
