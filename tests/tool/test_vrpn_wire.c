/* test_vrpn_wire.c - VRPN's bytes to poses: whole, in pieces, other people's, damaged, random. */
#include <string.h>
#include <unity.h>

#include "vrpn_wire.h"

enum { OURS = 4, OTHERS = 2, POS_QUAT = 9 };

static vrpn_wire wire;
static uint8_t sent[4096];
static size_t sent_n;

void setUp(void)
{
    memset(&wire, 0, sizeof wire);
    strcpy(wire.tracker, "Tracker0");
    wire.sensor = 1;
    vrpn_wire_start(&wire);
    sent_n = 0;
}

void tearDown(void) {}

static void put(uint64_t value, int bytes_n)
{
    for (int shift = 8 * (bytes_n - 1); shift >= 0; shift -= 8) {
        sent[sent_n++] = (uint8_t)(value >> shift);
    }
}

static void put_head(uint32_t length, int32_t sender, int32_t type)
{
    const uint32_t words[] = {length, 1700000000, 250000, (uint32_t)sender, (uint32_t)type, 77};
    for (int i = 0; i < 6; i++) {
        put(words[i], 4);
    }
}

static void put_description(int32_t number, int32_t type, const char *name)
{
    const uint32_t name_n = (uint32_t)strlen(name) + 1;
    put_head(24 + 4 + name_n, number, type);
    put(name_n, 4);
    memcpy(sent + sent_n, name, name_n);
    sent_n += name_n;
    while (sent_n % 8 != 0) {
        sent[sent_n++] = 0xEE; /* what pads is nobody's */
    }
}

static void put_pose(int32_t sender, uint32_t sensor, const double values[7])
{
    put_head(24 + 64, sender, POS_QUAT);
    put(sensor, 4);
    put(sensor, 4);
    for (int i = 0; i < 7; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put(bits, 8);
    }
}

static void put_start(void)
{
    memcpy(sent, "vrpn: ver. 07.35  0\0\0\0\0\0", VRPN_COOKIE_BYTES);
    sent_n = VRPN_COOKIE_BYTES;
    put_description(OTHERS, -1, "Wand");
    put_description(OURS, -1, "Tracker0");
    put_description(POS_QUAT, -2, "vrpn_Tracker Pos_Quat");
    put_description(POS_QUAT + 1, -2, "vrpn_Tracker Velocity");
}

/* In pieces of that many bytes; returns how many poses came, the last one in *sample. */
static int take(const uint8_t *bytes, size_t bytes_n, size_t piece_n, track_sample *sample)
{
    int poses_n = 0;
    for (size_t at = 0; at < bytes_n && wire.broken == NULL;) {
        size_t room, n = bytes_n - at < piece_n ? bytes_n - at : piece_n;
        uint8_t *const to = vrpn_wire_room(&wire, &room);
        TEST_ASSERT_GREATER_THAN(0, room);
        n = n < room ? n : room;
        memcpy(to, bytes + at, n);
        vrpn_wire_came(&wire, n);
        at += n;
        while (vrpn_wire_next(&wire, sample)) {
            poses_n++;
        }
    }
    return poses_n;
}

static const double POSE[7] = {1.25, -2.5, 3e-9, 0.1, 0.2, 0.3, 0.9};

static void test_poses_in_pieces(void)
{
    for (size_t piece_n = 1; piece_n < 300; piece_n++) {
        track_sample sample;
        setUp();
        put_start();
        put_pose(OTHERS, 1, POSE);
        put_pose(OURS, 0, POSE);
        put_pose(OURS, 1, POSE);
        put_description(OURS + 1, -1, "Late");
        put_pose(OURS, 1, POSE);
        TEST_ASSERT_EQUAL(2, take(sent, sent_n, piece_n, &sample));
        TEST_ASSERT_EQUAL_MEMORY(POSE, sample.position_m, sizeof sample.position_m);
        TEST_ASSERT_EQUAL_MEMORY(POSE + 3, sample.orientation, sizeof sample.orientation);
        TEST_ASSERT_EQUAL_DOUBLE(1700000000.25, sample.t_s);
        TEST_ASSERT_EQUAL(2, wire.others);
        TEST_ASSERT_EQUAL(0, wire.unreadable);
        TEST_ASSERT_EQUAL_STRING("Wand, Late", wire.others_text);
    }
}

static void test_numbers_are_told_anew(void)
{
    track_sample sample;
    put_start();
    put_description(OURS, -1, "Wand");  /* it has another name now */
    put_pose(OURS, 1, POSE);            /* so this is not ours */
    put_description(7, -1, "Tracker0"); /* ours is another one */
    put_pose(7, 1, POSE);               /* this */
    put_description(POS_QUAT, -2, "vrpn_Tracker Velocity");
    put_pose(7, 1, POSE); /* no pose any more */
    TEST_ASSERT_EQUAL(1, take(sent, sent_n, sizeof sent, &sample));
    TEST_ASSERT_EQUAL(1, wire.others);
}

