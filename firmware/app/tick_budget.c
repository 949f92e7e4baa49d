/* tick_budget.c - see tick_budget.h. */
#include "tick_budget.h"

#include "link.h"
#include "servo_types.h"

/* Cycles of a Cortex-M4F: what runs once a tick as if nothing of it were in the flash's cache, what runs once a
 * link, in loops, as if all of it were. A step at its worst: contour with hold = 2 and smoothing, elastic with all of
 * Newton's steps. */
static const struct {
    uint32_t tick, tick_link, step_link; /* a tick; a link in it; a link in each step of the rod */
} CYCLES[ROD_MODEL_COUNT] = {
    [ROD_MODEL_CONTOUR] = {49000, 640, 160},
    [ROD_MODEL_ELASTIC] = {46500, 950, 1600},
};

/* What interrupts leave of a tick, %. At 168 MHz the bytes of a line of 1 Mbaud, both ways, take 9; those of a
 * servo bus of 4.5 Mbaud 19 more. */
enum { SHARE = 90, SHARE_WITH_BUS = 70 };

static uint32_t cycles_of_link(int model, float tick_s)
{
    const int steps_n = model == ROD_MODEL_ELASTIC ? elastic_steps_n(tick_s) : 1;
    return CYCLES[model].tick_link + CYCLES[model].step_link * (uint32_t)steps_n;
}

uint32_t tick_budget_cycles(int model, int links_n, float tick_s)
{
    return CYCLES[model].tick + cycles_of_link(model, tick_s) * (uint32_t)links_n;
}

tick_budget tick_budget_of(const params_set *set, uint32_t clock_hz)
{
    const int model = set->rod.model;
    const bool bus = (int)set->device.servo_kind == SERVOS_BUS;
    const float given_us = set->rod.tick_s * 1e4f * (float)(bus ? SHARE_WITH_BUS : SHARE);
    const float cycles_per_us = 1e-6f * (float)clock_hz;
    const float needed = (float)tick_budget_cycles(model, set->rod.links_n, set->rod.tick_s);
    const float for_links = given_us * cycles_per_us - (float)CYCLES[model].tick;
    return (tick_budget){
        .needed_us = (uint32_t)(needed / cycles_per_us + 0.5f),
        .given_us = (uint32_t)(given_us + 0.5f),
        .links_max =
            for_links > 0.0f ? (int)(for_links / (float)cycles_of_link(model, set->rod.tick_s)) : 0,
    };
}

/* "elastic, 50 links: 1036 us at 168 MHz, a tick of 1000 has 900: fewer links, longer tick" */
static void explain(const params_set *set, uint32_t clock_hz, const tick_budget *budget, char *text)
{
    const rod_field *model = rod_field_find("model");
    const struct {
        const char *before;
        uint32_t number;
    } parts[] = {
        {", ", (uint32_t)set->rod.links_n},
        {" links: ", budget->needed_us},
        {" us at ", clock_hz / 1000000u},
        {" MHz, a tick of ", (uint32_t)(set->rod.tick_s * 1e6f + 0.5f)},
        {" has ", budget->given_us},
    };
    link_text(text, MESSAGES_TEXT_MAX + 1, model->choices[set->rod.model]);
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        link_text_add(text, MESSAGES_TEXT_MAX + 1, parts[i].before);
        link_text_add_number(text, MESSAGES_TEXT_MAX + 1, parts[i].number);
    }
    link_text_add(text, MESSAGES_TEXT_MAX + 1, ": fewer links, longer tick");
}

bool tick_budget_check(const params_set *set, uint32_t clock_hz, char *text, params_refusal *why)
{
    if (clock_hz == 0) {
        return true;
    }
    const tick_budget budget = tick_budget_of(set, clock_hz);
    if (set->rod.links_n <= budget.links_max) {
        return true;
    }
    explain(set, clock_hz, &budget, text);
    *why = (params_refusal){
        .reason = REASON_COMBINATION,
        .entry = -1,
        .value = (float)set->rod.links_n,
        .min = 1.0f,
        .max = (float)budget.links_max,
        .field = "links",
        .text = text,
    };
    return false;
}
