/* contour.c - see contour.h; equation numbers are the paper's, derivations in MODEL.md. */
#include "contour.h"

#include <float.h>
#include <stddef.h>

/* A rod of joints that have inertia has none at its nodes, and float32 would lose the softest ways to bend it among the
 * stiffest: so each node gets this share of its joint's, for touching only. */
static const float OWN_SHARE = 1e-5f;

/* M's bands. K's are those of D1' beta D1 + D2' eta D2 + diag k, D1 and D2 the first and second
 * difference. The midpoint scheme averages K over three time levels, so a quarter of it is implicit; the
 * paper's takes the internal energy wholly implicit, spring and damper explicit (Eq. 5). */
static int factor_system(const rod_params *params, float shape_nm, float *diagonal, penta *system)
{
    float off1[ROD_MAX_LINKS], off2[ROD_MAX_LINKS];
    const int n = params->links_n;
    const bool paper = params->scheme == ROD_SCHEME_PAPER;
    const float half_dt = 0.5f * params->tick_s;
    const float share = (paper ? 1.0f : 0.25f) * (params->tick_s * params->tick_s);
    const float *beta = params->coupling, *eta = params->smoothing;
    for (int i = 0; i < n; i++) {
        /* the second difference at i reaches from i - 1 to i + 1: none at the last joint */
        const float eta_before = i >= 1 ? eta[i - 1] : 0.0f;
        const float eta_here = i + 1 < n ? eta[i] : 0.0f;
        const float eta_after = i + 2 < n ? eta[i + 1] : 0.0f;
        const float beta_after = i + 1 < n ? beta[i + 1] : 0.0f;
        const float spring = paper ? 0.0f : params->spring[i] + shape_nm;
        const float rate = params->drag[i] + (paper ? 0.0f : params->damper[i]);
        diagonal[i] =
            params->inertia[i] + half_dt * rate +
            share * (spring + beta[i] + beta_after + eta_before + 4.0f * eta_here + eta_after);
        off1[i] = -share * (beta[i] + 2.0f * eta_here + 2.0f * eta_before);
        off2[i] = share * eta_before;
    }
    return penta_factor(system, n, diagonal, off1, off2);
}

rod_error contour_prepare(contour *model, const rod_params *params, float shape_nm, int *row_n)
{
    penta system;
    float diagonal[ROD_MAX_LINKS];
    *row_n = factor_system(params, shape_nm, diagonal, &system);
    if (*row_n != 0) {
        return ROD_E_PIVOT; /* and the model is as it was */
    }
    const int n = params->links_n;
    const float dt = params->tick_s;
    const float dt2 = dt * dt;
    const bool paper = params->scheme == ROD_SCHEME_PAPER;
    model->system = system;
    model->links_n = n;
    model->held_n = params->hold_n < n ? params->hold_n : n;
    model->paper_scheme = paper;
    model->tick_s = dt;
    model->tick_squared_s2 = dt2;
    for (int i = 0; i < n; i++) {
        const float drag = 0.5f * dt * params->drag[i];
        const float damper = 0.5f * dt * params->damper[i];
        model->row[i] = (contour_row){
            .momentum = params->inertia[i] - drag - (paper ? 2.0f * damper : damper),
            .spring = dt2 * (params->spring[i] + shape_nm),
            .coupling = dt2 * params->coupling[i],
            .smoothing = i + 1 < n ? dt2 * params->smoothing[i] : 0.0f,
            .limit_rad = params->limit_rad[i],
        };
        const float per_length = 1.0f / params->length_m[i];
        model->length_m[i] = params->length_m[i];
        model->joint_kg_m2[i] = diagonal[i];
        model->link[i] =
            (bending_link){.length_m = params->length_m[i],
                           .per_length = per_length,
                           .own_kg = OWN_SHARE * (diagonal[i] * per_length) * per_length};
        if (i < model->held_n) {
            model->held_momentum[i] = params->inertia[i] - drag;
            model->held_damper[i] = damper;
        }
    }
    return ROD_OK;
}

/* Inlined wherever the step needs it: small structures that are passed to or returned from a call go
 * through memory, and the step waits for them. */
#define INLINE static inline __attribute__((always_inline))

/* A held link, as it stands in its parent's axes before the base moves. */
typedef struct {
    joint_trig trig;
    vec3 link_m;
    float length_m;
} held_link;

INLINE held_link hold_link(const rod_joint angle_rad, float length_m)
{
    held_link held;
    held.trig = kinematics_trig(angle_rad);
    held.link_m = vec3_scale(kinematics_direction(&held.trig), length_m);
    held.length_m = length_m;
    return held;
}

/* How far a point fixed in the world moves in the base's axes. */
INLINE vec3 displacement(const rod_motion *motion, vec3 point_m)
{
    return vec3_add(motion->shift_m, quat_displacement(motion->turn, point_m));
}

