/* test_supervisor_time.c - the supervisor's clock: timeouts to the tick, the wrap of microseconds, states
 * that last for hours. */
#include "supervisor.h"
#include "test_support.h"
#include "unity.h"

#include <stddef.h>

void setUp(void) {}
void tearDown(void) {}

enum { TICK_US = 1000 };

typedef struct {
    supervisor s;
    uint32_t now_us;
} device;

static const supervisor_rule *step(device *d, uint32_t passed_us, uint32_t conditions)
{
    d->now_us += passed_us;
    return supervisor_step(&d->s, WHEN_READY | WHEN_TESTED | conditions, d->now_us);
}

static device disarmed_at(uint32_t now_us)
{
    device d = {.now_us = now_us};
    supervisor_init(&d.s);
    step(&d, 0, 0);
    step(&d, TICK_US, 0);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, d.s.state);
    return d;
}

static device active_at(uint32_t now_us)
{
    device d = disarmed_at(now_us);
    step(&d, TICK_US, WHEN_ARM | WHEN_POSES);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ARMING, d.s.state);
    step(&d, 1000000, WHEN_POSES);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, d.s.state);
    return d;
}

static device holding_at(uint32_t now_us)
{
    device d = active_at(now_us);
    step(&d, TICK_US, 0);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_HOLD, d.s.state);
    return d;
}

static device relaxing_at(uint32_t now_us)
{
    device d = holding_at(now_us);
    step(&d, 500000, 0);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_RELAX, d.s.state);
    return d;
}

/* With any length of tick, the state changes in the first step that is not before the time. */
static void expect_after(device d, uint32_t time_us, uint32_t conditions, supervisor_state to)
{
    static const uint32_t TICKS_US[] = {1, 7, 333, 1000, 4001, 499999};
    for (size_t i = 0; i < sizeof TICKS_US / sizeof TICKS_US[0]; i++) {
        device e = d;
        const supervisor_state from = e.s.state;
        /* in one leap to near the end, then by ticks */
        const uint32_t leap_us = time_us > 3 * TICKS_US[i] ? time_us - 3 * TICKS_US[i] - 1 : 0;
        step(&e, leap_us, conditions);
        uint32_t passed_us = leap_us;
        while (passed_us < time_us) {
            TEST_ASSERT_EQUAL_INT(from, e.s.state);
            const supervisor_rule *rule = step(&e, TICKS_US[i], conditions);
            passed_us += TICKS_US[i];
            TEST_ASSERT_EQUAL(passed_us >= time_us, rule != NULL);
        }
        TEST_ASSERT_EQUAL_INT(to, e.s.state);
    }
}

static void timeouts_are_kept_to_the_tick_wherever_the_clock_wraps(void)
{
    static const uint32_t STARTS_US[] = {0,
                                         0xFFFFFFFFu,
                                         0xFFFFFFFFu - 1000000u,
                                         0x7FFFFFFFu,
                                         0xFFFFFFFFu - 1500000u,
                                         0xFFFFFFFFu - 1700000u};
    for (size_t i = 0; i < sizeof STARTS_US / sizeof STARTS_US[0]; i++) {
        device d = disarmed_at(STARTS_US[i]);
        step(&d, TICK_US, WHEN_ARM | WHEN_POSES);
        expect_after(d, 1000000, WHEN_POSES, SUPERVISOR_ACTIVE);
        expect_after(holding_at(STARTS_US[i]), 500000, 0, SUPERVISOR_RELAX);
        expect_after(relaxing_at(STARTS_US[i]), 5000000, 0, SUPERVISOR_LIMP);
    }
}

static void relax_ends_when_straight(void)
{
    device d = relaxing_at(5);
    TEST_ASSERT_NULL(step(&d, TICK_US, 0));
    TEST_ASSERT_NOT_NULL(step(&d, TICK_US, WHEN_RELAXED));
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_LIMP, d.s.state);
}

static void hold_ends_after_200_ms_of_poses_counted_from_the_first(void)
{
    device d = holding_at(0xFFFFFFFFu - 1100000u); /* wraps meanwhile */
    step(&d, 150000, 0);
    step(&d, 50000, WHEN_POSES); /* the gap before is not good time */
    TEST_ASSERT_NULL(step(&d, 199999, WHEN_POSES));
    const supervisor_rule *rule = step(&d, 1, WHEN_POSES);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, d.s.state);
    TEST_ASSERT_EQUAL_UINT32(1000000, rule->blend_us);
}

static void poses_that_come_and_go_do_not_end_hold_nor_stretch_it(void)
{
    device d = holding_at(77);
    for (int ms = 1; ms < 500; ms++) {
        TEST_ASSERT_NULL(step(&d, TICK_US, ms % 190 != 0 ? WHEN_POSES : 0));
    }
    step(&d, TICK_US, WHEN_POSES);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_RELAX, d.s.state);
}

