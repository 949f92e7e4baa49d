/* test_clock_map.c - two simulated clocks and a line between them, against the offset they really have. */
#include <stdio.h>
#include <stdlib.h>

#include "../unit/test_support.h"
#include "clock_map.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* Two clocks over true time, in us: the device's is true but for where it starts. */
typedef struct {
    uint32_t device_start_us, sender_start_us;
    double sender_rate; /* 1 + drift */
    uint32_t seed;
} world;

static uint32_t device_at(const world *w, double t_us)
{
    return w->device_start_us + (uint32_t)(int64_t)t_us;
}

static uint32_t sender_at(const world *w, double t_us)
{
    return w->sender_start_us + (uint32_t)(int64_t)(t_us * w->sender_rate);
}

/* Legs of least_us and a queue of up to queue_us each; either end may ask. */
static clock_exchange exchange_at(world *w, double t_us, double least_us, double queue_us,
                                  bool device_asks)
{
    const double first_us = least_us + random_between(&w->seed, 0.0, queue_us);
    const double second_us = least_us + random_between(&w->seed, 0.0, queue_us);
    const double back_us = t_us + first_us + 300.0;
    if (device_asks) {
        return (clock_exchange){device_at(w, t_us), sender_at(w, t_us + first_us),
                                sender_at(w, back_us), device_at(w, back_us + second_us)};
    }
    return (clock_exchange){
        .sender_sent_us = sender_at(w, t_us),
        .device_received_us = device_at(w, t_us + first_us),
        .device_sent_us = device_at(w, back_us),
        .sender_received_us = sender_at(w, back_us + second_us),
    };
}

static int32_t error_at(const clock_map *map, const world *w, double t_us)
{
    uint32_t device_us = 0;
    TEST_ASSERT_TRUE(clock_map_to_device(map, sender_at(w, t_us), &device_us));
    return (int32_t)(device_us - device_at(w, t_us));
}

static void test_nothing_is_known_at_first(void)
{
    clock_map map;
    clock_map_init(&map);
    uint32_t device_us = 42;
    TEST_ASSERT_FALSE(clock_map_to_device(&map, 1000, &device_us));
    TEST_ASSERT_EQUAL_UINT32(42, device_us);
}

static void test_one_exchange_halves_the_delay(void)
{
    const uint32_t starts_us[] = {0, 1, 0x7ffffff0u, 0x80000000u, UINT32_MAX - 500u};
    for (int i = 0; i < 25; i++) {
        const uint32_t device_us = starts_us[i / 5], sender_us = starts_us[i % 5];
        clock_map map;
        clock_map_init(&map);
        /* 600 there, 1000 back: 200 off */
        const clock_exchange e = {device_us, sender_us + 600u, sender_us + 700u, device_us + 1700u};
        TEST_ASSERT_TRUE(clock_map_exchange(&map, &e));
        uint32_t mapped_us = 0;
        TEST_ASSERT_TRUE(clock_map_to_device(&map, sender_us + 900u, &mapped_us));
        TEST_ASSERT_EQUAL_UINT32(device_us + 900u + 200u, mapped_us);
    }
}

static void test_what_cannot_be_is_left_out(void)
{
    clock_map map;
    clock_map_init(&map);
    const clock_exchange too_long = {0, 50000, 50000, 100001};
    const clock_exchange just_right = {0, 50000, 50000, 100000};
    const clock_exchange backwards = {0, 5000, 6000, 799};
    const clock_exchange drifted = {0, 5000, 6000, 800};
    TEST_ASSERT_FALSE(clock_map_exchange(&map, &too_long));
    TEST_ASSERT_FALSE(clock_map_exchange(&map, &backwards));
    TEST_ASSERT_EQUAL_UINT32(2, map.left_out);
    TEST_ASSERT_TRUE(clock_map_exchange(&map, &drifted));
    clock_map_init(&map);
    TEST_ASSERT_TRUE(clock_map_exchange(&map, &just_right));
    TEST_ASSERT_EQUAL_UINT32(1, map.used);
}

