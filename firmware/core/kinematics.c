/* kinematics.c - see kinematics.h. */
#include "kinematics.h"

rod_motion kinematics_motion(const rod_pose *from, const rod_pose *to)
{
    const quat into = quat_conjugate(to->orientation);
    return (rod_motion){
        quat_multiply(into, from->orientation),
        quat_rotate(into, vec3_sub(from->position_m, to->position_m)),
    };
}

rod_pose kinematics_pose_before(const rod_pose *to, const rod_motion *motion)
{
    return (rod_pose){
        vec3_add(to->position_m, quat_rotate(to->orientation, motion->shift_m)),
        quat_multiply(to->orientation, motion->turn),
    };
}

frame3 kinematics_turn(const frame3 *parent, const joint_trig *t)
{
    /* about y by theta: x and z turn in their plane ... */
    const vec3 x =
        vec3_sub(vec3_scale(parent->x, t->theta.cos), vec3_scale(parent->z, t->theta.sin));
    const vec3 z =
        vec3_add(vec3_scale(parent->x, t->theta.sin), vec3_scale(parent->z, t->theta.cos));
    /* ... then about the new x by -phi: y and z turn in theirs */
    return (frame3){
        x,
        vec3_sub(vec3_scale(parent->y, t->phi.cos), vec3_scale(z, t->phi.sin)),
        vec3_add(vec3_scale(parent->y, t->phi.sin), vec3_scale(z, t->phi.cos)),
    };
}

void kinematics_nodes(const rod_pose *base, const rod_joint *angles_rad, const float *length_m,
                      int links_n, vec3 *nodes_m)
{
    frame3 link = quat_frame(base->orientation);
    nodes_m[0] = base->position_m;
    for (int i = 0; i < links_n; i++) {
        const joint_trig t = kinematics_trig(angles_rad[i]);
        link = kinematics_turn(&link, &t);
        nodes_m[i + 1] = vec3_add(nodes_m[i], vec3_scale(link.z, length_m[i]));
    }
}

/* A link of length 1 in its parent's axes to its angles, and to their sines and cosines. */
static joint_trig angles_of(vec3 d, rod_joint angles_rad)
{
    const float level_squared = d.x * d.x + d.z * d.z;
    joint_trig t;
    if (level_squared < 1e-12f) {
        t = (joint_trig){trig_sincos(angles_rad[ROD_THETA]), {d.y < 0.0f ? -1.0f : 1.0f, 0.0f}};
    } else {
        const float level = trig_sqrt(level_squared);
        const float per_level = 1.0f / level;
        t = (joint_trig){{d.x * per_level, d.z * per_level}, {d.y, level}};
        angles_rad[ROD_THETA] = trig_atan2(d.x, d.z);
    }
    angles_rad[ROD_PHI] = trig_asin(d.y);
    return t;
}

void kinematics_angles(const rod_pose *base, const vec3 *links, int links_n, rod_joint *angles_rad)
{
    frame3 link = quat_frame(base->orientation);
    for (int i = 0; i < links_n; i++) {
        const vec3 d = frame3_from_parent(&link, links[i]);
        const float length_squared = vec3_dot(d, d);
        const joint_trig t =
            length_squared > 0.0f
                ? angles_of(vec3_scale(d, 1.0f / trig_sqrt(length_squared)), angles_rad[i])
                : kinematics_trig(angles_rad[i]);
        link = kinematics_turn(&link, &t);
    }
}
