/* test_device_elastic.c - the elastic rod on the whole device: what does not fit a tick is refused, now and at the next
 * start, and what went wrong is counted. */
#include "device_fixture.h"

void setUp(void)
{
    bench_connected(6);
}

void tearDown(void)
{
    free(b);
}

static const rod_params *in_force(void)
{
    return &b->host.device.params.in_force.rod;
}

static void commit(void)
{
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
}

static void make_elastic(int links_n)
{
    stage("servo_kind", 0, (float)SERVOS_NONE);
    stage("model", 0, (float)ROD_MODEL_ELASTIC);
    stage("links", 0, (float)links_n);
    commit();
}

static void test_what_does_not_fit_a_tick_is_refused_with_the_arithmetic(void)
{
    make_elastic(41);
    TEST_ASSERT_EQUAL_INT(41, in_force()->links_n);
    make_elastic(42);
    const message_nack *nack = refused_at_once(REASON_COMBINATION);
    TEST_ASSERT_EQUAL_STRING("links", nack->field);
    TEST_ASSERT_EQUAL_FLOAT(42.0f, nack->value);
    TEST_ASSERT_EQUAL_FLOAT(41.0f, nack->maximum);
    TEST_ASSERT_EQUAL_STRING("elastic, 42 links: 914 us at 168 MHz, a tick of 1000 has 900: "
                             "fewer links, longer tick",
                             nack->text);
    TEST_ASSERT_EQUAL_INT(41, in_force()->links_n);
    stage("model", 0, (float)ROD_MODEL_CONTOUR);
    commit();
    TEST_ASSERT_EQUAL_INT(42, in_force()->links_n); /* it is the model that takes so long */
}

/* The servo bus has interrupts of its own. */
static void test_a_bus_leaves_less(void)
{
    make_elastic(41);
    stage("servo_kind", 0, (float)SERVOS_BUS);
    commit();
    TEST_ASSERT_EQUAL_FLOAT(27.0f, refused_at_once(REASON_COMBINATION)->maximum);
    stage("links", 0, 27.0f);
    commit();
    TEST_ASSERT_EQUAL_INT(27, in_force()->links_n);
}

static void start_again(float tick_s)
{
    bench_start_at(tick_s, 6);
    say_hello(100.0f);
    ticks(5);
}

/* As a board whose crystal is gone: settings that fitted do not fit any more. It comes up with the defaults, says so,
 * and can be cleared and told other ones. */
static void test_settings_that_no_longer_fit_are_not_run(void)
{
    make_elastic(40);
    save();
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_PARAM_SAVE, b->newest[MESSAGE_ACK].ack.answered);
    start_again(1e-3f);
    TEST_ASSERT_EQUAL_INT(40, in_force()->links_n);
    TEST_ASSERT_EQUAL_INT(ROD_MODEL_ELASTIC, in_force()->model);

    start_again(5e-4f);
    TEST_ASSERT_EQUAL_INT(6, in_force()->links_n);
    TEST_ASSERT_EQUAL_INT(ROD_MODEL_CONTOUR, in_force()->model);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_FAULT, state_now());
    TEST_ASSERT_EQUAL_UINT8(FAULT_CODE_SETTINGS, b->newest[MESSAGE_FAULT].fault.fault);
    ask_simply(MESSAGE_CLEAR_FAULT);
    ticks(5);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    make_elastic(8);
    save();
    start_again(5e-4f);
    TEST_ASSERT_EQUAL_INT(8, in_force()->links_n);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
}

/* Steps that no stream of poses could ask for: the pose checks are in their way. */
static void test_restored_lengths_are_counted_and_told(void)
{
    make_elastic(6);
    ask_simply(MESSAGE_STATS_GET);
    tick();
    TEST_ASSERT_EQUAL_UINT32(0, b->newest[MESSAGE_ROD_STATS].rod_stats.lengths_restored);
    rod *r = &b->host.device.body.rod;
    for (int i = 0; i < 100 && rod_restored_n(r) < 3; i++) {
        const rod_pose base = {{i % 2 == 0 ? 0.0f : 5.0f, (float)(i % 3), 0.0f},
                               {i % 2 == 0 ? 1.0f : 0.0f, 0.0f, 0.0f, i % 2 == 0 ? 0.0f : 1.0f}};
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(r, &base));
    }
    ask_simply(MESSAGE_STATS_GET);
    tick();
    TEST_ASSERT_EQUAL_UINT32(3, b->newest[MESSAGE_ROD_STATS].rod_stats.lengths_restored);
    TEST_ASSERT_EQUAL_UINT16(b->request_id, b->newest[MESSAGE_ROD_STATS].rod_stats.request_id);
    TEST_ASSERT_EQUAL_UINT16(b->request_id, b->newest[MESSAGE_STATS].stats.request_id);
}

/* A clock that runs on within a tick. */
static uint32_t taken_us;
static int asked_n;

static uint32_t running_clock(void *context)
{
    const host_device *h = context;
    return (uint32_t)(h->elapsed_s * 1e6 + 0.5) + (asked_n++ > 0 ? taken_us : 0);
}

static void tick_that_takes(uint32_t us)
{
    taken_us = us;
    asked_n = 0;
    b->host.hal.now_us = running_clock;
    tick();
}

static void test_only_a_change_of_parameters_may_take_two_ticks(void)
{
    tick_that_takes(1000);
    TEST_ASSERT_EQUAL_UINT32(0, b->host.device.deadline_misses);
    stage("spring", 0, 300.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick_that_takes(2000);
    TEST_ASSERT_EQUAL_FLOAT(300.0f, in_force()->spring[0]);
    TEST_ASSERT_EQUAL_UINT32(1, b->host.device.deadline_misses);
    tick_that_takes(1000);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    tick_that_takes(1001);
    tick_that_takes(1000);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_FAULT, state_now());
    TEST_ASSERT_EQUAL_UINT8(FAULT_CODE_DEADLINE, b->newest[MESSAGE_FAULT].fault.fault);
}

static void test_nor_may_that_take_longer(void)
{
    stage("spring", 0, 300.0f);
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick_that_takes(2001);
    tick_that_takes(1000);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_FAULT, state_now());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_does_not_fit_a_tick_is_refused_with_the_arithmetic);
    RUN_TEST(test_a_bus_leaves_less);
    RUN_TEST(test_settings_that_no_longer_fit_are_not_run);
    RUN_TEST(test_restored_lengths_are_counted_and_told);
    RUN_TEST(test_only_a_change_of_parameters_may_take_two_ticks);
    RUN_TEST(test_nor_may_that_take_longer);
    return UNITY_END();
}
