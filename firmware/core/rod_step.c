/* rod_step.c - see rod.h: one tick of either model, with what acts on the rod from outside. */
#include <string.h>

#include "rod_private.h"

static bool is_pose(const rod_pose *pose)
{
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    const float norm_squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    /* each comparison fails for NaN */
    return trig_abs(p.x) <= 1000.0f && trig_abs(p.y) <= 1000.0f && trig_abs(p.z) <= 1000.0f &&
           trig_abs(norm_squared - 1.0f) <= 2e-3f;
}

static void ask_force(const rod *r, vec3 *nodes_m, vec3 *forces_newton)
{
    const int nodes_n = rod_nodes(r, nodes_m);
    memset(forces_newton, 0, (size_t)nodes_n * sizeof *forces_newton);
    r->force(nodes_m, nodes_n, forces_newton, r->force_context);
}

/* Not inlined, like what asks for forces: a rod without external ones does not pay their stack. */
static __attribute__((noinline)) rod_error external_forces(const rod *r, vec3 *forces_newton)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1];
    ask_force(r, nodes_m, forces_newton);
    for (int i = 0; i <= r->params.links_n; i++) {
        const vec3 f = forces_newton[i];
        if (!(trig_abs(f.x) + trig_abs(f.y) + trig_abs(f.z) <= 1e9f)) {
            return ROD_E_FORCE;
        }
    }
    return ROD_OK;
}

static __attribute__((noinline)) rod_error external_torques(const rod *r, rod_joint *torque_nm)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1], forces_newton[ROD_MAX_LINKS + 1];
    ask_force(r, nodes_m, forces_newton);
    contour_torques(&r->as.contour.model, rod_angles(r), &r->base, nodes_m, forces_newton,
                    torque_nm);
    for (int i = 0; i < r->params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            if (!(trig_abs(torque_nm[i][axis]) <= 1e9f)) {
                return ROD_E_FORCE;
            }
        }
    }
    return ROD_OK;
}

static bool is_shaped(const rod *r)
{
    return r->shape.strength_nm > 0.0f;
}

/* contour's matrix holds the shape's stiffness: factored anew while it changes. Where float32 cannot, it stays. */
static void step_shape(rod *r)
{
    int row_n;
    if (shape_advance(&r->shape, r->params.links_n) && !rod_is_elastic(r)) {
        (void)contour_prepare(&r->as.contour.model, &r->params, r->shape.strength_nm, &row_n);
    }
}

static rod_error step_contour(rod *r, const rod_pose *base, const rod_motion *now,
                              const rod_joint *torque_nm)
{
    const contour *model = &r->as.contour.model;
    contour_state *from = &r->as.contour.state[r->as.contour.current];
    contour_state *to = &r->as.contour.state[1 - r->as.contour.current];
    const rod_error error = contour_step(model, from, to, &r->motion, now, torque_nm);
    if (error == ROD_OK) {
        if (r->objects != NULL) {
            contour_touch(model, from, to, &r->base, base, r->objects, &r->contacts);
        }
        r->as.contour.current = 1 - r->as.contour.current;
    }
    return error;
}

/* External forces, and a shape: it pulls as a spring does, whose stiffness the model has (step_shape). */
static __attribute__((noinline)) rod_error step_contour_with_torque(rod *r, const rod_pose *base,
                                                                    const rod_motion *now)
{
    rod_joint torque_nm[ROD_MAX_LINKS];
    memset(torque_nm, 0, sizeof torque_nm);
    const rod_error error = r->force != NULL ? external_torques(r, torque_nm) : ROD_OK;
    if (error != ROD_OK) {
        return error;
    }
    for (int i = 0; i < r->params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            torque_nm[i][axis] += r->shape.strength_nm * r->shape.angle_rad[i][axis];
        }
    }
    return step_contour(r, base, now, (const rod_joint *)torque_nm);
}

static rod_error step_elastic(rod *r, const rod_pose *base, const elastic_outside *outside)
{
    const bool found = elastic_step(&r->as.elastic.model, &r->as.elastic.state, &r->motion,
                                    &r->base, base, outside);
    r->restored_n += found ? 0 : 1;
    return ROD_OK;
}

static __attribute__((noinline)) rod_error step_elastic_with_force(rod *r, const rod_pose *base,
                                                                   elastic_outside *outside)
{
    vec3 forces_newton[ROD_MAX_LINKS + 1], link[ROD_MAX_LINKS];
    const rod_error error = r->force != NULL ? external_forces(r, forces_newton) : ROD_OK;
    if (error != ROD_OK) {
        return error;
    }
    outside->forces_newton = r->force != NULL ? forces_newton : NULL;
    if (is_shaped(r)) {
        shape_links(&r->shape, r->params.links_n, link);
        outside->shape = link;
        outside->shape_nm = r->shape.strength_nm;
    }
    return step_elastic(r, base, outside);
}

static float without_dust(float x)
{
    return trig_abs(x) < 1e-30f ? 0.0f : x;
}

static void sweep_vec3(vec3 *v)
{
    *v = (vec3){without_dust(v->x), without_dust(v->y), without_dust(v->z)};
}

/* A rod at rest decays for ever, into numbers so small that some processors take a hundred times as
 * long over them. One joint a tick is cleared of what is too small to matter. */
static void sweep(rod *r)
{
    const int i = r->swept = r->swept + 1 < r->params.links_n ? r->swept + 1 : 0;
    if (rod_is_elastic(r)) {
        elastic_state *state = &r->as.elastic.state;
        sweep_vec3(&state->link[i]);
        sweep_vec3(&state->link_step[i]);
        sweep_vec3(&state->speed_m_s[i]);
        sweep_vec3(&state->speed_step[i]);
        state->tension[i] = without_dust(state->tension[i]);
        state->tension_step[i] = without_dust(state->tension_step[i]);
        return;
    }
    contour_state *state = &r->as.contour.state[r->as.contour.current];
    for (int axis = 0; axis < 2; axis++) {
        state->angle_rad[i][axis] = without_dust(state->angle_rad[i][axis]);
        state->increment_rad[i][axis] = without_dust(state->increment_rad[i][axis]);
    }
}

/* The first pose: the rod as it lies in its base's axes goes to where the base is. */
static __attribute__((noinline)) void start(rod *r, const rod_pose *base)
{
    rod_joints j;
    rod_read_joints(r, &j);
    r->started = true;
    r->base = *base;
    rod_lay_joints(r, &j);
}

rod_error rod_step(rod *r, const rod_pose *base)
{
    if (!is_pose(base)) {
        return ROD_E_POSE;
    }
    if (!r->started) {
        start(r, base);
        return ROD_OK;
    }
    step_shape(r);
    const rod_motion now = kinematics_motion(&r->base, base);
    const bool pulled = r->force != NULL || is_shaped(r);
    rod_error error;
    if (rod_is_elastic(r)) {
        elastic_outside outside = {.objects = r->objects, .contacts = &r->contacts};
        error =
            pulled ? step_elastic_with_force(r, base, &outside) : step_elastic(r, base, &outside);
    } else {
        error =
            pulled ? step_contour_with_torque(r, base, &now) : step_contour(r, base, &now, NULL);
    }
    if (error == ROD_OK) {
        r->base = *base;
        r->motion = now;
        sweep(r);
    }
    return error;
}
