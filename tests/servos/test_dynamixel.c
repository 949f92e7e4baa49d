/* test_dynamixel.c - packets byte for byte as in the ROBOTIS e-Manual, page DYNAMIXEL Protocol 2.0, section Instruction
 * Details: the example of each instruction. Stuffing (section Packet Process) on vectors of our own. */
#include "dynamixel.h"

#include <string.h>

#include "dynamixel_x.h"
#include "test_support.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { ROOM = HOST_OR_BOARD(1024, 400) };
static uint8_t packet[ROOM], params[ROOM];

static void is(size_t n, const uint8_t *bytes, size_t bytes_n)
{
    TEST_ASSERT_EQUAL_UINT(bytes_n, n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, packet, bytes_n);
}
#define IS(n, ...) is(n, (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__}))

/* Exactly one packet, at the end of these bytes. */
static dxl_packet decoded(const uint8_t *bytes, size_t bytes_n)
{
    dxl_decoder d;
    dxl_packet p = {0};
    dxl_decoder_init(&d, params, sizeof params);
    for (size_t i = 0; i < bytes_n; i++) {
        TEST_ASSERT_EQUAL_INT(i == bytes_n - 1, dxl_decode(&d, bytes[i], &p));
    }
    TEST_ASSERT_EQUAL_UINT(bytes_n, p.wire_n);
    TEST_ASSERT_EQUAL_UINT32(0, d.bad_n);
    return p;
}

static void says(dxl_packet p, uint8_t id, uint8_t instruction, uint8_t error, const char *expected)
{
    TEST_ASSERT_EQUAL_HEX8(id, p.id);
    TEST_ASSERT_EQUAL_HEX8(instruction, p.instruction);
    TEST_ASSERT_EQUAL_HEX8(error, p.error);
    char text[64] = "";
    TEST_ASSERT_TRUE(p.params_n < 20);
    for (size_t i = 0; i < p.params_n; i++) {
        static const char DIGITS[] = "0123456789ABCDEF";
        text[3 * i] = DIGITS[p.params[i] >> 4];
        text[3 * i + 1] = DIGITS[p.params[i] & 15];
        text[3 * i + 2] = i + 1 < p.params_n ? ' ' : 0;
    }
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* Ping, examples 1 and 2 (to all). */
static void ping_and_its_answers(void)
{
    size_t n = dxl_ping(packet, ROOM, 1);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4E);
    says(decoded(packet, n), 1, DXL_PING, 0, "");
    n = dxl_ping(packet, ROOM, DXL_BROADCAST);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x03, 0x00, 0x01, 0x31, 0x42);
    const uint8_t about[] = {0x06, 0x04, 0x26};
    n = dxl_status(packet, ROOM, 1, 0, about, 3);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x55, 0x00, 0x06, 0x04, 0x26, 0x65, 0x5D);
    const dxl_packet p = decoded(packet, n);
    says(p, 1, DXL_STATUS, 0, "06 04 26");
    TEST_ASSERT_EQUAL_UINT16(1030, dxl_u16(p.params)); /* an XM430-W210 */
    TEST_ASSERT_TRUE(dxl_x_accepts(dxl_u16(p.params)));
    n = dxl_status(packet, ROOM, 2, 0, about, 3);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x02, 0x07, 0x00, 0x55, 0x00, 0x06, 0x04, 0x26, 0x6F, 0x6D);
}

/* Read: Present Position of an XM430-W210, 166. */
static void read_and_its_answer(void)
{
    size_t n = dxl_read(packet, ROOM, 1, DXL_X_PRESENT_POSITION, 4);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x02, 0x84, 0x00, 0x04, 0x00, 0x1D, 0x15);
    says(decoded(packet, n), 1, DXL_READ, 0, "84 00 04 00");
    const uint8_t position[] = {0xA6, 0, 0, 0};
    n = dxl_status(packet, ROOM, 1, 0, position, 4);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00, 0xA6, 0x00, 0x00, 0x00, 0x8C, 0xC0);
    const dxl_packet p = decoded(packet, n);
    TEST_ASSERT_EQUAL_UINT32(166, dxl_u32(p.params));
}

