/* elastic_step.c - see elastic.h: one tick of the elastic rod; the derivation is in MODEL.md, Section 5.
 *
 * h = 2/3 tick, and "bar" is BDF2's memory of a quantity, (4 x - x_before) / 3 = x + step / 3:
 * x_next = bar x + h v_next. Forces and matrix are multiplied by h^2. */
#include "elastic.h"

#include <float.h>
#include <stddef.h>

#include "elastic_private.h"

static const float THIRD = 1.0f / 3.0f;

/* Newton's method ends where no link is further than this from its length ... */
static const float LENGTH_ERROR_GOOD = 1e-6f;
/* ... or after so many steps; what is then further off than this is reported. */
static const float LENGTH_ERROR_MAX = 1e-5f;
enum { LENGTH_STEPS_MAX = 3 };

static vec3 axis_of(const rod_pose *pose)
{
    return quat_rotate(pose->orientation, (vec3){0.0f, 0.0f, 1.0f});
}

/* What comes of a step before the state takes it over. */
typedef struct {
    vec3 link[ROD_MAX_LINKS]; /* as predicted: bar + h bar v, in general not of unit length */
    vec3 unit[ROD_MAX_LINKS]; /* directions of unit length */
    vec3 node[ROD_MAX_LINKS]; /* h^2 force; then how far each node misses its prediction, m */
    float tension[ROD_MAX_LINKS];
    float stiffness[ROD_MAX_LINKS]; /* h^2 k + h c as secants at the predicted angles */
} outcome;

/* The direction of v, and its length; `otherwise` where it has none to speak of. */
static inline vec3 direction(vec3 v, vec3 otherwise, float *length)
{
    *length = trig_sqrt(vec3_dot(v, v));
    return *length > 1e-3f ? vec3_scale(v, 1.0f / *length) : otherwise;
}

/* A link at the end of a step in which nothing acts: its direction, in general not of unit length, and h times
 * how fast it turns: the rate of the direction, that as an angular velocity, and its spin about itself. */
typedef struct {
    vec3 link, turn, swing;
    float spin;
} motion;

/* The moment of the joint between two links, h^2 times; its stiffness h^2 k + h c as a secant; and the outer
 * link's spin.
 *
 * Bent by alpha, a joint has the curvature kappa = link - near link, |kappa| = 2 sin(alpha / 2), q its square's
 * quarter. For a torque of k alpha the spring on kappa is stiffer by alpha / sin alpha, which grows without
 * bound towards the fold; beyond 143 degrees it stays. The polynomial is asin(sqrt q) / sqrt q, q = 0 ... 0.9, to
 * 1.5e-5 below 66 degrees and 5e-4 above. The damper resists how fast the two links turn against each other: what
 * the curvature gains, less what it does where both turn together, as they do across the joint (by what
 * lies along it) and about it (a joint does not twist: the inner link's spin goes on to the outer). */
static inline vec3 joint_moment(const elastic_row *row, const motion *near, motion *far,
                                float *stiffness)
{
    const vec3 curvature = vec3_sub(far->link, near->link);
    const vec3 along = vec3_add(far->link, near->link);
    const float q_open = 0.25f * vec3_dot(curvature, curvature);
    const float q = q_open < 0.9f ? q_open : 0.9f;
    const float per_cos_squared = 1.0f / (1.0f - q); /* of alpha / 2 */
    const float quarter = 0.25f * per_cos_squared;   /* 1 / |along|^2 */
    const float arc =
        (((((0.93312079f * q - 1.59617995f) * q + 1.07601774f) * q - 0.24781261f) * q +
          0.10942365f) *
             q +
         0.16537747f) *
            q +
        1.0f;
    const float spring = row->spring * (arc * trig_sqrt(per_cos_squared));

    const float near_over = vec3_dot(near->swing, far->link);
    far->spin = near->spin + 2.0f * quarter * (near_over - vec3_dot(far->swing, near->link));
    const vec3 rate = vec3_sub(far->turn, near->turn);
    const vec3 level = vec3_add_scaled(rate, along, -quarter * vec3_dot(along, rate));
    const vec3 bending = vec3_add_scaled(level, vec3_cross(along, curvature),
                                         -(0.5f * near->spin + quarter * near_over));
    const float in_plane = quarter * (2.0f - q) * vec3_dot(curvature, rate);
    const vec3 damping = vec3_add_scaled(vec3_scale(bending, 1.0f - q), curvature, in_plane);
    *stiffness = spring + row->damper * per_cos_squared;
    return vec3_add_scaled(vec3_scale(curvature, spring), damping, row->damper);
}

