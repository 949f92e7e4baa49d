/* live_source_pace.h - how regularly a source's poses come: rate, jitter, silences.
 *
 * Intervals are between the moments of capture (live_source.h has the clock rule); silence is when nothing arrives.
 */
#ifndef LIMBER_LIVE_SOURCE_PACE_H
#define LIMBER_LIVE_SOURCE_PACE_H

#include <stdbool.h>
#include <stdint.h>

enum { LIVE_BIN_US = 10, LIVE_BINS_N = 100000, LIVE_RECENT_N = 15 };

typedef struct {
    uint32_t bins[LIVE_BINS_N]; /* intervals by length; the last one: a second or longer */
    uint64_t poses_n, intervals_n;
    uint64_t captured_us, arrived_us; /* of the last pose */
    uint32_t recent_us[LIVE_RECENT_N];
    uint64_t limit_us; /* of silence */
    bool silent;
    int silences_n;
    uint64_t silent_us, longest_us;
} live_pace;

void live_pace_start(live_pace *p, uint64_t now_us);

/* One pose more. True where that ends a silence, of *silence_us. */
bool live_pace_add(live_pace *p, uint64_t captured_us, uint64_t arrived_us, uint64_t *silence_us);

/* True where the source has fallen silent just now: nothing came for three usual intervals, but at least 100 ms; a
 * second while it is not known what is usual. */
bool live_pace_check(live_pace *p, uint64_t now_us);

/* The interval to the next pose does not count, nor does silence until then. */
void live_pace_forget(live_pace *p, uint64_t now_us);

/* Median of the intervals; 0 where there are none. */
double live_pace_median_ms(const live_pace *p);

/* By how much 99 % of the intervals differ from the median at most. */
double live_pace_jitter_ms(const live_pace *p);

#endif
