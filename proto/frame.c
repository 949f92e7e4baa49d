/* frame.c - see frame.h. */
#include "frame.h"

#include <string.h>

#include "crc32c.h"

/* COBS: a body is cut at its zeros and every 254 other bytes. Each block is sent as its length plus one,
 * the code, and its bytes; a code below FULL_BLOCK stands for a zero after the block, save the last. */
enum { FULL_BLOCK = 0xFF };

static void put_little_endian(uint8_t *to, uint32_t value, int bytes_n)
{
    for (int i = 0; i < bytes_n; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

/* Returns the end of what was written. The last block is closed without a zero after it. */
static uint8_t *stuff(const uint8_t *body, size_t body_n, uint8_t *wire)
{
    uint8_t *code = wire, *next = wire + 1;
    for (size_t i = 0; i < body_n; i++) {
        if (next - code == FULL_BLOCK) { /* a new block only because a byte follows */
            *code = FULL_BLOCK;
            code = next++;
        }
        const uint8_t byte = body[i];
        if (byte != 0) {
            *next++ = byte;
        } else {
            *code = (uint8_t)(next - code);
            code = next++;
        }
    }
    *code = (uint8_t)(next - code);
    return next;
}

size_t frame_encode(const frame *f, uint8_t *wire, size_t room)
{
    uint8_t body[FRAME_BODY_MAX];
    if (f->payload_n > FRAME_PAYLOAD_MAX || room < FRAME_WIRE_BYTES(f->payload_n)) {
        return 0;
    }
    const size_t before_crc_n = FRAME_HEADER_BYTES + f->payload_n;
    body[0] = f->type;
    body[1] = f->session;
    put_little_endian(body + 2, f->seq, 2);
    put_little_endian(body + 4, f->t_us, 4);
    if (f->payload_n > 0) {
        memcpy(body + FRAME_HEADER_BYTES, f->payload, f->payload_n);
    }
    put_little_endian(body + before_crc_n, crc32c(body, before_crc_n), FRAME_CRC_BYTES);
    wire[0] = 0;
    uint8_t *end = stuff(body, before_crc_n + FRAME_CRC_BYTES, wire + 1);
    *end++ = 0;
    return (size_t)(end - wire);
}

void frame_decoder_restart(frame_decoder *decoder)
{
    decoder->crc = CRC32C_START;
    decoder->body_n = 0;
    decoder->block_left = 0;
    decoder->zero_due = decoder->started = decoder->flood = false;
}

void frame_decoder_init(frame_decoder *decoder)
{
    decoder->counts = (frame_counts){0, 0, 0, 0, 0};
    frame_decoder_restart(decoder);
}

static void store(frame_decoder *decoder, uint8_t byte)
{
    if (decoder->body_n == FRAME_BODY_MAX) {
        decoder->flood = true;
        return;
    }
    decoder->body[decoder->body_n++] = byte;
    decoder->crc = crc32c_add_byte(decoder->crc, byte);
}

static uint32_t little_endian(const uint8_t *bytes, int bytes_n)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes_n; i++) {
        value |= (uint32_t)bytes[i] << (8 * i);
    }
    return value;
}

/* The stretch before a zero: the count of its fate. */
static uint32_t *judge(frame_decoder *decoder)
{
    if (decoder->flood) {
        return &decoder->counts.too_long;
    }
    if (decoder->block_left > 0) {
        return &decoder->counts.cobs;
    }
    if (decoder->body_n < FRAME_BODY_MIN) {
        return &decoder->counts.too_short;
    }
    return decoder->crc == CRC32C_RESIDUE ? &decoder->counts.good : &decoder->counts.crc;
}

static bool finish(frame_decoder *decoder, frame *f)
{
    if (!decoder->started) {
        return false;
    }
    uint32_t *const fate = judge(decoder);
    ++*fate;
    const bool good = fate == &decoder->counts.good;
    if (good) {
        const uint8_t *const body = decoder->body;
        *f = (frame){.type = body[0],
                     .session = body[1],
                     .seq = (uint16_t)little_endian(body + 2, 2),
                     .t_us = little_endian(body + 4, 4),
                     .payload = body + FRAME_HEADER_BYTES,
                     .payload_n = (size_t)decoder->body_n - FRAME_BODY_MIN};
    }
    frame_decoder_restart(decoder);
    return good;
}

bool frame_decoder_push(frame_decoder *decoder, uint8_t byte, frame *f)
{
    if (byte == 0) {
        return finish(decoder, f);
    }
    decoder->started = true;
    if (decoder->flood) {
        return false;
    }
    if (decoder->block_left > 0) {
        decoder->block_left--;
        store(decoder, byte);
        return false;
    }
    /* a code: the block before it is over, and so a block does follow the zero it stood for */
    if (decoder->zero_due) {
        store(decoder, 0);
    }
    decoder->block_left = (uint8_t)(byte - 1);
    decoder->zero_due = byte != FULL_BLOCK;
    return false;
}
