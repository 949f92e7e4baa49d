/* elastic_forces.c - see elastic_private.h: what acts on the elastic rod's nodes; MODEL.md, Section 5. */
#include <stddef.h>

#include "elastic_private.h"

/* What spin and torsion do is not in the matrix: it is taken with a damper of at most so many times what the node resists
 * turning with, m l^2. Beyond that it would drive the rod; and a joint so damped hardly moves. */
static const float DAMPER_MAX = 600.0f;

/* The moment of the joint between two links, h^2 times; its stiffness h^2 k + h c as a secant; the outer link's spin;
 * and what of a damper's torque a curvature cannot tell (add_torsion).
 *
 * Bent by alpha, a joint has the curvature kappa = link - near link, |kappa| = 2 sin(alpha / 2), q its square's
 * quarter. For a torque of k alpha the spring on kappa is stiffer by alpha / sin alpha, the damper on its rate by
 * 1 / cos^2(alpha / 2), both growing without bound towards the fold; beyond 143 degrees they stay. The polynomial
 * is asin(sqrt q) / sqrt q, q = 0 ... 0.9, to 1.5e-5 below 66 degrees and 5e-4 above. The damper resists how fast the
 * two links turn against each other: what the curvature gains, less what it does where both turn
 * together, as they do across the joint (what lies along it) and about it (a joint does not twist: the
 * inner link's spin goes on to the outer). */
static inline vec3 joint_moment(const elastic_row *row, float length_m, const elastic_motion *near,
                                elastic_motion *far, elastic_joint *load)
{
    const vec3 curvature = vec3_sub(far->link, near->link);
    const vec3 along = vec3_add(far->link, near->link);
    const float q_open = 0.25f * vec3_dot(curvature, curvature);
    const float q = q_open < 0.9f ? q_open : 0.9f;
    const float per_cos_squared =
        1.0f / (1.0f - q); /* of alpha / 2; |along| is twice that cosine */
    const float arc =
        (((((0.93312079f * q - 1.59617995f) * q + 1.07601774f) * q - 0.24781261f) * q +
          0.10942365f) *
             q +
         0.16537747f) *
            q +
        1.0f;
    const float spring = row->spring * (arc * trig_sqrt(per_cos_squared));
    const float damper = row->damper * per_cos_squared;

    const vec3 normal = vec3_cross(near->unit, far->unit);
    const float most = DAMPER_MAX * row->mass_kg * length_m * length_m;
    const float share = damper <= most ? 1.0f : most / damper;
    load->fold = vec3_scale(normal, 0.5f * per_cos_squared);
    const float about = near->spin - vec3_dot(near->turn, load->fold);
    far->spin = about - vec3_dot(far->turn, load->fold);
    const vec3 rate = vec3_add_scaled(vec3_sub(far->turn, near->turn), normal, -about * share);
    const vec3 bending =
        vec3_add_scaled(rate, along, -0.25f * per_cos_squared * vec3_dot(along, rate));
    load->torsion = share * damper * vec3_dot(bending, normal);
    load->stiffness = spring + damper;
    return vec3_add_scaled(vec3_scale(curvature, spring), bending, damper);
}

/* The nodes where they go if nothing acts on them, and the forces there. Each link pulls its two ends: by the
 * moments of its joints, M_j - M_{j+1} over its length, and by the tension that the last two ticks let expect. */
static void add_moments(const elastic *model, const elastic_state *state, vec3 base_turn_m,
                        elastic_motion near, const vec3 *forces_newton, elastic_outcome *o)
{
    const int n = model->links_n;
    const float h = model->h_s;
    vec3 near_m = base_turn_m;             /* h v of the link's near end */
    vec3 pull_before = {0.0f, 0.0f, 0.0f}; /* of the link before, without its outer moment */
    float per_length_before = 0.0f;
    for (int i = 0; i < n; i++) {
        const elastic_row *row = &model->row[i];
        const bending_link *own = &model->link[i];
        const vec3 speed = vec3_add_scaled(state->speed_m_s[i], state->speed_step[i], THIRD);
        const vec3 far_m = vec3_scale(speed, h);
        const vec3 turn = vec3_scale(vec3_sub(far_m, near_m), own->per_length);
        const vec3 link =
            vec3_add(state->link[i], vec3_add_scaled(turn, state->link_step[i], THIRD));
        float length;
        elastic_motion far = {.link = link,
                              .unit = direction(link, state->link[i], &length),
                              .turn = turn,
                              .spin = 0.0f};
        const vec3 moment = joint_moment(row, own->length_m, &near, &far, &o->joint[i]);
        o->link[i] = far.link;
        o->unit[i] = far.unit;
        o->tension[i] = state->tension[i] + state->tension_step[i];

        if (i > 0) { /* the link before has its outer moment now */
            const vec3 pull = vec3_add_scaled(pull_before, moment, -per_length_before);
            o->node[i - 1] = vec3_sub(o->node[i - 1], pull);
            if (i > 1) {
                o->node[i - 2] = vec3_add(o->node[i - 2], pull);
            }
        }
        pull_before = vec3_add_scaled(vec3_scale(moment, own->per_length), far.unit, o->tension[i]);
        per_length_before = own->per_length;

        vec3 force = vec3_scale(far_m, -row->drag);
        force.z -= row->mass_kg * model->fall_m;
        if (forces_newton != NULL) {
            force = vec3_add_scaled(force, forces_newton[i + 1], h * h);
        }
        o->node[i] = force;
        near_m = far_m;
        near = far;
    }
    o->node[n - 1] = vec3_sub(o->node[n - 1], pull_before);
    if (n > 1) {
        o->node[n - 2] = vec3_add(o->node[n - 2], pull_before);
    }
}

/* Dampers of a bend that turns hand torsion on towards the base; where the rod is bent, the torsion it carries
 * pushes it aside. */
static void add_torsion(const elastic *model, elastic_outcome *o)
{
    float torsion = 0.0f; /* of the link: from the joints beyond it */
    vec3 fold_after = {0.0f, 0.0f, 0.0f};
    for (int i = model->links_n - 1; i >= 0; i--) {
        const elastic_joint *joint = &o->joint[i];
        const vec3 push =
            vec3_scale(vec3_add(joint->fold, fold_after), torsion * model->link[i].per_length);
        o->node[i] = vec3_add(o->node[i], push);
        if (i > 0) {
            o->node[i - 1] = vec3_sub(o->node[i - 1], push);
        }
        torsion -= joint->torsion;
        fold_after = joint->fold;
    }
}

/* The links' directions as they are wanted; what holds a link there in the matrix is solve()'s. */
static void add_shape(const elastic *model, quat orientation, const elastic_outside *outside,
                      elastic_outcome *o)
{
    const frame3 axes = quat_frame(orientation);
    const float strength = model->h_s * model->h_s * outside->shape_nm;
    for (int i = 0; i < model->links_n; i++) {
        const vec3 missing = vec3_sub(frame3_to_parent(&axes, outside->shape[i]), o->link[i]);
        const vec3 pull = vec3_scale(missing, strength * model->link[i].per_length);
        o->node[i] = vec3_add(o->node[i], pull);
        if (i > 0) {
            o->node[i - 1] = vec3_sub(o->node[i - 1], pull);
        }
    }
}

void elastic_predict(const elastic *model, const elastic_state *state, vec3 base_turn_m,
                     elastic_motion base, quat orientation, const elastic_outside *outside,
                     elastic_outcome *o)
{
    add_moments(model, state, base_turn_m, base, outside->forces_newton, o);
    add_torsion(model, o);
    if (outside->shape != NULL) {
        add_shape(model, orientation, outside, o);
    }
}
