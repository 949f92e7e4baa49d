/* test_supervisor.c - the real tables, every state with every set of conditions.
 *
 * Two readings of safety.md that share nothing with the tables: a cascade of ifs that must agree with them
 * everywhere, and properties that each stand for one sentence. */
#include "supervisor_walk.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* --- the cascade ------------------------------------------------------------------------------- */

static supervisor_state next_by_hand(supervisor_state state, uint32_t set)
{
    const bool poses = (set & WHEN_POSES) != 0, time_is_up = (set & WHEN_TIME_IS_UP) != 0;
    const bool disarm = (set & WHEN_DISARM) != 0;
    const bool arm = (set & WHEN_ARM) != 0 && poses && !disarm;
    if (set & WHEN_ESTOP) {
        return SUPERVISOR_ESTOP;
    }
    if ((set & WHEN_FAULT) && state != SUPERVISOR_ESTOP) {
        return SUPERVISOR_FAULT;
    }
    switch (state) {
    case SUPERVISOR_BOOT:
        return set & WHEN_READY ? SUPERVISOR_SELFTEST : state;
    case SUPERVISOR_SELFTEST:
        return set & WHEN_TESTED ? SUPERVISOR_DISARMED : state;
    case SUPERVISOR_DISARMED:
        return arm ? SUPERVISOR_ARMING : state;
    case SUPERVISOR_ARMING:
        return disarm       ? SUPERVISOR_DISARMED
               : !poses     ? SUPERVISOR_HOLD
               : time_is_up ? SUPERVISOR_ACTIVE
                            : state;
    case SUPERVISOR_ACTIVE:
        return disarm ? SUPERVISOR_DISARMED : !poses ? SUPERVISOR_HOLD : state;
    case SUPERVISOR_HOLD:
        if (disarm) {
            return SUPERVISOR_DISARMED;
        }
        return poses && (set & WHEN_STEADY) ? SUPERVISOR_ACTIVE
               : time_is_up                 ? SUPERVISOR_RELAX
                                            : state;
    case SUPERVISOR_RELAX:
        if (disarm || arm) {
            return disarm ? SUPERVISOR_DISARMED : SUPERVISOR_ARMING;
        }
        return time_is_up || (set & WHEN_RELAXED) ? SUPERVISOR_LIMP : state;
    case SUPERVISOR_LIMP:
        return disarm ? SUPERVISOR_DISARMED : arm ? SUPERVISOR_ARMING : state;
    default: /* FAULT, ESTOP */
        return (set & WHEN_CLEAR) && (set & WHEN_TESTED) && !(set & WHEN_FAULT)
                   ? SUPERVISOR_DISARMED
                   : state;
    }
}

static void the_tables_agree_with_the_text_in_every_state_under_every_set(void)
{
    EACH_STATE_AND_SET
    {
        if (next_by_hand((supervisor_state)state, set) != next(state, set)) {
            TEST_FAIL_MESSAGE(about(state, set));
        }
    }
}

/* --- properties -------------------------------------------------------------------------------- */

static void estop_wins_in_all(void)
{
    EACH_STATE_AND_SET
    {
        if (set & WHEN_ESTOP) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(SUPERVISOR_ESTOP, next(state, set), about(state, set));
        }
    }
}

static void a_fault_comes_next_and_leaves_an_estop_alone(void)
{
    EACH_STATE_AND_SET
    {
        if ((set & WHEN_FAULT) && !(set & WHEN_ESTOP)) {
            const int expected = state == SUPERVISOR_ESTOP ? SUPERVISOR_ESTOP : SUPERVISOR_FAULT;
            TEST_ASSERT_EQUAL_INT_MESSAGE(expected, next(state, set), about(state, set));
        }
    }
}

static void latched_states_are_left_to_disarmed_by_a_request_without_a_cause(void)
{
    EACH_STATE_AND_SET
    {
        const supervisor_state to = next(state, set);
        if ((state != SUPERVISOR_FAULT && state != SUPERVISOR_ESTOP) || to == SUPERVISOR_ESTOP ||
            to == SUPERVISOR_FAULT) {
            continue;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(SUPERVISOR_DISARMED, to, about(state, set));
        TEST_ASSERT_TRUE_MESSAGE((set & WHEN_CLEAR) && (set & WHEN_TESTED), about(state, set));
        TEST_ASSERT_FALSE_MESSAGE(set & (WHEN_FAULT | WHEN_ESTOP), about(state, set));
    }
}

static void nothing_gets_torque_without_a_request_and_poses(void)
{
    EACH_STATE_AND_SET
    {
        const supervisor_state to = next(state, set);
        const bool armed_now = (torque(to) && !torque((supervisor_state)state)) ||
                               (to == SUPERVISOR_ARMING && state != SUPERVISOR_ARMING);
        if (armed_now) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(SUPERVISOR_ARMING, to, about(state, set));
            TEST_ASSERT_TRUE_MESSAGE((set & WHEN_ARM) && (set & WHEN_POSES), about(state, set));
            TEST_ASSERT_FALSE_MESSAGE(set & WHEN_DISARM, about(state, set));
            TEST_ASSERT_TRUE_MESSAGE(state == SUPERVISOR_DISARMED || state == SUPERVISOR_RELAX ||
                                         state == SUPERVISOR_LIMP,
                                     about(state, set));
        }
    }
}

