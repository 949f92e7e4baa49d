/* test_supervisor_tables.c - the tables themselves: no dead row, and what each state does and allows. */
#include "supervisor_walk.h"
#include "unity.h"

#include <string.h>

void setUp(void) {}
void tearDown(void) {}

static void each_rule_is_the_first_match_somewhere(void)
{
    bool used[SUPERVISOR_RULES_N] = {false};
    EACH_STATE_AND_SET
    {
        const supervisor_rule *rule = supervisor_find((supervisor_state)state, set);
        if (rule != NULL) {
            used[rule - supervisor_rules] = true;
        }
    }
    for (int i = 0; i < SUPERVISOR_RULES_N; i++) {
        TEST_ASSERT_TRUE_MESSAGE(used[i], supervisor_rules[i].why);
    }
}

static void each_state_that_a_rule_names_can_take_it(void)
{
    for (int i = 0; i < SUPERVISOR_RULES_N; i++) {
        const supervisor_rule *rule = &supervisor_rules[i];
        uint32_t taken_from = 0;
        EACH_STATE_AND_SET
        {
            taken_from |= supervisor_find((supervisor_state)state, set) == rule ? 1u << state : 0u;
        }
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(rule->from, taken_from, rule->why);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, rule->required & rule->forbidden, rule->why);
        TEST_ASSERT_TRUE_MESSAGE(rule->why[0] != '\0', "a rule without a reason");
    }
}

static void torque_only_in_the_four_states_that_may_have_it(void)
{
    for (int state = 0; state < SUPERVISOR_STATES_N; state++) {
        const supervisor_duty *duty = &supervisor_duties[state];
        const bool may = state == SUPERVISOR_ARMING || state == SUPERVISOR_ACTIVE ||
                         state == SUPERVISOR_HOLD || state == SUPERVISOR_RELAX;
        TEST_ASSERT_EQUAL_MESSAGE(may, duty->servo_power, duty->name);
        TEST_ASSERT_EQUAL_MESSAGE(may, duty->follow != FOLLOW_NOTHING, duty->name);
    }
}

static void only_disarmed_may_save_or_change_everything(void)
{
    for (int state = 0; state < SUPERVISOR_STATES_N; state++) {
        const supervisor_duty *duty = &supervisor_duties[state];
        TEST_ASSERT_EQUAL_MESSAGE(state == SUPERVISOR_DISARMED, duty->save, duty->name);
        TEST_ASSERT_EQUAL_MESSAGE(state == SUPERVISOR_DISARMED, duty->change_all, duty->name);
        TEST_ASSERT_TRUE_MESSAGE(!duty->self_test || !duty->servo_power, duty->name);
    }
}

static void each_state_has_a_name_of_its_own_and_safetys_time(void)
{
    for (int state = 0; state < SUPERVISOR_STATES_N; state++) {
        const supervisor_duty *duty = &supervisor_duties[state];
        TEST_ASSERT_NOT_NULL(duty->name);
        for (int other = 0; other < state; other++) {
            TEST_ASSERT_TRUE(strcmp(duty->name, supervisor_duties[other].name) != 0);
        }
        const uint32_t time_us = state == SUPERVISOR_ARMING  ? 1000000
                                 : state == SUPERVISOR_HOLD  ? 500000
                                 : state == SUPERVISOR_RELAX ? 5000000
                                                             : 0;
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(time_us, duty->time_us, duty->name);
    }
}

static void an_arm_is_refused_exactly_where_it_would_not_arm(void)
{
    EACH_STATE_AND_SET
    {
        const bool arms =
            state != SUPERVISOR_ARMING && next(state, set | WHEN_ARM) == SUPERVISOR_ARMING;
        const char *text = supervisor_no_arm((supervisor_state)state, set);
        TEST_ASSERT_EQUAL_MESSAGE(arms, text == NULL, about(state, set));
        TEST_ASSERT_TRUE(text == NULL || text[0] != '\0');
    }
}

static void a_refusal_to_arm_names_what_is_in_the_way(void)
{
    TEST_ASSERT_EQUAL_STRING("no valid poses arrive: start the stream first",
                             supervisor_no_arm(SUPERVISOR_LIMP, 0));
    TEST_ASSERT_NOT_NULL(
        strstr(supervisor_no_arm(SUPERVISOR_DISARMED, WHEN_POSES | WHEN_ESTOP), "e-stop"));
    TEST_ASSERT_NOT_NULL(
        strstr(supervisor_no_arm(SUPERVISOR_DISARMED, WHEN_POSES | WHEN_FAULT), "fault"));
    TEST_ASSERT_NOT_NULL(
        strstr(supervisor_no_arm(SUPERVISOR_RELAX, WHEN_POSES | WHEN_DISARM), "DISARM"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_rule_is_the_first_match_somewhere);
    RUN_TEST(each_state_that_a_rule_names_can_take_it);
    RUN_TEST(torque_only_in_the_four_states_that_may_have_it);
    RUN_TEST(only_disarmed_may_save_or_change_everything);
    RUN_TEST(each_state_has_a_name_of_its_own_and_safetys_time);
    RUN_TEST(an_arm_is_refused_exactly_where_it_would_not_arm);
    RUN_TEST(a_refusal_to_arm_names_what_is_in_the_way);
    return UNITY_END();
}
