/* test_monitor_state.c - what limber monitor makes of a device's messages, and how delays are spread. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "monitor_state.h"
#include "monitor_text.h"
#include "session.h"
#include "unity.h"

static monitor_state state;
static monitor_text text;

/* The counters are taken apart by a file that could also ask for them. */
int session_request(session *s, const message *request)
{
    (void)s;
    (void)request;
    return LIMBER_DEVICE;
}

void setUp(void)
{
    const message_hello device = {.links_n = 2, .tick_hz = 1000.0f, .device = "test"};
    monitor_state_init(&state);
    monitor_state_begin(&state, "pty:test", &device);
    monitor_state_refresh(&state, 1); /* the window begins */
}

void tearDown(void) {}

static void second(void)
{
    monitor_state_refresh(&state, state.window.start_us + 1000000);
}

static void take_angles(uint16_t pose_seq, uint32_t received_us, uint32_t sent_us, uint8_t flags)
{
    message m = {.type = MESSAGE_ANGLES};
    m.angles = (message_angles){.pose_seq = pose_seq,
                                .received_ago_us = (uint16_t)(sent_us - received_us),
                                .state = DEVICE_ACTIVE,
                                .flags = flags,
                                .angles_n = 2,
                                .angles_tenth_mrad = {{100, -15708}, {MESSAGES_ANGLE_INVALID, 0}}};
    monitor_state_take(&state, &m, sent_us);
}

static void take_stats(message_stats stats)
{
    monitor_state_take(&state, &(message){.type = MESSAGE_STATS, .stats = stats}, 0);
}

static const monitor_counter *counter(const char *name)
{
    for (int i = 0; i < state.counters_n; i++) {
        if (strcmp(state.counters[i].name, name) == 0) {
            return &state.counters[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

static void says(monitor_piece piece, const char *expected)
{
    (void)monitor_text_of(&state, piece, text);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* --- ANGLES ---------------------------------------------------------------------------------------- */

static void poses_are_timed_by_the_angles_that_name_them(void)
{
    /* seq and the device's clock wrap; the same pose named twice counts once; one pose is passed over */
    const uint32_t start_us = UINT32_MAX - 5000;
    take_angles(65534, start_us, start_us + 3000, 0);
    take_angles(65535, start_us + 8000, start_us + 9000, 0);
    take_angles(65535, start_us + 8000, start_us + 14000, 0);
    take_angles(0, start_us + 20000, start_us + 20001, 0);
    take_angles(2, start_us + 40000, start_us + 40500, 0);
    second();
    TEST_ASSERT_EQUAL_UINT(4, state.poses.intervals_n); /* 8, 12, and 20 ms that are two */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, state.poses.mean_ms);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, sqrt(2.0), state.poses.jitter_ms);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 12.0, state.poses.longest_ms);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0, state.angles_hz);
    says(MONITOR_TEXT_PACE, "apart 10.0 ms, jitter 1.41, max 12.0");
    second();
    says(MONITOR_TEXT_PACE, "");
    says(MONITOR_TEXT_ANGLES, "angles 0/s");
}

static void no_pose_is_not_timed(void)
{
    take_angles(7, 1000, 2000, ANGLES_NO_POSE);
    take_angles(8, 11000, 12000, 0);
    take_angles(9, 21000, 21000 + UINT16_MAX, 0); /* that or longer ago */
    take_angles(10, 31000, 32000, 0);
    second();
    TEST_ASSERT_EQUAL_UINT(0, state.poses.intervals_n);
}

static void limits_show_for_their_second_with_their_share(void)
{
    says(MONITOR_TEXT_LIMITS, ""); /* nothing known yet */
    for (int i = 0; i < 8; i++) {
        take_angles(1, 0, 0,
                    (uint8_t)(i == 0  ? ANGLES_LIMITED_ANGLE | ANGLES_BLENDING
                              : i < 4 ? ANGLES_BLENDING
                                      : 0));
    }
    second();
    says(MONITOR_TEXT_LIMITS, "limited angle 13 %, blending 50 %");
    second();
    says(MONITOR_TEXT_LIMITS, "no limit acts");
}

static void touching_shows_while_it_is_told(void)
{
    says(MONITOR_TEXT_TOUCH, "");
    const message beat = {.type = MESSAGE_HEARTBEAT, .heartbeat = {.state = DEVICE_ACTIVE}};
    message m = {.type = MESSAGE_TOUCH,
                 .touch = {.contacts_n = 3, .force_newton = {-3.0f, 0.0f, 4.0f}}};
    for (int i = 0; i < 5; i++) {
        monitor_state_take(&state, &beat, 0);
        monitor_state_take(&state, &m, 0);
        says(MONITOR_TEXT_TOUCH, "touches at 3 nodes, 5 N (-3, 0, 4)");
    }
    m.touch = (message_touch){.contacts_n = 1};
    monitor_state_take(&state, &m, 0);
    says(MONITOR_TEXT_TOUCH, "touches at 1 node, 0 N (0, 0, 0)");
    m.touch.contacts_n = 0;
    monitor_state_take(&state, &m, 0);
    says(MONITOR_TEXT_TOUCH, "");
}

/* The line may lose the one that says that it is over. */
static void a_touch_that_is_not_told_again_is_over(void)
{
    const message beat = {.type = MESSAGE_HEARTBEAT, .heartbeat = {.state = DEVICE_ACTIVE}};
    const message m = {.type = MESSAGE_TOUCH, .touch = {.contacts_n = 2}};
    monitor_state_take(&state, &m, 0);
    monitor_state_take(&state, &beat, 0);
    monitor_state_take(&state, &beat, 0);
    TEST_ASSERT_EQUAL_UINT(2, state.touch.contacts_n);
    monitor_state_take(&state, &beat, 0);
    says(MONITOR_TEXT_TOUCH, "");
}

static void angles_are_degrees(void)
{
    take_angles(1, 0, 0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 90.0, state.largest_deg);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5729577951308232, monitor_angle_deg(100));
    TEST_ASSERT_TRUE(isnan(monitor_angle_deg(MESSAGES_ANGLE_INVALID)));
}

