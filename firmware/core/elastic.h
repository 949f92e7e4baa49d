/* elastic.h - the second model: the elastic rod as physics, on node positions.
 *
 * Point masses m_i at the nodes, links of constant length between them, in joint i an ideal bending
 * spring (its torque is k_i times the angle) and damper (c_i times its rate), drag on each node, gravity.
 * Second order in time (BDF2); nothing is fitted. Used through rod.h; this header is for readers of
 * the mathematics and for tests of it. The derivation is in MODEL.md, Section 5.
 *
 * All memory is the caller's. A step factors one five-banded matrix and solves it for x, y and z, then
 * restores the lengths by one to three Newton steps, each one tridiagonal solve. One is enough unless the
 * motion is hostile; cost is linear in links_n, and stated for three.
 */
#ifndef LIMBER_ELASTIC_H
#define LIMBER_ELASTIC_H

#include "bending.h"
#include "kinematics.h"
#include "rod_params.h"
#include "touch.h"

/* What a step needs to know of the joint at link i's near end and of the node at its far end, with h = 2/3 of a step's
 * time folded in. */
typedef struct {
    float mass_kg, per_mass; /* m, 1 / m */
    float drag;              /* h gamma, kg */
    float spring;            /* h^2 k, kg m^2 */
    float damper;            /* h c, kg m^2 */
} elastic_row;

typedef struct {
    int links_n;
    int steps_n;      /* in a tick */
    float step_share; /* 1 / steps_n */
    float h_s, per_h;
    float fall_m;                     /* h^2 g */
    bending_link link[ROD_MAX_LINKS]; /* own_kg: m + h gamma */
    elastic_row row[ROD_MAX_LINKS];
} elastic;

/* Two levels of time, each pair as the last value and what it gained in the last step. */
typedef struct {
    vec3 link[ROD_MAX_LINKS], link_step[ROD_MAX_LINKS];       /* unit directions in the world */
    vec3 speed_m_s[ROD_MAX_LINKS], speed_step[ROD_MAX_LINKS]; /* of the far ends, in the world */
    /* h^2 times each link's pull in the last step, kg m */
    float tension[ROD_MAX_LINKS], tension_step[ROD_MAX_LINKS];
    vec3 base_step_m, axis_step; /* how the base's place and z moved in the last step, */
    float spin_step;             /* and how far it turned about that z, rad */
    rod_joint angle_rad[ROD_MAX_LINKS];
} elastic_state;

/* How many steps make a tick: one up to 2 ms, and as many as keep each within 1 ms beyond, while the base goes smoothly
 * from pose to pose (base_path.h). So a rod is as true at 100 Hz as at 1 kHz, and as costly a second; 500 Hz
 * costs half and is a little less true. Among objects, where a step costs four times as much, a tick of up to 4 ms is one
 * step too, so that long rods fit a small processor (MODEL.md, Section 9, has what that costs). */
int elastic_steps_n(float tick_s, bool among);

/* Fold; params have passed rod_params_check. Returns ROD_OK, or ROD_E_PIVOT with *row_n set to the 1-based row;
 * *model is then not to be used. */
rod_error elastic_prepare(elastic *model, const rod_params *params, bool among, int *row_n);

/* The same motion in steps `ratio` times as long. */
void elastic_change_step(elastic_state *state, int links_n, float ratio);

/* A state from joint angles, what they gained in the last tick, and how the base moved in it. Both have
 * links_n rows. */
void elastic_lay(const elastic *model, const rod_pose *base, const rod_motion *motion,
                 const rod_joint *angle_rad, const rod_joint *increment_rad, elastic_state *state);

/* And back: what the joint angles gained in the last tick. */
void elastic_increments(const elastic *model, const rod_pose *base, const rod_motion *motion,
                        const elastic_state *state, rod_joint *increment_rad);

/* What acts on the rod from outside. */
typedef struct {
    const vec3 *forces_newton; /* links_n + 1 rows, one a node (that on node 0 is the hand's
                                  affair); or NULL */
    const scene *objects;      /* or NULL */
    touch_contacts *contacts;  /* with them: of the last step; becomes this one's */
    const vec3 *shape; /* the directions that links are drawn to, in the base's axes; or NULL */
    float shape_nm;    /* with them: how strongly */
} elastic_outside;

/* One tick, in which the base goes from one pose to the next; previous: its motion in the tick before. Returns false where Newton's method left a link more
 * than 1e-5 off its length, so that the lengths were made good from the base outwards at the price of some
 * momentum: a hostile tick. There is no failure, every result is finite. */
bool elastic_step(const elastic *model, elastic_state *state, const rod_motion *previous,
                  const rod_pose *from, const rod_pose *to, const elastic_outside *outside);

/* Nodes 0 ... links_n in the world, m. */
void elastic_nodes(const elastic *model, const elastic_state *state, const rod_pose *base,
                   vec3 *nodes_m);

#endif