/* Write: 512 to Goal Position. */
static void write_and_its_answer(void)
{
    size_t n = dxl_write(packet, ROOM, 1, DXL_X_GOAL_POSITION, 4, 512);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x09, 0x00, 0x03, 0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xCA,
       0x89);
    says(decoded(packet, n), 1, DXL_WRITE, 0, "74 00 00 02 00 00");
    n = dxl_status(packet, ROOM, 1, 0, NULL, 0);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x04, 0x00, 0x55, 0x00, 0xA1, 0x0C);
    says(decoded(packet, n), 1, DXL_STATUS, 0, "");
}

/* Reboot; its answer is that to a write. */
static void reboot(void)
{
    const size_t n = dxl_reboot(packet, ROOM, 1);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x08, 0x2F, 0x4E);
    says(decoded(packet, n), 1, DXL_REBOOT, 0, "");
}

/* Sync Read: Present Position of two, 166 and 2079. */
static void sync_read_and_its_answers(void)
{
    dxl_sync_open(packet, DXL_X_PRESENT_POSITION, 4);
    packet[DXL_SYNC_PARAMS_AT] = 1;
    packet[DXL_SYNC_PARAMS_AT + 1] = 2;
    size_t n = dxl_seal(packet, ROOM, DXL_BROADCAST, DXL_SYNC_READ, 6);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x09, 0x00, 0x82, 0x84, 0x00, 0x04, 0x00, 0x01, 0x02, 0xCE,
       0xFA);
    says(decoded(packet, n), 0xFE, DXL_SYNC_READ, 0, "84 00 04 00 01 02");
    const uint8_t position[] = {0x1F, 0x08, 0, 0};
    n = dxl_status(packet, ROOM, 2, 0, position, 4);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0x02, 0x08, 0x00, 0x55, 0x00, 0x1F, 0x08, 0x00, 0x00, 0xBA, 0xBE);
}

/* Sync Write: Goal Position of two, 150 and 170. */
static void sync_write(void)
{
    dxl_sync_open(packet, DXL_X_GOAL_POSITION, 4);
    packet[DXL_SYNC_PARAMS_AT] = 1;
    dxl_put_u32(packet + DXL_SYNC_PARAMS_AT + 1, 150);
    packet[DXL_SYNC_PARAMS_AT + 5] = 2;
    dxl_put_u32(packet + DXL_SYNC_PARAMS_AT + 6, 170);
    const size_t n = dxl_seal(packet, ROOM, DXL_BROADCAST, DXL_SYNC_WRITE, 14);
    IS(n, 0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x11, 0x00, 0x83, 0x74, 0x00, 0x04, 0x00, 0x01, 0x96, 0x00,
       0x00, 0x00, 0x02, 0xAA, 0x00, 0x00, 0x00, 0x82, 0x87);
    says(decoded(packet, n), 0xFE, DXL_SYNC_WRITE, 0, "74 00 04 00 01 96 00 00 00 02 AA 00 00 00");
}

/* The packet that stops everything: 13 bytes. */
static void torque_off_to_all(void)
{
    const size_t n = dxl_write(packet, ROOM, DXL_BROADCAST, DXL_X_TORQUE, 1, 0);
    const uint8_t expected[] = {0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x06, 0x00, 0x03, 0x40, 0x00, 0x00};
    TEST_ASSERT_EQUAL_UINT(13, n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, packet, sizeof expected);
}

static uint16_t crc_by_bits(const uint8_t *bytes, size_t n)
{
    uint32_t crc = 0;
    for (size_t i = 0; i < n; i++) {
        crc ^= (uint32_t)bytes[i] << 8;
        for (int bit = 0; bit < 8; bit++) {
            crc = crc << 1 ^ ((crc & 0x8000u) != 0 ? 0x18005u : 0u);
        }
    }
    return (uint16_t)crc;
}

