/* kinematics.h - from joint angles to nodes in the world, and back (paper Eq. 6; MODEL.md).
 *
 * A joint turns by theta about its parent's y, then by phi about the turned -x, so that phi lifts the
 * link toward the parent's y. Frames chain R_i = R_{i-1} rot_y(theta_i) rot_x(-phi_i); the link points
 * along its own z. Joint 1's parent is the base, i.e. the hand. Angles in rad, lengths in m. Pure.
 */
#ifndef LIMBER_KINEMATICS_H
#define LIMBER_KINEMATICS_H

#include "trig.h"
#include "vec.h"

enum { ROD_THETA = 0, ROD_PHI = 1 };

/* The two angles of a joint, [ROD_THETA] and [ROD_PHI]; rows of an array of them are what
 * penta_solve2 takes. */
typedef float rod_joint[2];

typedef struct {
    vec3 position_m;  /* of the base, in the world */
    quat orientation; /* base -> world, unit length; the straight rod lies along the base's +z */
} rod_pose;

/* How the base moved from one pose to the next, seen in the axes it ends in. */
typedef struct {
    quat turn;    /* the old axes in the new ones */
    vec3 shift_m; /* the old position, from the new one */
} rod_motion;

/* Sine and cosine of both angles of a joint. */
typedef struct {
    trig_pair theta, phi;
} joint_trig;

rod_motion kinematics_motion(const rod_pose *from, const rod_pose *to);

/* And back: where a base that is now at `to` was one motion ago. */
rod_pose kinematics_pose_before(const rod_pose *to, const rod_motion *motion);

static inline joint_trig kinematics_trig(const rod_joint angles_rad)
{
    return (joint_trig){trig_sincos(angles_rad[ROD_THETA]), trig_sincos(angles_rad[ROD_PHI])};
}

/* The link's unit direction in its parent's axes (Eq. 6). */
static inline vec3 kinematics_direction(const joint_trig *t)
{
    return (vec3){t->phi.cos * t->theta.sin, t->phi.sin, t->phi.cos * t->theta.cos};
}

/* A frame turned through a joint: the parent's axes in, the link's own axes out. */
frame3 kinematics_turn(const frame3 *parent, const joint_trig *t);

/* Nodes 0 ... links_n in the world; node 0 is the base. About 135 instructions a link. */
void kinematics_nodes(const rod_pose *base, const rod_joint *angles_rad, const float *length_m,
                      int links_n, vec3 *nodes_m);

/* The inverse: angles from the links as vectors of any length, from node to node. Where a link points along its
 * parent's +-y, theta is open: the value already in angles_rad is kept. A link of no length keeps both
 * of its angles. About 230 instructions a link. */
void kinematics_angles(const rod_pose *base, const vec3 *links, int links_n, rod_joint *angles_rad);

#endif
