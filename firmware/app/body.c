/* body.c - see body.h. */
#include "body.h"

#include <string.h>

/* Servo 2i turns theta of joint i, servo 2i + 1 its phi. */
static void describe_servos(const params_set *set, servo_config *configs)
{
    const device_params *d = &set->device;
    for (int servo = 0; servo < 2 * set->rod.links_n; servo++) {
        configs[servo] = (servo_config){
            .id = (uint16_t)d->servo_id[servo],
            .joint = (uint8_t)(servo / 2),
            .axis = (uint8_t)(servo % 2),
            .sign = d->servo_sign[servo] < 0.0f ? -1 : 1,
            .offset_rad = d->servo_offset_rad[servo],
            .min_rad = d->servo_offset_rad[servo] + d->servo_min_rad[servo],
            .max_rad = d->servo_offset_rad[servo] + d->servo_max_rad[servo],
            .rate_rad_s = d->servo_rate_radps,
            .accel_rad_s2 = d->servo_acceleration_radps2,
        };
    }
}

/* The servos are served on whole ticks: at the asked rate or the next lower one that fits. */
static int period_ticks(const params_set *set)
{
    const float ticks = 1.0f / (set->device.servo_hz * set->rod.tick_s);
    const int whole = (int)(ticks + 0.999f);
    return whole > 1 ? whole : 1;
}

static bool prepare_servos(body *b, const params_set *set, params_refusal *why)
{
    servo_config configs[SERVOS_MAX];
    servo_refusal refusal;
    describe_servos(set, configs);
    const int ticks = period_ticks(set);
    const servo_error error = servo_map_init(&b->map, configs, 2 * set->rod.links_n,
                                             (float)ticks * set->rod.tick_s, &refusal);
    if (error != SERVO_OK) {
        *why = (params_refusal){REASON_COMBINATION,
                                refusal.servo,
                                refusal.value,
                                refusal.min,
                                refusal.max,
                                error == SERVO_E_ID       ? "servo_id"
                                : error == SERVO_E_OFFSET ? "servo_offset"
                                : error == SERVO_E_RANGE  ? "servo_min"
                                                          : "servo_rate",
                                servo_error_text(error)};
        return false;
    }
    b->servo_period_ticks = ticks;
    b->ticks_to_servos = 0;
    servo_blend_none(&b->blend);
    return true;
}

static bool refuse_rod(rod_error error, const rod_refusal *refusal, params_refusal *why)
{
    *why = (params_refusal){
        REASON_COMBINATION,   refusal->joint, refusal->value,
        refusal->min,         refusal->max,   refusal->field != NULL ? refusal->field->name : "",
        rod_error_text(error)};
    return false;
}

bool body_init(body *b, const params_set *set, params_refusal *why)
{
    memset(b, 0, sizeof *b);
    rod_refusal refusal;
    const rod_error error = rod_init(&b->rod, &set->rod, &refusal);
    if (error != ROD_OK) {
        return refuse_rod(error, &refusal, why);
    }
    b->blend_s = set->device.blend_s;
    b->finite = true;
    b->follow = FOLLOW_NOTHING;
    return prepare_servos(b, set, why);
}

bool body_change(body *b, const params_set *set, bool all_new, params_refusal *why)
{
    rod_refusal refusal;
    const rod_params before = *rod_params_of(&b->rod);
    const rod_error error = rod_set_params(&b->rod, &set->rod, &refusal);
    if (error != ROD_OK) {
        return refuse_rod(error, &refusal, why);
    }
    if (all_new && !prepare_servos(b, set, why)) {
        (void)rod_set_params(&b->rod, &before, NULL);
        return false;
    }
    b->blend_s = set->device.blend_s;
    if (!all_new && b->follow == FOLLOW_ROD) {
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
    const float *goals_rad = servo_map_goals(&b->map);
    for (int servo = 0; servo < b->map.servos_n; servo++) {
        const servo_motion *s = &b->map.servo[servo];
        angles_rad[s->joint][s->axis] = (goals_rad[servo] - s->offset_rad) * s->sign;
    }
}
