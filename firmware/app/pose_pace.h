/* pose_pace.h - how often the source measures, how evenly, and how old its poses are when they arrive.
 *
 * Lower medians of the last eight: a stall or a burst does not disturb them, a change of rate is known after
 * four poses. Caller-owned, all zeros to start; pure, no heap. At most 28 comparisons an answer.
 */
#ifndef LIMBER_POSE_PACE_H
#define LIMBER_POSE_PACE_H

#include <stdbool.h>
#include <stdint.h>

enum { POSE_PACE_N = 8 };

typedef struct {
    uint32_t interval_us[POSE_PACE_N], age_us[POSE_PACE_N];
    int interval_n, age_n; /* entries, counted on past POSE_PACE_N to tell the next place */
    bool slow;             /* the source is slower than the HOLD timeout allows */
} pose_pace;

/* One interval of the source (beyond 1 s: 1 s). Slow: from the second interval on, while the median is
 * over hold_us; no longer once it is 4/5 of that or less. */
void pose_pace_interval(pose_pace *pace, uint32_t interval_us, uint32_t hold_us);

/* One pose's age as it arrived. */
void pose_pace_age(pose_pace *pace, uint32_t age_us);

/* Medians, and the mean distance of intervals from theirs; 0 as long as nothing is known. */
uint32_t pose_pace_interval_us(const pose_pace *pace);
uint32_t pose_pace_age_us(const pose_pace *pace);
uint32_t pose_pace_jitter_us(const pose_pace *pace);

#endif