static void test_cookies(void)
{
    static const struct {
        const char *cookie;
        bool good;
    } CASES[] = {{"vrpn: ver. 07.00  0\0\0\0\0\0", true},
                 {"vrpn: ver. 07.99  3\0\0\0\0\0", true},
                 {"vrpn: ver. 08.00  0\0\0\0\0\0", false},
                 {"vrpn: ver. 06.15  0\0\0\0\0\0", false},
                 {"HTTP/1.1 404 Not Found\r\n", false}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        track_sample sample;
        setUp();
        TEST_ASSERT_EQUAL(0, take((const uint8_t *)CASES[i].cookie, VRPN_COOKIE_BYTES, 5, &sample));
        TEST_ASSERT_EQUAL(CASES[i].good, wire.greeted);
        TEST_ASSERT_EQUAL(CASES[i].good, wire.broken == NULL);
    }
}

static void test_lengths(void)
{
    static const uint32_t LENGTHS[] = {0, 1, 23, 65529, 65536, 0x80000000u, 0xFFFFFFFFu};
    for (size_t i = 0; i < sizeof LENGTHS / sizeof LENGTHS[0]; i++) {
        track_sample sample;
        setUp();
        put_start();
        put_head(LENGTHS[i], OURS, POS_QUAT);
        TEST_ASSERT_EQUAL(0, take(sent, sent_n, 100, &sample));
        TEST_ASSERT_NOT_NULL(wire.broken);
        TEST_ASSERT_EQUAL(1, wire.unreadable);
        vrpn_wire_start(&wire); /* a new connection has nothing of the old one */
        sent_n = 0;
        put_start();
        put_pose(OURS, 1, POSE);
        TEST_ASSERT_EQUAL(1, take(sent, sent_n, 100, &sample));
    }
    /* the longest that VRPN itself may send */
    setUp();
    put_start();
    put_head(64000, OURS, 3);
    track_sample sample;
    (void)take(sent, sent_n, 100, &sample);
    memset(sent, 0, sizeof sent);
    for (int left_n = 64000 - 24; left_n > 0; left_n -= 8) {
        (void)take(sent, 8, 8, &sample);
    }
    sent_n = 0;
    put_pose(OURS, 1, POSE);
    TEST_ASSERT_EQUAL(1, take(sent, sent_n, 100, &sample));
}

static void test_damaged(void)
{
    track_sample sample;
    put_start();
    put_head(24 + 56, OURS, POS_QUAT); /* too short for a pose */
    sent_n += 56;
    put_head(24 + 72, OURS, POS_QUAT); /* too long */
    sent_n += 72;
    put_head(24 + 8, 3, -1); /* a name longer than its message */
    put(100, 4);
    put(0, 4);
    put_head(24 + 3, 3, -2); /* no room for its length */
    put(0, 8);
    put_head(24 + 8, 3, -1); /* no zero at the end */
    put(4, 4);
    put(0x41414141, 4);
    put_head(24 + 8, 3, -2); /* no name at all */
    put(0, 8);
    put_pose(OURS, 1, POSE);
    TEST_ASSERT_EQUAL(1, take(sent, sent_n, 100, &sample));
    TEST_ASSERT_EQUAL(6, wire.unreadable);
}

static uint32_t random_bits(void)
{
    static uint32_t state = 12345;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/* Nothing that comes does harm (the sanitizers look on), and a new connection is as good as ever. */
static void test_random(void)
{
    for (int round = 0; round < 20000; round++) {
        track_sample sample;
        vrpn_wire_start(&wire);
        sent_n = 0;
        put_start();
        for (int i = 0; i < 4; i++) {
            put_pose(OURS, 1, POSE);
        }
        const size_t from = round % 2 == 0 ? VRPN_COOKIE_BYTES : 0;
        for (uint32_t i = 0; i <= random_bits() % 6; i++) {
            sent[from + random_bits() % (sent_n - from)] = (uint8_t)random_bits();
        }
        (void)take(sent, sent_n - random_bits() % 40, 1 + random_bits() % 500, &sample);
    }
    TEST_ASSERT_GREATER_THAN(1000, wire.unreadable);
    test_poses_in_pieces();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_poses_in_pieces);
    RUN_TEST(test_numbers_are_told_anew);
    RUN_TEST(test_cookies);
    RUN_TEST(test_lengths);
    RUN_TEST(test_damaged);
    RUN_TEST(test_random);
    return UNITY_END();
}
