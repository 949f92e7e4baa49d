/* test_board_timebase.c - microseconds around every wrap of a small SysTick, its interrupt served or waiting. */
#include <string.h>

#include "scripted.h"
#include "timebase.h"
#include "unity.h"

static systick_registers systick;
static scb_registers scb;
static timebase t;
static uint32_t counts; /* since the start: the truth */
static uint32_t cost;   /* of a register access, counts */
static bool pending, masked;

/* A clock that goes on by `cost` before and after each access, and an interrupt that comes at once, or waits. */
static void pass(void)
{
    for (uint32_t i = 0; i < cost; i++) {
        counts++;
        pending = pending || counts % t.tick_counts == 0;
    }
    if (pending && !masked) {
        pending = false;
        timebase_interrupt(&t);
    }
}

static uint32_t read(const reg *place, uint32_t held)
{
    pass();
    const uint32_t into = counts % t.tick_counts;
    if (place == &systick.cvr) {
        held = into == 0 ? 0 : t.tick_counts - into; /* ARMv7-M B3.3.1: 0 is the first of a tick */
    } else if (place == &scb.icsr) {
        held = pending ? SCB_ICSR_PENDSTSET : 0;
    }
    pass();
    return held;
}

static uint32_t truth_us(uint32_t at_counts)
{
    return at_counts / t.tick_counts * t.tick_us +
           at_counts % t.tick_counts * t.tick_us / t.tick_counts;
}

void setUp(void)
{
    scripted_start((script){read, NULL});
}

void tearDown(void) {}

static void start(uint32_t tick_counts, uint32_t at_counts)
{
    memset(&t, 0, sizeof t);
    scripted_start((script){NULL, NULL});
    timebase_start(&t, &systick, &scb, tick_counts * 100);
    scripted_start((script){read, NULL});
    counts = at_counts;
    t.ticks = at_counts / tick_counts;
    pending = false;
}

static uint32_t now_in_bounds(void)
{
    const uint32_t before_us = truth_us(counts), now_us = timebase_now_us(&t);
    TEST_ASSERT_TRUE(now_us >= before_us && now_us <= truth_us(counts));
    return now_us;
}

static void right_at_every_phase_with_interrupts(void)
{
    masked = false;
    for (uint32_t tick_counts = 40; tick_counts <= 48; tick_counts++) {
        for (cost = 1; cost <= 5; cost++) {
            for (uint32_t phase = 0; phase < 3 * tick_counts; phase++) {
                start(tick_counts, phase);
                uint32_t last_us = 0;
                for (int i = 0; i < 40; i++) {
                    const uint32_t now_us = now_in_bounds();
                    TEST_ASSERT_TRUE(now_us >= last_us);
                    last_us = now_us;
                    pass();
                }
            }
        }
    }
}

/* From an interrupt handler, or with interrupts held: a tick's interrupt may wait for up to a tick. */
static void right_while_the_interrupt_waits(void)
{
    for (cost = 1; cost <= 5; cost++) {
        for (uint32_t phase = 0; phase < 128; phase++) {
            masked = true;
            start(64, phase);
            const uint32_t end = (phase / 64 + 2) * 64;
            uint32_t last_us = 0;
            /* what a call may take stays within the tick that waits */
            while (counts + 10 * cost < end) {
                const uint32_t now_us = now_in_bounds();
                TEST_ASSERT_TRUE(now_us >= last_us);
                last_us = now_us;
                counts += pending ? 1 : 0; /* the phases between calls, too */
            }
            masked = false; /* it comes in at last, and nothing jumps */
            pass();
            TEST_ASSERT_TRUE(now_in_bounds() >= last_us);
        }
    }
}

static void wraps_with_its_32_bits(void)
{
    masked = false;
    cost = 1;
    start(20, 7);
    t.ticks = UINT32_MAX / t.tick_us; /* near the end of the 32 bits, then past it */
    const uint32_t before_us = timebase_now_us(&t);
    t.ticks++;
    const uint32_t after_us = timebase_now_us(&t);
    TEST_ASSERT_UINT32_WITHIN(t.tick_us / 2, t.tick_us, after_us - before_us);
}

