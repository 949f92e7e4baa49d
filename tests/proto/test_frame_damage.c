/* test_frame_damage.c - frames flipped, cut, stretched and doubled on the line: none comes out as what was
 * not sent, and the next whole one always comes out.
 *
 *     test_frame_damage [ROUNDS]     of the random part */
#include "frame.h"
#include "proto_support.h"
#include "unity.h"

#include <stdlib.h>

enum { WIRE_ROOM = 4 * 256 };

/* All 1.5 million pairs of 220 bytes where that takes two seconds, else a share of them. */
#ifdef __SANITIZE_ADDRESS__
enum { LONG_STRIDE = 11 };
#else
enum { LONG_STRIDE = HOST_OR_BOARD(1, 997) };
#endif

static frame_decoder decoder;
static int rounds_n = HOST_OR_BOARD(100000, 1000);

void setUp(void)
{
    frame_decoder_init(&decoder);
}
void tearDown(void) {}

typedef struct {
    uint8_t payload[300], wire[FRAME_WIRE_BYTES(300)];
    size_t wire_n;
    frame f;
} specimen;

static void make_specimen(specimen *s, size_t payload_n, bytes_kind kind, uint32_t *seed)
{
    random_bytes(s->payload, payload_n, kind, seed);
    s->f = random_frame(s->payload, payload_n, seed);
    s->wire_n = frame_encode(&s->f, s->wire, sizeof s->wire);
}

static specimen victim, witness;

/* Feeds damaged bytes, then the witness. Any frame that comes out must be victim or witness, and the
 * witness must. Returns how often the victim came out. */
