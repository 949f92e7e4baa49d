/* count_instructions.c - what the parts of the rod cost on the Cortex-M4F: see cost.h.
 *
 * Prints `part N count` lines, which cost.py holds against tests/data/instruction_counts.txt. The device around the
 * rod is count_tick.c's.
 */
#include <stdint.h>

#include "cost.h"
#include "rod.h"

static rod subject;
static rod_params params;
static float b2[ROD_MAX_LINKS][2], b3[ROD_MAX_LINKS][3];
static vec3 nodes[ROD_MAX_LINKS + 1];
static scene crowd;

static rod_pose hand_at(int tick)
{
    const trig_pair turn = trig_sincos(0.0026f * (float)tick);
    const trig_pair tilt = trig_sincos(0.0005f * (float)tick);
    return (rod_pose){{0.15f * turn.cos, 0.15f * turn.sin, 0.02f * tilt.sin},
                      {0.0f, tilt.sin, 0.0f, tilt.cos}};
}

/* As no hand can: from side to side by 0.1 m and 0.4 rad, a tick each. All of Newton's steps are taken. */
static rod_pose hostile_at(int tick)
{
    const float side = (tick & 1) != 0 ? 1.0f : -1.0f;
    const trig_pair tilt = trig_sincos(0.1f * side);
    return (rod_pose){{0.05f * side, 0.01f * (float)(tick % 7), -0.03f * side},
                      {0.0f, tilt.sin, 0.0f, tilt.cos}};
}

/* From wall to wall of the crowd below: nodes come to touch anew in every other tick. */
static rod_pose rattling_at(int tick)
{
    const float side = (tick & 2) != 0 ? 1.0f : -1.0f;
    return (rod_pose){{0.004f * side, 0.001f * (float)(tick % 5), 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
}

static void no_force(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)nodes_m, (void)nodes_n, (void)forces_newton, (void)context;
}

/* Eight boxes, four on either side of the rod as it stands: each of its nodes is near all of them, and what cannot be
 * held in the first pass is not held in the second. */
static void make_crowd(void)
{
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        const float side = (i & 1) != 0 ? 1.0f : -1.0f;
        const scene_object wall = {.kind = SCENE_BOX,
                                   .place_m = {side * 0.26f, 0.0f, 0.3f + 0.001f * (float)i},
                                   .orientation = {0.0f, 0.0f, 0.0f, 1.0f},
                                   .half_m = {0.2f, 1.0f, 1.0f},
                                   .radius_m = 0.055f,
                                   .friction = 0.5f};
        (void)scene_put(&crowd, i, &wall, NULL);
    }
}

/* Drawn to a shape that is still on its way. */
static void draw(void)
{
    rod_joint bent[ROD_MAX_LINKS];
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        bent[i][ROD_THETA] = bent[i][ROD_PHI] = 0.02f;
    }
    (void)rod_set_shape(&subject, (const rod_joint *)bent, 1.0f, 1.0f);
}

typedef enum {
    STEP,
    STEP_WITH_FORCE,
    STEP_AMONG_OBJECTS,
    STEP_TO_SHAPE,
    SOLVE2,
    SOLVE3,
    NODES,
    SET_PARAMS,
    PARTS_N
} part;
static const char *const PART_NAMES[PARTS_N] = {
    "step",   "step_with_force", "step_among_objects", "step_to_shape", "solve2",
    "solve3", "nodes",           "set_params"};

static bool is_step(part which)
{
    return which <= STEP_TO_SHAPE;
}

static void do_part(part which, const rod_pose *base)
{
    switch (which) {
    case STEP:
    case STEP_WITH_FORCE:
    case STEP_AMONG_OBJECTS:
    case STEP_TO_SHAPE:
        rod_step(&subject, base);
        break;
    case SOLVE2:
        penta_solve2(&subject.as.contour.model.system, b2);
        break;
    case SOLVE3:
        penta_solve3(&subject.as.contour.model.system, b3);
        break;
    case NODES:
        rod_nodes(&subject, nodes);
        break;
    default:
        rod_set_params(&subject, &params, NULL);
        break;
    }
}

static void contour_rod(int links_n, float smoothing, int hold_n)
{
    rod_params_defaults(&params);
    params.links_n = links_n;
    params.hold_n = hold_n;
    for (int i = 0; i < links_n; i++) {
        params.spring[i] = 2000.0f;
        params.smoothing[i] = smoothing;
    }
}

/* A soft rod of 0.6 m, whatever its links: it swings out by most of its length. */
static void elastic_rod(int links_n)
{
    rod_params_defaults(&params);
    params.model = ROD_MODEL_ELASTIC;
    params.links_n = links_n;
    for (int i = 0; i < links_n; i++) {
        params.length_m[i] = 0.6f / (float)links_n;
        params.mass_kg[i] = 0.2f / (float)links_n;
        params.spring[i] = 0.2f * (float)links_n;
        params.damper[i] = 0.001f * (float)links_n;
    }
}

/* A hundred ticks of a moving hand. */
static void count(const char *name, part which, rod_pose (*hand_at)(int tick))
{
    rod_init(&subject, &params, NULL);
    rod_set_force(&subject, which == STEP_WITH_FORCE ? no_force : NULL, NULL);
    rod_set_scene(&subject, which == STEP_AMONG_OBJECTS ? &crowd : NULL);
    if (which == STEP_TO_SHAPE) {
        draw();
    }
    for (int tick = 0; tick < 102; tick++) {
        const rod_pose base = hand_at(tick);
        if (tick < 2) {
            rod_step(&subject, &base); /* the first two only take in the motion */
            continue;
        }
        cost_begin();
        do_part(which, &base);
        cost_end();
        if (!is_step(which)) {
            rod_step(&subject, &base);
        }
    }
    cost_tell(name, params.links_n);
}

static void count_contour(int links_n)
{
    for (part which = 0; which < PARTS_N; which++) {
        contour_rod(links_n, 50.0f, 1);
        count(PART_NAMES[which], which, hand_at);
    }
    contour_rod(links_n, 0.0f, 1);
    count("step_no_smoothing", STEP, hand_at);
    contour_rod(links_n, 50.0f, 2);
    count("step_hold_2", STEP, hand_at);
    count("step_hostile_among", STEP_AMONG_OBJECTS, hostile_at);
    count("step_rattling", STEP_AMONG_OBJECTS, rattling_at);
}

static void count_elastic(int links_n)
{
    elastic_rod(links_n);
    count("elastic_step", STEP, hand_at);
    count("elastic_hostile", STEP, hostile_at);
    count("elastic_with_force", STEP_WITH_FORCE, hand_at);
    count("elastic_among", STEP_AMONG_OBJECTS, hand_at);
    count("elastic_hostile_among", STEP_AMONG_OBJECTS, hostile_at);
    count("elastic_rattling", STEP_AMONG_OBJECTS, rattling_at);
    count("elastic_to_shape", STEP_TO_SHAPE, hand_at);
    count("elastic_nodes", NODES, hand_at);
    count("elastic_set_params", SET_PARAMS, hand_at);
    params.tick_s = 4e-3f; /* in several steps */
    count("elastic_hostile_4ms", STEP, hostile_at);
    count("elastic_hostile_among_4ms", STEP_AMONG_OBJECTS, hostile_at);
}

int main(void)
{
    static const int LINKS_N[] = {4, 10, 20, 50};
    cost_start();
    make_crowd();
    for (int i = 0; i < 4; i++) {
        count_contour(LINKS_N[i]);
        count_elastic(LINKS_N[i]);
    }
    return 0;
}
