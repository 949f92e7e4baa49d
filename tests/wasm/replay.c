/* replay.c - the core as WebAssembly: node hands it a capsule piece by piece, it keeps the hash.
 *
 * No C library there: the few functions that the compiler calls are at the end.
 */
#include <stddef.h>

#include "angle_hash.h"
#include "capsule.h"

#define EXPORT __attribute__((visibility("default")))

EXPORT capsule_header *header_place(void);
EXPORT capsule_tick *tick_place(void);
EXPORT int begin(void);
EXPORT int step(void);
EXPORT uint32_t hash_high(void);
EXPORT uint32_t hash_low(void);

static capsule_header header;
static capsule_tick tick;
static rod subject;
static scene objects;
static uint64_t hash = ANGLE_HASH_START;

capsule_header *header_place(void)
{
    return &header;
}

capsule_tick *tick_place(void)
{
    return &tick;
}

int begin(void)
{
    return capsule_begin(&header, &objects, &subject);
}

int step(void)
{
    if (tick.restart != 0) {
        rod_reset(&subject);
    }
    const rod_error error = rod_step(&subject, &tick.base);
    hash = angle_hash_add(hash, &rod_angles(&subject)[0][0], 2 * header.params.links_n);
    return error;
}

uint32_t hash_high(void)
{
    return (uint32_t)(hash >> 32);
}

uint32_t hash_low(void)
{
    return (uint32_t)hash;
}

void *memset(void *to, int value, size_t n)
{
    for (unsigned char *c = to; n > 0; n--) {
        *c++ = (unsigned char)value;
    }
    return to;
}

void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    unsigned char *c = to;
    for (const unsigned char *f = from; n > 0; n--) {
        *c++ = *f++;
    }
    return to;
}

int strcmp(const char *a, const char *b)
{
    for (; *a != '\0' && *a == *b; a++, b++) {
    }
    return (unsigned char)*a - (unsigned char)*b;
}
