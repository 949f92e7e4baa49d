/* test_crc32c.c - the checksum against published values and against its definition, bit by bit. */
#include "crc32c.h"
#include "proto_support.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* RFC 3720, B.4, and the check value of every CRC catalogue. */
static void published_values(void)
{
    uint8_t bytes[32];
    TEST_ASSERT_EQUAL_HEX32(0xE3069283, crc32c("123456789", 9));
    memset(bytes, 0, sizeof bytes);
    TEST_ASSERT_EQUAL_HEX32(0x8A9136AA, crc32c(bytes, sizeof bytes));
    memset(bytes, 0xFF, sizeof bytes);
    TEST_ASSERT_EQUAL_HEX32(0x62A8AB43, crc32c(bytes, sizeof bytes));
    for (int i = 0; i < 32; i++) {
        bytes[i] = (uint8_t)i;
    }
    TEST_ASSERT_EQUAL_HEX32(0x46DD794E, crc32c(bytes, sizeof bytes));
    for (int i = 0; i < 32; i++) {
        bytes[i] = (uint8_t)(31 - i);
    }
    TEST_ASSERT_EQUAL_HEX32(0x113FDB5C, crc32c(bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_HEX32(0, crc32c(bytes, 0));
}

/* Division by the polynomial, lowest bit first. */
static uint32_t by_definition(const uint8_t *bytes, size_t bytes_n)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < 8 * bytes_n; i++) {
        const uint32_t bit = (uint32_t)(bytes[i / 8] >> (i % 8)) & 1u;
        crc = (crc >> 1) ^ (((crc ^ bit) & 1u) != 0 ? 0x82F63B78u : 0u);
    }
    return crc ^ 0xFFFFFFFFu;
}

static void equals_its_definition_in_any_pieces(void)
{
    uint32_t seed = 1;
    uint8_t bytes[300];
    for (int round = 0; round < HOST_OR_BOARD(2000, 50); round++) {
        const size_t n = random_below(&seed, sizeof bytes + 1);
        random_bytes(bytes, n, (bytes_kind)(round % BYTES_KINDS), &seed);
        uint32_t crc = CRC32C_START;
        for (size_t done = 0; done < n;) {
            const size_t piece = 1 + random_below(&seed, n - done);
            crc = crc32c_add(crc, bytes + done, piece);
            done += piece;
        }
        TEST_ASSERT_EQUAL_HEX32(by_definition(bytes, n), crc32c_finish(crc));
    }
}

static void own_checksum_leaves_the_residue(void)
{
    uint32_t seed = 2;
    uint8_t bytes[104] = {0};
    for (size_t n = 0; n <= 100; n++) {
        random_bytes(bytes, n, BYTES_ANY, &seed);
        const uint32_t crc = crc32c(bytes, n);
        for (size_t i = 0; i < 4; i++) {
            bytes[n + i] = (uint8_t)(crc >> (8 * i));
        }
        TEST_ASSERT_EQUAL_HEX32(CRC32C_RESIDUE, crc32c_add(CRC32C_START, bytes, n + 4));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(published_values);
    RUN_TEST(equals_its_definition_in_any_pieces);
    RUN_TEST(own_checksum_leaves_the_residue);
    return UNITY_END();
}
