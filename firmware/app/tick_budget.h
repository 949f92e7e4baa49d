/* tick_budget.h - whether a tick of the whole device fits the time there is, before it is tried.
 *
 * What the main loop's dearest tick takes is linear in the links; the constants are estimates of cycles, which
 * tests/target/cost.py holds against what is counted (COST.md). Pure functions; not for interrupts.
 */
#ifndef LIMBER_TICK_BUDGET_H
#define LIMBER_TICK_BUDGET_H

#include "params.h"

/* What else the rod has to do with. */
typedef struct {
    int objects_n; /* in the scene, whether touched or not */
    bool shaped;
} tick_load;

typedef struct {
    uint32_t needed_us; /* by the main loop, in its dearest tick */
    uint32_t given_us;  /* to the main loop: what interrupts leave it of a tick */
    int links_max;      /* most links of this model that fit under this load; 0 where none does */
    int objects_max;    /* most objects that these links leave time for */
} tick_budget;

/* The main loop's dearest tick: HEARTBEAT and STATS in it, and the rod's worst step. Parameters do not change in
 * it; one in which they do may take two ticks. Every link asks every object, and any of them may touch.
 * model: ROD_MODEL_... */
uint32_t tick_budget_cycles(int model, int links_n, float tick_s, const tick_load *load);

/* Of a set and a load, at this clock of the core. */
tick_budget tick_budget_of(const params_set *set, const tick_load *load, uint32_t clock_hz);

/* True where both fit, or the clock is not known (0). Else *why refuses the links, with the arithmetic in
 * `text`, which has room for MESSAGES_TEXT_MAX + 1 and must live as long as *why. */
bool tick_budget_check(const params_set *set, const tick_load *load, uint32_t clock_hz, char *text,
                       params_refusal *why);

/* The same where the objects are what is asked for: *why refuses those. */
bool tick_budget_check_objects(const params_set *set, const tick_load *load, uint32_t clock_hz,
                               char *text, params_refusal *why);

#endif