/* Where the nodes go if nothing acts on them, and the forces on them there. Each link pulls its two
 * ends: by the moments of its joints, M_j - M_{j+1} over its length, and by last tick's tension. */
static void predict(const elastic *model, const elastic_state *state, vec3 base_turn_m, motion near,
                    const vec3 *forces_newton, outcome *o)
{
    const int n = model->links_n;
    const float h = model->h_s;
    vec3 near_m = base_turn_m;             /* h v of the link's near end */
    vec3 pull_before = {0.0f, 0.0f, 0.0f}; /* of the link before, without its outer moment */
    float per_length_before = 0.0f;
    for (int i = 0; i < n; i++) {
        const elastic_row *row = &model->row[i];
        const vec3 speed = vec3_add_scaled(state->speed_m_s[i], state->speed_step[i], THIRD);
        const vec3 far_m = vec3_scale(speed, h);
        motion far;
        far.turn = vec3_scale(vec3_sub(far_m, near_m), row->per_length);
        far.link = vec3_add(state->link[i], vec3_add_scaled(far.turn, state->link_step[i], THIRD));
        float length;
        const vec3 unit = direction(far.link, state->link[i], &length);
        far.swing = vec3_cross(unit, far.turn);
        const vec3 moment = joint_moment(row, &near, &far, &o->stiffness[i]);
        o->link[i] = far.link;
        o->unit[i] = unit;
        o->tension[i] = state->tension[i] + state->tension_step[i];

        if (i > 0) { /* the link before has its outer moment now */
            const vec3 pull = vec3_add_scaled(pull_before, moment, -per_length_before);
            o->node[i - 1] = vec3_sub(o->node[i - 1], pull);
            if (i > 1) {
                o->node[i - 2] = vec3_add(o->node[i - 2], pull);
            }
        }
        pull_before = vec3_add_scaled(vec3_scale(moment, row->per_length), unit, o->tension[i]);
        per_length_before = row->per_length;

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

/* Forces to displacements. Where a folded joint's secant is too stiff for float32 beside the rest, the
 * matrix of the straight rod, which elastic_prepare has found good, serves. */
static __attribute__((noinline)) void solve(const elastic *model, outcome *o)
{
    penta system;
    if (elastic_factor(model, o->stiffness, &system) != 0) {
        elastic_straight_stiffness(model, o->stiffness);
        (void)elastic_factor(model, o->stiffness, &system);
    }
    penta_solve3(&system, (float(*)[3])(void *)o->node); /* a vec3 is three floats */
}

/* The links as the nodes now stand: their directions, and what each has too much in length, m. Returns
 * the worst relative error. */
static float measure(const elastic *model, outcome *o, float *excess_m)
{
    float worst = 0.0f;
    vec3 near_m = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < model->links_n; i++) {
        const elastic_row *row = &model->row[i];
        const vec3 link =
            vec3_add_scaled(o->link[i], vec3_sub(o->node[i], near_m), row->per_length);
        float length;
        o->unit[i] = direction(link, o->unit[i], &length);
        excess_m[i] = (length - 1.0f) * row->length_m;
        const float error = trig_abs(length - 1.0f);
        worst = error <= worst ? worst : error;
        near_m = o->node[i];
    }
    return worst;
}

/* One Newton step on the lengths: pulls x along the links with (G M^-1 G') x = excess, tridiagonal
 * with diagonal 1 / m_i + 1 / m_{i-1} and off-diagonal -(u_i . u_{i-1}) / m_{i-1}; the base has no 1 / m.
 * Written so that no pivot can fall below 1 / m_i, whatever the rounding. */
static void shorten(const elastic *model, outcome *o, float *excess_m)
{
    const int n = model->links_n;
    float carry[ROD_MAX_LINKS]; /* cos / (m pivot) of the link before: what a row hands on */
    float per_mass_before = 0.0f, share = 0.0f, excess_before = 0.0f;
    for (int i = 0; i < n; i++) {
        float cosine = 0.0f;
        if (i > 0) {
            const float dot = vec3_dot(o->unit[i - 1], o->unit[i]);
            cosine = dot > 1.0f ? 1.0f : dot < -1.0f ? -1.0f : dot;
        }
        const float per_mass = model->row[i].per_mass;
        const float per_pivot =
            1.0f / (per_mass + per_mass_before * (1.0f - (cosine * cosine) * share));
        carry[i] = cosine * share;
        excess_before = excess_m[i] + carry[i] * excess_before;
        excess_m[i] = excess_before;
        share = per_mass * per_pivot;
        per_mass_before = per_mass;
        o->stiffness[i] = per_pivot; /* free by now */
    }
    float pull_after = 0.0f;
    float carry_after = 0.0f;
    vec3 unit_after = {0.0f, 0.0f, 0.0f};
    for (int i = n - 1; i >= 0; i--) {
        const float pull = excess_m[i] * o->stiffness[i] + carry_after * pull_after;
        const vec3 both =
            vec3_sub(vec3_scale(unit_after, pull_after), vec3_scale(o->unit[i], pull));
        o->node[i] = vec3_add_scaled(o->node[i], both, model->row[i].per_mass);
        o->tension[i] += pull;
        pull_after = pull;
        carry_after = carry[i];
        unit_after = o->unit[i];
    }
}

/* The lengths are made exact from the base outwards: what Newton's method has left is far too small to matter,
 * or else the motion is hostile and this is what keeps the rod together. Returns false where a node
 * is nowhere. */
static bool close_links(const elastic *model, outcome *o, const float *excess_m)
{
    bool finite = true;
    vec3 shift_m = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < model->links_n; i++) {
        shift_m = vec3_add_scaled(shift_m, o->unit[i], -excess_m[i]);
        o->node[i] = vec3_add(o->node[i], shift_m);
        const vec3 d = o->node[i];
        finite = finite && trig_abs(d.x) + trig_abs(d.y) + trig_abs(d.z) <= FLT_MAX;
    }
    return finite;
}

