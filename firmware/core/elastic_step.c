/* elastic_step.c - see elastic.h: one tick of the elastic rod; the derivation is in MODEL.md, Section 5.
 *
 * h = 2/3 tick, and "bar" is BDF2's memory of a quantity, (4 x - x_before) / 3 = x + step / 3:
 * x_next = bar x + h v_next. Forces and matrix are multiplied by h^2. */
#include "elastic.h"

#include <stddef.h>
#include <string.h>

#include "base_path.h"
#include "elastic_private.h"

/* Newton's method ends where no link is further than this from its length ... */
static const float LENGTH_ERROR_GOOD = 1e-6f;
/* ... or after so many steps; what is then further off than this is reported. */
static const float LENGTH_ERROR_MAX = 1e-5f;
enum { LENGTH_STEPS_MAX = 3 };

static vec3 axis_of(const rod_pose *pose)
{
    return quat_rotate(pose->orientation, (vec3){0.0f, 0.0f, 1.0f});
}

/* The matrix of a step. Of the tension it holds what lasts, the least of the last two steps and the next: a jump's, of one
 * step, would stiffen a rod that is slack by then. */
typedef struct {
    float stiffness[ROD_MAX_LINKS], lasting[ROD_MAX_LINKS];
} step_stiffness;

static void stiffness_of(const elastic *model, const elastic_state *state,
                         const elastic_outside *outside, const elastic_outcome *o,
                         step_stiffness *s)
{
    for (int i = 0; i < model->links_n; i++) {
        s->stiffness[i] = o->joint[i].stiffness;
        s->lasting[i] = state->tension[i] - trig_abs(state->tension_step[i]);
    }
    if (outside->shape != NULL) { /* a link drawn to a direction is held there like a string's */
        const float strength = model->h_s * model->h_s * outside->shape_nm;
        for (int i = 0; i < model->links_n; i++) {
            const float lasting = s->lasting[i] > 0.0f ? s->lasting[i] : 0.0f;
            s->lasting[i] = lasting + strength * model->link[i].per_length;
        }
    }
}

/* Forces to displacements. Where a folded joint's secant is too stiff for float32 beside the rest, the matrix of the
 * straight rod, which elastic_prepare has found good, serves. */
static __attribute__((noinline)) void solve(const elastic *model, const elastic_state *state,
                                            const elastic_outside *outside, elastic_outcome *o)
{
    penta system;
    step_stiffness s;
    stiffness_of(model, state, outside, o, &s);
    if (elastic_factor(model, s.stiffness, s.lasting, &system) != 0) {
        elastic_straight_stiffness(model, s.stiffness);
        (void)elastic_factor(model, s.stiffness, outside->shape != NULL ? s.lasting : NULL,
                             &system);
    }
    penta_solve3(&system, (float(*)[3])(void *)o->node); /* a vec3 is three floats */
}

/* The links as the nodes now stand: their directions, and what each has too much in length, m. Returns
 * the worst relative error. */
static float measure(const elastic *model, elastic_outcome *o, float *excess_m)
{
    float worst = 0.0f;
    vec3 near_m = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < model->links_n; i++) {
        const bending_link *row = &model->link[i];
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
static void shorten(const elastic *model, elastic_outcome *o, float *excess_m)
{
    const int n = model->links_n;
    float per_pivots[ROD_MAX_LINKS];
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
        per_pivots[i] = per_pivot;
    }
    float pull_after = 0.0f;
    float carry_after = 0.0f;
    vec3 unit_after = {0.0f, 0.0f, 0.0f};
    for (int i = n - 1; i >= 0; i--) {
        const float pull = excess_m[i] * per_pivots[i] + carry_after * pull_after;
        const vec3 both =
            vec3_sub(vec3_scale(unit_after, pull_after), vec3_scale(o->unit[i], pull));
        o->node[i] = vec3_add_scaled(o->node[i], both, model->row[i].per_mass);
        o->tension[i] += pull;
        pull_after = pull;
        carry_after = carry[i];
        unit_after = o->unit[i];
    }
}

/* Links are of unit length again by their directions alone. What Newton's method has left of their errors is rounding and
 * must not reach the speeds: 1e-8 of a length in every tick is a force that grows as 1 / h^2 (a hanging
 * chain's second frequency: 0.03 % too high at 1 kHz, 0.4 % at 4 kHz). */
static void take_over(const elastic *model, const elastic_outcome *o, elastic_state *state)
{
    for (int i = 0; i < model->links_n; i++) {
        state->link_step[i] = vec3_sub(o->unit[i], state->link[i]);
        state->link[i] = o->unit[i];
        state->speed_step[i] =
            vec3_add_scaled(vec3_scale(state->speed_step[i], THIRD), o->node[i], model->per_h);
        state->speed_m_s[i] = vec3_add(state->speed_m_s[i], state->speed_step[i]);
        state->tension_step[i] = o->tension[i] - state->tension[i];
        state->tension[i] = o->tension[i];
    }
}

/* A hostile step leaves the directions of the links, and the rod goes along with its base. Were what the lengths
 * miss to count as motion, the rod would be driven by its own errors and need not come to rest. */
