/* faults.c - see faults.h. */
#include "faults.h"

const fault_info fault_infos[FAULT_CAUSES_N] = {
    [FAULT_SOLVER] = {"solver", "the rod's solution was not finite three ticks in a row: check the "
                                "rod's parameters"},
    [FAULT_DEADLINE] = {"deadline", "a tick took too long: fewer links or a lower tick rate"},
    [FAULT_CANARY] = {"stack_canary", "the stack overran its end: restart, and report this"},
    [FAULT_WATCHDOG] = {"watchdog", "part of the main loop did not check in: report this"},
    [FAULT_SERVO] = {"servo", "a servo reports an error or does not answer: check cables, supply "
                              "and load"},
    [FAULT_SERVO_MAP] = {"servo_map", "the servos' positions cannot be taken as goals: check the "
                                      "servo map's offsets"},
    [FAULT_FLASH] = {"flash", "the settings' flash reported an error or read back wrong"},
    [FAULT_SETTINGS] = {"settings", "no stored copy of the settings is whole: check the values, "
                                    "then SAVE"},
    [FAULT_SELF_TEST] = {"self_test", "the self test failed: see the log for the part"},
    [FAULT_CLOCK] = {"clock",
                     "crystal and PLL failed, it runs on 16 MHz with slow ticks: check the "
                     "crystal"},
    [FAULT_PROCESSOR] = {"processor", "the processor faulted and was restarted: report this, with "
                                      "BOOT_REPORT"},
};

static void count(uint32_t *counter)
{
    *counter += *counter < UINT32_MAX ? 1u : 0u;
}

static void latch(fault_log *log, fault_cause cause)
{
    count(&log->counts[cause]);
    log->latched |= 1u << cause;
    if (log->first < 0) {
        log->first = (int32_t)cause;
    }
}

void faults_init(fault_log *log)
{
    *log = (fault_log){.first = -1};
}

void faults_raise(fault_log *log, fault_cause cause)
{
    log->raised |= 1u << cause;
    latch(log, cause);
}

void faults_set(fault_log *log, fault_cause cause, bool present)
{
    const uint32_t bit = 1u << cause;
    if (!present) {
        log->lasting &= ~bit;
    } else if ((log->lasting & bit) == 0) {
        log->lasting |= bit;
        latch(log, cause);
    }
}

void faults_solver(fault_log *log, bool finite)
{
    if (finite) {
        log->solver_run = 0;
        return;
    }
    count(&log->solver_failures);
    if (log->solver_run < FAULTS_SOLVER_N) {
        log->solver_run++;
    }
    if (log->solver_run >= FAULTS_SOLVER_N) {
        faults_raise(log, FAULT_SOLVER);
    }
}

bool faults_any(const fault_log *log)
{
    return (log->lasting | log->raised) != 0;
}

void faults_end_tick(fault_log *log)
{
    log->raised = 0;
}

void faults_clear(fault_log *log)
{
    log->latched = log->lasting;
    log->first = -1;
    for (int cause = 0; cause < FAULT_CAUSES_N && log->first < 0; cause++) {
        if ((log->lasting >> cause & 1u) != 0) {
            log->first = cause;
        }
    }
}