/* The turn of a held joint whose link's far end is displaced by `moved`, seen in its new parent's axes.
 * Written with differences only, so that a small displacement gives a small turn with all its digits;
 * to first order it is Eq. 10 (rows in their right order). Where the far end has met the joint there is
 * no direction: returns false, and no turn. */
INLINE bool turn_of_link(const held_link *held, vec3 moved, rod_joint delta_rad)
{
    const trig_pair theta = held->trig.theta, phi = held->trig.phi;
    const float aside = moved.x * theta.cos - moved.z * theta.sin; /* across the link, level */
    const float along = moved.x * theta.sin + moved.z * theta.cos; /* along it, level */
    const float level = held->length_m * phi.cos;
    const float ahead = level + along;
    const float up = held->link_m.y + moved.y;
    const float level_new_squared = ahead * ahead + aside * aside;
    const float length_new_squared = level_new_squared + up * up;
    if (length_new_squared < 1e-12f * (held->length_m * held->length_m)) {
        delta_rad[ROD_THETA] = delta_rad[ROD_PHI] = 0.0f;
        return false;
    }
    const float level_new = trig_sqrt(level_new_squared);
    const float level_gain =
        ahead > 0.0f ? along + aside * aside / (level_new + ahead) : level_new - level;
    delta_rad[ROD_THETA] =
        level_new_squared < 1e-12f * length_new_squared ? 0.0f : trig_atan2(aside, ahead);
    delta_rad[ROD_PHI] =
        trig_atan2(moved.y * phi.cos - level_gain * phi.sin, level_new * phi.cos + up * phi.sin);
    return true;
}

/* The turn of the second held joint (Fig. 6b): node 1 has moved onto the new direction of link 1,
 * node 2 has stayed. Not inlined: most rods hold one joint and should not pay this one's registers. */
static __attribute__((noinline)) void
turn_of_second_link(const contour *model, const held_link *first, const rod_joint *angle_rad,
                    const rod_motion *motion, rod_joint delta_rad[2])
{
    static const frame3 BASE = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const held_link second = hold_link(angle_rad[1], model->length_m[1]);
    const frame3 link1 = kinematics_turn(&BASE, &first->trig);
    const vec3 node2 = vec3_add(first->link_m, frame3_to_parent(&link1, second.link_m));

    const rod_joint turned = {angle_rad[0][ROD_THETA] + delta_rad[0][ROD_THETA],
                              angle_rad[0][ROD_PHI] + delta_rad[0][ROD_PHI]};
    const joint_trig turned_trig = kinematics_trig(turned);
    const frame3 link1_new = kinematics_turn(&BASE, &turned_trig);
    const vec3 node1_new = vec3_scale(link1_new.z, first->length_m);
    const vec3 node2_new = vec3_add(node2, displacement(motion, node2));

    const vec3 link2_new = frame3_from_parent(&link1_new, vec3_sub(node2_new, node1_new));
    (void)turn_of_link(&second, vec3_sub(link2_new, second.link_m), delta_rad[1]);
}

INLINE void base_motion(const contour *model, const held_link *first, const rod_joint *angle_rad,
                        const rod_motion *motion, rod_joint delta_rad[2])
{
    delta_rad[1][ROD_THETA] = delta_rad[1][ROD_PHI] = 0.0f;
    if (turn_of_link(first, displacement(motion, first->link_m), delta_rad[0]) &&
        model->held_n == 2) {
        turn_of_second_link(model, first, angle_rad, motion, delta_rad);
    }
}

void contour_base_motion(const contour *model, const rod_joint *angle_rad, const rod_motion *motion,
                         rod_joint delta_rad[2])
{
    const held_link first = hold_link(angle_rad[0], model->length_m[0]);
    base_motion(model, &first, angle_rad, motion, delta_rad);
}

/* b = momentum g - dt^2 K y, with K y as the gradient of the bending energy: every difference is
 * taken once, and what a joint gains from its neighbour the neighbour loses. b[-1] exists too: it
 * takes what joint 1 pulls at the hand. y has a row more than there are joints. */
static void right_hand_side(const contour *model, const rod_joint *g, const rod_joint *y,
                            rod_joint *b)
{
    rod_joint difference = {y[0][0], y[0][1]}; /* y_i - y_{i-1}; joint 1 couples to angle zero */
    rod_joint moment = {0.0f, 0.0f};           /* eta (second difference) of the row before */
    for (int i = 0; i < model->links_n; i++) {
        const contour_row *row = &model->row[i];
        for (int axis = 0; axis < 2; axis++) {
            const float next_difference = y[i + 1][axis] - y[i][axis];
            const float next_moment = row->smoothing * (next_difference - difference[axis]);
            const float pull = row->coupling * difference[axis] + (moment[axis] - next_moment);
            b[i][axis] = (row->momentum * g[i][axis] - row->spring * y[i][axis]) - pull;
            b[i - 1][axis] += pull;
            difference[axis] = next_difference;
            moment[axis] = next_moment;
        }
    }
}

