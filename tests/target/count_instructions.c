/* count_instructions.c - what a step costs on the Cortex-M4F, in instructions, exactly.
 *
 * QEMU with `-icount shift=0` advances virtual time by 1 ns an instruction, and its TIM2, left at its
 * reset prescaler, counts that nanosecond by nanosecond: the counter's difference is the number of
 * instructions, the same in every run. Prints `part N count` lines, which cost.py holds against
 * tests/data/instruction_counts.txt.
 */
#include <stdint.h>
#include <stdio.h>

#include "rod.h"

#define TIM2_CR1 (*(volatile uint32_t *)0x40000000) /* RM0090, 18.4.1 */
#define TIM2_CNT (*(volatile uint32_t *)0x40000024) /* 18.4.10 */
#define TIM2_ARR (*(volatile uint32_t *)0x4000002C) /* 18.4.12 */

static rod subject;
static rod_params params;
static float b2[ROD_MAX_LINKS][2], b3[ROD_MAX_LINKS][3];
static vec3 nodes[ROD_MAX_LINKS + 1];

static rod_pose hand_at(int tick)
{
    const trig_pair turn = trig_sincos(0.0026f * (float)tick);
    const trig_pair tilt = trig_sincos(0.0005f * (float)tick);
    return (rod_pose){{0.15f * turn.cos, 0.15f * turn.sin, 0.02f * tilt.sin},
                      {0.0f, tilt.sin, 0.0f, tilt.cos}};
}

static void no_force(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)nodes_m, (void)nodes_n, (void)forces_newton, (void)context;
}

typedef enum { NOTHING, STEP, STEP_WITH_FORCE, SOLVE2, SOLVE3, NODES, SET_PARAMS, PARTS_N } part;
static const char *const PART_NAMES[PARTS_N] = {"nothing", "step",  "step_with_force", "solve2",
                                                "solve3",  "nodes", "set_params"};

static void do_part(part which, const rod_pose *base)
{
    switch (which) {
    case STEP:
    case STEP_WITH_FORCE:
        rod_step(&subject, base);
        break;
    case SOLVE2:
        penta_solve2(&subject.model.system, b2);
        break;
    case SOLVE3:
        penta_solve3(&subject.model.system, b3);
        break;
    case NODES:
        rod_nodes(&subject, nodes);
        break;
    case SET_PARAMS:
        rod_set_params(&subject, &params, NULL);
        break;
    default:
        break; /* what measuring itself costs */
    }
}

/* The dearest of a hundred ticks of a moving hand. */
static uint32_t count(part which, int links_n, float smoothing, int hold_n)
{
    rod_params_defaults(&params);
    params.links_n = links_n;
    params.hold_n = hold_n;
    for (int i = 0; i < links_n; i++) {
        params.spring[i] = 2000.0f;
        params.smoothing[i] = smoothing;
    }
    rod_init(&subject, &params, NULL);
    rod_set_force(&subject, which == STEP_WITH_FORCE ? no_force : NULL, NULL);
    uint32_t dearest = 0;
    for (int tick = 0; tick < 102; tick++) {
        const rod_pose base = hand_at(tick);
        const uint32_t start = TIM2_CNT;
        do_part(which, &base);
        const uint32_t taken = TIM2_CNT - start;
        if (tick >= 2 && taken > dearest) {
            dearest = taken;
        }
        if (which != STEP && which != STEP_WITH_FORCE) {
            rod_step(&subject, &base);
        }
    }
    return dearest;
}

int main(void)
{
    static const int LINKS_N[] = {4, 10, 20, 50};
    TIM2_ARR = UINT32_MAX;
    TIM2_CR1 = 1;
    const uint32_t nothing = count(NOTHING, 4, 0.0f, 1);
    for (int i = 0; i < 4; i++) {
        const int n = LINKS_N[i];
        for (part which = STEP; which < PARTS_N; which++) {
            printf("%s %d %lu\n", PART_NAMES[which], n,
                   (unsigned long)(count(which, n, 50.0f, 1) - nothing));
        }
        printf("step_no_smoothing %d %lu\n", n, (unsigned long)(count(STEP, n, 0.0f, 1) - nothing));
        printf("step_hold_2 %d %lu\n", n, (unsigned long)(count(STEP, n, 50.0f, 2) - nothing));
    }
    return 0;
}
