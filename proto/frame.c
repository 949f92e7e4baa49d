/* frame.c - see frame.h. */
#include "frame.h"

#include "crc32c.h"

/* COBS: a body is cut at its zeros and every 254 other bytes. Each block is sent as its length plus one,
 * the code, and its bytes; a code below FULL_BLOCK stands for a zero after the block, save the last. */
enum { FULL_BLOCK = 0xFF };

typedef struct {
    uint8_t *code; /* where the open block's code will be written */
    uint8_t *next;
    uint32_t crc;
    bool after_full; /* a full block was closed: a new one opens only if a byte follows */
} encoder;

static void open_block(encoder *e)
{
    e->code = e->next++;
    e->after_full = false;
}

static void close_block(encoder *e)
{
    *e->code = (uint8_t)(e->next - e->code);
}

static void encode_byte(encoder *e, uint8_t byte)
{
    if (e->after_full) {
        open_block(e);
    }
    if (byte == 0) {
        close_block(e);
        open_block(e);
        return;
    }
    *e->next++ = byte;
    if (e->next - e->code == FULL_BLOCK) {
        close_block(e);
        e->after_full = true;
    }
}

static void encode(encoder *e, const uint8_t *bytes, size_t bytes_n)
{
    for (size_t i = 0; i < bytes_n; i++) {
        e->crc = crc32c_add_byte(e->crc, bytes[i]);
        encode_byte(e, bytes[i]);
    }
}

static void encode_little_endian(encoder *e, uint32_t value, int bytes_n)
{
    for (int i = 0; i < bytes_n; i++) {
        const uint8_t byte = (uint8_t)(value >> (8 * i));
        encode(e, &byte, 1);
    }
}

size_t frame_encode(const frame *f, uint8_t *wire, size_t room)
{
    if (f->payload_n > FRAME_PAYLOAD_MAX || room < FRAME_WIRE_BYTES(f->payload_n)) {
        return 0;
    }
    encoder e = {.next = wire, .crc = CRC32C_START};
    *e.next++ = 0;
    open_block(&e);
    encode_little_endian(&e, f->type, 1);
    encode_little_endian(&e, f->session, 1);
    encode_little_endian(&e, f->seq, 2);
    encode_little_endian(&e, f->t_us, 4);
    encode(&e, f->payload, f->payload_n);
    encode_little_endian(&e, crc32c_finish(e.crc), FRAME_CRC_BYTES);
    close_block(&e);
    *e.next++ = 0;
    return (size_t)(e.next - wire);
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
