/* rod.h - an elastic rod of N links that follows a hand: parameters in, a pose per tick in, joint
 * angles out. This is the header to include.
 *
 *     static rod foil;                              // caller-owned; 11.3 KB at 64 links
 *     rod_params params;
 *     rod_preset_fill(rod_preset_find("foil"), ROD_MODEL_CONTOUR, 8, &params);
 *     rod_init(&foil, &params, NULL);               // straight and at rest
 *     for (;;) {                                    // every params.tick_s
 *         rod_step(&foil, &base);
 *         drive(rod_angles(&foil));
 *     }
 *
 * SI units and radians. World axes right-handed; the base is the hand, its +z runs along the straight
 * rod. No heap, no globals, no I/O, no clock, no libm; float32 with one fixed order of operations, so
 * the same inputs give the same bits on every target. Subnormals are kept; a rod at rest is swept clean of them
 * within a second or two.
 *
 * Interrupts: rod_step does not block and may run in one. It takes the same time at every call for a given N
 * (contour), or up to a stated worst (elastic: one to three Newton steps on the lengths); a rod must not be stepped and changed at once. Errors are negative (rod_params.h); a call that
 * returns one has changed nothing.
 */
#ifndef LIMBER_ROD_H
#define LIMBER_ROD_H

#include "contour.h"
#include "elastic.h"
#include "kinematics.h"
#include "presets.h"
#include "rod_params.h"
#include "scene.h"
#include "shape.h"
#include "touch.h"

/* An external energy, as world forces on the nodes: objects touched, wind, a shape to take. Reads
 * nodes 0 ... nodes_n - 1 (m, world) and writes as many forces (N), all zero beforehand. Called once
 * in each rod_step, with the nodes as the last step left them. */
typedef void (*rod_force_fn)(const vec3 *nodes_m, int nodes_n, vec3 *forces_newton, void *context);

/* One rod. Treat the members as private: they may change with any version. */
typedef struct {
    rod_params params;
    union { /* params.model says which */
        struct {
            contour model;
            contour_state state
                [2]; /* a step reads one and writes the other, so a failed one spoils nothing */
            int current;
        } contour;
        struct {
            elastic model;
            elastic_state state;
        } elastic;
    } as;
    int swept;
    uint32_t restored_n;
    bool started; /* a base pose has been seen */
    rod_pose base;
    rod_motion motion; /* of the base, in the last tick */
    rod_force_fn force;
    void *force_context;
    const scene *objects;
    touch_contacts contacts;
    shape shape;
} rod;

/* Check, prepare, and lay the rod straight and at rest. *refusal (may be NULL) says what was wrong.
 * Errors: those of rod_params_check, ROD_E_PIVOT. Cost: one factorisation. */
rod_error rod_init(rod *r, const rod_params *params, rod_refusal *refusal);

/* Change parameters while the rod lives: angles and speeds stay. Joints that are new are straight and
 * at rest; after a change of tick the speeds are kept per second. Errors and cost as rod_init. */
rod_error rod_set_params(rod *r, const rod_params *params, rod_refusal *refusal);

/* Straight and at rest; the next step starts from its pose, wherever that is. Forces stay set. */
void rod_reset(rod *r);

/* External forces from now on; NULL for none (as after rod_init). */
void rod_set_force(rod *r, rod_force_fn force, void *context);

/* Objects to touch from now on; NULL for none (as after rod_init). The scene stays the caller's, who may change it
 * between two steps: an object may appear, move and vanish at any time. One that moves is taken as
 * standing still in each step; nodes that find themselves inside one are let out at TOUCH_ESCAPE_M_S. An empty scene
 * counts as one: give NULL where there is nothing. Errors: ROD_E_PIVOT, for an elastic rod at a tick of 2 to 4 ms
 * that float32 does not resolve in the longer steps it takes among objects (elastic.h). */
rod_error rod_set_scene(rod *r, const scene *objects);

/* What touched in the last step: *contacts_n of them, by node, at most two a node. A force is what the object pushes the
 * node with, N, in the world. Points into the rod; valid until the next call that takes a non-const rod. */
const touch_contact *rod_contacts(const rod *r, int *contacts_n);

/* A shape to take, as joint angles (links_n rows; the stops bound what the rod makes of them): strength_nm pulls each joint
 * (contour) or each link's direction in the base's axes (elastic) towards it like a spring of so many N m. 0 N m or NULL
 * lets the rod go. The change is blended in evenly over blend_s; a shape given meanwhile starts from what is in
 * force. Survives rod_reset and other parameters, but not another links_n or the paper's scheme.
 * Errors: ROD_E_SHAPE beyond the bounds of shape.h, or with the paper's scheme (whose springs are explicit). */
rod_error rod_set_shape(rod *r, const rod_joint *angle_rad, float strength_nm, float blend_s);

/* One tick: the base is now here. The first step after rod_init or rod_reset only takes the pose.
 * The quaternion must be of unit length to 1e-3: to what it is off, links are off in rod_nodes. Errors: ROD_E_POSE, ROD_E_FORCE, ROD_E_NOT_FINITE.
 * Cost on a Cortex-M4F, instructions: see README, "What it costs"; linear in N. */
rod_error rod_step(rod *r, const rod_pose *base);

/* The joints' angles after the last step, rad: links_n rows of [ROD_THETA], [ROD_PHI]. Points into
 * the rod; valid until the next call that takes a non-const rod. */
const rod_joint *rod_angles(const rod *r);

/* Nodes 0 ... links_n in the world, m, into the caller's links_n + 1 entries. Returns that number,
 * or 0 before the first pose. About 135 instructions a link (contour), 20 (elastic): ask when you need them. */
int rod_nodes(const rod *r, vec3 *nodes_m);

/* Ticks since rod_init whose motion was so violent that the links' lengths were made good from the base
 * outwards, at the price of some momentum (elastic.h). Always 0 for contour. */
uint32_t rod_restored_n(const rod *r);

/* The parameters in force. */
const rod_params *rod_params_of(const rod *r);

#endif
