/* body.c - see body.h. */
#include "body.h"

#include <string.h>

#include "servo_setup.h"

/* Goals start straight and at rest: only without torque. */
static void lay_servos(body *b, const servo_setup *setup)
{
    (void)servo_map_init(&b->map, setup->map, setup->servos_n, setup->period_s, NULL);
    b->servo_period_ticks = setup->period_ticks;
    b->ticks_to_servos = 0;
    servo_blend_none(&b->blend);
}

bool body_init(body *b, const params_set *set, params_refusal *why)
{
    memset(b, 0, sizeof *b);
    rod_refusal refusal;
    const rod_error error = rod_init(&b->rod, &set->rod, &refusal);
    if (error != ROD_OK) {
        return params_refuse_rod(error, &refusal, why);
    }
    servo_setup setup;
    if (!servo_setup_make(&setup, set, why)) {
        return false;
    }
    lay_servos(b, &setup);
    b->blend_s = set->device.blend_s;
    b->finite = true;
    b->follow = FOLLOW_NOTHING;
    return true;
}

bool body_change(body *b, const params_set *set, bool all_new, params_refusal *why)
{
    servo_setup setup;
    rod_refusal refusal;
    const int links_n = rod_params_of(&b->rod)->links_n;
    if (all_new && !servo_setup_make(&setup, set, why)) {
        return false;
    }
    const rod_error error = rod_set_params(&b->rod, &set->rod, &refusal);
    if (error != ROD_OK) {
        return params_refuse_rod(error, &refusal, why);
    }
    b->shape_ticks = set->rod.links_n == links_n ? b->shape_ticks : 0;
    b->blend_s = set->device.blend_s;
    if (all_new) {
        lay_servos(b, &setup);
    } else if (b->follow == FOLLOW_ROD) {
        float targets_rad[SERVOS_MAX];
        servo_map_targets(&b->map, rod_angles(&b->rod), set->rod.links_n, targets_rad);
        servo_blend_from_motion(&b->blend, &b->map, targets_rad, (uint32_t)(b->blend_s * 1e6f));
    }
    return true;
}

rod_error body_put_object(body *b, int index, const scene_object *object, scene_refusal *refusal)
{
    static const scene_object NONE = {.kind = SCENE_NONE};
    rod_error error = scene_put(&b->scene, index, object, refusal);
    if (error == ROD_OK) { /* an empty scene would cost the rod a look at every place */
        error = rod_set_scene(&b->rod, scene_objects_n(&b->scene) > 0 ? &b->scene : NULL);
    }
    if (error == ROD_E_PIVOT) { /* the first object: it was there alone */
        (void)scene_put(&b->scene, index, &NONE, NULL);
    }
    return error;
}

rod_error body_take_shape(body *b, const body_shape *shape)
{
    const bool pulls = shape->angles_n > 0 && shape->strength_nm > 0.0f;
    const rod_error error =
        rod_set_shape(&b->rod, pulls ? shape->angle_rad : NULL, shape->strength_nm, shape->blend_s);
    if (error == ROD_OK) {
        const float blend_ticks = shape->blend_s / rod_params_of(&b->rod)->tick_s;
        if (pulls || b->shape_ticks > 0) {
            b->shape_ticks = pulls ? UINT32_MAX : (uint32_t)blend_ticks + 2u;
        }
    }
    return error;
}

int body_touch(const body *b, int object, vec3 *force_newton)
{
    int contacts_n, touching_n = 0;
    const touch_contact *contact = rod_contacts(&b->rod, &contacts_n);
    *force_newton = (vec3){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < contacts_n; i++) {
        if (object == BODY_ANY_OBJECT || contact[i].object == object) {
            *force_newton = vec3_add(*force_newton, contact[i].force_newton);
            touching_n++;
        }
    }
    return touching_n;
}

servo_error body_place(body *b, const float *positions_rad)
{
    return servo_map_place(&b->map, positions_rad, NULL);
}

static void serve_servos(body *b)
{
    float targets_rad[SERVOS_MAX];
    switch (b->follow) {
    case FOLLOW_ROD:
        servo_map_targets(&b->map, rod_angles(&b->rod), rod_params_of(&b->rod)->links_n,
                          targets_rad);
        break;
    case FOLLOW_STRAIGHT:
        servo_map_straight(&b->map, targets_rad);
        break;
    default:
        b->limited = servo_map_hold(&b->map);
        return;
    }
    servo_blend_mix(&b->blend, targets_rad);
    b->limited = servo_map_follow(&b->map, targets_rad);
}

void body_tick(body *b, const body_input *input)
{
    if (input->has_base) {
        if (input->restart) {
            rod_reset(&b->rod);
        }
        b->finite = rod_step(&b->rod, &input->base) == ROD_OK;
        if (b->finite && b->shape_ticks > 0 && b->shape_ticks < UINT32_MAX) {
            b->shape_ticks--;
        }
    }
    b->follow = input->follow;
    if (input->blend_us > 0) {
        servo_blend_from_rest(&b->blend, &b->map, input->blend_us);
    } else if (input->has_base && input->restart && input->follow == FOLLOW_ROD) {
        /* the tracker was lost and found elsewhere: the rod is straight all at once, the joints not */
        servo_blend_from_rest(&b->blend, &b->map, (uint32_t)(b->blend_s * 1e6f));
    }
    b->goals_new = b->ticks_to_servos == 0;
    if (b->goals_new) {
        b->ticks_to_servos = b->servo_period_ticks;
        serve_servos(b);
    }
    b->ticks_to_servos--;
}

const float *body_goals(const body *b)
{
    return servo_map_goals(&b->map);
}

void body_angles(const body *b, rod_joint *angles_rad)
{
    for (int servo = 0; servo < b->map.servos_n; servo++) {
        angles_rad[servo / 2][servo % 2] = body_angle_rad(b, servo);
    }
}
