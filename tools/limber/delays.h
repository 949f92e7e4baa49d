/* delays.h - how long from a pose to the angles it led to, and where that time went.
 *
 *     pose sent --- line --- received --- solve --- solved --- reply --- ANGLES here
 *
 * ANGLES echoes the seq of the newest pose in it and how long ago, on the device's clock, that was received
 * and the solving ended; the clock's offset (clock_sync.h) ties the two ends together. line + solve + reply
 * is the whole, exactly; an error of the offset moves time between line and reply only. Each pose counts
 * once, with the first ANGLES that it is in. A pose goes into the next tick: `solve` is the time to the end of
 * that one, at most a tick and the solving; the ticks after it, until it is the turn of ANGLES, which come at a
 * rate of their own, count to `reply`.
 */
#ifndef LIMBER_DELAYS_H
#define LIMBER_DELAYS_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "clock_sync.h"
#include "messages.h"

enum { DELAYS_BIN_US = 5, DELAYS_BINS_N = 200000 }; /* up to 1 s */

typedef struct {
    uint32_t bins[DELAYS_BINS_N];
    uint64_t n;
    int64_t max_us;
} delays;

typedef struct {
    delays whole, line, solve, reply;
    uint64_t sent_us[65536]; /* by seq */
    uint64_t sent_n;         /* in this session */
    uint16_t last_seq, last_echo;
    bool echoed;
    int32_t tick_us;                    /* 0: unknown */
    uint64_t first_echo_n, last_echo_n; /* of the session's poses, from 1 */
} pose_delays;

/* All zeros, from malloc (4 MB); NULL after complaining. */
pose_delays *pose_delays_new(void);

/* Seqs begin anew, at a device that ticks so fast. */
void pose_delays_session(pose_delays *d, float tick_hz);

void pose_delays_sent(pose_delays *d, uint16_t seq, uint64_t sent_us);
void pose_delays_angles(pose_delays *d, const message_angles *angles, uint32_t device_us,
                        uint64_t came_us, const clock_sync *clock);

/* Poses of this session at whose loss the device cannot know of: before the first and after the last that
 * it has echoed. */
uint64_t pose_delays_unseen(const pose_delays *d);

void pose_delays_print(const pose_delays *d, FILE *out);
cJSON *pose_delays_json(const pose_delays *d);

/* The delay that a share of them does not exceed, ms; 0 where there are none. */
double delays_quantile_ms(const delays *d, double share);

/* How they are spread: bars next to each other, from the shortest delay to the longest, every delay in one of
 * them. All are equally wide (5, 10, 20, 50, 100, ... us), but for the last where a few delays (at most 1 %)
 * are so long that they would leave the others no room: that one reaches to the longest. */
enum { DELAYS_BARS_MAX = 25 };
typedef struct {
    double from_ms, to_ms;
    uint64_t n;
} delays_bar;
/* Returns how many bars there are; 0 without delays. */
int delays_bars(const delays *d, delays_bar bars[DELAYS_BARS_MAX]);
void delays_print_bars(const delays *d, FILE *out);
cJSON *delays_bars_json(const delays *d);

#endif
