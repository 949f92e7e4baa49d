/* contour_touch.c - see contour.h: the active contour against objects; MODEL.md, "Touch".
 *
 * Where a step has taken a node into an object, the rod is put outside by the least turn of its joints, least in the
 * measure of the step's own matrix: that is how the step would have answered the object's force. On node positions that
 * measure is D' diag(M) D, whose bands bending.h knows. */
#include <stddef.h>
#include <string.h>

#include "contour.h"

/* How stiff a link is along itself beside its node. */
static const float LENGTH_HOLD = 1.0f;

/* A joint is turned by no more than this in a step, rad: what is left is for the next. */
static const float TURN_MAX_RAD = 0.2f;

/* Unit directions of the links and the nodes at their far ends. */
static void lay(const contour *model, const rod_joint *angle_rad, const rod_pose *base, vec3 *link,
                vec3 *node_m)
{
    frame3 frame = quat_frame(base->orientation);
    vec3 place = base->position_m;
    for (int i = 0; i < model->links_n; i++) {
        const joint_trig t = kinematics_trig(angle_rad[i]);
        frame = kinematics_turn(&frame, &t);
        place = vec3_add_scaled(place, frame.z, model->link[i].length_m);
        link[i] = frame.z;
        node_m[i] = place;
    }
}

/* The links' directions become how far each node is put, m. */
static __attribute__((noinline)) bool displace(const contour *model, touch_points *points,
                                               vec3 *link)
{
    const int n = model->links_n;
    vec3 displacement_m[ROD_MAX_LINKS];
    bending_bands bands;
    vec3 force[ROD_MAX_LINKS];
    float tension[ROD_MAX_LINKS];
    memset(force, 0, sizeof force);
    memset(tension, 0, sizeof tension);
    bending_assemble(model->link, n, model->joint_kg_m2, NULL, &bands);
    const touch_system system = {.nodes_n = n,
                                 .diagonal = bending_diagonal(&bands),
                                 .off1 = bending_off1(&bands),
                                 .off2 = bands.off2,
                                 .link = model->link,
                                 .along = link,
                                 .force = force,
                                 .hold = LENGTH_HOLD};
    const bool solved = touch_solve(&system, points, displacement_m, tension);
    memcpy(link, displacement_m, (size_t)n * sizeof *link);
    return solved;
}

static float within(float x, float most)
{
    return x > most ? most : x < -most ? -most : x;
}

/* The joints' turns that put the nodes there, to first order, so that small ones keep their digits: what a link turns
 * in the world, less what the joints before it turn it. The stops have the last word, and the speeds become what the
 * rod has really done. */
static __attribute__((noinline)) void turn_joints(const contour *model, const rod_pose *base,
                                                  const vec3 *displacement_m, contour_state *to)
{
    frame3 frame = quat_frame(base->orientation);
    vec3 turned = {0.0f, 0.0f, 0.0f}, before_m = turned;
    for (int i = 0; i < model->links_n; i++) {
        const joint_trig t = kinematics_trig(to->angle_rad[i]);
        const vec3 theta_axis = frame.y;
        frame = kinematics_turn(&frame, &t);
        const vec3 gain_m = vec3_sub(displacement_m[i], before_m);
        const vec3 left =
            vec3_sub(vec3_scale(gain_m, model->link[i].per_length), vec3_cross(turned, frame.z));
        const float level = t.phi.cos > 1e-2f ? t.phi.cos : 1e-2f;
        const float turn[2] = {vec3_dot(left, frame.x) / level, vec3_dot(left, frame.y)};
        float done[2];
        for (int axis = 0; axis < 2; axis++) {
            const float angle = to->angle_rad[i][axis];
            const float limit = model->row[i].limit_rad;
            const float next = within(angle + within(turn[axis], TURN_MAX_RAD), limit);
            done[axis] = next - angle;
            to->angle_rad[i][axis] = next;
            to->increment_rad[i][axis] += done[axis];
        }
        turned = vec3_add_scaled(turned, theta_axis, done[ROD_THETA]);
        turned = vec3_add_scaled(turned, frame.x, -done[ROD_PHI]);
        before_m = displacement_m[i];
    }
}

/* The points near objects, and the links' directions after the step. Not inlined, like what comes after it: their arrays
 * need not lie on the stack together. */
static __attribute__((noinline)) void find(const contour *model, const contour_state *from,
                                           const contour_state *to, const rod_pose *base_from,
                                           const rod_pose *base_to, const scene *objects,
                                           const touch_contacts *last, touch_points *points,
                                           vec3 *link)
{
    vec3 before_m[ROD_MAX_LINKS], after_m[ROD_MAX_LINKS];
    lay(model, from->angle_rad, base_from, link, before_m);
    lay(model, to->angle_rad, base_to, link, after_m);
    const touch_nodes nodes = {.nodes_n = model->links_n,
                               .step_s = model->tick_s,
                               .h_squared_s2 = model->tick_squared_s2,
                               .base_m = base_to->position_m,
                               .before_m = before_m,
                               .after_m = after_m,
                               .link = model->link};
    touch_find(objects, last, &nodes, points);
    for (int i = 0; i < points->points_n; i++) {
        points->point[i].force = (vec3){0.0f, 0.0f, 0.0f}; /* it was not in the step */
    }
}

void contour_touch(const contour *model, const contour_state *from, contour_state *to,
                   const rod_pose *base_from, const rod_pose *base_to, const scene *objects,
                   touch_contacts *contacts)
{
    touch_points points;
    vec3 link[ROD_MAX_LINKS]; /* then how far its far end is put */
    find(model, from, to, base_from, base_to, objects, contacts, &points, link);
    contacts->contacts_n = 0;
    if (points.points_n > 0 && displace(model, &points, link)) {
        touch_remember(&points, model->tick_squared_s2, contacts);
    }
    if (contacts->contacts_n > 0) {
        turn_joints(model, base_to, link, to);
    }
}
