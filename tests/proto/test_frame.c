/* test_frame.c - frames there and back, the exact bytes, and the exact count of everything that is none. */
#include "crc32c.h"
#include "frame.h"
#include "proto_support.h"
#include "unity.h"

static frame_decoder decoder;
static uint8_t payload[FRAME_PAYLOAD_MAX + 1], wire[2 * FRAME_WIRE_MAX];
static frame got; /* the last frame decoded */

void setUp(void)
{
    frame_decoder_init(&decoder);
}
void tearDown(void) {}

/* How many frames come out of these bytes. */
static int feed(const uint8_t *bytes, size_t bytes_n)
{
    int frames_n = 0;
    for (size_t i = 0; i < bytes_n; i++) {
        frames_n += frame_decoder_push(&decoder, bytes[i], &got) ? 1 : 0;
    }
    return frames_n;
}

#define ASSERT_COUNTS(...)                                                                         \
    do {                                                                                           \
        const frame_counts expected = {__VA_ARGS__};                                               \
        TEST_ASSERT_EQUAL_UINT32(expected.good, decoder.counts.good);                              \
        TEST_ASSERT_EQUAL_UINT32(expected.crc, decoder.counts.crc);                                \
        TEST_ASSERT_EQUAL_UINT32(expected.cobs, decoder.counts.cobs);                              \
        TEST_ASSERT_EQUAL_UINT32(expected.too_short, decoder.counts.too_short);                    \
        TEST_ASSERT_EQUAL_UINT32(expected.too_long, decoder.counts.too_long);                      \
    } while (0)

/* COBS the way the paper tells it: whole at once, into `body`. Returns its length. */
static size_t textbook_cobs_decode(const uint8_t *coded, size_t coded_n, uint8_t *body)
{
    size_t n = 0;
    for (size_t at = 0; at < coded_n;) {
        const uint8_t code = coded[at++];
        for (int i = 1; i < code; i++) {
            body[n++] = coded[at++];
        }
        if (code < 0xFF && at < coded_n) {
            body[n++] = 0;
        }
    }
    return n;
}

static void every_length_and_kind_comes_back(void)
{
    uint32_t seed = 3, good = 0;
    static uint8_t body[FRAME_BODY_MAX];
    for (size_t n = 0; n <= FRAME_PAYLOAD_MAX; n += HOST_OR_BOARD(1, 13)) {
        for (int kind = 0; kind < BYTES_KINDS; kind++) {
            random_bytes(payload, n, (bytes_kind)kind, &seed);
            const frame sent = random_frame(payload, n, &seed);
            const size_t wire_n = frame_encode(&sent, wire, FRAME_WIRE_BYTES(n));
            TEST_ASSERT_TRUE(wire_n > 0 && wire_n <= FRAME_WIRE_BYTES(n));
            TEST_ASSERT_TRUE(n > 242 || wire_n == n + 15);
            TEST_ASSERT_EQUAL_HEX8(0, wire[0]);
            TEST_ASSERT_EQUAL_HEX8(0, wire[wire_n - 1]);
            TEST_ASSERT_NULL(memchr(wire + 1, 0, wire_n - 2));

            TEST_ASSERT_EQUAL_INT(0, feed(wire, wire_n - 1));
            TEST_ASSERT_EQUAL_INT(1, feed(wire + wire_n - 1, 1));
            TEST_ASSERT_TRUE(frames_same(&sent, &got));
            good++;

            const size_t body_n = textbook_cobs_decode(wire + 1, wire_n - 2, body);
            TEST_ASSERT_EQUAL_size_t(FRAME_BODY_MIN + n, body_n);
            TEST_ASSERT_EQUAL_HEX8(sent.type, body[0]);
            TEST_ASSERT_EQUAL_HEX8(sent.session, body[1]);
            TEST_ASSERT_EQUAL_HEX16(sent.seq, body[2] | body[3] << 8);
            TEST_ASSERT_EQUAL_HEX32(sent.t_us, body[4] | (uint32_t)body[5] << 8 |
                                                   (uint32_t)body[6] << 16 |
                                                   (uint32_t)body[7] << 24);
            TEST_ASSERT_TRUE(n == 0 || memcmp(payload, body + 8, n) == 0);
            const uint32_t crc = crc32c(body, 8 + n);
            for (size_t i = 0; i < 4; i++) {
                TEST_ASSERT_EQUAL_HEX8((uint8_t)(crc >> (8 * i)), body[8 + n + i]);
            }
        }
    }
    ASSERT_COUNTS(.good = good);
}

/* A run of just 254 bytes without a zero, at the end of the body and before a zero: the corners of COBS.
 * The payload is searched until the checksum has no zero either. */
