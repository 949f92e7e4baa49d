/* ring.h - a queue of bytes between the main loop and an interrupt, one of them at each end.
 *
 * One end only writes `in`, the other only `out`; both count on for ever, so that full and empty differ.
 * There is one core, and an interrupt sees its stores in program order: it is only the compiler that
 * must not move a byte past the count which hands it over. Hence volatile counts and signal fences, and no
 * masking of interrupts. Sizes are powers of two; no function waits.
 */
#ifndef LIMBER_RING_H
#define LIMBER_RING_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

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

/* Of n bytes from a count on: so many lie before the end of the memory, the others at its start. */
static inline size_t ring_to_end(const ring *r, uint32_t at, size_t n)
{
    const size_t left = r->size - (at & (r->size - 1));
    return n < left ? n : left;
}

/* All of them or, where there is no room, none. */
static inline bool ring_put(ring *r, const uint8_t *bytes, size_t bytes_n)
{
    const uint32_t in = r->in;
    if (bytes_n > ring_free(r)) {
        return false;
    }
    const size_t to_end = ring_to_end(r, in, bytes_n);
    memcpy(r->bytes + (in & (r->size - 1)), bytes, to_end);
    memcpy(r->bytes, bytes + to_end, bytes_n - to_end);
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
    const size_t to_end = ring_to_end(r, out, n);
    memcpy(bytes, r->bytes + (out & (r->size - 1)), to_end);
    memcpy(bytes + to_end, r->bytes, n - to_end);
    atomic_signal_fence(memory_order_release);
    r->out = out + (uint32_t)n;
    return n;
}

/* One byte, for interrupts. False: no room, or nothing there. */
static inline bool ring_put_byte(ring *r, uint8_t byte)
{
    const uint32_t in = r->in;
    if (in - r->out == r->size) {
        return false;
    }
    r->bytes[in & (r->size - 1)] = byte;
    atomic_signal_fence(memory_order_release);
    r->in = in + 1;
    return true;
}

static inline bool ring_take_byte(ring *r, uint8_t *byte)
{
    const uint32_t out = r->out;
    if (out == r->in) {
        return false;
    }
    atomic_signal_fence(memory_order_acquire);
    *byte = r->bytes[out & (r->size - 1)];
    atomic_signal_fence(memory_order_release);
    r->out = out + 1;
    return true;
}

/* By the taking end. */
static inline void ring_drop_all(ring *r)
{
    r->out = r->in;
}

#endif
