/* angle_hash.h - one number for all the bits of a run: FNV-1a, 64 bits, over the float32 angles,
 * little-endian, row after row, theta before phi. Used on the host and on the target alike. */
#ifndef LIMBER_ANGLE_HASH_H
#define LIMBER_ANGLE_HASH_H

#include <stdint.h>
#include <string.h>

#define ANGLE_HASH_START UINT64_C(0xcbf29ce484222325)

static inline uint64_t angle_hash_add(uint64_t hash, const float *values, int values_n)
{
    for (int i = 0; i < values_n; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        for (int byte = 0; byte < 4; byte++) {
            hash = (hash ^ (bits & 0xffu)) * UINT64_C(0x100000001b3);
            bits >>= 8;
        }
    }
    return hash;
}

#endif
