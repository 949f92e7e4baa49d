/* saved_params.h - parameters as bytes for flash, by name, so that other firmware can read them.
 *
 * Each kept parameter: CRC-32C of its name u32, number of entries u16, 0 u16, entries f32; little-endian. A reader
 * skips names it does not know and leaves what it does not find as it was.
 */
#ifndef LIMBER_SAVED_PARAMS_H
#define LIMBER_SAVED_PARAMS_H

#include "params.h"

#define SAVED_PARAMS_VERSION 1u

/* The most bytes a set takes. */
uint32_t saved_params_bytes_max(void);

/* Returns the bytes written; room >= saved_params_bytes_max(). */
uint32_t saved_params_pack(const params_set *set, uint8_t *bytes);

/* Values go into *set as they are; params_commit judges them. */
void saved_params_unpack(const uint8_t *bytes, uint32_t bytes_n, params_set *set);

#endif
