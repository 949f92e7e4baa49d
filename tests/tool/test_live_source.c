/* test_live_source.c - the clock rule, silence and jitter, the limit on floods, of a source that is a script. */
#include <string.h>
#include <unity.h>

#include "limber.h"
#include "live_source.h"

static live_source source;
static live_kind kind;
static track_sample next_sample;
static int left_n;
static uint64_t now_us; /* what limber_now_us tells */

uint64_t limber_now_us(void)
{
    return now_us;
}

void limber_note(const char *format, ...)
{
    (void)format;
}

const live_kind live_vrpn_kind = {.prefix = "vrpn:"}, live_osc_kind = {.prefix = "osc:"};

static int open_script(live_source *s, const char *where)
{
    (void)s;
    (void)where;
    return SIM_OK;
}

static bool next_of_script(live_source *s, track_sample *sample)
{
    (void)s;
    *sample = next_sample;
    return left_n-- > 0;
}

static void start(bool timed, bool waits)
{
    kind = (live_kind){
        .prefix = "", .timed = timed, .waits = waits, .open = open_script, .next = next_of_script};
    now_us = 1000000000;
    next_sample = (track_sample){.orientation = {0, 0, 0, 1}};
    TEST_ASSERT_EQUAL(SIM_OK, live_source_open(&source, &kind, "script"));
}

void setUp(void) {}

void tearDown(void)
{
    live_source_close(&source);
}

/* A pose of that time that arrives so late; when it was captured, by our clock, after the start. */
static int64_t captured_us(double t_s, int64_t its_start_us, int64_t late_us)
{
    track_sample sample;
    uint64_t at_us;
    now_us = source.arrived_us = (uint64_t)(1000000000 + (int64_t)(t_s * 1e6 + 0.5) + late_us);
    next_sample.t_s = t_s + (double)its_start_us * 1e-6;
    left_n = 1;
    TEST_ASSERT_TRUE(live_source_next(&source, &sample, &at_us));
    TEST_ASSERT_TRUE(at_us <= now_us);
    return (int64_t)at_us - 1000000000;
}

/* What takes longer than the quickest was captured by so much earlier than it arrived. */
static void test_clock_of_source(void)
{
    const int64_t its_us = 1700000000123456;
    start(true, true);
    TEST_ASSERT_INT64_WITHIN(2, 700, captured_us(0.00, its_us, 700));
    TEST_ASSERT_INT64_WITHIN(2, 10300, captured_us(0.01, its_us, 300)); /* the least so far */
    TEST_ASSERT_INT64_WITHIN(2, 20300, captured_us(0.02, its_us, 5300));
    TEST_ASSERT_INT64_WITHIN(2, 30300, captured_us(0.03, its_us, 45300));
    TEST_ASSERT_INT64_WITHIN(2, 40300, captured_us(0.04, its_us, 35300));
    TEST_ASSERT_EQUAL(0, source.counts.clock_restarts);
}

/* A clock that runs slower than ours by 0.1 %: poses never look older than what it loses in two windows of 5 s. */
static void test_clock_drifts(void)
{
    start(true, true);
    for (int n = 1; n < 6000; n++) {
        const double t_s = n * 0.01;
        const int64_t drift_us = (int64_t)(t_s * 1e3);
        const int64_t got_us = captured_us(t_s, 5000000 - drift_us, 200);
        TEST_ASSERT_INT64_WITHIN(10300, (int64_t)(t_s * 1e6), got_us - 200);
    }
}

static void test_clock_jumps(void)
{
    start(true, true);
    (void)captured_us(0.00, 0, 100);
    TEST_ASSERT_INT64_WITHIN(2, 10100, captured_us(0.01, -3600000000, 100));
    TEST_ASSERT_INT64_WITHIN(2, 20100, captured_us(0.02, 7200000000, 100));
    TEST_ASSERT_INT64_WITHIN(2, 30100, captured_us(0.03, 7200000000, 900));
    TEST_ASSERT_EQUAL(2, source.counts.clock_restarts);
}

/* Servers that leave their times empty: then arrival counts. */
static void test_clock_stands(void)
{
    start(true, true);
    for (int n = 0; n < 100; n++) {
        const double t_s = n * 0.01;
        TEST_ASSERT_INT64_WITHIN(2, (int64_t)(t_s * 1e6) + 50,
                                 captured_us(t_s, -(int64_t)(t_s * 1e6 + 0.5), 50));
    }
}

static void test_arrival(void)
{
    start(false, true);
    TEST_ASSERT_EQUAL_INT64(10000 + 333, captured_us(0.01, 99999, 333));
    TEST_ASSERT_EQUAL_INT64(20000 + 45000, captured_us(0.02, -5, 45000));
}