static void disarm_takes_the_torque_in_one_step_from_everywhere(void)
{
    EACH_STATE_AND_SET
    {
        if (set & WHEN_DISARM) {
            TEST_ASSERT_FALSE_MESSAGE(torque(next(state, set)), about(state, set));
        }
    }
}

static void the_rod_is_never_followed_without_poses(void)
{
    EACH_STATE_AND_SET
    {
        const supervisor_state to = next(state, set);
        if (!(set & WHEN_POSES)) {
            TEST_ASSERT_NOT_EQUAL_INT_MESSAGE(FOLLOW_ROD, supervisor_duties[to].follow,
                                              about(state, set));
        }
    }
}

/* Every way to follow the rod or to straighten starts with a blend, but for ARMING's own end. */
static void what_the_joints_follow_changes_through_a_blend(void)
{
    EACH_STATE_AND_SET
    {
        const supervisor_rule *rule = supervisor_find((supervisor_state)state, set);
        if (rule == NULL) {
            continue;
        }
        const supervisor_follow before = supervisor_duties[state].follow;
        const supervisor_follow after = supervisor_duties[rule->to].follow;
        const bool moves = after == FOLLOW_ROD || after == FOLLOW_STRAIGHT;
        const uint32_t least_us = !moves || before == after  ? 0
                                  : after == FOLLOW_STRAIGHT ? 2000000
                                                             : 1000000;
        TEST_ASSERT_TRUE_MESSAGE(rule->blend_us >= least_us, about(state, set));
        TEST_ASSERT_TRUE_MESSAGE(moves || rule->blend_us == 0, about(state, set));
    }
}

static void exactly_the_documented_transitions_exist(void)
{
    const uint32_t latched = 1u << SUPERVISOR_FAULT | 1u << SUPERVISOR_ESTOP;
    const uint32_t expected[SUPERVISOR_STATES_N] = {
        [SUPERVISOR_BOOT] = latched | 1u << SUPERVISOR_SELFTEST,
        [SUPERVISOR_SELFTEST] = latched | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_DISARMED] = latched | 1u << SUPERVISOR_ARMING,
        [SUPERVISOR_ARMING] =
            latched | 1u << SUPERVISOR_ACTIVE | 1u << SUPERVISOR_HOLD | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_ACTIVE] = latched | 1u << SUPERVISOR_HOLD | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_HOLD] =
            latched | 1u << SUPERVISOR_ACTIVE | 1u << SUPERVISOR_RELAX | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_RELAX] =
            latched | 1u << SUPERVISOR_LIMP | 1u << SUPERVISOR_ARMING | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_LIMP] = latched | 1u << SUPERVISOR_ARMING | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_FAULT] = latched | 1u << SUPERVISOR_DISARMED,
        [SUPERVISOR_ESTOP] = 1u << SUPERVISOR_ESTOP | 1u << SUPERVISOR_DISARMED,
    };
    uint32_t reached[SUPERVISOR_STATES_N] = {0};
    EACH_STATE_AND_SET
    {
        reached[state] |= 1u << next(state, set);
    }
    for (int state = 0; state < SUPERVISOR_STATES_N; state++) {
        const uint32_t staying = 1u << state;
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected[state] | staying, reached[state] | staying,
                                        supervisor_duties[state].name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_tables_agree_with_the_text_in_every_state_under_every_set);
    RUN_TEST(estop_wins_in_all);
    RUN_TEST(a_fault_comes_next_and_leaves_an_estop_alone);
    RUN_TEST(latched_states_are_left_to_disarmed_by_a_request_without_a_cause);
    RUN_TEST(nothing_gets_torque_without_a_request_and_poses);
    RUN_TEST(disarm_takes_the_torque_in_one_step_from_everywhere);
    RUN_TEST(the_rod_is_never_followed_without_poses);
    RUN_TEST(what_the_joints_follow_changes_through_a_blend);
    RUN_TEST(exactly_the_documented_transitions_exist);
    return UNITY_END();
}
