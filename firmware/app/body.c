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
    if (all_new && !servo_setup_make(&setup, set, why)) {
        return false;
    }
    const rod_error error = rod_set_params(&b->rod, &set->rod, &refusal);
    if (error != ROD_OK) {
        return params_refuse_rod(error, &refusal, why);
    }
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