static void restore(const elastic *model, const elastic_outcome *o, vec3 base_turn_m,
                    elastic_state *state)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const vec3 speed = vec3_scale(base_turn_m, model->per_h);
    for (int i = 0; i < model->links_n; i++) {
        state->link[i] = o->unit[i];
        state->link_step[i] = state->speed_step[i] = NONE;
        state->speed_m_s[i] = speed;
        state->tension[i] = state->tension_step[i] = 0.0f;
    }
}

/* How far the base turned about its axis, rad; of large turns, what a sine makes of them. */
static float spin_of(const rod_pose *from, const rod_pose *to, vec3 axis)
{
    const quat turn = quat_multiply(to->orientation, quat_conjugate(from->orientation));
    const float twice = turn.w < 0.0f ? -2.0f : 2.0f;
    return twice * vec3_dot((vec3){turn.x, turn.y, turn.z}, axis);
}

/* Newton's method on the lengths. Returns whether they are found. */
static bool find_lengths(const elastic *model, elastic_outcome *o)
{
    float excess_m[ROD_MAX_LINKS];
    float worst = measure(model, o, excess_m);
    for (int i = 0; i < LENGTH_STEPS_MAX; i++) {
        shorten(model, o, excess_m);
        worst = measure(model, o, excess_m);
        if (worst <= LENGTH_ERROR_GOOD) {
            break;
        }
    }
    return worst <= LENGTH_ERROR_MAX;
}

static bool finish(const elastic *model, elastic_state *state, vec3 base_turn_m,
                   const elastic_outside *outside, elastic_outcome *o)
{
    solve(model, state, outside, o);
    const bool found = find_lengths(model, o);
    if (found) {
        take_over(model, o, state);
    } else {
        restore(model, o, base_turn_m, state);
    }
    return found;
}

/* The same among objects. Not inlined: a rod without any does not pay for its stack. */
static __attribute__((noinline)) bool finish_touching(const elastic *model, elastic_state *state,
                                                      const rod_pose *from, const rod_pose *to,
                                                      vec3 base_turn_m,
                                                      const elastic_outside *outside,
                                                      elastic_outcome *o)
{
    touch_points points;
    bending_bands bands;
    step_stiffness s;
    elastic_touch_find(model, state, o, from->position_m, to->position_m, outside, &points);
    outside->contacts->contacts_n = 0;
    if (points.points_n == 0) {
        return finish(model, state, base_turn_m, outside, o);
    }
    stiffness_of(model, state, outside, o, &s);
    bending_assemble(model->link, model->links_n, s.stiffness, s.lasting, &bands);
    if (!elastic_touch_solve(model, &bands, &points, o)) { /* float32 cannot */
        return finish(model, state, base_turn_m, outside, o);
    }
    if (!find_lengths(model, o)) {
        restore(model, o, base_turn_m, state);
        return false;
    }
    take_over(model, o, state);
    touch_remember(&points, model->h_s * model->h_s, outside->contacts);
    elastic_touch_settle(model, &bands, &points, vec3_sub(to->position_m, from->position_m), state);
    return true;
}

static bool step_once(const elastic *model, elastic_state *state, const rod_pose *from,
                      const rod_pose *to, const elastic_outside *outside)
{
    const vec3 axis = axis_of(to);
    const vec3 axis_step = vec3_sub(axis, axis_of(from));
    const float spin_step = spin_of(from, to, axis);
    const vec3 base_step_m = vec3_sub(to->position_m, from->position_m);

    /* what the base does in this step, less bar */
    const vec3 base_turn_m = vec3_add_scaled(base_step_m, state->base_step_m, -THIRD);
    elastic_motion base = {.link = axis,
                           .unit = axis,
                           .turn = vec3_add_scaled(axis_step, state->axis_step, -THIRD),
                           .spin = spin_step - THIRD * state->spin_step};

    elastic_outcome o;
    elastic_predict(model, state, base_turn_m, base, to->orientation, outside, &o);
    const bool found = outside->objects != NULL
                           ? finish_touching(model, state, from, to, base_turn_m, outside, &o)
                           : finish(model, state, base_turn_m, outside, &o);
    state->axis_step = axis_step;
    state->spin_step = spin_step;
    state->base_step_m = base_step_m;
    return found;
}

bool elastic_step(const elastic *model, elastic_state *state, const rod_motion *previous,
                  const rod_pose *from, const rod_pose *to, const elastic_outside *outside)
{
    bool found = true;
    rod_pose here = *from;
    if (model->steps_n > 1) {
        const rod_pose before = kinematics_pose_before(from, previous);
        const base_path path = base_path_between(&before, from, to);
        for (int i = 1; i < model->steps_n; i++) {
            const rod_pose next = base_path_pose(&path, (float)i * model->step_share);
            found = step_once(model, state, &here, &next, outside) && found;
            here = next;
        }
    }
    found = step_once(model, state, &here, to, outside) && found;
    kinematics_angles(to, state->link, model->links_n, state->angle_rad);
    return found;
}