static void test_numbers_that_are_none(void)
{
    static const double BAD[] = {0.0 / 0.0, 1.0 / 0.0, -1e13};
    track_sample sample;
    uint64_t at_us;
    start(true, true);
    for (int i = 0; i < 3 * 8; i++) {
        double values[8] = {0, 0, 0, 0, 0, 0, 0, 1};
        values[i % 8] = BAD[i / 8];
        if (i / 8 == 2 && i % 8 > 3) {
            continue; /* a quaternion of any finite length will do */
        }
        next_sample.t_s = values[0];
        memcpy(next_sample.position_m, values + 1, sizeof next_sample.position_m);
        memcpy(next_sample.orientation, values + 4, sizeof next_sample.orientation);
        left_n = 1;
        TEST_ASSERT_FALSE(live_source_next(&source, &sample, &at_us));
    }
    TEST_ASSERT_EQUAL(20, source.counts.unreadable);
    next_sample = (track_sample){.t_s = 1.0};
    left_n = 1;
    TEST_ASSERT_FALSE(live_source_next(&source, &sample, &at_us));
    TEST_ASSERT_EQUAL(1, source.counts.blind);
    TEST_ASSERT_TRUE(live_source_is_silent(&source)); /* who sees nothing has not sent a pose */
}

static void test_silence(void)
{
    track_sample sample;
    uint64_t at_us;
    start(false, true);
    TEST_ASSERT_TRUE(live_source_is_silent(&source));
    for (int n = 0; n < 50; n++) {
        (void)captured_us(n * 0.05, 0, n % 2 == 0 ? 0 : 1000);
    }
    TEST_ASSERT_FALSE(live_source_is_silent(&source));
    now_us += 147000; /* three usual intervals are 147 or 153 ms */
    TEST_ASSERT_FALSE(live_source_next(&source, &sample, &at_us));
    TEST_ASSERT_FALSE(live_source_is_silent(&source));
    now_us += 6001;
    TEST_ASSERT_FALSE(live_source_next(&source, &sample, &at_us));
    TEST_ASSERT_TRUE(live_source_is_silent(&source));
    (void)captured_us(50 * 0.05 + 1.0, 0, 0);
    TEST_ASSERT_FALSE(live_source_is_silent(&source));
    TEST_ASSERT_EQUAL(1, source.pace->silences_n);
    TEST_ASSERT_INT64_WITHIN(2000, 1050000, source.pace->longest_us);
    TEST_ASSERT_DOUBLE_WITHIN(2.0, 50.0, live_pace_median_ms(source.pace));
}

static void test_median_and_jitter(void)
{
    start(false, true);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, live_pace_median_ms(source.pace));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, live_pace_jitter_ms(source.pace));
    double t_s = 0.0;
    for (int n = 0; n <= 1000; n++) { /* 970 of 10 ms, 20 of 13, 10 of 40 */
        (void)captured_us(t_s, 0, 0);
        t_s += n % 100 == 50 ? 0.040 : n % 50 == 7 ? 0.013 : 0.010;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.011, 10.0, live_pace_median_ms(source.pace));
    TEST_ASSERT_DOUBLE_WITHIN(0.021, 3.0, live_pace_jitter_ms(source.pace));
}

/* 2000 a second go through, 20000 do not; a burst of 50 does. */
static void test_flood(void)
{
    track_sample sample;
    uint64_t at_us;
    start(false, false);
    left_n = 50;
    while (live_source_next(&source, &sample, &at_us)) {
    }
    TEST_ASSERT_EQUAL(0, source.counts.too_many);
    TEST_ASSERT_EQUAL(50, source.pace->poses_n);
    for (int n = 0; n < 20000; n++) {
        now_us += 50;
        left_n = 1;
        (void)live_source_next(&source, &sample, &at_us);
    }
    TEST_ASSERT_INT64_WITHIN(2, 2050, source.pace->poses_n);
    TEST_ASSERT_EQUAL(20050 - (long)source.pace->poses_n, source.counts.too_many);
}

static void test_host_and_port(void)
{
    static const struct {
        const char *text, *host, *port;
    } CASES[] = {{"h", "h", "none"},        {"h:1", "h", "1"},        {"h:65535", "h", "65535"},
                 {"[::1]:80", "::1", "80"}, {"[::1]", "::1", "none"}, {":5", "", "5"}};
    static const char *const BAD[] = {"h:",   "h:0",  "h:65536", "h:x",   "h: 1",
                                      "h:-1", "h:1x", "[::1]x",  "[::1]:"};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        char text[50], *host;
        const char *port = "none";
        TEST_ASSERT_TRUE_MESSAGE(live_source_split(strcpy(text, CASES[i].text), &host, &port),
                                 CASES[i].text);
        TEST_ASSERT_EQUAL_STRING(CASES[i].host, host);
        TEST_ASSERT_EQUAL_STRING(CASES[i].port, port);
    }
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        char text[50], *host;
        const char *port = "none";
        TEST_ASSERT_FALSE_MESSAGE(live_source_split(strcpy(text, BAD[i]), &host, &port), BAD[i]);
    }
    start(false, false);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_clock_of_source);
    RUN_TEST(test_clock_drifts);
    RUN_TEST(test_clock_jumps);
    RUN_TEST(test_clock_stands);
    RUN_TEST(test_arrival);
    RUN_TEST(test_numbers_that_are_none);
    RUN_TEST(test_silence);
    RUN_TEST(test_median_and_jitter);
    RUN_TEST(test_flood);
    RUN_TEST(test_host_and_port);
    return UNITY_END();
}
