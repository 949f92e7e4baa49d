/* crc32c.h - the checksum of frames and of settings records: CRC-32C (Castagnoli).
 *
 * Reflected polynomial 0x1EDC6F41, register and result inverted; "123456789" gives 0xE3069283. It finds
 * every pattern of up to 5 flipped bits in up to 655 bytes and of up to 3 in anything we send (Koopman
 * 2002), and, its register starting at ones, also lost or added zero bytes.
 *
 *     uint32_t crc = CRC32C_START;
 *     crc = crc32c_add(crc, bytes, bytes_n);        // as often as needed, in any pieces
 *     uint32_t checksum = crc32c_finish(crc);
 *
 * A stream that ends in its own checksum, low byte first, always leaves CRC32C_RESIDUE in the register:
 * a receiver need not know in advance where the checksum starts.
 *
 * Pure functions, safe in an interrupt. A table of 1 KB; about 6 instructions a byte.
 */
#ifndef LIMBER_CRC32C_H
#define LIMBER_CRC32C_H

#include <stddef.h>
#include <stdint.h>

#define CRC32C_START 0xFFFFFFFFu
#define CRC32C_RESIDUE 0xB798B438u

extern const uint32_t crc32c_table[256];

static inline uint32_t crc32c_add_byte(uint32_t crc, uint8_t byte)
{
    return crc32c_table[(crc ^ byte) & 0xFFu] ^ (crc >> 8);
}

uint32_t crc32c_add(uint32_t crc, const void *bytes, size_t bytes_n);

static inline uint32_t crc32c_finish(uint32_t crc)
{
    return crc ^ 0xFFFFFFFFu;
}

/* All three in one. */
uint32_t crc32c(const void *bytes, size_t bytes_n);

#endif
