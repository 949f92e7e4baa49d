/* tick_budget.c - see tick_budget.h. */
#include "tick_budget.h"

#include "link.h"
#include "servo_types.h"

/* Cycles of a Cortex-M4F: what runs once a tick as if nothing of it were in the flash's cache, what runs once a
 * link, in loops, as if all of it were. A step at its worst: contour with hold = 2 and smoothing, elastic with all of
 * Newton's steps; among objects every node on two of them, all passes and a blow. */
static const struct {
    uint32_t tick, tick_link, step_link; /* a tick; a link in it; a link in each step of the rod */
    /* more for each link and step: with a scene, for each object in it, with a shape */
    uint32_t touch_link, object_link, shape_link;
} CYCLES[ROD_MODEL_COUNT] = {
    [ROD_MODEL_CONTOUR] = {49000, 640, 160, 6300, 100, 330},
    [ROD_MODEL_ELASTIC] = {46500, 950, 1600, 6400, 100, 430},
};

/* What interrupts leave of a tick, %. At 168 MHz the bytes of a line of 1 Mbaud, both ways, take 9; those of a
 * servo bus of 4.5 Mbaud 19 more. */
enum { SHARE = 90, SHARE_WITH_BUS = 70 };

static uint32_t link_cycles(int model, float tick_s, const tick_load *load)
{
    const bool among = load->objects_n > 0;
    const uint32_t steps_n =
        model == ROD_MODEL_ELASTIC ? (uint32_t)elastic_steps_n(tick_s, among) : 1u;
    uint32_t step = CYCLES[model].step_link + (load->shaped ? CYCLES[model].shape_link : 0u);
    if (among) {
        step += CYCLES[model].touch_link + (uint32_t)load->objects_n * CYCLES[model].object_link;
    }
    return CYCLES[model].tick_link + step * steps_n;
}

uint32_t tick_budget_cycles(int model, int links_n, float tick_s, const tick_load *load)
{
    return CYCLES[model].tick + link_cycles(model, tick_s, load) * (uint32_t)links_n;
}

static int links_max(const params_set *set, const tick_load *load, float cycles)
{
    const int model = set->rod.model;
    const float for_links = cycles - (float)CYCLES[model].tick;
    const uint32_t a_link = link_cycles(model, set->rod.tick_s, load);
    return for_links > 0.0f ? (int)(for_links / (float)a_link) : 0;
}

tick_budget tick_budget_of(const params_set *set, const tick_load *load, uint32_t clock_hz)
{
    const rod_params *rod = &set->rod;
    const bool bus = (int)set->device.servo_kind == SERVOS_BUS;
    const float given_us = rod->tick_s * 1e4f * (float)(bus ? SHARE_WITH_BUS : SHARE);
    const float cycles_per_us = 1e-6f * (float)clock_hz;
    const float needed = (float)tick_budget_cycles(rod->model, rod->links_n, rod->tick_s, load);
    tick_budget budget = {
        .needed_us = (uint32_t)(needed / cycles_per_us + 0.5f),
        .given_us = (uint32_t)(given_us + 0.5f),
        .links_max = links_max(set, load, given_us * cycles_per_us),
    };
    tick_load more = {.objects_n = 1, .shaped = load->shaped};
    while (more.objects_n <= SCENE_OBJECTS_MAX &&
           links_max(set, &more, given_us * cycles_per_us) >= rod->links_n) {
        budget.objects_max = more.objects_n++;
    }
    return budget;
}

static void add_numbered(char *text, const char *before, uint32_t number)
{
    link_text_add(text, MESSAGES_TEXT_MAX + 1, before);
    link_text_add_number(text, MESSAGES_TEXT_MAX + 1, number);
}

/* "elastic, 50 links, 2 objects: 2036 us at 168 MHz, a tick of 1000 has 900" */
static void explain(const params_set *set, const tick_load *load, uint32_t clock_hz,
                    const tick_budget *budget, char *text)
{
    link_text(text, MESSAGES_TEXT_MAX + 1, rod_field_find("model")->choices[set->rod.model]);
    add_numbered(text, ", ", (uint32_t)set->rod.links_n);
    link_text_add(text, MESSAGES_TEXT_MAX + 1, " links");
    if (load->objects_n > 0) {
        add_numbered(text, ", ", (uint32_t)load->objects_n);
        link_text_add(text, MESSAGES_TEXT_MAX + 1, load->objects_n == 1 ? " object" : " objects");
    }
    link_text_add(text, MESSAGES_TEXT_MAX + 1, load->shaped ? ", a shape" : "");
    add_numbered(text, ": ", budget->needed_us);
    add_numbered(text, " us at ", clock_hz / 1000000u);
    add_numbered(text, " MHz, a tick of ", (uint32_t)(set->rod.tick_s * 1e6f + 0.5f));
    add_numbered(text, " has ", budget->given_us);
}

static bool refuse(char *text, const char *advice, params_refusal *why, params_refusal what)
{
    link_text_add(text, MESSAGES_TEXT_MAX + 1, advice);
    *why = what;
    why->reason = REASON_COMBINATION;
    why->entry = -1;
    why->text = text;
    return false;
}

bool tick_budget_check(const params_set *set, const tick_load *load, uint32_t clock_hz, char *text,
                       params_refusal *why)
{
    if (clock_hz == 0) {
        return true;
    }
    const tick_budget budget = tick_budget_of(set, load, clock_hz);
    if (set->rod.links_n <= budget.links_max) {
        return true;
    }
    const bool alone = load->objects_n == 0 && !load->shaped;
    explain(set, load, clock_hz, &budget, text);
    return refuse(text, alone ? ": fewer links, longer tick" : "", why,
                  (params_refusal){.value = (float)set->rod.links_n,
                                   .min = 1.0f,
                                   .max = (float)budget.links_max,
                                   .field = "links"});
}

bool tick_budget_check_objects(const params_set *set, const tick_load *load, uint32_t clock_hz,
                               char *text, params_refusal *why)
{
    if (clock_hz == 0) {
        return true;
    }
    const tick_budget budget = tick_budget_of(set, load, clock_hz);
    if (load->objects_n <= budget.objects_max) {
        return true;
    }
    explain(set, load, clock_hz, &budget, text);
    return refuse(text, "", why,
                  (params_refusal){.value = (float)load->objects_n,
                                   .max = (float)budget.objects_max,
                                   .field = "objects"});
}
