/* rod.c - see rod.h. */
#include "rod.h"

#include <string.h>

/* Takes the parameters over and refactors, or leaves the rod as it was. */
static rod_error prepare(rod *r, const rod_params *params, rod_refusal *refusal)
{
    const rod_error error = rod_params_check(params, refusal);
    if (error != ROD_OK) {
        return error;
    }
    int row_n;
    if (contour_prepare(&r->model, params, &row_n) != ROD_OK) {
        if (refusal != NULL) {
            *refusal = (rod_refusal){ROD_E_PIVOT, NULL, row_n - 1, 0.0f, 0.0f, 0.0f};
        }
        return ROD_E_PIVOT;
    }
    r->params = *params;
    return ROD_OK;
}

rod_error rod_init(rod *r, const rod_params *params, rod_refusal *refusal)
{
    const rod_error error = prepare(r, params, refusal);
    if (error == ROD_OK) {
        rod_set_force(r, NULL, NULL);
        rod_reset(r);
    }
    return error;
}

static const rod_motion NO_MOTION = {{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};

/* The same speed over a tick `ratio` times as long. */
static rod_motion stretch(const rod_motion *motion, float ratio)
{
    /* the vector part is half the angle, to first order: enough for the turn within a tick */
    const float scale = motion->turn.w < 0.0f ? -ratio : ratio;
    const quat q = {motion->turn.x * scale, motion->turn.y * scale, motion->turn.z * scale, 1.0f};
    const float norm = 1.0f / trig_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + 1.0f);
    return (rod_motion){{q.x * norm, q.y * norm, q.z * norm, norm},
                        vec3_scale(motion->shift_m, ratio)};
}

rod_error rod_set_params(rod *r, const rod_params *params, rod_refusal *refusal)
{
    const float old_tick_s = r->params.tick_s;
    const rod_error error = prepare(r, params, refusal);
    if (error != ROD_OK) {
        return error;
    }
    contour_state *state = &r->state[r->current];
    for (int i = params->links_n; i <= ROD_MAX_LINKS; i++) {
        for (int axis = 0; axis < 2; axis++) {
            state->angle_rad[i][axis] = state->increment_rad[i][axis] = 0.0f;
        }
    }
    /* the other state keeps its rows beyond the last one at zero as well */
    r->state[1 - r->current] = *state;

    if (old_tick_s < params->tick_s || old_tick_s > params->tick_s) {
        const float ratio = params->tick_s / old_tick_s;
        for (int i = 0; i < params->links_n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                state->increment_rad[i][axis] *= ratio;
            }
        }
        r->motion = stretch(&r->motion, ratio);
    }
    return ROD_OK;
}

void rod_reset(rod *r)
{
    memset(r->state, 0, sizeof r->state);
    r->current = r->swept = 0;
    r->started = false;
    r->motion = NO_MOTION;
}

void rod_set_force(rod *r, rod_force_fn force, void *context)
{
    r->force = force;
    r->force_context = context;
}

static bool is_pose(const rod_pose *pose)
{
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    const float norm_squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    /* each comparison fails for NaN */
    return trig_abs(p.x) <= 1000.0f && trig_abs(p.y) <= 1000.0f && trig_abs(p.z) <= 1000.0f &&
           trig_abs(norm_squared - 1.0f) <= 2e-3f;
}

/* Asks the force function and turns its answer into torques. Its own frame, for the nodes' sake: a
 * rod without external forces does not pay their stack. */
static __attribute__((noinline)) rod_error external_torques(const rod *r, rod_joint *torque_nm)
{
    const rod_joint *angles = rod_angles(r);
    vec3 nodes_m[ROD_MAX_LINKS + 1], forces_newton[ROD_MAX_LINKS + 1];
    const int nodes_n = rod_nodes(r, nodes_m);
    memset(forces_newton, 0, sizeof forces_newton);
    r->force(nodes_m, nodes_n, forces_newton, r->force_context);
    contour_torques(&r->model, angles, &r->base, nodes_m, forces_newton, torque_nm);
    for (int i = 0; i < r->params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            if (!(trig_abs(torque_nm[i][axis]) <= 1e9f)) {
                return ROD_E_FORCE;
            }
        }
    }
    return ROD_OK;
}

static __attribute__((noinline)) rod_error step_with_force(rod *r, const rod_motion *now)
{
    rod_joint torque_nm[ROD_MAX_LINKS];
    const rod_error error = external_torques(r, torque_nm);
    if (error != ROD_OK) {
        return error;
    }
    return contour_step(&r->model, &r->state[r->current], &r->state[1 - r->current], &r->motion,
                        now, (const rod_joint *)torque_nm);
}

/* A rod at rest decays for ever, into numbers so small that some processors take a hundred times as
 * long over them. One joint a tick is cleared of what is too small to matter. */
static void sweep(rod *r)
{
    contour_state *state = &r->state[r->current];
    r->swept = r->swept + 1 < r->params.links_n ? r->swept + 1 : 0;
    for (int axis = 0; axis < 2; axis++) {
        float *angle = &state->angle_rad[r->swept][axis];
        float *increment = &state->increment_rad[r->swept][axis];
        *angle = trig_abs(*angle) < 1e-30f ? 0.0f : *angle;
        *increment = trig_abs(*increment) < 1e-30f ? 0.0f : *increment;
    }
}

rod_error rod_step(rod *r, const rod_pose *base)
{
    if (!is_pose(base)) {
        return ROD_E_POSE;
    }
    if (!r->started) {
        r->started = true;
        r->base = *base;
        return ROD_OK;
    }
    const rod_motion now = kinematics_motion(&r->base, base);
    const rod_error error = r->force != NULL
                                ? step_with_force(r, &now)
                                : contour_step(&r->model, &r->state[r->current],
                                               &r->state[1 - r->current], &r->motion, &now, NULL);
    if (error == ROD_OK) {
        r->current = 1 - r->current;
        r->base = *base;
        r->motion = now;
        sweep(r);
    }
    return error;
}

const rod_joint *rod_angles(const rod *r)
{
    return (const rod_joint *)r->state[r->current].angle_rad;
}

int rod_nodes(const rod *r, vec3 *nodes_m)
{
    if (!r->started) {
        return 0;
    }
    kinematics_nodes(&r->base, rod_angles(r), r->params.length_m, r->params.links_n, nodes_m);
    return r->params.links_n + 1;
}

const rod_params *rod_params_of(const rod *r)
{
    return &r->params;
}
