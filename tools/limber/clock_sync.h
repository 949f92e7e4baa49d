/* clock_sync.h - the device's clock, seen from here: TIMESYNC exchanges to an offset and how far off it may be.
 *
 * Of the last eight exchanges the quickest counts: queues lengthen a round trip, nothing shortens it. Half of
 * it is the most that the offset can be off; what two clocks may drift apart since is added.
 */
#ifndef LIMBER_CLOCK_SYNC_H
#define LIMBER_CLOCK_SYNC_H

#include <stdint.h>

#include "messages.h"

enum { CLOCK_SYNC_N = 8, CLOCK_SYNC_UNKNOWN = 65535 };

typedef struct {
    uint32_t offset_us; /* device's clock minus ours, modulo 2^32 */
    uint32_t delay_us;  /* both legs together */
    uint64_t at_us;     /* our clock */
} clock_sync_sample;

typedef struct {
    clock_sync_sample samples[CLOCK_SYNC_N];
    int samples_n, next;
    clock_sync_sample best; /* of them; of no meaning while samples_n is 0 */
    message_timesync news;  /* the last exchange, for the device: t1 is still to be filled in */
} clock_sync;

/* t1, t4: ours as the TIMESYNC left and its answer came; t2, t3: the device's in between. */
void clock_sync_add(clock_sync *sync, uint32_t t1_us, uint32_t t2_us, uint32_t t3_us,
                    uint64_t t4_us);

/* The next TIMESYNC, which tells the device of the exchange before, once. */
message clock_sync_ask(clock_sync *sync, uint64_t now_us);

/* How far off the offset may be; CLOCK_SYNC_UNKNOWN before the first answer. */
uint16_t clock_sync_error_us(const clock_sync *sync, uint64_t now_us);

/* Our time of a moment on the device's clock, modulo 2^32. */
uint32_t clock_sync_to_ours(const clock_sync *sync, uint32_t device_us);

#endif
