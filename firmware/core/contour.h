/* contour.h - the paper's model (its Section 3.3): joint angles as an active contour.
 *
 * Used through rod.h; this header is for readers of the mathematics and for tests of it. The
 * derivation, and where the printed paper is wrong, is in MODEL.md.
 *
 * All memory is the caller's. Preparing costs a factorisation; a step is free of division except in
 * the arc tangents of the one or two held joints, and its cost depends on links_n alone.
 */
#ifndef LIMBER_CONTOUR_H
#define LIMBER_CONTOUR_H

#include "kinematics.h"
#include "penta.h"
#include "rod_params.h"
#include "touch.h"

/* What a step needs to know of joint i, with the tick folded in. */
typedef struct {
    float momentum;  /* midpoint: mu - dt (gamma + c) / 2; paper: mu - dt gamma / 2 - dt c */
    float spring;    /* dt^2 k */
    float coupling;  /* dt^2 beta */
    float smoothing; /* dt^2 eta; 0 in the last row, whose second difference does not exist */
    float limit_rad;
} contour_row;

typedef struct {
    int links_n, held_n;
    bool paper_scheme;
    float tick_squared_s2;
    float held_momentum[2]; /* mu - dt gamma / 2 of the held joints */
    float held_damper[2];   /* dt c / 2 */
    float length_m[ROD_MAX_LINKS];
    contour_row row[ROD_MAX_LINKS];
    penta system;                     /* M */
    float tick_s;                     /* and for touching: */
    float joint_kg_m2[ROD_MAX_LINKS]; /* M's diagonal */
    bending_link link[ROD_MAX_LINKS];
} contour;

/* The row after the last is always zero: it spares the step its end cases. */
typedef struct {
    rod_joint angle_rad[ROD_MAX_LINKS + 1];     /* x */
    rod_joint increment_rad[ROD_MAX_LINKS + 1]; /* g: what the last step added to x */
} contour_state;

/* Fold and factor; params have passed rod_params_check. shape_nm: what a shape adds to every spring; its pull comes with
 * torque_nm. Returns ROD_OK, or ROD_E_PIVOT with *row_n set to the 1-based row and *model as it was. */
rod_error contour_prepare(contour *model, const rod_params *params, float shape_nm, int *row_n);

/* How much the held joints' angles change when the base moves while the links' far ends stay where
 * they are (Eqs. 9 and 10, exact for any step): what the hand does to the rod. Fills
 * delta_rad[0 ... held_n - 1], and zero in what is left of the two. */
void contour_base_motion(const contour *model, const rod_joint *angle_rad, const rod_motion *motion,
                         rod_joint delta_rad[2]);

/* One tick: `from` becomes `to` (never the same memory). previous, now: the base's motion in the last
 * tick and in this one. torque_nm: the generalised force of external energies, a row per joint, or
 * NULL. Returns ROD_OK or ROD_E_NOT_FINITE, where *to is not to be used. */
rod_error contour_step(const contour *model, const contour_state *from, contour_state *to,
                       const rod_motion *previous, const rod_motion *now,
                       const rod_joint *torque_nm);

/* After a step from one base pose to the next: the joints turn so that no node is left in an object, and `contacts` is what
 * touched. A node sticks while what its contact needs lies in the cone; it creeps a little, since nothing is
 * remembered. */
void contour_touch(const contour *model, const contour_state *from, contour_state *to,
                   const rod_pose *base_from, const rod_pose *base_to, const scene *objects,
                   touch_contacts *contacts);

/* World forces on nodes 1 ... links_n to torques on the joints, by the transposed Jacobian.
 * nodes_m and forces_newton have links_n + 1 rows; a force on node 0 pushes the hand: no torque. */
void contour_torques(const contour *model, const rod_joint *angle_rad, const rod_pose *base,
                     const vec3 *nodes_m, const vec3 *forces_newton, rod_joint *torque_nm);

#endif
