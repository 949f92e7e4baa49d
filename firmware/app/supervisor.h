/* supervisor.h - what the device may do at this moment, as two const tables and one pure function.
 *
 *     BOOT -> SELFTEST -> DISARMED -> ARMING -> ACTIVE <-> HOLD -> RELAX -> LIMP
 *     FAULT and ESTOP: latched, reached from everywhere, left by CLEAR_FAULT to DISARMED only
 *
 * The tables are README's safety table; the tests walk every state with every set of conditions. One
 * transition a step at most. Decisions that table leaves open:
 *
 *   ARM       the only way to torque, in DISARMED, RELAX and LIMP, while poses arrive; always through
 *             ARMING. Out of DISARMED and LIMP the device first reads where the servos are
 *             (servo_map_place); out of RELAX they have torque and their goals are known.
 *   DISARM    torque off at once, in every state, to DISARMED. Not a ramp: who says "off" must not see
 *             the rod move by itself for two seconds more, and off needs neither the solver nor the
 *             servos' obedience. Who wants it gentle stops the stream: HOLD, RELAX, LIMP.
 *             DISARM beats an ARM of the same step. It is accepted everywhere (FAULT and ESTOP, which
 *             have no torque, stay what they are).
 *   ARMING    that loses its stream goes to HOLD as ACTIVE does. The way back takes the same 1 s blend, so
 *             the rod is never followed without one since the joints last stood still.
 *   HOLD      its 500 ms count from entering it: poses that come back too late to be good for 200 ms
 *             by then do not stop RELAX.
 *   FAULT     comes after ESTOP and does not replace it. Both are left only once the self test has
 *             passed, the cause is gone and the input is released; ESTOP with a fault left stays ESTOP.
 *   reset     BOOT; nothing of the state survives, so nothing re-arms.
 *
 * All of it may run in an interrupt, allocates nothing, and costs under 200 instructions a step.
 */
#ifndef LIMBER_SUPERVISOR_H
#define LIMBER_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    SUPERVISOR_BOOT,     /* clocks, settings, peripherals */
    SUPERVISOR_SELFTEST, /* the device checks itself */
    SUPERVISOR_DISARMED, /* no torque; parameters may change */
    SUPERVISOR_ARMING,   /* torque; from where the joints are to the rod */
    SUPERVISOR_ACTIVE,   /* follows the rod */
    SUPERVISOR_HOLD,     /* no poses: stopped within the limits, holds */
    SUPERVISOR_RELAX,    /* still none: to straight, slowly */
    SUPERVISOR_LIMP,     /* given up: no torque, until DISARM or a fresh ARM */
    SUPERVISOR_FAULT,    /* latched; faults.h has the cause */
    SUPERVISOR_ESTOP,    /* latched */
    SUPERVISOR_STATES_N,
} supervisor_state;

/* What holds in a step, bits. The caller gives the first SUPERVISOR_GIVEN_N, supervisor_step the rest. */
enum {
    WHEN_ESTOP = 1 << 0,  /* the input says stop, or an ESTOP message came since the last step */
    WHEN_FAULT = 1 << 1,  /* a cause of a fault is present (faults_any) */
    WHEN_READY = 1 << 2,  /* start-up is done */
    WHEN_TESTED = 1 << 3, /* the self test has passed since the reset */
    WHEN_ARM = 1 << 4,    /* requested since the last step, each of the three */
    WHEN_DISARM = 1 << 5,
    WHEN_CLEAR = 1 << 6,
    WHEN_POSES = 1 << 7,   /* the newest accepted pose is younger than the HOLD parameter (50 ms) */
    WHEN_RELAXED = 1 << 8, /* the ramp is over and every servo at rest at its straight goal */
    WHEN_STEADY = 1 << 9,  /* WHEN_POSES in every step of the last SUPERVISOR_STEADY_US */
    WHEN_TIME_IS_UP = 1 << 10, /* the state has lasted its time_us */
    SUPERVISOR_GIVEN_N = 9,
    SUPERVISOR_CONDITIONS_N = 11,
};

#define SUPERVISOR_STEADY_US 200000u
#define SUPERVISOR_ARMING_US 1000000u
#define SUPERVISOR_HOLD_US 500000u
#define SUPERVISOR_RAMP_US 2000000u /* at least: the servos' limits may make it longer */
#define SUPERVISOR_RELAX_US 5000000u

/* A transition: in one of the states `from` (bits), if all of `required` and none of `forbidden` hold. */
typedef struct {
    uint16_t from, required, forbidden;
    uint8_t to; /* supervisor_state */
    uint32_t
        blend_us; /* the joints pass over so long from their goals to what `to` follows; 0: no blend */
    const char *why; /* for LOG: why the device did that */
} supervisor_rule;

enum { SUPERVISOR_RULES_N = 13 };
extern const supervisor_rule supervisor_rules[SUPERVISOR_RULES_N]; /* the first match counts */

typedef enum {
    FOLLOW_NOTHING,  /* no goals are sent */
    FOLLOW_HOLD,     /* stop within the limits, then hold (servo_map_hold) */
    FOLLOW_ROD,      /* through the rule's blend, while that lasts */
    FOLLOW_STRAIGHT, /* likewise */
} supervisor_follow;

/* What a state does and allows. */
typedef struct {
    const char *name;
    supervisor_follow follow;
    bool servo_power;
    bool self_test;     /* run it, unless it has passed */
    bool change_all;    /* parameters of the disarmed-only kind; live ones may always change */
    bool save;          /* SAVE, PRESET and DEFAULTS to flash */
    uint32_t time_us;   /* after which WHEN_TIME_IS_UP holds; 0: never */
    const char *no_arm; /* why ARM is refused, for the NACK; NULL: allowed, while poses arrive */
} supervisor_duty;

extern const supervisor_duty supervisor_duties[SUPERVISOR_STATES_N];

/* The first rule that matches, or NULL: stay. A rule may lead to the state one is in (ESTOP). */
const supervisor_rule *supervisor_find(supervisor_state state, uint32_t conditions);

/* The state after one step. Pure. */
supervisor_state supervisor_next(supervisor_state state, uint32_t conditions);

/* Why an ARM in this state, under these conditions, would be refused; NULL if it would be obeyed. */
const char *supervisor_no_arm(supervisor_state state, uint32_t conditions);

/* The state with its clock. Read `state`; treat the others as private. */
typedef struct {
    supervisor_state state;
    bool started;         /* last_us is known */
    uint32_t last_us;     /* of the last step */
    uint32_t in_state_us; /* both saturate: a state may last for days */
    uint32_t with_poses_us;
    bool had_poses; /* in the last step */
} supervisor;

/* BOOT. */
void supervisor_init(supervisor *s);

/* One step, once a tick: conditions as the caller sees them (those the supervisor keeps itself are
 * ignored), now_us wraps at 2^32 and may advance by less than that from step to step. Returns the rule
 * obeyed if the state changed, else NULL. A state's time starts with the step that entered it; it is up
 * in the first step at or after time_us. */
const supervisor_rule *supervisor_step(supervisor *s, uint32_t conditions, uint32_t now_us);

/* The state's time begins now: what it is for could not begin before. */
void supervisor_start_over(supervisor *s);

#endif