/* --- STATS ----------------------------------------------------------------------------------------- */

static void counters_tell_by_how_much_they_grew(void)
{
    take_stats(
        (message_stats){.uptime_ms = 1000, .poses_accepted = 50, .poses_late = 3, .holds = 1});
    TEST_ASSERT_FALSE(state.rates_known);
    TEST_ASSERT_FALSE(counter("holds")->growing);
    take_stats(
        (message_stats){.uptime_ms = 1200, .poses_accepted = 9999}); /* too close for a rate */
    take_stats((message_stats){.uptime_ms = 3000,
                               .poses_accepted = 250,
                               .poses_late = 5,
                               .poses_teleport = 1,
                               .poses_lost = 8,
                               .holds = 1,
                               .tick_max_us = 77});
    says(MONITOR_TEXT_POSES, "poses 100/s, refused 1.5, lost 4.0");
    TEST_ASSERT_TRUE(counter("poses_late")->growing);
    TEST_ASSERT_FALSE(counter("poses_late")->usual);
    TEST_ASSERT_TRUE(counter("poses_accepted")->usual);
    TEST_ASSERT_FALSE(counter("holds")->growing);
    monitor_text_counter(counter("poses_late"), text);
    TEST_ASSERT_EQUAL_STRING("poses_late 5 +2", text);

    /* one lost pose came after all; what grew stays marked for five seconds */
    message_stats later = {
        .uptime_ms = 4000, .poses_accepted = 250, .poses_late = 5, .poses_lost = 7};
    take_stats(later);
    says(MONITOR_TEXT_POSES, "poses 0/s, refused 0, lost 0");
    TEST_ASSERT_TRUE(counter("poses_late")->growing);
    later.uptime_ms = 8000;
    take_stats(later);
    TEST_ASSERT_FALSE(counter("poses_late")->growing);
}

static void counters_and_uptime_wrap(void)
{
    take_stats((message_stats){.uptime_ms = (uint32_t)-500, .poses_accepted = UINT32_MAX});
    take_stats((message_stats){.uptime_ms = 500, .poses_accepted = 99});
    says(MONITOR_TEXT_POSES, "poses 100/s, refused 0, lost 0");
}

/* --- states ---------------------------------------------------------------------------------------- */

static void take_heartbeat(uint8_t fault, uint8_t flags)
{
    monitor_state_take(&state,
                       &(message){.type = MESSAGE_HEARTBEAT,
                                  .heartbeat = {.state = DEVICE_DISARMED,
                                                .fault = fault,
                                                .flags = flags,
                                                .tick_mean_us = 120,
                                                .tick_max_us = 240}},
                       0);
}

static void alarms(void)
{
    message told = {.type = MESSAGE_FAULT, .fault = {.fault = FAULT_CODE_SERVO}};
    take_heartbeat(FAULT_CODE_NONE, HEARTBEAT_TORQUE);
    TEST_ASSERT_FALSE(monitor_text_alarm(&state, text));
    says(MONITOR_TEXT_TICK, "tick 120 us, max 240 (24 %)");
    take_heartbeat(FAULT_CODE_NONE, HEARTBEAT_ESTOP_OPEN);
    TEST_ASSERT_TRUE(monitor_text_alarm(&state, text));
    TEST_ASSERT_EQUAL_STRING("the e-stop input says stop", text);
    strcpy(told.fault.text, "id 3\x1b[2J\xc3");
    monitor_state_take(&state, &told, 0);
    take_heartbeat(FAULT_CODE_SERVO, HEARTBEAT_ESTOP_OPEN);
    TEST_ASSERT_TRUE(monitor_text_alarm(&state, text));
    TEST_ASSERT_EQUAL_STRING("SERVO: a servo reports an error or does not answer (id 3?[2J?)",
                             text);
}

