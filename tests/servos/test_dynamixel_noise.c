/* test_dynamixel_noise.c - the decoder on a bad line: torn, damaged and hostile bytes. */
#include "dynamixel.h"

#include <string.h>

#include "test_support.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { ROOM = 64, KEPT = 16, GUARD = 0xA5 };
static uint8_t params[KEPT + 8];
static dxl_decoder d;
static dxl_packet last;

static void fresh(void)
{
    memset(params, GUARD, sizeof params);
    dxl_decoder_init(&d, params, KEPT);
}

static void guarded(void)
{
    for (size_t i = KEPT; i < sizeof params; i++) {
        TEST_ASSERT_EQUAL_HEX8(GUARD, params[i]);
    }
}

/* How many packets are in these bytes. */
static int feed(const uint8_t *bytes, size_t bytes_n)
{
    int found = 0;
    for (size_t i = 0; i < bytes_n; i++) {
        found += dxl_decode(&d, bytes[i], &last) ? 1 : 0;
    }
    return found;
}

static size_t answer(uint8_t *packet, uint8_t id)
{
    const uint8_t values[] = {1, 0xFF, 0xFF, 0xFD, 0, 2};
    return dxl_status(packet, ROOM, id, 0, values, sizeof values);
}

/* Cut anywhere, the next packet is found, though it follows at once; even if the cut left half a header. */
static void a_packet_behind_a_torn_one_is_found(void)
{
    uint8_t packet[ROOM], torn[ROOM];
    const size_t n = answer(packet, 5), torn_n = answer(torn, 6);
    for (size_t cut = 0; cut < torn_n; cut++) {
        fresh();
        TEST_ASSERT_EQUAL_INT(0, feed(torn, cut));
        TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
        TEST_ASSERT_EQUAL_UINT8(5, last.id);
        TEST_ASSERT_EQUAL_UINT(6, last.params_n);
        TEST_ASSERT_EQUAL_INT(1, feed(torn, torn_n));
    }
}

/* The CRC is not stuffed: with FF FF before it, FD 00 in it looks like a header, and is none. */
static void a_crc_like_a_header_is_none(void)
{
    uint8_t packet[ROOM];
    size_t n = 0;
    int found = 0;
    for (uint32_t i = 0; i < 0x20000 && found < 1; i++) {
        const uint8_t values[] = {(uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), 0xFF, 0xFF};
        n = dxl_status(packet, ROOM, 5, 0, values, sizeof values);
        found += dxl_u16(packet + n - 2) == 0x00FD ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_INT(1, found);
    fresh();
    TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
    TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
    TEST_ASSERT_EQUAL_UINT32(0, d.bad_n);
}

/* Any one or two wrong bits: not taken for a packet (the CRC finds them all), and the next one is. */
static void flipped_bits_are_found(void)
{
    uint8_t packet[ROOM], damaged[ROOM];
    const int n = (int)answer(packet, 5);
    const int stride = HOST_OR_BOARD(1, 7);
    for (int a = 0; a < 8 * n; a++) {
        for (int b = a; b < 8 * n; b += stride) {
            memcpy(damaged, packet, (size_t)n);
            damaged[a / 8] ^= (uint8_t)(1u << a % 8);
            if (b != a) {
                damaged[b / 8] ^= (uint8_t)(1u << b % 8);
            }
            fresh();
            TEST_ASSERT_EQUAL_INT(0, feed(damaged, (size_t)n));
        }
    }
}

/* A wrong length can swallow what follows, but no more than that length says. */
static void after_damage_it_recovers(void)
{
    uint8_t packet[ROOM], damaged[ROOM];
    const size_t n = answer(packet, 5);
    for (size_t at = 0; at < n; at++) {
        for (int wrong = 0; wrong < 256; wrong += HOST_OR_BOARD(1, 17)) {
            memcpy(damaged, packet, n);
            damaged[at] = (uint8_t)wrong;
            fresh();
            feed(damaged, n);
            feed(packet, n);
            TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
        }
    }
}

static void impossible_lengths_are_refused(void)
{
    static const uint16_t LENGTHS[] = {0, 1, 2, DXL_LENGTH_MAX + 1, 0xFFFF};
    uint8_t packet[ROOM];
    const size_t n = answer(packet, 5);
    for (size_t i = 0; i < sizeof LENGTHS / sizeof LENGTHS[0]; i++) {
        const uint8_t head[] = {
            0xFF, 0xFF, 0xFD, 0, 1, (uint8_t)LENGTHS[i], (uint8_t)(LENGTHS[i] >> 8)};
        fresh();
        TEST_ASSERT_EQUAL_INT(0, feed(head, sizeof head));
        TEST_ASSERT_EQUAL_UINT32(1, d.bad_n);
        TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
    }
}

/* A status packet has at least an error. */
static void a_status_packet_without_error_is_none(void)
{
    uint8_t packet[ROOM];
    fresh();
    const size_t n = dxl_seal(packet, ROOM, 1, DXL_STATUS, 0);
    TEST_ASSERT_EQUAL_INT(0, feed(packet, n));
    TEST_ASSERT_EQUAL_UINT32(1, d.bad_n);
}

/* Longer than there is room: counted and checked whole, but only its beginning kept. */
static void a_longer_packet_keeps_to_its_room(void)
{
    uint8_t packet[900];
    memset(packet + DXL_PARAMS_AT, 0x77, 800);
    const size_t n = dxl_seal(packet, sizeof packet, DXL_BROADCAST, DXL_SYNC_WRITE, 800);
    fresh();
    TEST_ASSERT_EQUAL_INT(1, feed(packet, n));
    TEST_ASSERT_EQUAL_UINT(800, last.params_n);
    TEST_ASSERT_EQUAL_UINT(n, last.wire_n);
    TEST_ASSERT_EQUAL_HEX8(0x77, params[KEPT - 1]);
    guarded();
}

static void noise_is_harmless_and_packets_are_found_in_it(void)
{
    static const uint8_t KINDS[] = {0xFF, 0xFF, 0xFD, 0x00, 0x03, 0x55};
    uint32_t seed = 11;
    int found = 0, sent = 0;
    fresh();
    for (int round = 0; round < HOST_OR_BOARD(20000, 400); round++) {
        uint8_t bytes[40], packet[ROOM];
        for (size_t i = 0; i < sizeof bytes; i++) {
            bytes[i] = random_below(&seed, 2) ? KINDS[random_below(&seed, sizeof KINDS)]
                                              : (uint8_t)random_bits(&seed);
        }
        feed(bytes, (size_t)random_below(&seed, sizeof bytes));
        const size_t n = answer(packet, 5);
        found += feed(packet, n) > 0 && last.id == 5 ? 1 : 0;
        sent++;
        guarded();
    }
    /* noise that looks like a header can take the next packet for its own; it seldom does */
    TEST_ASSERT_TRUE(found > sent * 9 / 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_packet_behind_a_torn_one_is_found);
    RUN_TEST(a_crc_like_a_header_is_none);
    RUN_TEST(flipped_bits_are_found);
    RUN_TEST(after_damage_it_recovers);
    RUN_TEST(impossible_lengths_are_refused);
    RUN_TEST(a_status_packet_without_error_is_none);
    RUN_TEST(a_longer_packet_keeps_to_its_room);
    RUN_TEST(noise_is_harmless_and_packets_are_found_in_it);
    return UNITY_END();
}