/* Four hours, so over three wraps of both clocks, an exchange a second. */
static int32_t worst_of_hours(double drift, double queue_us, bool device_asks,
                              int32_t *worst_step_us, double *rms_us)
{
    world w = {UINT32_MAX - 20000000u, 0x7ff00000u, 1.0 + drift, 5};
    clock_map map;
    clock_map_init(&map);
    int32_t worst_us = 0;
    double sum = 0.0;
    int n = 0;
    *worst_step_us = 0;
    const int seconds_n = HOST_OR_BOARD(4 * 3600, 300);
    for (int s = 0; s < seconds_n; s++) {
        const double t_us = 1e6 * s;
        const int32_t before_us = s > 0 ? error_at(&map, &w, t_us + 10e3) : 0;
        const clock_exchange e = exchange_at(&w, t_us, 200.0, queue_us, device_asks);
        TEST_ASSERT_TRUE(clock_map_exchange(&map, &e));
        const int32_t after_us = error_at(&map, &w, t_us + 10e3);
        for (int i = 0; i < 10; i++) {
            clock_map_tick(&map, device_at(&w, t_us + 10e3 + 99e3 * i));
            const int32_t error_us = error_at(&map, &w, t_us + 10e3 + 99e3 * i);
            if (s >= 60) {
                sum += (double)error_us * (double)error_us;
                n++;
                worst_us = worst_us > abs(error_us) ? worst_us : abs(error_us);
            }
        }
        if (s >= 8) {
            const int32_t step_us = abs(after_us - before_us);
            *worst_step_us = *worst_step_us > step_us ? *worst_step_us : step_us;
        }
    }
    *rms_us = sqrt(sum / n);
    return worst_us;
}

static void test_drifting_clocks_over_a_queueing_line(void)
{
    int32_t step_us;
    double rms_us;
    const double drifts[] = {80e-6, -80e-6, 0.0, 100e-6};
    for (int i = 0; i < 4; i++) {
        const int32_t worst_us = worst_of_hours(drifts[i], 4000.0, i % 2 == 0, &step_us, &rms_us);
        char text[80];
        snprintf(text, sizeof text, "drift %g: rms %.0f us, worst %d us, step %d us", drifts[i],
                 rms_us, (int)worst_us, (int)step_us);
        TEST_ASSERT_TRUE_MESSAGE(step_us <= CLOCK_STEP_MAX_US + 2, text);
        TEST_ASSERT_TRUE_MESSAGE(worst_us < 1600 && rms_us < 450.0, text);
        if (HOST_OR_BOARD(1, 0) == 1) { /* better would be wrong as well */
            TEST_ASSERT_TRUE_MESSAGE(worst_us > 1100 && rms_us > 300.0, text);
        }
    }
    TEST_ASSERT_LESS_THAN_INT32(40, worst_of_hours(50e-6, 0.0, true, &step_us, &rms_us));
}

static void test_a_clock_that_is_set_is_believed_the_third_time(void)
{
    world w = {1000, 5000000, 1.0, 9};
    clock_map map;
    clock_map_init(&map);
    double t_us = 0.0;
    for (int i = 0; i < 20; i++, t_us += 1e6) {
        const clock_exchange e = exchange_at(&w, t_us, 200.0, 100.0, true);
        clock_map_exchange(&map, &e);
    }
    /* one wild exchange is left out ... */
    world wild = w;
    wild.sender_start_us += 123456789u;
    clock_exchange e = exchange_at(&wild, t_us, 200.0, 100.0, true);
    TEST_ASSERT_FALSE(clock_map_exchange(&map, &e));
    TEST_ASSERT_INT32_WITHIN(100, 0, error_at(&map, &w, t_us));
    /* ... three that do not agree as well ... */
    for (uint32_t i = 0; i < 9; i++) {
        wild.sender_start_us += 500000000u;
        e = exchange_at(&wild, t_us, 200.0, 100.0, true);
        TEST_ASSERT_FALSE(clock_map_exchange(&map, &e));
    }
    /* ... three that do are not */
    w.sender_start_us += 3000000000u;
    for (int i = 0; i < 3; i++, t_us += 1e6) {
        e = exchange_at(&w, t_us, 200.0, 100.0, true);
        TEST_ASSERT_EQUAL(i == 2, clock_map_exchange(&map, &e));
    }
    TEST_ASSERT_EQUAL_UINT32(1, map.jumps);
    TEST_ASSERT_EQUAL_UINT32(12, map.left_out);
    TEST_ASSERT_INT32_WITHIN(100, 0, error_at(&map, &w, t_us));
}