static void a_new_session_forgets_the_one_before(void)
{
    const message_hello device = {.links_n = 3};
    take_angles(1, 0, 0, 0);
    take_stats((message_stats){.uptime_ms = 1000, .holds = 1});
    monitor_state_lost(&state, "cable");
    TEST_ASSERT_TRUE(monitor_text_alarm(&state, text));
    TEST_ASSERT_EQUAL_STRING("LOST: cable", text);
    TEST_ASSERT_TRUE(state.angles_known); /* still to be seen */
    monitor_state_begin(&state, "pty:test", &device);
    TEST_ASSERT_FALSE(monitor_text_alarm(&state, text));
    TEST_ASSERT_FALSE(state.angles_known || state.stats_known);
    TEST_ASSERT_EQUAL_INT(3, state.device.links_n);
}

/* --- delays ---------------------------------------------------------------------------------------- */

static void add_delays(delays *d, int us, uint32_t n)
{
    const int bin = us / DELAYS_BIN_US;
    d->bins[bin < DELAYS_BINS_N ? bin : DELAYS_BINS_N - 1] += n;
    d->n += n;
    d->max_us = us > d->max_us ? us : d->max_us;
}

/* Bars next to each other with everything in them; returns how many. */
static int check_bars(const delays *d, delays_bar bars[DELAYS_BARS_MAX])
{
    const int bars_n = delays_bars(d, bars);
    uint64_t n = 0;
    TEST_ASSERT_LESS_OR_EQUAL_INT(DELAYS_BARS_MAX, bars_n);
    for (int i = 0; i < bars_n; i++) {
        n += bars[i].n;
        TEST_ASSERT_TRUE(bars[i].from_ms < bars[i].to_ms);
        TEST_ASSERT_TRUE(i == 0 || !(bars[i].from_ms < bars[i - 1].to_ms ||
                                     bars[i].from_ms > bars[i - 1].to_ms));
    }
    TEST_ASSERT_EQUAL_UINT64(d->n, n);
    TEST_ASSERT_TRUE(bars_n == 0 || bars[bars_n - 1].to_ms * 1000.0 + 1e-6 >= (double)d->max_us);
    return bars_n;
}

static void bars_hold_every_delay(void)
{
    delays *const d = calloc(1, sizeof *d);
    delays_bar bars[DELAYS_BARS_MAX];
    TEST_ASSERT_EQUAL_INT(0, delays_bars(d, bars));
    add_delays(d, 1002, 1);
    TEST_ASSERT_EQUAL_INT(1, check_bars(d, bars));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, bars[0].from_ms);
    TEST_ASSERT_EQUAL_DOUBLE(1.005, bars[0].to_ms);

    /* 1 to 3 ms: 99 % in twenty bars of 0.1 ms, and one more for the rest */
    for (int us = 1002; us < 3005; us += 5) {
        add_delays(d, us, 10);
    }
    TEST_ASSERT_EQUAL_INT(21, check_bars(d, bars));
    TEST_ASSERT_EQUAL_DOUBLE(1.1, bars[0].to_ms);
    TEST_ASSERT_EQUAL_UINT64(201, bars[0].n);
    TEST_ASSERT_EQUAL_DOUBLE(3.1, bars[20].to_ms);

    /* one in a thousand takes long: it is in the last bar, which reaches to it */
    add_delays(d, 250003, 4);
    TEST_ASSERT_EQUAL_INT(21, check_bars(d, bars));
    TEST_ASSERT_EQUAL_UINT64(201, bars[0].n);
    TEST_ASSERT_EQUAL_UINT64(14, bars[20].n);
    TEST_ASSERT_EQUAL_DOUBLE(250.003, bars[20].to_ms);

    /* beyond all bins */
    add_delays(d, 7000000, 4000);
    const int bars_n = check_bars(d, bars);
    TEST_ASSERT_EQUAL_DOUBLE(7000.0, bars[bars_n - 1].to_ms);
    free(d);
}

static void bars_of_seeded_delays(void)
{
    uint32_t random = 1;
    for (int round = 0; round < 200; round++) {
        delays *const d = calloc(1, sizeof *d);
        delays_bar bars[DELAYS_BARS_MAX];
        const uint32_t most_us = 10u << round % 20;
        for (int i = 0; i < 50 * (1 + round % 5); i++) {
            random = random * 1664525u + 1013904223u;
            add_delays(d, (int)(random / 3 % most_us), 1);
        }
        TEST_ASSERT_GREATER_THAN_INT(0, check_bars(d, bars));
        free(d);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(poses_are_timed_by_the_angles_that_name_them);
    RUN_TEST(no_pose_is_not_timed);
    RUN_TEST(limits_show_for_their_second_with_their_share);
    RUN_TEST(touching_shows_while_it_is_told);
    RUN_TEST(a_touch_that_is_not_told_again_is_over);
    RUN_TEST(angles_are_degrees);
    RUN_TEST(counters_tell_by_how_much_they_grew);
    RUN_TEST(counters_and_uptime_wrap);
    RUN_TEST(alarms);
    RUN_TEST(a_new_session_forgets_the_one_before);
    RUN_TEST(bars_hold_every_delay);
    RUN_TEST(bars_of_seeded_delays);
    return UNITY_END();
}