static void steady_at_the_very_end_of_hold_goes_back(void)
{
    device d = holding_at(77);
    step(&d, 300000, WHEN_POSES);
    step(&d, 200000, WHEN_POSES);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, d.s.state);
}

static void good_poses_alone_lead_nowhere_from_relax_and_limp(void)
{
    device d = relaxing_at(1);
    for (int ms = 0; ms < 4999; ms++) {
        TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_POSES));
    }
    step(&d, TICK_US, WHEN_POSES);
    for (int second = 0; second < 3600; second++) {
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_LIMP, d.s.state);
        step(&d, 1000000, WHEN_POSES);
    }
    step(&d, TICK_US, WHEN_POSES | WHEN_ARM);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ARMING, d.s.state);
}

static void arming_that_loses_its_poses_still_owes_a_whole_blend(void)
{
    device d = disarmed_at(9);
    TEST_ASSERT_EQUAL_UINT32(1000000, step(&d, TICK_US, WHEN_ARM | WHEN_POSES)->blend_us);
    step(&d, 900000, WHEN_POSES);
    step(&d, TICK_US, 0);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_HOLD, d.s.state);
    step(&d, TICK_US, WHEN_POSES);
    TEST_ASSERT_EQUAL_UINT32(1000000, step(&d, 200000, WHEN_POSES)->blend_us);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, d.s.state);
}

static void hours_in_a_state_neither_wrap_nor_spoil_the_next_one(void)
{
    device d = active_at(123);
    for (int hour = 0; hour < 30; hour++) { /* each longer than half the clock's wrap */
        TEST_ASSERT_NULL(step(&d, 3600000000u, WHEN_POSES));
    }
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, d.s.in_state_us);
    step(&d, TICK_US, 0);
    expect_after(d, 500000, 0, SUPERVISOR_RELAX);
    step(&d, 500000, 0);
    step(&d, 5000000, 0);
    for (int hour = 0; hour < 30; hour++) {
        TEST_ASSERT_NULL(step(&d, 3600000000u, 0));
    }
    step(&d, TICK_US, WHEN_ARM | WHEN_POSES);
    expect_after(d, 1000000, WHEN_POSES, SUPERVISOR_ACTIVE);
}

static void the_callers_word_on_its_own_conditions_is_ignored(void)
{
    device d = holding_at(0);
    TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_STEADY));
    TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_TIME_IS_UP));
}

static void estop_takes_one_step_and_is_reported_once(void)
{
    device d = active_at(0);
    TEST_ASSERT_NOT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_ESTOP));
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, d.s.state);
    TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_ESTOP));
    TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_ESTOP | WHEN_CLEAR));
    TEST_ASSERT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_FAULT | WHEN_CLEAR));
    TEST_ASSERT_NOT_NULL(step(&d, TICK_US, WHEN_POSES | WHEN_CLEAR | WHEN_ARM));
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, d.s.state);
}

/* Whatever else happens, without an ARM there is no torque: not after a reset, not ever. */
static void nothing_but_a_request_arms(void)
{
    uint32_t seed = 20180303u;
    for (int reset = 0; reset < HOST_OR_BOARD(1000, 20); reset++) {
        device d = {.now_us = random_bits(&seed)};
        supervisor_init(&d.s);
        for (int i = 0; i < 1000; i++) {
            const uint32_t conditions = random_bits(&seed) & ~(uint32_t)WHEN_ARM;
            d.now_us += random_bits(&seed) >> (random_bits(&seed) & 31u);
            supervisor_step(&d.s, conditions & random_bits(&seed), d.now_us);
            TEST_ASSERT_FALSE(supervisor_duties[d.s.state].servo_power);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(timeouts_are_kept_to_the_tick_wherever_the_clock_wraps);
    RUN_TEST(relax_ends_when_straight);
    RUN_TEST(hold_ends_after_200_ms_of_poses_counted_from_the_first);
    RUN_TEST(poses_that_come_and_go_do_not_end_hold_nor_stretch_it);
    RUN_TEST(steady_at_the_very_end_of_hold_goes_back);
    RUN_TEST(good_poses_alone_lead_nowhere_from_relax_and_limp);
    RUN_TEST(arming_that_loses_its_poses_still_owes_a_whole_blend);
    RUN_TEST(hours_in_a_state_neither_wrap_nor_spoil_the_next_one);
    RUN_TEST(the_callers_word_on_its_own_conditions_is_ignored);
    RUN_TEST(estop_takes_one_step_and_is_reported_once);
    RUN_TEST(nothing_but_a_request_arms);
    return UNITY_END();
}