static int judge(const uint8_t *damaged, size_t damaged_n)
{
    int victims = 0, witnesses = 0;
    frame out;
    for (size_t i = 0; i < damaged_n + witness.wire_n; i++) {
        const uint8_t byte = i < damaged_n ? damaged[i] : witness.wire[i - damaged_n];
        if (frame_decoder_push(&decoder, byte, &out)) {
            if (frames_same(&out, &victim.f)) {
                victims++;
            } else {
                TEST_ASSERT_TRUE_MESSAGE(frames_same(&out, &witness.f), "a wrong frame came out");
                TEST_ASSERT_EQUAL_size_t_MESSAGE(damaged_n + witness.wire_n - 1, i, "too early");
                witnesses++;
            }
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, witnesses, "a whole frame was lost");
    return victims;
}

/* The frame's bytes on the wire: 40 and 220, zeros included. */
static void make_victim(size_t wire_n, bytes_kind kind, uint32_t *seed)
{
    make_specimen(&victim, wire_n - 15, kind, seed);
    TEST_ASSERT_EQUAL_size_t(wire_n, victim.wire_n);
    make_specimen(&witness, 3, BYTES_ANY, seed);
}

static const size_t WIRE_SIZES[] = {40, 220};

static void every_flipped_bit(void)
{
    uint32_t seed = 21;
    for (int k = 0; k < 2 * BYTES_KINDS; k++) {
        make_victim(WIRE_SIZES[k % 2], (bytes_kind)(k / 2), &seed);
        for (size_t bit = 0; bit < 8 * victim.wire_n; bit++) {
            victim.wire[bit / 8] ^= (uint8_t)(1u << bit % 8);
            const int victims = judge(victim.wire, victim.wire_n);
            victim.wire[bit / 8] ^= (uint8_t)(1u << bit % 8);
            /* not without a border, but for the one that the frame after it brings along */
            const bool border = bit / 8 == 0 || bit / 8 == victim.wire_n - 1;
            TEST_ASSERT_TRUE(border || victims == 0);
        }
    }
}

static void every_pair_of_flipped_bits(void)
{
    uint32_t seed = 22;
    for (int k = 0; k < 2; k++) {
        make_victim(WIRE_SIZES[k], BYTES_MANY_ZEROS, &seed);
        const size_t bits_n = 8 * (victim.wire_n - 1); /* borders: see single bits */
        const size_t stride = k == 0 ? HOST_OR_BOARD(1, 7) : LONG_STRIDE;
        for (size_t first = 8; first < bits_n; first++) {
            victim.wire[first / 8] ^= (uint8_t)(1u << first % 8);
            for (size_t second = first + 1; second < bits_n; second += stride) {
                victim.wire[second / 8] ^= (uint8_t)(1u << second % 8);
                TEST_ASSERT_EQUAL_INT(0, judge(victim.wire, victim.wire_n));
                victim.wire[second / 8] ^= (uint8_t)(1u << second % 8);
            }
            victim.wire[first / 8] ^= (uint8_t)(1u << first % 8);
        }
    }
}

/* Takes `out_n` bytes away at `at` and puts `in_n` there. */
static size_t splice(uint8_t *to, size_t at, size_t out_n, const uint8_t *in, size_t in_n)
{
    const size_t after_n = victim.wire_n - at - out_n;
    memcpy(to, victim.wire, at);
    memcpy(to + at, in, in_n);
    memcpy(to + at + in_n, victim.wire + at + out_n, after_n);
    return at + in_n + after_n;
}

static bool inside(size_t at)
{
    return at > 0 && at < victim.wire_n - 1;
}

static void bytes_lost_everywhere(void)
{
    uint32_t seed = 23;
    static uint8_t damaged[WIRE_ROOM];
    for (int k = 0; k < 2 * BYTES_KINDS; k++) {
        make_victim(WIRE_SIZES[k % 2], (bytes_kind)(k / 2), &seed);
        for (size_t at = 0; at < victim.wire_n; at++) {
            for (size_t lost_n = 1; lost_n <= victim.wire_n - at; lost_n += 1 + lost_n / 4) {
                const size_t n = splice(damaged, at, lost_n, damaged, 0);
                const int victims = judge(damaged, n);
                TEST_ASSERT_TRUE(victims == 0 || at == 0 || at == victim.wire_n - 1);
            }
        }
    }
}

static void bytes_added_everywhere(void)
{
    uint32_t seed = 24;
    static uint8_t damaged[WIRE_ROOM];
    for (int k = 0; k < 2 * BYTES_KINDS; k++) {
        make_victim(WIRE_SIZES[k % 2], (bytes_kind)(k / 2), &seed);
        for (size_t at = 0; at <= victim.wire_n; at++) {
            for (unsigned value = 0; value < 256; value += HOST_OR_BOARD(1, 51)) {
                const uint8_t byte = (uint8_t)value;
                const size_t n = splice(damaged, at, 0, &byte, 1);
                const int victims = judge(damaged, n);
                TEST_ASSERT_TRUE(victims == 0 || at <= 1 || at >= victim.wire_n - 1);
            }
        }
    }
}

static void stretches_doubled_everywhere(void)
{
    uint32_t seed = 25;
    static uint8_t damaged[WIRE_ROOM];
    for (int k = 0; k < 2 * BYTES_KINDS; k++) {
        make_victim(WIRE_SIZES[k % 2], (bytes_kind)(k / 2), &seed);
        for (size_t at = 0; at < victim.wire_n; at++) {
            for (size_t n = 1; n <= victim.wire_n - at; n += 1 + n / 4) {
                const size_t damaged_n = splice(damaged, at, 0, victim.wire + at, n);
                const int victims = judge(damaged, damaged_n);
                /* whole, and once more whole: the device knows a duplicate by its seq */
                TEST_ASSERT_TRUE(victims <= 2);
                TEST_ASSERT_TRUE(victims == 0 || at <= 1 || !inside(at + n - 1));
            }
        }
    }
}

/* --- random damage ------------------------------------------------------------------------------- */

/* Up to four hits of any kind; returns the new length. */
static size_t damage(uint8_t *bytes, size_t n, uint32_t *seed)
{
    for (size_t hits = 1 + random_below(seed, 4); hits > 0 && n > 0; hits--) {
        const size_t at = random_below(seed, n), rest = n - at;
        switch (random_below(seed, 6)) {
        case 0: /* bits */
            bytes[at] ^= (uint8_t)(1u << random_below(seed, 8));
            break;
        case 1: /* a byte */
            bytes[at] = (uint8_t)random_bits(seed);
            break;
        case 2: /* lost */
            memmove(bytes + at, bytes + at + 1, rest - 1);
            n--;
            break;
        case 3: /* added, one time in two a zero */
            memmove(bytes + at + 1, bytes + at, rest);
            bytes[at] = (uint8_t)(random_below(seed, 2) * random_bits(seed));
            n++;
            break;
        case 4: /* a burst */
            random_bytes(bytes + at, 1 + random_below(seed, rest < 8 ? rest : 8), BYTES_ANY, seed);
            break;
        default: /* the rest */
            n = at;
        }
    }
    return n;
}

/* Damaged frames and garbage between whole ones. */
static void random_damage_between_whole_frames(void)
{
    uint32_t seed = 26;
    static uint8_t damaged[WIRE_ROOM];
    for (int round = 0; round < rounds_n; round++) {
        const size_t payload_n = random_below(&seed, round % 16 == 0 ? 300 : 60);
        make_specimen(&victim, payload_n, (bytes_kind)random_below(&seed, BYTES_KINDS), &seed);
        make_specimen(&witness, random_below(&seed, 30), BYTES_ANY, &seed);
        memcpy(damaged, victim.wire, victim.wire_n);
        size_t n = damage(damaged, victim.wire_n, &seed);
        if (round % 8 == 0) {
            const size_t garbage_n = random_below(&seed, 200);
            random_bytes(damaged + n, garbage_n, (bytes_kind)(round / 8 % BYTES_KINDS), &seed);
            n += garbage_n;
        }
        TEST_ASSERT_TRUE(judge(damaged, n) <= 1);
    }
}

/* Each stretch between zeros is counted once: nothing is counted twice, nothing goes missing. */
static void every_stretch_is_counted_once(void)
{
    uint32_t seed = 27, stretches = 0;
    frame out;
    uint8_t last = 0;
    for (int i = 0; i < 20 * rounds_n; i++) {
        const uint8_t byte = random_below(&seed, 40) == 0 ? 0 : (uint8_t)random_bits(&seed);
        TEST_ASSERT_FALSE(frame_decoder_push(&decoder, byte, &out));
        stretches += byte == 0 && last != 0 ? 1 : 0;
        last = byte;
    }
    const frame_counts *const counts = &decoder.counts;
    TEST_ASSERT_EQUAL_UINT32(stretches, counts->good + counts->crc + counts->cobs +
                                            counts->too_short + counts->too_long);
}

int main(int argc, char **argv)
{
    if (argc == 2 && atoi(argv[1]) > 0) {
        rounds_n = atoi(argv[1]);
    }
    UNITY_BEGIN();
    RUN_TEST(every_flipped_bit);
    RUN_TEST(every_pair_of_flipped_bits);
    RUN_TEST(bytes_lost_everywhere);
    RUN_TEST(bytes_added_everywhere);
    RUN_TEST(stretches_doubled_everywhere);
    RUN_TEST(random_damage_between_whole_frames);
    RUN_TEST(every_stretch_is_counted_once);
    return UNITY_END();
}