/* to = from + step, with the joint stops. Returns false where an angle is not a number. */
static bool advance(const contour *model, const rod_joint *from, const rod_joint *step,
                    contour_state *to)
{
    bool finite = true;
    for (int i = 0; i < model->links_n; i++) {
        const float limit = model->row[i].limit_rad;
        for (int axis = 0; axis < 2; axis++) {
            float angle = from[i][axis] + step[i][axis];
            float increment = step[i][axis];
            if (!(trig_abs(angle) <= limit)) {
                finite = finite && trig_abs(angle) <= FLT_MAX;
                angle = angle < 0.0f ? -limit : limit;
                increment = 0.0f;
            }
            to->angle_rad[i][axis] = angle;
            to->increment_rad[i][axis] = increment;
        }
    }
    return finite;
}

rod_error contour_step(const contour *model, const contour_state *from, contour_state *to,
                       const rod_motion *previous, const rod_motion *now,
                       const rod_joint *torque_nm)
{
    const rod_joint *x = from->angle_rad;
    const rod_joint *g = from->increment_rad;
    const int n = model->links_n;
    const int held_n = model->held_n;
    const bool paper = model->paper_scheme;

    const held_link first = hold_link(x[0], model->length_m[0]);
    rod_joint delta[2], delta_previous[2]; /* both base motions start from the same angles */
    base_motion(model, &first, x, now, delta);
    base_motion(model, &first, x, previous, delta_previous);

    /* The angles at which the bending energy pulls. Midpoint: with the quarter of the new increment
     * that M holds, K sees (x_old + 2 x + x_new) / 4, x as the base has turned it. Paper: v = x + delta. */
    rod_joint y[ROD_MAX_LINKS + 1];
    const float back = paper ? 0.0f : 0.25f;
    for (int i = 0; i <= n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            y[i][axis] = x[i][axis] - back * g[i][axis];
        }
    }
    for (int i = 0; i < held_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            y[i][axis] += (paper ? 1.0f : 0.25f) * delta[i][axis];
        }
    }

    rod_joint hand_and_joints[ROD_MAX_LINKS + 1];
    rod_joint *b = hand_and_joints + 1;
    hand_and_joints[0][ROD_THETA] = hand_and_joints[0][ROD_PHI] = 0.0f;
    right_hand_side(model, g, y, b);
    if (!paper) { /* inertia and drag act in the world, the damper on the joint's own angle */
        for (int i = 0; i < held_n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                b[i][axis] -= model->held_momentum[i] * delta_previous[i][axis] +
                              model->held_damper[i] * delta[i][axis];
            }
        }
    }
    if (torque_nm != NULL) {
        for (int i = 0; i < n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                b[i][axis] += model->tick_squared_s2 * torque_nm[i][axis];
            }
        }
    }

    penta_solve2(&model->system, b);

    if (paper) { /* x+ = v + b, and w of the next step is v: the increment is b alone */
        return advance(model, y, b, to) ? ROD_OK : ROD_E_NOT_FINITE;
    }
    for (int i = 0; i < held_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            b[i][axis] += delta[i][axis];
        }
    }
    return advance(model, x, b, to) ? ROD_OK : ROD_E_NOT_FINITE;
}

void contour_torques(const contour *model, const rod_joint *angle_rad, const rod_pose *base,
                     const vec3 *nodes_m, const vec3 *forces_newton, rod_joint *torque_nm)
{
    const int n = model->links_n;
    /* From the base outwards: the axes each joint turns about, in the world ... */
    vec3 axis_theta[ROD_MAX_LINKS], axis_phi[ROD_MAX_LINKS];
    frame3 link = quat_frame(base->orientation);
    for (int i = 0; i < n; i++) {
        const joint_trig t = kinematics_trig(angle_rad[i]);
        axis_theta[i] = link.y;
        link = kinematics_turn(&link, &t);
        axis_phi[i] = vec3_scale(link.x, -1.0f);
    }
    /* ... and from the tip inwards: the force and moment of all that lies beyond it. */
    vec3 force = {0.0f, 0.0f, 0.0f};
    vec3 moment = {0.0f, 0.0f, 0.0f};
    for (int i = n - 1; i >= 0; i--) {
        force = vec3_add(force, forces_newton[i + 1]);
        const vec3 arm = vec3_sub(nodes_m[i + 1], nodes_m[i]);
        moment = vec3_add(moment, vec3_cross(arm, force));
        torque_nm[i][ROD_THETA] = vec3_dot(axis_theta[i], moment);
        torque_nm[i][ROD_PHI] = vec3_dot(axis_phi[i], moment);
    }
}
