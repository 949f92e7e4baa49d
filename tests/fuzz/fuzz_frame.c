/* fuzz_frame.c - any bytes through decoder and messages; traps where a promise of their headers is broken.
 *
 * The first byte of the input says what the rest is:
 *   even   what the line brings
 *   odd    a body without its checksum, which is made right: gets past the checksum to the messages */
#include <string.h>

#include "messages.h"

#define PROMISE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            __builtin_trap();                                                                      \
        }                                                                                          \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *input, size_t input_n);

static uint8_t payload[FRAME_PAYLOAD_MAX], wire[FRAME_WIRE_MAX];
static message first, second;

/* What comes out of a frame goes in again and comes out the same. */
static void try_message(const frame *f)
{
    PROMISE(f->payload_n <= FRAME_PAYLOAD_MAX);
    memset(&first, 0, sizeof first);
    const messages_error error = messages_unpack(f, &first);
    const message_info *const info = messages_info(f->type);
    PROMISE((error == MESSAGES_E_TYPE) == (info == NULL));
    if (error != MESSAGES_OK) {
        return;
    }
    const int n = messages_pack(&first, payload, sizeof payload);
    PROMISE(n >= info->fixed_bytes && (size_t)n <= f->payload_n);
    const frame again = {f->type, f->session, f->seq, f->t_us, payload, (size_t)n};
    memset(&second, 0, sizeof second);
    PROMISE(messages_unpack(&again, &second) == MESSAGES_OK);
    PROMISE(memcmp(&first, &second, sizeof first) == 0);
}

static void try_line(const uint8_t *bytes, size_t bytes_n)
{
    static frame_decoder decoder;
    frame_decoder_init(&decoder);
    uint32_t stretches = 0, good = 0;
    for (size_t i = 0; i < bytes_n; i++) {
        frame f;
        const bool border = bytes[i] == 0 && i > 0 && bytes[i - 1] != 0;
        stretches += border ? 1 : 0;
        if (frame_decoder_push(&decoder, bytes[i], &f)) {
            PROMISE(border);
            good++;
            try_message(&f);
        }
    }
    const frame_counts *const counts = &decoder.counts;
    PROMISE(good == counts->good);
    PROMISE(stretches ==
            counts->good + counts->crc + counts->cobs + counts->too_short + counts->too_long);
}

static void try_body(const uint8_t *body, size_t body_n)
{
    if (body_n < FRAME_HEADER_BYTES || body_n > FRAME_HEADER_BYTES + FRAME_PAYLOAD_MAX) {
        return;
    }
    static frame_decoder decoder;
    frame_decoder_init(&decoder);
    const frame sent = {.type = body[0],
                        .session = body[1],
                        .seq = (uint16_t)(body[2] | body[3] << 8),
                        .t_us = (uint32_t)body[4] | (uint32_t)body[5] << 8 |
                                (uint32_t)body[6] << 16 | (uint32_t)body[7] << 24,
                        .payload = body + FRAME_HEADER_BYTES,
                        .payload_n = body_n - FRAME_HEADER_BYTES};
    const size_t wire_n = frame_encode(&sent, wire, sizeof wire);
    PROMISE(wire_n > 0 && wire_n <= FRAME_WIRE_BYTES(sent.payload_n));
    for (size_t i = 0; i < wire_n; i++) {
        frame f;
        const bool came = frame_decoder_push(&decoder, wire[i], &f);
        PROMISE(came == (i == wire_n - 1));
        if (came) {
            PROMISE(f.type == sent.type && f.session == sent.session && f.seq == sent.seq);
            PROMISE(f.t_us == sent.t_us && f.payload_n == sent.payload_n);
            PROMISE(memcmp(f.payload, sent.payload, sent.payload_n) == 0);
            try_message(&f);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *input, size_t input_n)
{
    if (input_n > 0) {
        (input[0] % 2 == 0 ? try_line : try_body)(input + 1, input_n - 1);
    }
    return 0;
}