static void runs_of_254(void)
{
    uint32_t seed = 4;
    const int lengths[] = {253, 254, 255, 507, 508, 509, 510, 762, 763};
    for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
        for (int found = 0; found < 3;) {
            const size_t n = (size_t)lengths[k] - FRAME_BODY_MIN;
            random_bytes(payload, n, BYTES_NO_ZERO, &seed);
            const frame sent = {1, 1, 0x0101, 0x01010101, payload, n};
            const size_t wire_n = frame_encode(&sent, wire, sizeof wire);
            TEST_ASSERT_EQUAL_INT(1, feed(wire, wire_n));
            TEST_ASSERT_TRUE(frames_same(&sent, &got));
            const size_t blocks_n = (size_t)(lengths[k] + 253) / 254;
            const bool no_zero_at_all = wire[1] == 0xFF || (lengths[k] < 254 && wire[1] == 254);
            found += no_zero_at_all && wire_n == (size_t)lengths[k] + blocks_n + 2 ? 1 : 0;
        }
    }
}

/* Some encoders close a last full block with an empty one: the same body. */
static void empty_block_after_a_full_one(void)
{
    uint32_t seed = 5;
    size_t wire_n;
    frame sent;
    do {
        random_bytes(payload, 254 - FRAME_BODY_MIN, BYTES_NO_ZERO, &seed);
        sent = (frame){9, 9, 0x0909, 0x09090909, payload, 254 - FRAME_BODY_MIN};
        wire_n = frame_encode(&sent, wire, sizeof wire);
    } while (wire[1] != 0xFF);
    wire[wire_n - 1] = 1;
    wire[wire_n] = 0;
    TEST_ASSERT_EQUAL_INT(1, feed(wire, wire_n + 1));
    TEST_ASSERT_TRUE(frames_same(&sent, &got));
}

static void encoder_refuses_what_does_not_fit(void)
{
    uint32_t seed = 6;
    random_bytes(payload, sizeof payload, BYTES_NO_ZERO, &seed);
    for (size_t n = 0; n <= FRAME_PAYLOAD_MAX; n += 100) {
        const frame f = random_frame(payload, n, &seed);
        memset(wire, 0xA5, sizeof wire);
        TEST_ASSERT_EQUAL_size_t(0, frame_encode(&f, wire, FRAME_WIRE_BYTES(n) - 1));
        TEST_ASSERT_TRUE(frame_encode(&f, wire, FRAME_WIRE_BYTES(n)) > 0);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xA5, wire + FRAME_WIRE_BYTES(n),
                                    sizeof wire - FRAME_WIRE_BYTES(n));
    }
    const frame longer = random_frame(payload, FRAME_PAYLOAD_MAX + 1, &seed);
    TEST_ASSERT_EQUAL_size_t(0, frame_encode(&longer, wire, sizeof wire));
    TEST_ASSERT_EQUAL_INT(FRAME_WIRE_MAX, FRAME_WIRE_BYTES(FRAME_PAYLOAD_MAX));
}

static size_t example(size_t payload_n, uint32_t *seed)
{
    random_bytes(payload, payload_n, BYTES_ANY, seed);
    const frame f = random_frame(payload, payload_n, seed);
    return frame_encode(&f, wire, sizeof wire);
}

static void zeros_are_borders_and_nothing_else(void)
{
    uint32_t seed = 7;
    static const uint8_t ZEROS[5] = {0};
    TEST_ASSERT_EQUAL_INT(0, feed(ZEROS, 5));
    ASSERT_COUNTS(0);
    for (uint32_t i = 0; i < 10; i++) { /* one zero between each two */
        const size_t n = example(30, &seed);
        const size_t skipped_n = i == 0 ? 0 : 1;
        TEST_ASSERT_EQUAL_INT(1, feed(wire + skipped_n, n - skipped_n));
    }
    feed(ZEROS, 5);
    ASSERT_COUNTS(.good = 10);
}

static void first_frame_needs_no_leading_zero(void)
{
    uint32_t seed = 8;
    const size_t n = example(30, &seed);
    TEST_ASSERT_EQUAL_INT(1, feed(wire + 1, n - 1));
}

static void cut_off_at_every_place(void)
{
    uint32_t seed = 9;
    const size_t n = example(32, &seed);
    for (size_t kept_n = 2; kept_n < n - 1; kept_n++) {
        const uint32_t bad = decoder.counts.crc + decoder.counts.cobs + decoder.counts.too_short;
        TEST_ASSERT_EQUAL_INT(0, feed(wire, kept_n));
        TEST_ASSERT_EQUAL_INT(1, feed(wire, n));
        TEST_ASSERT_EQUAL_UINT32(bad + 1, decoder.counts.crc + decoder.counts.cobs +
                                              decoder.counts.too_short);
    }
}