/* Every entry of the table is what the polynomial makes of that byte; CRC-16/UMTS's check value is FEE8. */
static void the_crc_is_that_of_its_polynomial(void)
{
    for (int i = 0; i < 256; i++) {
        const uint8_t byte = (uint8_t)i;
        TEST_ASSERT_EQUAL_HEX16(crc_by_bits(&byte, 1), dxl_crc16(0, &byte, 1));
    }
    TEST_ASSERT_EQUAL_HEX16(0xFEE8, dxl_crc16(0, (const uint8_t *)"123456789", 9));
    const uint16_t half = dxl_crc16(0, (const uint8_t *)"1234", 4);
    TEST_ASSERT_EQUAL_HEX16(0xFEE8, dxl_crc16(half, (const uint8_t *)"56789", 5));
}

static void stuffed(const uint8_t *plain, size_t plain_n, const uint8_t *wire, size_t wire_n)
{
    memcpy(packet + DXL_PARAMS_AT, plain, plain_n);
    const size_t n = dxl_seal(packet, ROOM, 7, DXL_WRITE, plain_n);
    TEST_ASSERT_EQUAL_UINT(DXL_OVERHEAD_BYTES + wire_n, n);
    TEST_ASSERT_EQUAL_UINT16(3 + wire_n, dxl_u16(packet + 5)); /* the length counts the stuffing */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wire, packet + DXL_PARAMS_AT, wire_n);
    TEST_ASSERT_EQUAL_HEX16(crc_by_bits(packet, n - 2), dxl_u16(packet + n - 2));
    const dxl_packet p = decoded(packet, n);
    TEST_ASSERT_EQUAL_UINT(plain_n, p.params_n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(plain, p.params, plain_n);
}
#define BYTES(...) (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__})

static void an_fd_goes_in_behind_every_false_header(void)
{
    stuffed(BYTES(0xFF, 0xFF, 0xFD), BYTES(0xFF, 0xFF, 0xFD, 0xFD));
    stuffed(BYTES(0xFF, 0xFF, 0xFD, 0x00), BYTES(0xFF, 0xFF, 0xFD, 0xFD, 0x00));
    stuffed(BYTES(0xFF, 0xFF, 0xFD, 0xFD), BYTES(0xFF, 0xFF, 0xFD, 0xFD, 0xFD));
    stuffed(BYTES(0xFF, 0xFF, 0xFF, 0xFD, 1), BYTES(0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 1));
    stuffed(BYTES(1, 0xFF, 0xFF, 0xFD, 0xFF, 0xFF, 0xFD, 2),
            BYTES(1, 0xFF, 0xFF, 0xFD, 0xFD, 0xFF, 0xFF, 0xFD, 0xFD, 2));
    stuffed(BYTES(0xFF, 0xFD, 0xFF, 0xFF), BYTES(0xFF, 0xFD, 0xFF, 0xFF)); /* nothing to stuff */
}

/* Headers everywhere: all bytes of few kinds, at random lengths, survive the way there and back. */
static void whatever_is_sealed_comes_out_again(void)
{
    static const uint8_t KINDS[] = {0xFF, 0xFF, 0xFD, 0x00, 0x55};
    static uint8_t plain[ROOM];
    uint32_t seed = 20240607;
    for (int round = 0; round < HOST_OR_BOARD(20000, 200); round++) {
        const size_t plain_n = (size_t)random_below(&seed, ROOM / 2);
        for (size_t i = 0; i < plain_n; i++) {
            plain[i] = KINDS[random_below(&seed, sizeof KINDS)];
        }
        memcpy(packet + DXL_PARAMS_AT, plain, plain_n);
        const size_t n =
            dxl_seal(packet, ROOM, (uint8_t)random_below(&seed, 253), DXL_WRITE, plain_n);
        TEST_ASSERT_TRUE(n > 0);
        for (size_t i = 3; i < n - 2; i++) { /* FF FF FD 00 begins no second packet */
            TEST_ASSERT_FALSE(i > 3 && memcmp(packet + i - 3, "\xFF\xFF\xFD\x00", 4) == 0);
        }
        const dxl_packet p = decoded(packet, n);
        TEST_ASSERT_EQUAL_UINT(plain_n, p.params_n);
        TEST_ASSERT_TRUE(plain_n == 0 || memcmp(plain, p.params, plain_n) == 0);
    }
}