static void test_a_bad_first_exchange_is_put_right_at_once(void)
{
    world w = {0, 777, 1.0, 9};
    clock_map map;
    clock_map_init(&map);
    clock_exchange e = {0, 777u + 60000u, 777u + 60000u, 60100u}; /* 60 ms there, 0.1 ms back */
    TEST_ASSERT_TRUE(clock_map_exchange(&map, &e));
    TEST_ASSERT_INT32_WITHIN(100, -30000, error_at(&map, &w, 1e5));
    e = exchange_at(&w, 1e6, 100.0, 0.0, true);
    TEST_ASSERT_TRUE(clock_map_exchange(&map, &e));
    TEST_ASSERT_INT32_WITHIN(2, 0, error_at(&map, &w, 1.1e6));
}

static void test_silence_ends_the_map(void)
{
    clock_map map;
    clock_map_init(&map);
    const uint32_t at_us = UINT32_MAX - 1000u;
    const clock_exchange e = {at_us, 5, 5, at_us};
    clock_map_exchange(&map, &e);
    clock_map_tick(&map, at_us + 60000000u);
    TEST_ASSERT_TRUE(map.synced);
    clock_map_tick(&map, at_us + 60000001u);
    TEST_ASSERT_FALSE(map.synced);
    TEST_ASSERT_EQUAL_UINT32(1, map.used);
    TEST_ASSERT_TRUE(clock_map_exchange(&map, &e)); /* and starts anew */
}

static void test_hostile_exchanges_leave_it_usable(void)
{
    uint32_t seed = 21;
    clock_map map;
    clock_map_init(&map);
    for (int i = 0; i < 20000; i++) {
        const uint32_t now_us = random_bits(&seed), there_us = random_bits(&seed);
        const clock_exchange e = {
            now_us,
            there_us,
            random_below(&seed, 2) == 0 ? there_us + 10u : random_bits(&seed),
            random_below(&seed, 2) == 0 ? now_us + 200u : random_bits(&seed),
        };
        clock_map_exchange(&map, &e);
        TEST_ASSERT_TRUE(map.drift >= -CLOCK_DRIFT_MAX && map.drift <= CLOCK_DRIFT_MAX);
        uint32_t device_us;
        clock_map_to_device(&map, random_bits(&seed), &device_us);
    }
    TEST_ASSERT_EQUAL_UINT32(20000, map.used + map.left_out);
    world w = {0, 777, 1.0, 9};
    for (int i = 0; i < 3; i++) {
        const clock_exchange e = exchange_at(&w, 1e6 * i, 100.0, 0.0, true);
        clock_map_exchange(&map, &e);
    }
    TEST_ASSERT_INT32_WITHIN(2, 0, error_at(&map, &w, 2e6));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_is_known_at_first);
    RUN_TEST(test_one_exchange_halves_the_delay);
    RUN_TEST(test_what_cannot_be_is_left_out);
    RUN_TEST(test_drifting_clocks_over_a_queueing_line);
    RUN_TEST(test_a_clock_that_is_set_is_believed_the_third_time);
    RUN_TEST(test_a_bad_first_exchange_is_put_right_at_once);
    RUN_TEST(test_silence_ends_the_map);
    RUN_TEST(test_hostile_exchanges_leave_it_usable);
    return UNITY_END();
}
