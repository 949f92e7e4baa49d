/* scene_commands.c - what stands in the rod's way and what shape it is to take (PROTOCOL.md, "Scene and shape"). */
#include "answers.h"
#include "tick_budget.h"

_Static_assert((int)OBJECT_NONE == SCENE_NONE && (int)OBJECT_PLANE == SCENE_PLANE &&
                   (int)OBJECT_SPHERE == SCENE_SPHERE && (int)OBJECT_CAPSULE == SCENE_CAPSULE &&
                   (int)OBJECT_BOX == SCENE_BOX,
               "the wire's kinds are the scene's");

enum { ALL_PLACES = 255 }; /* of SCENE_PUT, with no object: takes all away */

/* What rod_set_shape takes. */
#define ANGLE_MAX_RAD 3.14159265f

/* --- objects --------------------------------------------------------------------------------------- */

static params_refusal out_of_bounds(const char *field, int entry, float value, float min, float max)
{
    const bool finite = value >= -3.0e38f && value <= 3.0e38f;
    return (params_refusal){.reason = finite ? REASON_BOUNDS : REASON_NOT_FINITE,
                            .entry = entry,
                            .value = value,
                            .min = min,
                            .max = max,
                            .field = field};
}

/* An object that is one more must leave the tick enough time. */
static bool fits_the_tick(const device *d, int index, const scene_object *object, char *text,
                          params_refusal *why)
{
    const bool is_there = d->body.scene.body[index].object.kind != SCENE_NONE;
    if (is_there || object->kind == SCENE_NONE) {
        return true;
    }
    const tick_load load = {scene_objects_n(&d->body.scene) + 1, d->body.shape_ticks > 0};
    return tick_budget_check_objects(&d->params.in_force, &load, d->boot.clock_hz, text, why);
}

bool device_put_object(device *d, int index, const scene_object *object, char *text,
                       params_refusal *why)
{
    scene_refusal refusal;
    if (index < 0 || index >= SCENE_OBJECTS_MAX) {
        *why = (params_refusal){.reason = REASON_INDEX,
                                .entry = -1,
                                .value = (float)index,
                                .max = (float)(SCENE_OBJECTS_MAX - 1),
                                .field = "index"};
        return false;
    }
    if (scene_check(object, &refusal) != ROD_OK) {
        *why = out_of_bounds(refusal.field, refusal.axis, refusal.value, refusal.min, refusal.max);
        return false;
    }
    if (!fits_the_tick(d, index, object, text, why)) {
        return false;
    }
    const rod_error error = body_put_object(&d->body, index, object, NULL);
    if (error != ROD_OK) {
        *why = (params_refusal){.reason = REASON_COMBINATION,
                                .entry = -1,
                                .field = "objects",
                                .text = rod_error_text(error)};
        return false;
    }
    if (d->config.watcher.put != NULL) {
        d->config.watcher.put(d->config.watcher.context, index, object);
    }
    return true;
}

static void take_put(device *d, const message_scene_put *put)
{
    const scene_object object = {
        .kind = put->kind,
        .place_m = {put->place_m[0], put->place_m[1], put->place_m[2]},
        .orientation = {put->orientation_xyzw[0], put->orientation_xyzw[1],
                        put->orientation_xyzw[2], put->orientation_xyzw[3]},
        .half_m = {put->half_m[0], put->half_m[1], put->half_m[2]},
        .radius_m = put->radius_m,
        .friction = put->friction,
    };
    params_refusal why;
    char text[MESSAGES_TEXT_MAX + 1];
    const bool all = put->index == ALL_PLACES && put->kind == OBJECT_NONE;
    const int first = all ? 0 : put->index, last = all ? SCENE_OBJECTS_MAX - 1 : put->index;
    for (int index = first; index <= last; index++) {
        if (!device_put_object(d, index, &object, text, &why)) {
            answers_refuse(d, put->request_id, MESSAGE_SCENE_PUT, &why);
            return;
        }
    }
    answers_acknowledge(d, put->request_id, MESSAGE_SCENE_PUT);
}