static void take_over(const elastic *model, const outcome *o, bool lengths_found,
                      elastic_state *state)
{
    for (int i = 0; i < model->links_n; i++) {
        state->link_step[i] = vec3_sub(o->unit[i], state->link[i]);
        state->link[i] = o->unit[i];
        state->speed_step[i] =
            vec3_add_scaled(vec3_scale(state->speed_step[i], THIRD), o->node[i], model->per_h);
        state->speed_m_s[i] = vec3_add(state->speed_m_s[i], state->speed_step[i]);
        const float tension = lengths_found ? o->tension[i] : 0.0f;
        state->tension_step[i] = lengths_found ? tension - state->tension[i] : 0.0f;
        state->tension[i] = tension;
    }
}

/* How far the base turned about its axis, rad; of large turns, what a sine makes of them. */
static float spin_of(const rod_pose *from, const rod_pose *to, vec3 axis)
{
    const quat turn = quat_multiply(to->orientation, quat_conjugate(from->orientation));
    const float twice = turn.w < 0.0f ? -2.0f : 2.0f;
    return twice * vec3_dot((vec3){turn.x, turn.y, turn.z}, axis);
}

rod_error elastic_step(const elastic *model, elastic_state *state, const rod_pose *from,
                       const rod_pose *to, const vec3 *forces_newton, bool *restored)
{
    const vec3 axis = axis_of(to);
    const vec3 axis_step = vec3_sub(axis, axis_of(from));
    const float spin_step = spin_of(from, to, axis);
    const vec3 base_step_m = vec3_sub(to->position_m, from->position_m);

    /* what the base does in this step, less bar */
    const vec3 base_turn_m = vec3_add_scaled(base_step_m, state->base_step_m, -THIRD);
    motion base = {.link = axis,
                   .turn = vec3_add_scaled(axis_step, state->axis_step, -THIRD),
                   .spin = spin_step - THIRD * state->spin_step};
    base.swing = vec3_cross(base.link, base.turn);

    outcome o;
    predict(model, state, base_turn_m, base, forces_newton, &o);
    solve(model, &o);
    float excess_m[ROD_MAX_LINKS];
    float worst = measure(model, &o, excess_m);
    for (int i = 0; i < LENGTH_STEPS_MAX; i++) {
        shorten(model, &o, excess_m);
        worst = measure(model, &o, excess_m);
        if (worst <= LENGTH_ERROR_GOOD) {
            break;
        }
    }
    if (!close_links(model, &o, excess_m)) {
        return ROD_E_NOT_FINITE;
    }
    *restored = !(worst <= LENGTH_ERROR_MAX);
    take_over(model, &o, !*restored, state);
    state->axis_step = axis_step;
    state->spin_step = spin_step;
    state->base_step_m = base_step_m;
    kinematics_angles(to, state->link, model->links_n, state->angle_rad);
    return ROD_OK;
}
