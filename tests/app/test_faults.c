/* test_faults.c - causes of faults: names, counting, what lasts and what does not. */
#include "faults.h"
#include "unity.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static fault_log fresh(void)
{
    fault_log log;
    memset(&log, 0xA5, sizeof log);
    faults_init(&log);
    return log;
}

static void each_cause_has_a_name_of_its_own_and_a_sentence(void)
{
    for (int i = 0; i < FAULT_CAUSES_N; i++) {
        TEST_ASSERT_NOT_NULL(fault_infos[i].name);
        TEST_ASSERT_TRUE(strlen(fault_infos[i].text) > 10);
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(strcmp(fault_infos[i].name, fault_infos[j].name) != 0);
        }
    }
}

static void a_fresh_log_has_nothing(void)
{
    const fault_log log = fresh();
    TEST_ASSERT_FALSE(faults_any(&log));
    TEST_ASSERT_EQUAL_INT(-1, log.first);
    TEST_ASSERT_EQUAL_HEX32(0, log.latched);
}

static void a_moment_is_seen_for_one_tick_and_stays_latched(void)
{
    fault_log log = fresh();
    faults_raise(&log, FAULT_DEADLINE);
    TEST_ASSERT_TRUE(faults_any(&log));
    faults_end_tick(&log);
    TEST_ASSERT_FALSE(faults_any(&log));
    TEST_ASSERT_EQUAL_HEX32(1u << FAULT_DEADLINE, log.latched);
    TEST_ASSERT_EQUAL_UINT32(1, log.counts[FAULT_DEADLINE]);
}

static void what_lasts_counts_when_it_comes_and_is_present_until_it_goes(void)
{
    fault_log log = fresh();
    for (int tick = 0; tick < 5; tick++) {
        faults_set(&log, FAULT_SERVO, true);
        TEST_ASSERT_TRUE(faults_any(&log));
        faults_end_tick(&log);
        TEST_ASSERT_TRUE(faults_any(&log));
    }
    TEST_ASSERT_EQUAL_UINT32(1, log.counts[FAULT_SERVO]);
    faults_set(&log, FAULT_SERVO, false);
    TEST_ASSERT_FALSE(faults_any(&log));
    faults_set(&log, FAULT_SERVO, true);
    TEST_ASSERT_EQUAL_UINT32(2, log.counts[FAULT_SERVO]);
}

static void the_first_cause_is_remembered_until_cleared(void)
{
    fault_log log = fresh();
    faults_raise(&log, FAULT_CLOCK);
    faults_raise(&log, FAULT_SOLVER);
    faults_set(&log, FAULT_CANARY, true);
    TEST_ASSERT_EQUAL_INT(FAULT_CLOCK, log.first);
    faults_end_tick(&log);
    faults_clear(&log);
    /* the canary still lasts */
    TEST_ASSERT_EQUAL_INT(FAULT_CANARY, log.first);
    TEST_ASSERT_EQUAL_HEX32(1u << FAULT_CANARY, log.latched);
    TEST_ASSERT_EQUAL_UINT32(1, log.counts[FAULT_CLOCK]);
    faults_set(&log, FAULT_CANARY, false);
    faults_clear(&log);
    TEST_ASSERT_EQUAL_INT(-1, log.first);
    TEST_ASSERT_EQUAL_HEX32(0, log.latched);
}

static void two_solver_failures_are_borne_the_third_in_a_row_is_a_fault(void)
{
    fault_log log = fresh();
    for (int round = 0; round < 10; round++) {
        faults_solver(&log, false);
        faults_solver(&log, false);
        TEST_ASSERT_FALSE(faults_any(&log));
        faults_solver(&log, true);
    }
    TEST_ASSERT_EQUAL_UINT32(20, log.solver_failures);
    for (int i = 0; i < 300; i++) {
        faults_solver(&log, false);
        TEST_ASSERT_EQUAL(i >= 2, faults_any(&log));
        faults_end_tick(&log);
    }
    TEST_ASSERT_EQUAL_UINT32(298, log.counts[FAULT_SOLVER]);
    faults_solver(&log, true);
    TEST_ASSERT_FALSE(faults_any(&log));
}

static void counters_saturate(void)
{
    fault_log log = fresh();
    log.counts[FAULT_FLASH] = UINT32_MAX - 1;
    log.solver_failures = UINT32_MAX;
    for (int i = 0; i < 3; i++) {
        faults_raise(&log, FAULT_FLASH);
        faults_solver(&log, false);
    }
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, log.counts[FAULT_FLASH]);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, log.solver_failures);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_cause_has_a_name_of_its_own_and_a_sentence);
    RUN_TEST(a_fresh_log_has_nothing);
    RUN_TEST(a_moment_is_seen_for_one_tick_and_stays_latched);
    RUN_TEST(what_lasts_counts_when_it_comes_and_is_present_until_it_goes);
    RUN_TEST(the_first_cause_is_remembered_until_cleared);
    RUN_TEST(two_solver_failures_are_borne_the_third_in_a_row_is_a_fault);
    RUN_TEST(counters_saturate);
    return UNITY_END();
}
