/* ring.h - a queue of bytes between the main loop and an interrupt, one of them at each end.
 *
 * One end only writes `in`, the other only `out`; both count on for ever, so that full and empty differ.
 * There is one core, and an interrupt sees its stores in program order: it is only the compiler that
 * must not move a byte past the count which hands it over. Hence volatile counts and signal fences, and no
 * masking of interrupts. Sizes are powers of two; no function waits, each costs a few cycles a byte.
 */
#ifndef LIMBER_RING_H
#define LIMBER_RING_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t *bytes;
    uint32_t size; /* a power of two */
    volatile uint32_t in, out;
} ring;

static inline size_t ring_used(const ring *r)
{
    return r->in - r->out;
}

static inline size_t ring_free(const ring *r)
{
    return r->size - ring_used(r);
}

/* All of them or, where there is no room, none. */
static inline bool ring_put(ring *r, const uint8_t *bytes, size_t bytes_n)
{
    const uint32_t in = r->in;
    if (bytes_n > ring_free(r)) {
        return false;
    }
    for (uint32_t i = 0; i < bytes_n; i++) {
        r->bytes[(in + i) & (r->size - 1)] = bytes[i];
    }
    atomic_signal_fence(memory_order_release);
    r->in = in + (uint32_t)bytes_n;
    return true;
}

/* Up to room of them; returns how many. */
static inline size_t ring_take(ring *r, uint8_t *bytes, size_t room)
{
    const uint32_t out = r->out;
    const size_t used = ring_used(r), n = used < room ? used : room;
    atomic_signal_fence(memory_order_acquire);
    for (uint32_t i = 0; i < n; i++) {
        bytes[i] = r->bytes[(out + i) & (r->size - 1)];
    }
    atomic_signal_fence(memory_order_release);
    r->out = out + (uint32_t)n;
    return n;
}

/* By the taking end. */
static inline void ring_drop_all(ring *r)
{
    r->out = r->in;
}

#endif
