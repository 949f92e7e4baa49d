/* supervisor.c - see supervisor.h. */
#include "supervisor.h"

#include <stddef.h>

#define IN(state) (1u << SUPERVISOR_##state)
#define ANYWHERE ((1u << SUPERVISOR_STATES_N) - 1u)

_Static_assert(SUPERVISOR_STATES_N <= 16 && SUPERVISOR_CONDITIONS_N <= 16, "bits of a rule");

const supervisor_rule supervisor_rules[SUPERVISOR_RULES_N] = {
    {ANYWHERE, WHEN_ESTOP, 0, SUPERVISOR_ESTOP, 0, "emergency stop"},
    {ANYWHERE & ~IN(ESTOP), WHEN_FAULT, 0, SUPERVISOR_FAULT, 0, "fault"},
    {IN(FAULT) | IN(ESTOP), WHEN_CLEAR | WHEN_TESTED, WHEN_FAULT | WHEN_ESTOP, SUPERVISOR_DISARMED,
     0, "cleared by request"},

    {IN(BOOT), WHEN_READY, 0, SUPERVISOR_SELFTEST, 0, "started"},
    {IN(SELFTEST), WHEN_TESTED, 0, SUPERVISOR_DISARMED, 0, "self test passed"},

    {IN(ARMING) | IN(ACTIVE) | IN(HOLD) | IN(RELAX) | IN(LIMP), WHEN_DISARM, 0, SUPERVISOR_DISARMED,
     0, "disarmed by request"},
    {IN(DISARMED) | IN(RELAX) | IN(LIMP), WHEN_ARM | WHEN_POSES, WHEN_DISARM, SUPERVISOR_ARMING,
     SUPERVISOR_ARMING_US, "armed by request"},

    {IN(ARMING) | IN(ACTIVE), 0, WHEN_POSES, SUPERVISOR_HOLD, 0, "no valid pose in time"},
    {IN(ARMING), WHEN_TIME_IS_UP, 0, SUPERVISOR_ACTIVE, 0, "blended in"},
    {IN(HOLD), WHEN_POSES | WHEN_STEADY, 0, SUPERVISOR_ACTIVE, SUPERVISOR_ARMING_US,
     "poses are back"},
    {IN(HOLD), WHEN_TIME_IS_UP, 0, SUPERVISOR_RELAX, SUPERVISOR_RAMP_US, "poses stayed away"},
    {IN(RELAX), WHEN_RELAXED, 0, SUPERVISOR_LIMP, 0, "straight"},
    {IN(RELAX), WHEN_TIME_IS_UP, 0, SUPERVISOR_LIMP, 0, "not straight in time"},
};

static const char ARMED_ALREADY[] = "armed already";

const supervisor_duty supervisor_duties[SUPERVISOR_STATES_N] = {
    [SUPERVISOR_BOOT] = {.name = "BOOT", .follow = FOLLOW_NOTHING, .no_arm = "still starting"},
    [SUPERVISOR_SELFTEST] = {.name = "SELFTEST",
                             .follow = FOLLOW_NOTHING,
                             .self_test = true,
                             .no_arm = "the self test has not passed yet"},
    [SUPERVISOR_DISARMED] = {.name = "DISARMED",
                             .follow = FOLLOW_NOTHING,
                             .change_all = true,
                             .save = true},
    [SUPERVISOR_ARMING] = {.name = "ARMING",
                           .follow = FOLLOW_ROD,
                           .servo_power = true,
                           .time_us = SUPERVISOR_ARMING_US,
                           .no_arm = ARMED_ALREADY},
    [SUPERVISOR_ACTIVE] = {.name = "ACTIVE",
                           .follow = FOLLOW_ROD,
                           .servo_power = true,
                           .no_arm = ARMED_ALREADY},
    [SUPERVISOR_HOLD] = {.name = "HOLD",
                         .follow = FOLLOW_HOLD,
                         .servo_power = true,
                         .time_us = SUPERVISOR_HOLD_US,
                         .no_arm = ARMED_ALREADY},
    [SUPERVISOR_RELAX] = {.name = "RELAX",
                          .follow = FOLLOW_STRAIGHT,
                          .servo_power = true,
                          .time_us = SUPERVISOR_RELAX_US},
    [SUPERVISOR_LIMP] = {.name = "LIMP", .follow = FOLLOW_NOTHING},
    [SUPERVISOR_FAULT] = {.name = "FAULT",
                          .follow = FOLLOW_NOTHING,
                          .self_test = true,
                          .no_arm = "a fault is latched: remove its cause, then CLEAR_FAULT"},
    [SUPERVISOR_ESTOP] = {.name = "ESTOP",
                          .follow = FOLLOW_NOTHING,
                          .self_test = true,
                          .no_arm = "stopped: release the e-stop, then CLEAR_FAULT"},
};

