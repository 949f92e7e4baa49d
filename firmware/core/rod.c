/* rod.c - see rod.h. */
#include "rod.h"

#include <string.h>

#include "rod_private.h"

bool rod_is_elastic(const rod *r)
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

static rod_error prepare(prepared *model, const rod_params *params, float shape_nm, bool among,
                         rod_refusal *refusal)
{
    const rod_error error = rod_params_check(params, refusal);
    if (error != ROD_OK) {
        return error;
    }
    int row_n;
    const rod_error pivot = params->model == ROD_MODEL_ELASTIC
                                ? elastic_prepare(&model->elastic, params, among, &row_n)
                                : contour_prepare(&model->contour, params, shape_nm, &row_n);
    if (pivot != ROD_OK && refusal != NULL) {
        *refusal = (rod_refusal){pivot, NULL, row_n - 1, 0.0f, 0.0f, 0.0f};
    }
    return pivot;
}

static void put_in_place(rod *r, const prepared *model, const rod_params *params)
{
    r->params = *params;
    if (rod_is_elastic(r)) {
        r->as.elastic.model = model->elastic;
    } else {
        r->as.contour.model = model->contour;
    }
}

rod_error rod_init(rod *r, const rod_params *params, rod_refusal *refusal)
{
    prepared model;
    const rod_error error = prepare(&model, params, 0.0f, false, refusal);
    if (error == ROD_OK) {
        put_in_place(r, &model, params);
        memset(&r->shape, 0, sizeof r->shape);
        r->restored_n = 0;
        rod_set_force(r, NULL, NULL);
        r->objects = NULL;
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

void rod_read_joints(const rod *r, rod_joints *j)
{
    const size_t bytes = (size_t)r->params.links_n * sizeof(rod_joint);
    memset(j, 0, sizeof *j);
    memcpy(j->angle_rad, rod_angles(r), bytes);
    if (rod_is_elastic(r)) {
        elastic_increments(&r->as.elastic.model, &r->base, &r->motion, &r->as.elastic.state,
                           j->increment_rad);
    } else {
        memcpy(j->increment_rad, r->as.contour.state[r->as.contour.current].increment_rad, bytes);
    }
}

void rod_lay_joints(rod *r, const rod_joints *j)
{
    if (rod_is_elastic(r)) {
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
    const rod_error error =
        prepare(&model, params, shaped ? r->shape.strength_nm : 0.0f, r->objects != NULL, refusal);
    if (error != ROD_OK) {
        return error;
    }
    if (!shaped) {
        memset(&r->shape, 0, sizeof r->shape);
    }
    if (rod_is_elastic(r) && params->model == ROD_MODEL_ELASTIC &&
        is_same_shape(&r->params, params)) {
        put_in_place(r, &model, params);
        return ROD_OK;
    }
    rod_joints j;
    rod_read_joints(r, &j);
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
    rod_lay_joints(r, &j);
    return ROD_OK;
}

void rod_reset(rod *r)
{
    rod_joints straight_at_rest;
    memset(&straight_at_rest, 0, sizeof straight_at_rest);
    r->swept = 0;
    r->contacts.contacts_n = 0;
    r->started = false;
    r->base = (rod_pose){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};
    r->motion = NO_MOTION;
    rod_lay_joints(r, &straight_at_rest);
}

void rod_set_force(rod *r, rod_force_fn force, void *context)
{
    r->force = force;
    r->force_context = context;
}

/* With objects or without, ticks may be of other steps. */
static rod_error change_steps(rod *r, bool among)
{
    elastic *model = &r->as.elastic.model;
    if (!rod_is_elastic(r) || elastic_steps_n(r->params.tick_s, among) == model->steps_n) {
        return ROD_OK;
    }
    elastic other;
    int row_n;
    const rod_error error = elastic_prepare(&other, &r->params, among, &row_n);
    if (error == ROD_OK) {
        elastic_change_step(&r->as.elastic.state, r->params.links_n, other.h_s * model->per_h);
        *model = other;
    }
    return error;
}

rod_error rod_set_scene(rod *r, const scene *objects)
{
    const rod_error error = change_steps(r, objects != NULL);
    if (error == ROD_OK) {
        r->objects = objects;
        r->contacts.contacts_n = objects != NULL ? r->contacts.contacts_n : 0;
    }
    return error;
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

const rod_joint *rod_angles(const rod *r)
{
    return rod_is_elastic(r)
               ? (const rod_joint *)r->as.elastic.state.angle_rad
               : (const rod_joint *)r->as.contour.state[r->as.contour.current].angle_rad;
}

int rod_nodes(const rod *r, vec3 *nodes_m)
{
    if (!r->started) {
        return 0;
    }
    if (rod_is_elastic(r)) {
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
