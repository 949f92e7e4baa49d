/* tick_budget.h - whether a tick of the whole device fits the time there is, before it is tried.
 *
 * What the main loop's dearest tick takes is linear in the links; the constants are estimates of cycles, which
 * tests/target/cost.py holds against what is counted (COST.md). Pure functions; not for interrupts.
 */
#ifndef LIMBER_TICK_BUDGET_H
#define LIMBER_TICK_BUDGET_H

#include "params.h"

typedef struct {
    uint32_t needed_us; /* by the main loop, in its dearest tick */
    uint32_t given_us;  /* to the main loop: what interrupts leave it of a tick */
    int links_max;      /* most links of this model that fit; 0 where none does */
} tick_budget;

/* The main loop's dearest tick: HEARTBEAT and STATS in it, and the rod's worst step. Parameters do not change in
 * it; one in which they do may take two ticks. model: ROD_MODEL_... */
uint32_t tick_budget_cycles(int model, int links_n, float tick_s);

/* Of a set, at this clock of the core. */
tick_budget tick_budget_of(const params_set *set, uint32_t clock_hz);

/* True where the set fits, or the clock is not known (0). Else *why refuses the links, with the arithmetic in
 * `text`, which has room for MESSAGES_TEXT_MAX + 1 and must live as long as *why. */
bool tick_budget_check(const params_set *set, uint32_t clock_hz, char *text, params_refusal *why);

#endif