/* A false header at every place, in a status packet as well, where an error stands before. */
static void stuffing_at_every_place(void)
{
    uint8_t plain[40];
    for (size_t at = 0; at + 3 <= sizeof plain; at++) {
        for (size_t i = 0; i < sizeof plain; i++) {
            plain[i] = (uint8_t)(i + 1);
        }
        memcpy(plain + at, "\xFF\xFF\xFD", 3);
        const size_t n = dxl_status(packet, ROOM, 9, 0x80, plain, sizeof plain);
        TEST_ASSERT_EQUAL_UINT(DXL_STATUS_BYTES + sizeof plain + 1, n);
        const dxl_packet p = decoded(packet, n);
        TEST_ASSERT_EQUAL_HEX8(0x80, p.error);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(plain, p.params, sizeof plain);
    }
}

static void what_does_not_fit_is_refused_and_nothing_is_written_beyond(void)
{
    for (size_t room = 0; room < 16; room++) {
        memset(packet, 0xAA, sizeof packet);
        TEST_ASSERT_EQUAL_UINT(0, dxl_write(packet, room < 16 ? room : 15, 1, 116, 4, 512));
        TEST_ASSERT_EQUAL_UINT(room >= 10 ? 10 : 0, dxl_ping(packet, room, 1));
        TEST_ASSERT_EQUAL_HEX8(0xAA, packet[room]);
    }
    const uint8_t false_header[] = {0xFF, 0xFF, 0xFD};
    TEST_ASSERT_EQUAL_UINT(
        0, dxl_status(packet, 14, 1, 0, false_header, 3)); /* 15 with its stuffing */
    TEST_ASSERT_EQUAL_UINT(15, dxl_status(packet, 15, 1, 0, false_header, 3));
    TEST_ASSERT_EQUAL_UINT(0, dxl_write(packet, ROOM, 1, 116, 5, 0));
    TEST_ASSERT_EQUAL_UINT(0, dxl_seal(packet, ROOM, 1, DXL_WRITE, SIZE_MAX));
}

static void models_and_rates(void)
{
    static const uint16_t GOOD[] = {30, 311, 321, 1000, 1020, 1030, 1060, 1190, 1240, 1310, 1700};
    static const uint16_t BAD[] = {0, 12, 29, 350, 999, 2000, 35074, 65535};
    for (size_t i = 0; i < sizeof GOOD / sizeof GOOD[0]; i++) {
        TEST_ASSERT_TRUE(dxl_x_accepts(GOOD[i]));
    }
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        TEST_ASSERT_FALSE(dxl_x_accepts(BAD[i]));
    }
    TEST_ASSERT_EQUAL_INT(1, dxl_x_baud_code(57600)); /* as delivered */
    TEST_ASSERT_EQUAL_INT(7, dxl_x_baud_code(4500000));
    TEST_ASSERT_EQUAL_INT(-1, dxl_x_baud_code(0));
    TEST_ASSERT_EQUAL_INT(-1, dxl_x_baud_code(250000));
    for (int code = -1; code <= DXL_X_BAUD_CODES_N; code++) {
        const bool there = code >= 0 && code < DXL_X_BAUD_CODES_N;
        TEST_ASSERT_EQUAL_INT(there ? code : -1, dxl_x_baud_code(dxl_x_baud(code)));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(ping_and_its_answers);
    RUN_TEST(read_and_its_answer);
    RUN_TEST(write_and_its_answer);
    RUN_TEST(reboot);
    RUN_TEST(sync_read_and_its_answers);
    RUN_TEST(sync_write);
    RUN_TEST(torque_off_to_all);
    RUN_TEST(the_crc_is_that_of_its_polynomial);
    RUN_TEST(an_fd_goes_in_behind_every_false_header);
    RUN_TEST(whatever_is_sealed_comes_out_again);
    RUN_TEST(stuffing_at_every_place);
    RUN_TEST(what_does_not_fit_is_refused_and_nothing_is_written_beyond);
    RUN_TEST(models_and_rates);
    return UNITY_END();
}
