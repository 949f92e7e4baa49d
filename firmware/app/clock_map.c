/* clock_map.c - see clock_map.h. */
#include "clock_map.h"

enum {
    SETTLING_N = 8,         /* exchanges that may move the offset at once */
    STRANGERS_N = 3,        /* in a row: a clock was set */
    BACKWARDS_MAX_US = 200, /* legs apart by 2 s on clocks 100 ppm apart look this much too short */
    AGE_TO_DELAY_SHIFT = 12, /* 2^-12 = 244 ppm */
};
#define DRIFT_BASELINE_US 32000000u

/* From one reading of a clock to another, us: right while they are within 35 min of each other. */
static int32_t elapsed_us(uint32_t from_us, uint32_t to_us)
{
    return (int32_t)(to_us - from_us);
}

static uint32_t magnitude(int32_t x)
{
    return x < 0 ? 0u - (uint32_t)x : (uint32_t)x;
}

static int32_t within(int32_t x, int32_t bound)
{
    return x > bound ? bound : x < -bound ? -bound : x;
}

static uint32_t offset_at(const clock_map *map, uint32_t sender_us)
{
    /* at most 2^31 * 100 ppm, so it fits an int32 */
    const float gained_us = map->drift * (float)elapsed_us(map->base.sender_us, sender_us);
    return map->base.offset_us + (uint32_t)(int32_t)gained_us;
}

void clock_map_init(clock_map *map)
{
    *map = (clock_map){0};
}

static void forget(clock_map *map)
{
    const uint32_t used = map->used, left_out = map->left_out, jumps = map->jumps;
    *map = (clock_map){.used = used, .left_out = left_out, .jumps = jumps};
}

void clock_map_tick(clock_map *map, uint32_t now_us)
{
    if (map->synced && elapsed_us(map->exchanged_us, now_us) > (int32_t)CLOCK_SILENCE_MAX_US) {
        forget(map);
    }
}

bool clock_map_to_device(const clock_map *map, uint32_t sender_us, uint32_t *device_us)
{
    if (!map->synced) {
        return false;
    }
    *device_us = sender_us + offset_at(map, sender_us);
    return true;
}

static bool sample_of(const clock_exchange *e, clock_sample *sample)
{
    const uint32_t offset_low_us = e->device_sent_us - e->sender_received_us;
    const uint32_t offset_high_us = e->device_received_us - e->sender_sent_us;
    int32_t delay_us = elapsed_us(offset_low_us, offset_high_us);
    if (delay_us < -BACKWARDS_MAX_US || delay_us > CLOCK_DELAY_MAX_US) {
        return false;
    }
    delay_us = delay_us < 0 ? 0 : delay_us;
    const int32_t turnaround_us = elapsed_us(e->sender_received_us, e->sender_sent_us);
    *sample = (clock_sample){
        .sender_us = e->sender_received_us + (uint32_t)(turnaround_us / 2),
        .offset_us = offset_low_us + (uint32_t)delay_us / 2u,
        .delay_us = (uint32_t)delay_us,
    };
    return true;
}

/* Whether a sample contradicts the map. Three in a row that agree with one another are right, and all
 * that was known before them is not. */
static bool is_stranger(clock_map *map, const clock_sample *sample)
{
    const uint32_t bound_us = (sample->delay_us + map->base.delay_us) / 2u + CLOCK_JUMP_MIN_US;
    const int32_t error_us = elapsed_us(offset_at(map, sample->sender_us), sample->offset_us);
    if (magnitude(error_us) <= bound_us) {
        map->strangers = 0;
        return false;
    }
    const int32_t apart_us = elapsed_us(map->stranger_offset_us, sample->offset_us);
    map->strangers = map->strangers > 0 && magnitude(apart_us) <= bound_us ? map->strangers + 1 : 1;
    map->stranger_offset_us = sample->offset_us;
    if (map->strangers < STRANGERS_N) {
        return true;
    }
    forget(map);
    map->jumps++;
    return false;
}

static const clock_sample *best_of(const clock_map *map, uint32_t sender_us)
{
    const clock_sample *best = &map->window[0];
    uint32_t least_us = UINT32_MAX;
    for (int i = 0; i < map->window_n; i++) {
        const clock_sample *sample = &map->window[i];
        const uint32_t age_us = magnitude(elapsed_us(sample->sender_us, sender_us));
        const uint32_t doubt_us = sample->delay_us + (age_us >> AGE_TO_DELAY_SHIFT);
        if (doubt_us < least_us) {
            least_us = doubt_us;
            best = sample;
        }
    }
    return best;
}

static void learn_drift(clock_map *map, const clock_sample *best)
{
    if (!map->far_known) {
        map->far = *best;
        map->far_known = map->window_n == CLOCK_WINDOW_N;
        return;
    }
    const int32_t baseline_us = elapsed_us(map->far.sender_us, best->sender_us);
    if (baseline_us < (int32_t)DRIFT_BASELINE_US) {
        return;
    }
    const float measured =
        (float)elapsed_us(map->far.offset_us, best->offset_us) / (float)baseline_us;
    const float drift = map->drift + (map->drift_known ? 0.25f : 1.0f) * (measured - map->drift);
    map->drift_known = true;
    map->drift = drift > CLOCK_DRIFT_MAX    ? CLOCK_DRIFT_MAX
                 : drift < -CLOCK_DRIFT_MAX ? -CLOCK_DRIFT_MAX
                                            : drift;
    map->far = *best;
}

bool clock_map_exchange(clock_map *map, const clock_exchange *exchange)
{
    clock_sample sample;
    if (!sample_of(exchange, &sample) || (map->synced && is_stranger(map, &sample))) {
        map->left_out++;
        return false;
    }
    map->used++;
    map->exchanged_us = exchange->device_received_us;
    map->window[map->window_next] = sample;
    map->window_next = (map->window_next + 1) % CLOCK_WINDOW_N;
    const bool settling = map->window_n < SETTLING_N;
    map->window_n += map->window_n < CLOCK_WINDOW_N ? 1 : 0;

    const clock_sample *best = best_of(map, sample.sender_us);
    if (!map->synced) {
        map->base = *best;
        map->synced = true;
        return true;
    }
    /* the map as it is, seen from here, before the drift changes ... */
    const uint32_t here_us = offset_at(map, sample.sender_us);
    const int32_t error_us = elapsed_us(offset_at(map, best->sender_us), best->offset_us);
    /* ... moved to agree with the best exchange there was: by a quarter, which averages over the
     * luck of several */
    map->base = (clock_sample){
        .sender_us = sample.sender_us,
        .offset_us =
            here_us + (uint32_t)(settling ? error_us : within(error_us / 4, CLOCK_STEP_MAX_US)),
        .delay_us = best->delay_us,
    };
    learn_drift(map, best);
    return true;
}