/* One stretch of each kind, known by construction. */
static void every_cause_has_its_count(void)
{
    uint32_t seed = 10;
    static const uint8_t SHORT[] = {0, 5, 1, 2, 3, 4, 0}; /* 4 bytes */
    static const uint8_t SHORTER[] = {0, 1, 0};           /* none */
    static const uint8_t ELEVEN[] = {0, 12, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    static const uint8_t TWELVE[] = {0, 13, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    static const uint8_t CUT[] = {0, 14, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    TEST_ASSERT_EQUAL_INT(0, feed(SHORT, sizeof SHORT));
    ASSERT_COUNTS(.too_short = 1);
    TEST_ASSERT_EQUAL_INT(0, feed(SHORTER, sizeof SHORTER));
    TEST_ASSERT_EQUAL_INT(0, feed(ELEVEN, sizeof ELEVEN));
    ASSERT_COUNTS(.too_short = 3);
    TEST_ASSERT_EQUAL_INT(0, feed(TWELVE, sizeof TWELVE));
    ASSERT_COUNTS(.too_short = 3, .crc = 1);
    TEST_ASSERT_EQUAL_INT(0, feed(CUT, sizeof CUT));
    ASSERT_COUNTS(.too_short = 3, .crc = 1, .cobs = 1);
    TEST_ASSERT_EQUAL_INT(1, feed(wire, example(0, &seed)));
    ASSERT_COUNTS(.good = 1, .too_short = 3, .crc = 1, .cobs = 1);
}

static void overlong_is_discarded_once_and_for_all(void)
{
    uint32_t seed = 11;
    const size_t n = example(FRAME_PAYLOAD_MAX, &seed);
    for (int zeros = 0; zeros < 2; zeros++) { /* runs of full blocks; of empty ones */
        static uint8_t one_longer[FRAME_BODY_MAX + 2];
        memset(one_longer, 1, sizeof one_longer);
        if (zeros == 0) { /* a body of FRAME_BODY_MAX + 1: five blocks */
            for (size_t at = 0; at < sizeof one_longer; at += 255) {
                one_longer[at] = 0xFF;
            }
        }
        TEST_ASSERT_EQUAL_INT(0, feed((const uint8_t[]){0}, 1));
        TEST_ASSERT_EQUAL_INT(0, feed(one_longer, sizeof one_longer));
        if (zeros == 0) {
            TEST_ASSERT_EQUAL_INT(0, feed((const uint8_t[]){1, 1, 1, 1, 1}, 5));
        }
        for (int i = 0; i < HOST_OR_BOARD(100000, 5000); i++) {
            TEST_ASSERT_EQUAL_INT(0, feed((const uint8_t[]){0x5A}, 1));
        }
        TEST_ASSERT_EQUAL_INT(1, feed(wire, n));
        ASSERT_COUNTS(.good = (uint32_t)zeros + 1, .too_long = (uint32_t)zeros + 1);
    }
}

/* A body of the greatest length is no overrun, one more byte is. */
static void the_longest_body_and_one_more(void)
{
    for (size_t body_n = FRAME_BODY_MAX - 1; body_n <= FRAME_BODY_MAX + 1; body_n++) {
        frame_decoder_init(&decoder);
        for (size_t i = 0; i <= body_n; i++) { /* n zeros are n + 1 empty blocks */
            TEST_ASSERT_EQUAL_INT(0, feed((const uint8_t[]){1}, 1));
        }
        TEST_ASSERT_EQUAL_INT(0, feed((const uint8_t[]){0}, 1));
        if (body_n <= FRAME_BODY_MAX) {
            ASSERT_COUNTS(.crc = 1);
        } else {
            ASSERT_COUNTS(.too_long = 1);
        }
    }
}

static void restart_forgets_the_stretch_under_way(void)
{
    uint32_t seed = 12;
    const size_t n = example(30, &seed);
    feed(wire, n / 2);
    frame_decoder_restart(&decoder);
    TEST_ASSERT_EQUAL_INT(1, feed(wire, n));
    ASSERT_COUNTS(.good = 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_length_and_kind_comes_back);
    RUN_TEST(runs_of_254);
    RUN_TEST(empty_block_after_a_full_one);
    RUN_TEST(encoder_refuses_what_does_not_fit);
    RUN_TEST(zeros_are_borders_and_nothing_else);
    RUN_TEST(first_frame_needs_no_leading_zero);
    RUN_TEST(cut_off_at_every_place);
    RUN_TEST(every_cause_has_its_count);
    RUN_TEST(overlong_is_discarded_once_and_for_all);
    RUN_TEST(the_longest_body_and_one_more);
    RUN_TEST(restart_forgets_the_stretch_under_way);
    return UNITY_END();
}
