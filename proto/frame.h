/* frame.h - one message as bytes on a line, and back, whatever the line does to them.
 *
 *     0x00 . COBS( type u8, session u8, seq u16, t_us u32 . payload . CRC-32C u32 ) . 0x00
 *
 * All little-endian. COBS (Cheshire and Baker 1999) takes every zero out of the body at the price of one
 * byte in 254, so that a zero can only be a border; the checksum covers header and payload. The first
 * zero ends whatever garbage came before; two frames in a row may share one, and more in a row are
 * nothing. PROTOCOL.md is normative.
 *
 * Plain data on caller-owned memory. No function here blocks or keeps a pointer of the caller's; each
 * is safe in an interrupt as long as one decoder is used from one place only.
 */
#ifndef LIMBER_FRAME_H
#define LIMBER_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    FRAME_HEADER_BYTES = 8,
    FRAME_CRC_BYTES = 4,
    FRAME_PAYLOAD_MAX = 1100,
    FRAME_BODY_MIN = FRAME_HEADER_BYTES + FRAME_CRC_BYTES,
    FRAME_BODY_MAX = FRAME_BODY_MIN + FRAME_PAYLOAD_MAX,
};

/* The most bytes on the line, both zeros included, that a frame of that payload takes: exact up to
 * 242 bytes of payload, above that at most the number of full 254s too many. */
#define FRAME_WIRE_BYTES(payload_n)                                                                \
    (FRAME_BODY_MIN + (payload_n) + (FRAME_BODY_MIN + (payload_n) + 253) / 254 + 2)

enum { FRAME_WIRE_MAX = FRAME_WIRE_BYTES(FRAME_PAYLOAD_MAX) };

typedef struct {
    uint8_t type;    /* message_type, or one that a later minor version added */
    uint8_t session; /* chosen by the PC with each HELLO; 0 before the first */
    uint16_t seq;    /* counts this sender's frames of this type, wraps */
    uint32_t t_us;   /* sender's clock when it was packed, wraps */
    const uint8_t *payload;
    size_t payload_n;
} frame;

/* Write the frame to wire, both zeros included. Returns the bytes written, or 0, with nothing of use
 * written, if room < FRAME_WIRE_BYTES(payload_n) or the payload is longer than FRAME_PAYLOAD_MAX.
 * Cost: about 25 instructions a byte. */
size_t frame_encode(const frame *f, uint8_t *wire, size_t room);

/* What has come in, by the fate of each stretch between two zeros; empty ones are not counted. */
typedef struct {
    uint32_t good;
    uint32_t crc;       /* whole, but the checksum is wrong */
    uint32_t cobs;      /* cut off: the coding promised more bytes than came */
    uint32_t too_short; /* less than a header and a checksum */
    uint32_t too_long;  /* more than FRAME_BODY_MAX; known and discarded before its end */
} frame_counts;

/* A decoder: 1.2 KB. Its counts may be read at any time; treat the rest as private. */
typedef struct {
    frame_counts counts;
    uint32_t crc;
    uint16_t body_n;
    uint8_t block_left;  /* bytes still to come in this COBS block */
    bool zero_due;       /* this block stands for a zero after it, if any block follows */
    bool started, flood; /* a byte has come since the last zero; more than fits have */
    uint8_t body[FRAME_BODY_MAX];
} frame_decoder;

/* Ready for the first byte, all counts 0. */
void frame_decoder_init(frame_decoder *decoder);

/* One byte from the line. True if it completes a good frame: *f then describes it, its payload pointing
 * into the decoder until the next push. Otherwise *f is left alone. Cost: at most one byte stored and
 * checksummed, about 40 instructions, whatever the byte. */
bool frame_decoder_push(frame_decoder *decoder, uint8_t byte, frame *f);

/* The line was interrupted (port reopened, bytes known lost): what has come since the last zero cannot
 * become a frame and is forgotten, uncounted. */
void frame_decoder_restart(frame_decoder *decoder);

#endif
