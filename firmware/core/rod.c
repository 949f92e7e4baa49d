/* rod.c - see rod.h. */
#include "rod.h"

#include <string.h>

static bool is_elastic(const rod *r)
{
    return r->params.model == ROD_MODEL_ELASTIC;
}

/* The paper's scheme takes springs explicitly: a strong shape would throw the rod about. */
static bool may_have_shape(const rod_params *params)
{
    return params->model == ROD_MODEL_ELASTIC || params->scheme == ROD_SCHEME_MIDPOINT;
}

/* A model made ready, before it takes its place. */
typedef union {
    contour contour;
    elastic elastic;
} prepared;

static rod_error prepare(prepared *model, const rod_params *params, float shape_nm,
                         rod_refusal *refusal)
{
    const rod_error error = rod_params_check(params, refusal);
    if (error != ROD_OK) {
        return error;
    }
    int row_n;
    const rod_error pivot = params->model == ROD_MODEL_ELASTIC
                                ? elastic_prepare(&model->elastic, params, &row_n)
                                : contour_prepare(&model->contour, params, shape_nm, &row_n);
    if (pivot != ROD_OK && refusal != NULL) {
        *refusal = (rod_refusal){pivot, NULL, row_n - 1, 0.0f, 0.0f, 0.0f};
    }
    return pivot;
}

static void put_in_place(rod *r, const prepared *model, const rod_params *params)
{
    r->params = *params;
    if (is_elastic(r)) {
        r->as.elastic.model = model->elastic;
    } else {
        r->as.contour.model = model->contour;
    }
}

rod_error rod_init(rod *r, const rod_params *params, rod_refusal *refusal)
{
    prepared model;
    const rod_error error = prepare(&model, params, 0.0f, refusal);
    if (error == ROD_OK) {
        put_in_place(r, &model, params);
        memset(&r->shape, 0, sizeof r->shape);
        r->restored_n = 0;
        rod_set_force(r, NULL, NULL);
        rod_set_scene(r, NULL);
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

/* What both models have in common: where the joints are, and how they moved in the last tick. */
typedef struct {
    rod_joint angle_rad[ROD_MAX_LINKS], increment_rad[ROD_MAX_LINKS];
} joints;

/* Joints beyond the last are straight and at rest. */
static void read_joints(const rod *r, joints *j)
{
    const size_t bytes = (size_t)r->params.links_n * sizeof(rod_joint);
    memset(j, 0, sizeof *j);
    memcpy(j->angle_rad, rod_angles(r), bytes);
    if (is_elastic(r)) {
        elastic_increments(&r->as.elastic.model, &r->base, &r->motion, &r->as.elastic.state,
                           j->increment_rad);
    } else {
        memcpy(j->increment_rad, r->as.contour.state[r->as.contour.current].increment_rad, bytes);
    }
}

static void lay_joints(rod *r, const joints *j)
{
    if (is_elastic(r)) {
        elastic_lay(&r->as.elastic.model, &r->base, &r->motion, (const rod_joint *)j->angle_rad,
                    (const rod_joint *)j->increment_rad, &r->as.elastic.state);
        return;
    }
    const size_t bytes = (size_t)r->params.links_n * sizeof(rod_joint);
    memset(r->as.contour.state, 0, sizeof r->as.contour.state);
    r->as.contour.current = 0;
    memcpy(r->as.contour.state[0].angle_rad, j->angle_rad, bytes);
    memcpy(r->as.contour.state[0].increment_rad, j->increment_rad, bytes);
}

static bool differs(float a, float b)
{
    return a < b || a > b;
}

/* The same links at the same tick: a state of the elastic model then means the same. */
static bool is_same_shape(const rod_params *a, const rod_params *b)
{
    bool same = a->links_n == b->links_n && !differs(a->tick_s, b->tick_s);
    for (int i = 0; same && i < a->links_n; i++) {
        same = !differs(a->length_m[i], b->length_m[i]);
    }
    return same;
}

rod_error rod_set_params(rod *r, const rod_params *params, rod_refusal *refusal)
{
    prepared model;
    const bool shaped = may_have_shape(params) && params->links_n == r->params.links_n;
    const rod_error error = prepare(&model, params, shaped ? r->shape.strength_nm : 0.0f, refusal);
    if (error != ROD_OK) {
        return error;
    }
    if (!shaped) {
        memset(&r->shape, 0, sizeof r->shape);
    }
    if (is_elastic(r) && params->model == ROD_MODEL_ELASTIC && is_same_shape(&r->params, params)) {
        put_in_place(r, &model, params);
        return ROD_OK;
    }
    joints j;
    read_joints(r, &j);
    if (differs(params->tick_s, r->params.tick_s)) {
        const float ratio = params->tick_s / r->params.tick_s;
        for (int i = 0; i < params->links_n; i++) {
            for (int axis = 0; axis < 2; axis++) {
                j.increment_rad[i][axis] *= ratio;
            }
        }
        r->motion = stretch(&r->motion, ratio);
    }
    put_in_place(r, &model, params);
    lay_joints(r, &j);
    return ROD_OK;
}

void rod_reset(rod *r)
{
    joints straight_at_rest;
    memset(&straight_at_rest, 0, sizeof straight_at_rest);
    r->swept = 0;
    r->contacts.contacts_n = 0;
    r->started = false;
    r->base = (rod_pose){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    r->motion = NO_MOTION;
    lay_joints(r, &straight_at_rest);
}

void rod_set_force(rod *r, rod_force_fn force, void *context)
{
    r->force = force;
    r->force_context = context;
}

void rod_set_scene(rod *r, const scene *objects)
{
    r->objects = objects;
    r->contacts.contacts_n = objects != NULL ? r->contacts.contacts_n : 0;
}

const touch_contact *rod_contacts(const rod *r, int *contacts_n)
{
    *contacts_n = r->contacts.contacts_n;
    return r->contacts.contact;
}

rod_error rod_set_shape(rod *r, const rod_joint *angle_rad, float strength_nm, float blend_s)
{
    return may_have_shape(&r->params)
               ? shape_set(&r->shape, angle_rad, rod_angles(r), r->params.links_n, strength_nm,
                           blend_s, r->params.tick_s)
               : ROD_E_SHAPE;
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
    if (shape_advance(&r->shape, r->params.links_n) && !is_elastic(r)) {
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
    if (is_elastic(r)) {
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
    joints j;
    read_joints(r, &j);
    r->started = true;
    r->base = *base;
    lay_joints(r, &j);
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
    if (is_elastic(r)) {
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

const rod_joint *rod_angles(const rod *r)
{
    return is_elastic(r) ? (const rod_joint *)r->as.elastic.state.angle_rad
                         : (const rod_joint *)r->as.contour.state[r->as.contour.current].angle_rad;
}

int rod_nodes(const rod *r, vec3 *nodes_m)
{
    if (!r->started) {
        return 0;
    }
    if (is_elastic(r)) {
        elastic_nodes(&r->as.elastic.model, &r->as.elastic.state, &r->base, nodes_m);
    } else {
        kinematics_nodes(&r->base, rod_angles(r), r->params.length_m, r->params.links_n, nodes_m);
    }
    return r->params.links_n + 1;
}

uint32_t rod_restored_n(const rod *r)
{
    return r->restored_n;
}

const rod_params *rod_params_of(const rod *r)
{
    return &r->params;
}