const supervisor_rule *supervisor_find(supervisor_state state, uint32_t conditions)
{
    for (int i = 0; i < SUPERVISOR_RULES_N; i++) {
        const supervisor_rule *rule = &supervisor_rules[i];
        if ((rule->from >> state & 1u) != 0 && (rule->required & ~conditions) == 0 &&
            (rule->forbidden & conditions) == 0) {
            return rule;
        }
    }
    return NULL;
}

supervisor_state supervisor_next(supervisor_state state, uint32_t conditions)
{
    const supervisor_rule *rule = supervisor_find(state, conditions);
    return rule != NULL ? (supervisor_state)rule->to : state;
}

const char *supervisor_no_arm(supervisor_state state, uint32_t conditions)
{
    if (supervisor_duties[state].no_arm != NULL) {
        return supervisor_duties[state].no_arm;
    }
    /* asked of the rules themselves, so that the answer and the deed cannot differ */
    switch (supervisor_next(state, conditions | WHEN_ARM)) {
    case SUPERVISOR_ARMING:
        return NULL;
    case SUPERVISOR_ESTOP:
        return supervisor_duties[SUPERVISOR_ESTOP].no_arm;
    case SUPERVISOR_FAULT:
        return supervisor_duties[SUPERVISOR_FAULT].no_arm;
    default:
        return (conditions & WHEN_POSES) != 0 ? "a DISARM came with it"
                                              : "no valid poses arrive: start the stream first";
    }
}

void supervisor_init(supervisor *s)
{
    *s = (supervisor){.state = SUPERVISOR_BOOT};
}

static uint32_t add_saturating(uint32_t a, uint32_t b)
{
    return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

const supervisor_rule *supervisor_step(supervisor *s, uint32_t conditions, uint32_t now_us)
{
    const uint32_t passed_us = s->started ? now_us - s->last_us : 0;
    s->started = true;
    s->last_us = now_us;

    conditions &= (1u << SUPERVISOR_GIVEN_N) - 1u;
    s->in_state_us = add_saturating(s->in_state_us, passed_us);
    const uint32_t time_us = supervisor_duties[s->state].time_us;
    if (time_us != 0 && s->in_state_us >= time_us) {
        conditions |= WHEN_TIME_IS_UP;
    }
    /* counts from the first step with poses, not from the gap before it */
    const bool poses = (conditions & WHEN_POSES) != 0;
    s->with_poses_us = poses && s->had_poses ? add_saturating(s->with_poses_us, passed_us) : 0;
    s->had_poses = poses;
    if (poses && s->with_poses_us >= SUPERVISOR_STEADY_US) {
        conditions |= WHEN_STEADY;
    }

    const supervisor_rule *rule = supervisor_find(s->state, conditions);
    if (rule == NULL || rule->to == (uint8_t)s->state) {
        return NULL;
    }
    s->state = (supervisor_state)rule->to;
    s->in_state_us = 0;
    return rule;
}

void supervisor_start_over(supervisor *s)
{
    s->in_state_us = 0;
}
