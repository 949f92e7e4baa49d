/* clock_sync.c - see clock_sync.h. */
#include "clock_sync.h"

enum { DELAY_MAX_US = 1000000, DRIFT_PER_MILLION = 100 };

/* How far off a sample's offset may be by now. */
static uint64_t error_of(const clock_sync_sample *sample, uint64_t now_us)
{
    return sample->delay_us / 2 + (now_us - sample->at_us) * DRIFT_PER_MILLION / 1000000;
}

void clock_sync_add(clock_sync *sync, uint32_t t1_us, uint32_t t2_us, uint32_t t3_us,
                    uint64_t t4_us)
{
    const uint32_t ours_us = (uint32_t)t4_us - t1_us, device_us = t3_us - t2_us;
    if (ours_us > DELAY_MAX_US || device_us > ours_us + 1000) {
        return; /* an answer to something older, or nonsense */
    }
    sync->news = (message_timesync){0, 1, t1_us, t2_us, t3_us, (uint32_t)t4_us};
    const uint32_t delay_us = ours_us > device_us ? ours_us - device_us : 0;
    const uint32_t offset_us = t2_us - t1_us - delay_us / 2; /* both legs take the same */
    sync->samples[sync->next] = (clock_sync_sample){offset_us, delay_us, t4_us};
    sync->next = (sync->next + 1) % CLOCK_SYNC_N;
    sync->samples_n += sync->samples_n < CLOCK_SYNC_N;
    sync->best = sync->samples[0];
    for (int i = 1; i < sync->samples_n; i++) {
        if (error_of(&sync->samples[i], t4_us) < error_of(&sync->best, t4_us)) {
            sync->best = sync->samples[i];
        }
    }
}

message clock_sync_ask(clock_sync *sync, uint64_t now_us)
{
    message ask = {.type = MESSAGE_TIMESYNC, .timesync = sync->news};
    ask.timesync.t1_us = (uint32_t)now_us;
    sync->news = (message_timesync){0};
    return ask;
}

uint16_t clock_sync_error_us(const clock_sync *sync, uint64_t now_us)
{
    if (sync->samples_n == 0) {
        return CLOCK_SYNC_UNKNOWN;
    }
    const uint64_t error_us = error_of(&sync->best, now_us);
    return error_us < CLOCK_SYNC_UNKNOWN ? (uint16_t)error_us : CLOCK_SYNC_UNKNOWN - 1;
}

uint32_t clock_sync_to_ours(const clock_sync *sync, uint32_t device_us)
{
    return device_us - sync->best.offset_us;
}
