/* dynamixel.h - packets of Dynamixel Protocol 2.0, both directions: the master writes instructions and reads
 * status packets, the simulator's servos the other way round.
 *
 *     FF FF FD 00 · id · length, 2 bytes · instruction · [error, in a status packet] · parameters · CRC, 2 bytes
 *
 * Numbers go low byte first. The length counts from the instruction to the CRC. Wherever FF FF FD stands in
 * what the length counts, but for the CRC, a further FD is stuffed in behind it, so that the header with its 00
 * stands nowhere else. The CRC-16 (polynomial 8005, from 0, not reflected) covers all before it.
 *
 * Source: ROBOTIS e-Manual, page DYNAMIXEL Protocol 2.0, sections Instruction Packet, Status Packet, Packet Process and
 * Instruction Details; page CRC Calculation. Caller-owned memory, no state but what is passed in, main loop or
 * interrupt alike.
 */
#ifndef LIMBER_DYNAMIXEL_H
#define LIMBER_DYNAMIXEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef enum {
    DXL_PING = 0x01,
    DXL_READ = 0x02,
    DXL_WRITE = 0x03,
    DXL_REBOOT = 0x08,
    DXL_STATUS = 0x55,
    DXL_SYNC_READ = 0x82,
    DXL_SYNC_WRITE = 0x83,
} dxl_instruction;

/* The error of a status packet: a number, and DXL_ALERT while Hardware Error Status is not 0. */
enum {
    DXL_E_RESULT = 0x01,
    DXL_E_INSTRUCTION = 0x02,
    DXL_E_CRC = 0x03,
    DXL_E_RANGE = 0x04,
    DXL_E_LENGTH = 0x05,
    DXL_E_LIMIT = 0x06,
    DXL_E_ACCESS = 0x07,
    DXL_ALERT = 0x80,
};

enum {
    DXL_BROADCAST = 0xFE,
    DXL_PARAMS_AT = 8,       /* where the parameters of an instruction begin */
    DXL_OVERHEAD_BYTES = 10, /* of an instruction without parameters */
    DXL_STATUS_BYTES = 11,   /* of a status packet without parameters */
    DXL_LENGTH_MAX = 1024,   /* a longer one is taken for noise */
    DXL_SYNC_PARAMS_AT =
        DXL_PARAMS_AT + 4, /* where the servos' part of a sync instruction begins */
};

/* Goes on from `crc`, at first 0. About 7 instructions a byte on a Cortex-M4. */
uint16_t dxl_crc16(uint16_t crc, const uint8_t *bytes, size_t bytes_n);

/* --- Writing. All return the packet's length in bytes, or 0 if it does not fit room. --- */

/* Makes a packet of the params_n parameters that stand at packet + DXL_PARAMS_AT: header, stuffing, CRC. All
 * others end in this one. About 10 instructions a byte. */
size_t dxl_seal(uint8_t *packet, size_t room, uint8_t id, uint8_t instruction, size_t params_n);

size_t dxl_ping(uint8_t *packet, size_t room, uint8_t id);
size_t dxl_reboot(uint8_t *packet, size_t room, uint8_t id);
size_t dxl_read(uint8_t *packet, size_t room, uint8_t id, uint16_t address, uint16_t n);
/* The n <= 4 low bytes of value. */
size_t dxl_write(uint8_t *packet, size_t room, uint8_t id, uint16_t address, uint16_t n,
                 uint32_t value);
size_t dxl_status(uint8_t *packet, size_t room, uint8_t id, uint8_t error, const uint8_t *params,
                  size_t params_n);

/* Sync instructions in two steps: this one writes address and length of the data, then the caller puts each
 * servo's part (its id; for a write, the n bytes after it) behind one another from packet + DXL_SYNC_PARAMS_AT,
 * then dxl_seal(packet, room, DXL_BROADCAST, instruction, 4 + parts_n). Needs room for DXL_SYNC_PARAMS_AT. */
void dxl_sync_open(uint8_t *packet, uint16_t address, uint16_t n);

/* --- Reading --- */

/* A packet whose CRC is right, without its stuffing. params stays valid until the next byte goes in. */
typedef struct {
    uint8_t id, instruction;
    uint8_t error; /* of a status packet */
    const uint8_t *params;
    size_t params_n; /* all of them; no more than the decoder's room are at *params */
    size_t wire_n;   /* bytes on the wire */
} dxl_packet;

/* Treat as private, but for bad_n. Whatever comes in, no byte is written beyond room, and a whole packet is found
 * if nothing tore it, even right behind a torn one. */
typedef struct {
    uint8_t *params;
    size_t room;
    uint32_t
        bad_n; /* packets with a wrong CRC or an impossible length, or torn by a new header; wraps */
    uint32_t last; /* bytes, the newest lowest */
    uint8_t state, id, instruction, error;
    uint16_t length, left_n; /* from the instruction on; and without the CRC, still to come */
    uint16_t params_n;
    uint16_t crc, crc_sent;
} dxl_decoder;

/* Parameters go to params[room], which must outlive the decoder; of a longer packet the first are kept. */
void dxl_decoder_init(dxl_decoder *d, uint8_t *params, size_t room);

/* The next byte from the wire. True: it was the last of a packet, now in *packet. About 50 instructions. */
bool dxl_decode(dxl_decoder *d, uint8_t byte, dxl_packet *packet);

/* --- Numbers, low byte first --- */

static inline uint16_t dxl_u16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static inline uint32_t dxl_u32(const uint8_t *bytes)
{
    return dxl_u16(bytes) | (uint32_t)dxl_u16(bytes + 2) << 16;
}

/* One store, which matters for a hundred goals. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
               "numbers are written as they lie in memory");
static inline void dxl_put_u32(uint8_t *bytes, uint32_t value)
{
    memcpy(bytes, &value, sizeof value);
}

#endif
