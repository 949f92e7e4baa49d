/* faults.h - everything that can put the device into FAULT: one enum, a name and a sentence for each, and
 * a log that counts them.
 *
 * A cause is either a moment (a deadline was missed: faults_raise) or a condition that lasts (a servo
 * reports an error: faults_set); the supervisor sees both as WHEN_FAULT. Once a tick: raise and set, ask
 * faults_any, step the supervisor, faults_end_tick. Caller-owned, no heap, main loop only.
 *
 * What only DISARMED can cure (a SAVE, other parameters) must be a moment: FAULT_SETTINGS, FAULT_FLASH,
 * FAULT_SERVO_MAP, FAULT_SOLVER. CLEAR_FAULT waits until nothing lasts, so as lasting causes they
 * would keep out their own cure.
 *
 * Order and numbers are part of the wire (FAULT, STATS): add at the end.
 */
#ifndef LIMBER_FAULTS_H
#define LIMBER_FAULTS_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    FAULT_SOLVER,    /* the rod's step was not finite, FAULTS_SOLVER_N ticks in a row */
    FAULT_DEADLINE,  /* a tick took longer than it may */
    FAULT_CANARY,    /* the stack has grown over its end: lasts until a reset */
    FAULT_WATCHDOG,  /* part of the main loop did not check in */
    FAULT_SERVO,     /* a servo reports an error or does not answer */
    FAULT_SERVO_MAP, /* the servos' present positions cannot be taken as goals */
    FAULT_FLASH,     /* the settings' flash reported an error or read back wrong */
    FAULT_SETTINGS,  /* settings were stored, but none of the copies is whole */
    FAULT_SELF_TEST,
    FAULT_CLOCK,     /* not the clock the firmware was built for: told at start, can be cleared */
    FAULT_PROCESSOR, /* the processor faulted, and the firmware restarted; likewise */
    FAULT_CAUSES_N,
} fault_cause;

enum { FAULTS_SOLVER_N = 3 };

_Static_assert(FAULT_CAUSES_N <= 32, "masks are 32 bits");

typedef struct {
    const char *name; /* for JSON and tables */
    const char *text; /* what happened and what to do, one sentence */
} fault_info;

extern const fault_info fault_infos[FAULT_CAUSES_N];

/* Read all of it; write through the functions. Masks: bit 1 << cause. */
typedef struct {
    uint32_t counts
        [FAULT_CAUSES_N];     /* since the reset; a lasting cause counts when it comes; saturate */
    uint32_t lasting, raised; /* now */
    uint32_t latched;         /* since the last faults_clear */
    int32_t first;            /* fault_cause that came first since then, or -1 */
    uint32_t solver_failures; /* ticks, since the reset; saturates */
    uint8_t solver_run;       /* and in a row */
} fault_log;

void faults_init(fault_log *log);

/* It happened in this tick. */
void faults_raise(fault_log *log, fault_cause cause);

/* It is, or is not, the case from now on. */
void faults_set(fault_log *log, fault_cause cause, bool present);

/* What a rod_step came to: raises FAULT_SOLVER at the third failure in a row and at each after it. */
void faults_solver(fault_log *log, bool finite);

/* WHEN_FAULT: some cause is present in this tick. */
bool faults_any(const fault_log *log);

/* The supervisor has seen this tick's moments. */
void faults_end_tick(fault_log *log);

/* The supervisor has left FAULT or ESTOP: unlatch. Counts stay; what still lasts is latched again. */
void faults_clear(fault_log *log);

#endif