static void ticks_as_fast_as_the_clock_allows(void)
{
    TEST_ASSERT_EQUAL_UINT32(1000, timebase_tick_hz(168000000));
    TEST_ASSERT_EQUAL_UINT32(100, timebase_tick_hz(16000000));
    timebase_start(&t, &systick, &scb, 168000000);
    TEST_ASSERT_EQUAL_UINT32(167999, systick.rvr);
    TEST_ASSERT_EQUAL_UINT32(1000, t.tick_us);
    TEST_ASSERT_EQUAL_HEX32(7, systick.csr);
    timebase_start(&t, &systick, &scb, 16000000);
    TEST_ASSERT_EQUAL_UINT32(159999, systick.rvr);
    TEST_ASSERT_EQUAL_UINT32(10000, t.tick_us);
}

static void full_scale_fits_32_bits(void)
{
    static const uint32_t CLOCKS_HZ[] = {168000000, 16000000};
    for (int i = 0; i < 2; i++) {
        scripted_start((script){NULL, NULL});
        timebase_start(&t, &systick, &scb, CLOCKS_HZ[i]);
        t.ticks = 0;
        systick.cvr = 1; /* the last count of a tick */
        TEST_ASSERT_EQUAL_UINT32(t.tick_us - 1, timebase_now_us(&t));
        systick.cvr = t.tick_counts / 2;
        TEST_ASSERT_EQUAL_UINT32(t.tick_us / 2, timebase_now_us(&t));
    }
}

/* Where ticks are lost: the clock that the host keeps is right all the same. */
static void an_emulator_s_clock_needs_no_ticks(void)
{
    static tim_registers tim2;
    scripted_start((script){NULL, NULL});
    timebase_start(&t, &systick, &scb, 168000000);
    tim2.cnt = UINT32_MAX - 5000500;
    const uint32_t start_ns = tim2.cnt;
    timebase_emulated(&t, &tim2);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, tim2.arr);
    for (uint32_t ms = 1; ms < 20; ms += 1 + ms % 3) { /* 1 to 3 at a time, and one interrupt */
        tim2.cnt = start_ns + ms * 1000000u + 777;
        TEST_ASSERT_EQUAL_UINT32(ms * 1000, timebase_now_us(&t));
        timebase_interrupt(&t);
        TEST_ASSERT_EQUAL_UINT32(ms * 1000, timebase_now_us(&t));
        tim2.cnt += 500000;
        TEST_ASSERT_EQUAL_UINT32(ms * 1000 + 500, timebase_now_us(&t));
    }
}

static void only_silicon_is_trusted(void)
{
    const clock_state reached = {CLOCK_HSI, 16000000, 16000000, 16000000, 16000000};
    systick.calib = 18750 | 1u << 30;
    scripted_start((script){NULL, NULL});
    TEST_ASSERT_EQUAL_INT(CLOCK_HSI, timebase_trust(&systick, reached).kind);
    systick.calib = 209999; /* QEMU 10 */
    const clock_state clock = timebase_trust(&systick, reached);
    TEST_ASSERT_EQUAL_INT(CLOCK_EMULATED, clock.kind);
    TEST_ASSERT_EQUAL_UINT32(168000000, clock.core_hz);
    TEST_ASSERT_EQUAL_UINT32(84000000, clock.apb2_hz);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(right_at_every_phase_with_interrupts);
    RUN_TEST(right_while_the_interrupt_waits);
    RUN_TEST(wraps_with_its_32_bits);
    RUN_TEST(ticks_as_fast_as_the_clock_allows);
    RUN_TEST(full_scale_fits_32_bits);
    RUN_TEST(an_emulator_s_clock_needs_no_ticks);
    RUN_TEST(only_silicon_is_trusted);
    return UNITY_END();
}
