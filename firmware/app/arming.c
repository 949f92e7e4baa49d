/* arming.c - from an ARM to torque. The servos are looked for first, while they have none: only when all of
 * them have answered and the goals are where they are do the states hear of the ARM. */
#include "answers.h"

void arming_trouble(const device *d, char *text, size_t room)
{
    const servo_trouble *trouble = &d->servos.trouble;
    link_text(text, room, "");
    if (trouble->servo >= 0) {
        link_text_add(text, room, "servo ");
        link_text_add_number(text, room, trouble->id);
        link_text_add(text, room, " (joint ");
        link_text_add_number(text, room, (uint32_t)trouble->servo / 2u + 1u);
        link_text_add(text, room, trouble->servo % 2 == 0 ? ", theta) " : ", phi) ");
    }
    link_text_add(text, room, servo_trouble_text(trouble->kind));
}

static void refuse(device *d, uint8_t reason, const char *text)
{
    servos_off(&d->servos);
    answers_refuse_for(d, d->arming.id, MESSAGE_ARM, reason, text);
    d->arming.id = 0;
}

void arming_begin(device *d, uint16_t request_id)
{
    d->arming = (device_request){request_id, MESSAGE_ARM};
    servos_prepare(&d->servos, d->now_us);
}

/* The goals are where the servos are. Hobby servos cannot tell; theirs are straight, and the first move is theirs
 * alone (README, safety table). */
static bool place(device *d)
{
    float positions_rad[SERVOS_MAX];
    if (!servos_positions(&d->servos, positions_rad)) {
        return true;
    }
    if (body_place(&d->body, positions_rad) != SERVO_OK) {
        return false;
    }
    d->input.placed = true;
    if (d->config.watcher.placed != NULL) {
        d->config.watcher.placed(d->config.watcher.context, positions_rad, d->body.map.servos_n);
    }
    return true;
}

void arming_before_states(device *d)
{
    char text[MESSAGES_TEXT_MAX + 1];
    if (d->arming.id == 0) {
        return;
    }
    switch (d->servos.state) {
    case SERVOS_ON: /* out of RELAX: they have torque and their goals are known */
        d->arm = true;
        break;
    case SERVOS_PREPARED:
        if (place(d)) {
            d->arm = true;
        } else {
            faults_raise(&d->faults, FAULT_SERVO_MAP);
            refuse(d, REASON_SERVO, fault_infos[FAULT_SERVO_MAP].text);
        }
        break;
    case SERVOS_PREPARING:
        break;
    case SERVOS_FAILED:
        arming_trouble(d, text, sizeof text);
        refuse(d, servo_commands_reason(d->servos.trouble.kind), text);
        break;
    default: /* something has switched them off in between */
        refuse(d, REASON_STATE, "stopped before the servos were ready");
        break;
    }
}

void arming_after_states(device *d)
{
    if (!d->arm || d->arming.id == 0) {
        return;
    }
    if (d->supervisor.state == SUPERVISOR_ARMING) {
        answers_acknowledge(d, d->arming.id, MESSAGE_ARM);
        d->arming.id = 0;
    } else {
        const pose_stream stream = pose_input_stream(&d->poses);
        const uint32_t poses = stream.state == POSE_STREAM_GOOD ? WHEN_POSES : 0u;
        const char *no = supervisor_no_arm(d->supervisor.state, poses);
        refuse(d, REASON_STATE, no != NULL ? no : "stopped before the servos were ready");
    }
}
