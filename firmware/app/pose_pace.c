/* pose_pace.c - see pose_pace.h. */
#include "pose_pace.h"

#define INTERVAL_MAX_US 1000000u

static int kept(int n)
{
    return n < POSE_PACE_N ? n : POSE_PACE_N;
}

static uint32_t median(const uint32_t *history, int n)
{
    uint32_t sorted[POSE_PACE_N] = {0};
    const int kept_n = kept(n);
    for (int i = 0; i < kept_n; i++) {
        int at = i;
        for (; at > 0 && sorted[at - 1] > history[i]; at--) {
            sorted[at] = sorted[at - 1];
        }
        sorted[at] = history[i];
    }
    return sorted[kept_n > 0 ? (kept_n - 1) / 2 : 0];
}

static void remember(uint32_t *history, int *n, uint32_t value)
{
    history[*n % POSE_PACE_N] = value;
    /* counts to twice the places, then back by one round: the next place stays right */
    *n = *n + 1 < 2 * POSE_PACE_N ? *n + 1 : POSE_PACE_N;
}

void pose_pace_interval(pose_pace *pace, uint32_t interval_us, uint32_t hold_us)
{
    remember(pace->interval_us, &pace->interval_n,
             interval_us < INTERVAL_MAX_US ? interval_us : INTERVAL_MAX_US);
    const uint32_t median_us = pose_pace_interval_us(pace);
    if (pace->interval_n >= 2 && median_us > hold_us) {
        pace->slow = true;
    } else if (median_us <= hold_us / 5u * 4u) {
        pace->slow = false;
    }
}

void pose_pace_age(pose_pace *pace, uint32_t age_us)
{
    remember(pace->age_us, &pace->age_n, age_us);
}

uint32_t pose_pace_interval_us(const pose_pace *pace)
{
    return median(pace->interval_us, pace->interval_n);
}

uint32_t pose_pace_age_us(const pose_pace *pace)
{
    return median(pace->age_us, pace->age_n);
}

uint32_t pose_pace_jitter_us(const pose_pace *pace)
{
    const uint32_t median_us = pose_pace_interval_us(pace);
    const int kept_n = kept(pace->interval_n);
    uint32_t apart_us = 0; /* at most 8 s */
    for (int i = 0; i < kept_n; i++) {
        const uint32_t interval_us = pace->interval_us[i];
        apart_us += interval_us > median_us ? interval_us - median_us : median_us - interval_us;
    }
    return kept_n > 0 ? apart_us / (uint32_t)kept_n : 0u;
}
