/* test_osc_wire.c - OSC packets to poses: alone, in bundles, other people's, damaged, random. */
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "osc_wire.h"

static osc_wire wire;
static uint8_t sent[2048];
static size_t sent_n;

void setUp(void)
{
    memset(&wire, 0, sizeof wire);
    sent_n = 0;
}

void tearDown(void) {}

static void put_u32(uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8) {
        sent[sent_n++] = (uint8_t)(value >> shift);
    }
}

static void put_text(const char *text)
{
    const size_t n = (strlen(text) / 4 + 1) * 4;
    memset(sent + sent_n, 0, n);
    memcpy(sent + sent_n, text, strlen(text));
    sent_n += n;
}

static void put_pose(const char *address, const char *types, const char *serial, float first)
{
    put_text(address);
    put_text(types);
    put_text(serial);
    for (int i = 0; i < 7; i++) {
        const float value = first + (float)i;
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_u32(bits);
    }
}

/* Returns where its size goes; end_element fills it in. */
static size_t begin_element(void)
{
    put_u32(0);
    return sent_n;
}

static void end_element(size_t from)
{
    const size_t to = sent_n;
    sent_n = from - 4;
    put_u32((uint32_t)(to - from));
    sent_n = to;
}

static void put_bundle(void)
{
    memcpy(sent + sent_n, "#bundle", 8);
    sent_n += 8;
    put_u32(0);
    put_u32(1);
}

static int take(track_sample *sample)
{
    int poses_n = 0;
    memcpy(wire.bytes, sent, sent_n);
    osc_wire_came(&wire, sent_n);
    while (osc_wire_next(&wire, sample)) {
        poses_n++;
    }
    TEST_ASSERT_FALSE(osc_wire_next(&wire, sample));
    return poses_n;
}

static void put_nest(void)
{
    put_bundle();
    size_t element = begin_element();
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", 1.0f);
    end_element(element);
    const size_t nest = begin_element();
    put_bundle();
    element = begin_element();
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "B", 2.0f);
    end_element(element);
    element = begin_element();
    put_pose("/VMC/Ext/Hmd/Pos", ",sfffffff", "A", 3.0f);
    end_element(element);
    end_element(nest);
    element = begin_element();
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", 4.0f);
    end_element(element);
}

static void test_alone_and_nested(void)
{
    track_sample sample;
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", -0.1f);
    TEST_ASSERT_EQUAL(1, take(&sample));
    TEST_ASSERT_EQUAL_DOUBLE((double)-0.1f, sample.position_m[0]);
    TEST_ASSERT_EQUAL_DOUBLE((double)(-0.1f + 3.0f), sample.orientation[0]);
    TEST_ASSERT_EQUAL_DOUBLE((double)(-0.1f + 6.0f), sample.orientation[3]);
    sent_n = 0;
    put_nest();
    TEST_ASSERT_EQUAL(2, take(&sample));
    TEST_ASSERT_EQUAL_DOUBLE(4.0, sample.position_m[0]);
    TEST_ASSERT_EQUAL(2, wire.others);
    TEST_ASSERT_EQUAL(0, wire.unreadable);
    strcpy(wire.serial, "B");
    TEST_ASSERT_EQUAL(1, take(&sample));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, sample.position_m[0]);
}

static void test_wrong_types(void)
{
    static const char *const TYPES[] = {",fffffff",    ",sffffff",  ",sffffffff", ",sfffiiii",
                                        ",sdddddddd",  ",bfffffff", ",",          "sfffffff",
                                        ",s[fffffff]", ",sfffffff?"};
    for (size_t i = 0; i < sizeof TYPES / sizeof TYPES[0]; i++) {
        track_sample sample;
        setUp();
        put_pose("/VMC/Ext/Tra/Pos", TYPES[i], "A", 1.0f);
        TEST_ASSERT_EQUAL_MESSAGE(0, take(&sample), TYPES[i]);
        TEST_ASSERT_EQUAL_MESSAGE(1, wire.unreadable, TYPES[i]);
    }
}

static void test_cut_short(void)
{
    for (int nested = 0; nested < 2; nested++) {
        setUp();
        if (nested == 1) {
            put_nest();
        } else {
            put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", 1.0f);
        }
        const size_t whole_n = sent_n;
        for (sent_n = 1; sent_n < whole_n; sent_n++) {
            track_sample sample;
            const long unreadable = wire.unreadable;
            const int poses_n = take(&sample);
            TEST_ASSERT_TRUE(nested == 1 ? poses_n <= 1 : poses_n == 0);
            /* a cut just between two elements is nothing that could be seen */
            TEST_ASSERT_TRUE(wire.unreadable > unreadable || nested == 1);
        }
    }
}

static void test_sizes_that_lie(void)
{
    static const uint32_t SIZES[] = {1, 2, 3, 5, 0x7FFFFFFF, 0x80000000u, 0xFFFFFFFCu, 0xFFFFFFFFu};
    for (size_t i = 0; i < sizeof SIZES / sizeof SIZES[0]; i++) {
        track_sample sample;
        setUp();
        put_bundle();
        put_u32(SIZES[i]);
        put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", 1.0f);
        TEST_ASSERT_EQUAL(0, take(&sample));
        TEST_ASSERT_EQUAL(1, wire.unreadable);
    }
}

static void test_serials(void)
{
    char serial[OSC_SERIAL_BYTES + 1];
    track_sample sample;
    memset(serial, 'x', sizeof serial);
    serial[OSC_SERIAL_BYTES] = '\0'; /* one too long */
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", serial, 1.0f);
    TEST_ASSERT_EQUAL(0, take(&sample));
    TEST_ASSERT_EQUAL(1, wire.unreadable);
    serial[OSC_SERIAL_BYTES - 1] = '\0';
    sent_n = 0;
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", serial, 1.0f);
    TEST_ASSERT_EQUAL(1, take(&sample));
    sent_n = 0;
    put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "y", 1.0f);
    TEST_ASSERT_EQUAL(0, take(&sample));
    TEST_ASSERT_EQUAL(1, wire.others);
}

static uint32_t random_bits(void)
{
    static uint32_t state = 999;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

static void test_random(void)
{
    for (int round = 0; round < 30000; round++) {
        track_sample sample;
        sent_n = 0;
        if (round % 2 == 0) {
            put_nest();
        } else {
            put_pose("/VMC/Ext/Tra/Pos", ",sfffffff", "A", 1.0f);
        }
        for (uint32_t i = 0; i <= random_bits() % 8; i++) {
            sent[random_bits() % sent_n] = (uint8_t)random_bits();
        }
        sent_n -= random_bits() % 16;
        TEST_ASSERT_TRUE(take(&sample) <= 3);
    }
    TEST_ASSERT_GREATER_THAN(5000, wire.unreadable);
    setUp();
    test_alone_and_nested();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_alone_and_nested);
    RUN_TEST(test_wrong_types);
    RUN_TEST(test_cut_short);
    RUN_TEST(test_sizes_that_lie);
    RUN_TEST(test_serials);
    RUN_TEST(test_random);
    return UNITY_END();
}