static void take_get(device *d, const message_scene_get *get)
{
    if (get->index >= SCENE_OBJECTS_MAX) {
        answers_refuse_for(d, get->request_id, MESSAGE_SCENE_GET, REASON_INDEX, NULL);
        return;
    }
    const scene_object *o = &d->body.scene.body[get->index].object;
    message m = {.type = MESSAGE_SCENE_OBJECT,
                 .scene_object = {.request_id = get->request_id,
                                  .index = get->index,
                                  .objects_max = SCENE_OBJECTS_MAX}};
    if (o->kind != SCENE_NONE) {
        vec3 force;
        const uint16_t contacts_n = (uint16_t)body_touch(&d->body, get->index, &force);
        m.scene_object =
            (message_scene_object){.request_id = get->request_id,
                                   .index = get->index,
                                   .objects_max = SCENE_OBJECTS_MAX,
                                   .kind = (uint8_t)o->kind,
                                   .place_m = {o->place_m.x, o->place_m.y, o->place_m.z},
                                   .orientation_xyzw = {o->orientation.x, o->orientation.y,
                                                        o->orientation.z, o->orientation.w},
                                   .half_m = {o->half_m.x, o->half_m.y, o->half_m.z},
                                   .radius_m = o->radius_m,
                                   .friction = o->friction,
                                   .contacts_n = contacts_n,
                                   .force_newton = {force.x, force.y, force.z}};
    }
    (void)link_send(&d->link, &m, d->now_us);
}

/* --- the shape -------------------------------------------------------------------------------------- */

static bool is_within(const char *field, int entry, float value, float min, float max,
                      params_refusal *why)
{
    if (value >= min && value <= max) { /* NaN is not */
        return true;
    }
    *why = out_of_bounds(field, entry, value, min, max);
    return false;
}

static bool is_shape(const params_set *set, const body_shape *shape, params_refusal *why)
{
    if (!is_within("strength", -1, shape->strength_nm, 0.0f, ROD_SHAPE_STRENGTH_MAX_NM, why) ||
        !is_within("blend", -1, shape->blend_s, 0.0f, ROD_SHAPE_BLEND_MAX_S, why)) {
        return false;
    }
    if (shape->angles_n != 0 && shape->angles_n != set->rod.links_n) {
        *why = (params_refusal){.reason = REASON_ENTRIES,
                                .entry = -1,
                                .value = (float)shape->angles_n,
                                .min = (float)set->rod.links_n,
                                .max = (float)set->rod.links_n,
                                .field = "angles",
                                .text = "as many angles as the rod has links, or none"};
        return false;
    }
    bool good = true;
    for (int i = 0; i < 2 * shape->angles_n && good; i++) {
        good = is_within("angles", i / 2, shape->angle_rad[i / 2][i % 2], -ANGLE_MAX_RAD,
                         ANGLE_MAX_RAD, why);
    }
    return good;
}

bool device_take_shape(device *d, const body_shape *shape, char *text, params_refusal *why)
{
    const params_set *set = &d->params.in_force;
    const bool pulls = shape->angles_n > 0 && shape->strength_nm > 0.0f;
    const tick_load load = {scene_objects_n(&d->body.scene), true};
    if (!is_shape(set, shape, why) ||
        (pulls && !tick_budget_check(set, &load, d->boot.clock_hz, text, why))) {
        return false;
    }
    const rod_error error = body_take_shape(&d->body, shape);
    if (error != ROD_OK) {
        return params_refuse_rod(error, &(rod_refusal){.joint = -1}, why);
    }
    if (d->config.watcher.shaped != NULL) {
        d->config.watcher.shaped(d->config.watcher.context, shape);
    }
    return true;
}

static void take_shape(device *d, const message_shape *m)
{
    body_shape shape = {
        .strength_nm = m->strength_nm, .blend_s = m->blend_s, .angles_n = m->angles_n};
    for (int i = 0; i < m->angles_n && i < ROD_MAX_LINKS; i++) {
        shape.angle_rad[i][ROD_THETA] = 1e-4f * (float)m->angles_tenth_mrad[i][0];
        shape.angle_rad[i][ROD_PHI] = 1e-4f * (float)m->angles_tenth_mrad[i][1];
    }
    params_refusal why;
    char text[MESSAGES_TEXT_MAX + 1];
    if (device_take_shape(d, &shape, text, &why)) {
        answers_acknowledge(d, m->request_id, MESSAGE_SHAPE);
    } else {
        answers_refuse(d, m->request_id, MESSAGE_SHAPE, &why);
    }
}

void scene_commands_take(device *d, const message *m)
{
    switch (m->type) {
    case MESSAGE_SCENE_PUT:
        take_put(d, &m->scene_put);
        break;
    case MESSAGE_SCENE_GET:
        take_get(d, &m->scene_get);
        break;
    case MESSAGE_SHAPE:
        take_shape(d, &m->shape);
        break;
    default:
        break;
    }
}
