/* capsule.h - a replay in a nutshell: the rod's parameters and the exact float32 pose of every tick.
 *
 * Written by `limber-sim replay --capsule`, read by the emulated board's test, which must come to the
 * same hash. A test's file, not a wire format: structs as they lie in memory. Both ends are little-endian
 * with 4-byte int32 and float and no padding, which the assertions below hold them to.
 */
#ifndef LIMBER_CAPSULE_H
#define LIMBER_CAPSULE_H

#include <stdint.h>

#include "rod.h"

#define CAPSULE_MAGIC UINT32_C(0x4c4d4231) /* "LMB1" */

typedef struct {
    uint32_t magic;
    uint32_t ticks_n;
    rod_params params;
} capsule_header;

typedef struct {
    uint32_t restart; /* 1: the rod starts anew at this tick */
    rod_pose base;
} capsule_tick;

_Static_assert(sizeof(capsule_header) == 8 + 4 * (6 + 9 * ROD_MAX_LINKS), "no padding");
_Static_assert(sizeof(capsule_tick) == 32, "no padding");

#endif
