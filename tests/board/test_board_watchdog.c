/* test_board_watchdog.c - the hardware watchdog's keys in order, and when the other one is starved. */
#include <string.h>

#include "scripted.h"
#include "unity.h"
#include "watchdog.h"

static iwdg_registers iwdg;
static watchdog w;
static int busy_polls; /* of its settings; -1: for ever */
static bool unlocked;

static uint32_t read(const reg *place, uint32_t held)
{
    if (place != &iwdg.sr || busy_polls == 0) {
        return held;
    }
    busy_polls -= busy_polls > 0 ? 1 : 0;
    return IWDG_SR_RVU;
}

/* RM0090 21.3.2: settings count only behind the key 0x5555, which any other key takes back. */
static bool write(reg *place, uint32_t value)
{
    if (place == &iwdg.kr) {
        unlocked = value == 0x5555;
        return false;
    }
    return (place == &iwdg.pr || place == &iwdg.rlr) && !unlocked;
}

void setUp(void)
{
    memset(&iwdg, 0, sizeof iwdg);
    memset(&w, 0, sizeof w);
    iwdg.pr = 7;
    iwdg.rlr = 0xFFF;
    busy_polls = 0;
    unlocked = false;
    scripted_start((script){read, write});
}

void tearDown(void) {}

static void starts_sets_and_feeds(void)
{
    busy_polls = 50;
    TEST_ASSERT_TRUE(watchdog_start(&w, &iwdg, 1000, 7));
    static const uint32_t KEYS[] = {0xCCCC, 0x5555, 0xAAAA};
    int keys_n = 0;
    for (int i = 0; i < scripted_writes_n; i++) {
        if (scripted_writes[i].place == &iwdg.kr) {
            TEST_ASSERT_TRUE(keys_n < 3);
            TEST_ASSERT_EQUAL_HEX32(KEYS[keys_n], scripted_writes[i].value);
            keys_n++;
        }
    }
    TEST_ASSERT_EQUAL_INT(3, keys_n);
    TEST_ASSERT_EQUAL_UINT32(0, iwdg.pr);    /* 32 kHz / 4 */
    TEST_ASSERT_EQUAL_UINT32(800, iwdg.rlr); /* 100 ms of it */
}

static void settings_that_are_never_taken_are_told(void)
{
    busy_polls = -1;
    TEST_ASSERT_FALSE(watchdog_start(&w, &iwdg, 1000, 7));
    TEST_ASSERT_TRUE(scripted_reads_n < 100000);
    TEST_ASSERT_EQUAL_HEX32(0xAAAA, iwdg.kr);
    TEST_ASSERT_TRUE(w.watching);
}

static void feeding_is_one_key_and_none_before_the_start(void)
{
    watchdog_feed(&w, 5);
    TEST_ASSERT_EQUAL_INT(0, scripted_writes_n);
    (void)watchdog_start(&w, &iwdg, 1000, 7);
    scripted_start((script){read, write});
    watchdog_feed(&w, 8);
    TEST_ASSERT_EQUAL_INT(1, scripted_writes_n);
    TEST_ASSERT_EQUAL_HEX32(0xAAAA, iwdg.kr);
}

static void starved_after_50_ms_also_where_ticks_wrap(void)
{
    static const uint32_t STARTS[] = {0, 1000, UINT32_MAX - 20};
    static const uint32_t RATES_HZ[] = {1000, 100};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 2; j++) {
            const uint32_t limit = RATES_HZ[j] / 20, start = STARTS[i];
            memset(&w, 0, sizeof w);
            TEST_ASSERT_FALSE(watchdog_starved(&w, start + 1000)); /* not started */
            (void)watchdog_start(&w, &iwdg, RATES_HZ[j], start);
            for (uint32_t later = 0; later <= limit; later++) {
                TEST_ASSERT_FALSE(watchdog_starved(&w, start + later));
            }
            TEST_ASSERT_TRUE(watchdog_starved(&w, start + limit + 1));
            watchdog_feed(&w, start + limit);
            TEST_ASSERT_FALSE(watchdog_starved(&w, start + 2 * limit));
            TEST_ASSERT_TRUE(watchdog_starved(&w, start + 2 * limit + 1));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(starts_sets_and_feeds);
    RUN_TEST(settings_that_are_never_taken_are_told);
    RUN_TEST(feeding_is_one_key_and_none_before_the_start);
    RUN_TEST(starved_after_50_ms_also_where_ticks_wrap);
    return UNITY_END();
}
