/* proto_support.h - what several tests of the wire need: seeded random numbers, random messages and
 * frames, and what a decoder makes of a stretch of bytes. */
#ifndef LIMBER_PROTO_SUPPORT_H
#define LIMBER_PROTO_SUPPORT_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "messages.h"

/* The emulated board takes a hundred times as long. */
#ifdef __arm__
#define HOST_OR_BOARD(host, board) (board)
#else
#define HOST_OR_BOARD(host, board) (host)
#endif

/* Marsaglia's xorshift: the same numbers on every machine. The seed must not be 0. */
static inline uint32_t random_bits(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

static inline size_t random_below(uint32_t *seed, size_t bound)
{
    return random_bits(seed) % bound;
}

/* --- payloads ------------------------------------------------------------------------------------ */

/* What COBS finds easy and hard. */
typedef enum { BYTES_ANY, BYTES_NO_ZERO, BYTES_ALL_ZERO, BYTES_MANY_ZEROS, BYTES_KINDS } bytes_kind;

static inline void random_bytes(uint8_t *bytes, size_t n, bytes_kind kind, uint32_t *seed)
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t any = (uint8_t)(random_bits(seed) >> 11);
        switch (kind) {
        case BYTES_NO_ZERO:
            bytes[i] = any != 0 ? any : 1;
            break;
        case BYTES_ALL_ZERO:
            bytes[i] = 0;
            break;
        case BYTES_MANY_ZEROS:
            bytes[i] = random_below(seed, 2) == 0 ? 0 : any;
            break;
        default:
            bytes[i] = any;
        }
    }
}

/* A frame around the caller's payload, all else random. */
static inline frame random_frame(const uint8_t *payload, size_t payload_n, uint32_t *seed)
{
    const uint8_t type = (uint8_t)random_bits(seed), session = (uint8_t)random_bits(seed);
    const uint16_t seq = (uint16_t)random_bits(seed);
    return (frame){type, session, seq, random_bits(seed), payload, payload_n};
}

static inline bool frames_same(const frame *a, const frame *b)
{
    return a->type == b->type && a->session == b->session && a->seq == b->seq &&
           a->t_us == b->t_us && a->payload_n == b->payload_n &&
           (a->payload_n == 0 || memcmp(a->payload, b->payload, a->payload_n) == 0);
}

static inline bool counts_same(const frame_counts *a, const frame_counts *b)
{
    return a->good == b->good && a->crc == b->crc && a->cobs == b->cobs &&
           a->too_short == b->too_short && a->too_long == b->too_long;
}

/* --- messages ------------------------------------------------------------------------------------ */

typedef enum { FILL_ZEROS, FILL_ONES, FILL_RANDOM, FILL_RANDOM_FINITE, FILL_KINDS } fill_kind;

static inline size_t number_bytes(uint8_t type)
{
    return type == WIRE_U16 || type == WIRE_I16 ? 2 : type == WIRE_U32 || type == WIRE_F32 ? 4 : 1;
}

static inline void fill_number(char *to, uint8_t type, fill_kind kind, uint32_t *seed)
{
    uint32_t bits = kind == FILL_ZEROS ? 0 : kind == FILL_ONES ? UINT32_MAX : random_bits(seed);
    if (kind == FILL_RANDOM_FINITE && type == WIRE_F32 && (bits & 0x7F800000u) == 0x7F800000u) {
        bits ^= 0x40000000u; /* infinities and NaNs become numbers */
    }
    const uint8_t u8 = (uint8_t)bits;
    const uint16_t u16 = (uint16_t)bits;
    const void *const source = number_bytes(type) == 4   ? (const void *)&bits
                               : number_bytes(type) == 2 ? (const void *)&u16
                                                         : &u8;
    memcpy(to, source, number_bytes(type));
}

/* Printable ASCII where finite, as such texts are shown to people. */
static inline void fill_text(char *to, size_t n, fill_kind kind, uint32_t *seed)
{
    const size_t used_n = kind == FILL_ZEROS  ? 0
                          : kind == FILL_ONES ? n
                                              : random_below(seed, n + 1);
    for (size_t i = 0; i < used_n; i++) {
        const int any = (int)(1 + random_below(seed, 255)),
                  print = (int)(' ' + random_below(seed, 95));
        to[i] = (char)(kind == FILL_ONES ? 255 : kind == FILL_RANDOM_FINITE ? print : any);
    }
}

/* A message of that type; what its type does not use stays zero, so that two may be compared whole. */
static inline void fill_message(message *m, const message_info *info, fill_kind kind,
                                uint32_t *seed)
{
    memset(m, 0, sizeof *m);
    m->type = info->type;
    for (int i = 0; i < info->fields_n; i++) {
        const message_field *const field = &info->fields[i];
        char *const to = (char *)m + field->offset;
        if (field->type == WIRE_NAME) {
            fill_text(to, field->n, kind, seed);
            continue;
        }
        for (size_t k = 0; k < field->n; k++) {
            fill_number(to + k * number_bytes(field->type), field->type, kind, seed);
        }
    }
    const message_tail *const tail = &info->tail;
    if (tail->type == WIRE_NAME) {
        fill_text((char *)m + tail->offset, tail->max, kind, seed);
    } else if (tail->max > 0) {
        const size_t longest = tail->max;
        const uint16_t count = (uint16_t)(kind == FILL_ZEROS  ? 0
                                          : kind == FILL_ONES ? longest
                                                              : random_below(seed, longest + 1));
        memcpy((char *)m + tail->count_offset, &count, sizeof count);
        const size_t width = number_bytes(tail->type), bytes = count * tail->element_bytes;
        for (size_t at = 0; at < bytes; at += width) {
            fill_number((char *)m + tail->offset + at, tail->type, kind, seed);
        }
    }
}

#endif
