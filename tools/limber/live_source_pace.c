/* live_source_pace.c - see live_source_pace.h. */
#include "live_source_pace.h"

#include <stdlib.h>
#include <string.h>

enum { SILENCE_MIN_US = 100000, SILENCE_FIRST_US = 1000000, KNOWN_N = 3 };

void live_pace_start(live_pace *p, uint64_t now_us)
{
    *p = (live_pace){.arrived_us = now_us, .limit_us = SILENCE_FIRST_US};
}

static int by_size(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint64_t silence_limit_us(const live_pace *p)
{
    uint32_t sorted[LIVE_RECENT_N];
    const size_t n = p->intervals_n < LIVE_RECENT_N ? (size_t)p->intervals_n : LIVE_RECENT_N;
    if (n < KNOWN_N) {
        return SILENCE_FIRST_US;
    }
    memcpy(sorted, p->recent_us, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, by_size);
    const uint64_t limit_us = 3 * (uint64_t)sorted[n / 2];
    return limit_us > SILENCE_MIN_US ? limit_us : SILENCE_MIN_US;
}

static void add_interval(live_pace *p, uint64_t us)
{
    const uint64_t bin = us / LIVE_BIN_US;
    p->bins[bin < LIVE_BINS_N ? bin : LIVE_BINS_N - 1]++;
    p->recent_us[p->intervals_n % LIVE_RECENT_N] = us < UINT32_MAX ? (uint32_t)us : UINT32_MAX;
    p->intervals_n++;
    p->limit_us = silence_limit_us(p);
}

bool live_pace_add(live_pace *p, uint64_t captured_us, uint64_t arrived_us, uint64_t *silence_us)
{
    const bool was_silent = p->silent;
    *silence_us = arrived_us > p->arrived_us ? arrived_us - p->arrived_us : 0;
    if (was_silent && p->poses_n > 0) {
        p->silent_us += *silence_us;
        p->longest_us = *silence_us > p->longest_us ? *silence_us : p->longest_us;
    } else if (!was_silent && p->captured_us > 0) { /* a silence is no interval */
        add_interval(p, captured_us > p->captured_us ? captured_us - p->captured_us : 0);
    }
    p->silent = false;
    p->captured_us = captured_us;
    p->arrived_us = arrived_us;
    p->poses_n++;
    return was_silent;
}

bool live_pace_check(live_pace *p, uint64_t now_us)
{
    if (p->silent || now_us < p->arrived_us + p->limit_us) {
        return false;
    }
    p->silent = true;
    p->silences_n += p->poses_n > 0; /* one that has not begun yet has not fallen silent */
    return true;
}

void live_pace_forget(live_pace *p, uint64_t now_us)
{
    p->captured_us = 0;
    p->arrived_us = now_us;
}

static int64_t median_bin(const live_pace *p)
{
    uint64_t so_far = 0;
    int64_t bin = 0;
    while (bin < LIVE_BINS_N - 1 && (so_far += p->bins[bin]) < (p->intervals_n + 1) / 2) {
        bin++;
    }
    return bin;
}

double live_pace_median_ms(const live_pace *p)
{
    return p->intervals_n == 0 ? 0.0 : ((double)median_bin(p) + 0.5) * LIVE_BIN_US * 1e-3;
}

double live_pace_jitter_ms(const live_pace *p)
{
    const int64_t median = median_bin(p);
    const uint64_t wanted = p->intervals_n - p->intervals_n / 100;
    uint64_t within = p->bins[median];
    int64_t apart = 0;
    while (within < wanted && apart < LIVE_BINS_N) {
        apart++;
        within += median - apart >= 0 ? p->bins[median - apart] : 0;
        within += median + apart < LIVE_BINS_N ? p->bins[median + apart] : 0;
    }
    return (double)apart * LIVE_BIN_US * 1e-3;
}
