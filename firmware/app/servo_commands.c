/* servo_commands.c - provisioning servos over the wire (PROTOCOL.md, SERVO_PING to SERVO_TEST): one request to one
 * servo at a time, only while DISARMED; answered when the servo has: SERVO_PING by SERVO_INFO, the others by ACK,
 * which is kept for when they are asked again. */
#include <string.h>

#include "answers.h"

uint8_t servo_commands_reason(uint8_t trouble_kind)
{
    switch (trouble_kind) {
    case SERVO_TROUBLE_SILENT:
        return REASON_SERVO_SILENT;
    case SERVO_TROUBLE_GARBLED:
        return REASON_SERVO_GARBLED;
    case SERVO_TROUBLE_HARDWARE:
        return REASON_SERVO_HARDWARE;
    case SERVO_TROUBLE_BAUD:
    case SERVO_TROUBLE_CHANNEL:
        return REASON_SERVO_BEYOND;
    default:
        return REASON_SERVO;
    }
}

static servo_request translate(const message *m)
{
    switch (m->type) {
    case MESSAGE_SERVO_ASSIGN:
        return (servo_request){.kind = SERVO_REQUEST_ID,
                               .id = m->servo_assign.old_id,
                               .new_id = m->servo_assign.new_id,
                               .baud = m->servo_assign.baud};
    case MESSAGE_SERVO_SET_BAUD:
        return (servo_request){.kind = SERVO_REQUEST_BAUD,
                               .id = m->servo_set_baud.id,
                               .baud = m->servo_set_baud.baud,
                               .new_baud = m->servo_set_baud.new_baud};
    case MESSAGE_SERVO_TEST:
        return (servo_request){.kind = SERVO_REQUEST_TEST,
                               .id = m->servo_test.id,
                               .baud = m->servo_test.baud,
                               .turn_rad = m->servo_test.turn_rad};
    default:
        return (servo_request){
            .kind = SERVO_REQUEST_PING, .id = m->servo_ping.id, .baud = m->servo_ping.baud};
    }
}

/* What can be said without asking the servo. */
static bool check(device *d, const message *m, const servo_request *request)
{
    params_refusal why = {.reason = REASON_BOUNDS, .entry = -1};
    if (d->supervisor.state != SUPERVISOR_DISARMED) {
        why.reason = d->supervisor.state >= SUPERVISOR_FAULT ? REASON_LATCHED : REASON_STATE;
        why.text = "servos are set up while DISARMED only";
    } else if (d->saving.id != 0 || d->arming.id != 0 || d->servicing.id != 0) {
        why.reason = REASON_BUSY;
    } else if (d->params.in_force.device.servo_kind < 0.5f) {
        why.reason = REASON_UNSUPPORTED;
        why.field = "servo_kind";
        why.text = "the servo_kind parameter says that there are none: set it to bus or pwm";
    } else if (d->servos.config.kind == SERVOS_PWM &&
               (request->kind == SERVO_REQUEST_ID || request->kind == SERVO_REQUEST_BAUD)) {
        why.reason = REASON_UNSUPPORTED;
        why.field = "servo_kind";
        why.text = "hobby servos have no id and no baud rate";
    } else if (request->id > SERVO_ID_MAX || request->new_id > SERVO_ID_MAX) {
        const bool new_one = request->new_id > SERVO_ID_MAX;
        why.value = new_one ? (float)request->new_id : (float)request->id;
        why.max = (float)SERVO_ID_MAX;
        why.field = new_one ? "new_id" : "id";
    } else if (!(request->turn_rad >= -0.5f && request->turn_rad <= 0.5f)) {
        why.value = request->turn_rad;
        why.min = -0.5f;
        why.max = 0.5f;
        why.field = "turn_rad";
    } else {
        return true;
    }
    answers_refuse(d, m->servo_ping.request_id, m->type, &why);
    return false;
}

void servo_commands_take(device *d, const message *m)
{
    const servo_request request = translate(m);
    if (!check(d, m, &request)) {
        return;
    }
    if (servos_request(&d->servos, &request, d->now_us)) {
        d->servicing = (device_request){m->servo_ping.request_id, m->type};
    } else {
        answers_refuse_for(d, m->servo_ping.request_id, m->type, REASON_BUSY, NULL);
    }
}

static void tell(device *d, uint16_t request_id, const servo_info *info)
{
    const message m = {.type = MESSAGE_SERVO_INFO,
                       .servo_info = {.request_id = request_id,
                                      .id = info->id,
                                      .firmware = info->firmware,
                                      .model = info->model,
                                      .baud = info->baud,
                                      .hardware_error = info->hardware_error,
                                      .position_rad = info->position_rad,
                                      .supply_v = info->supply_v,
                                      .temperature_c = info->temperature_c}};
    d->commands_done++;
    (void)link_send(&d->link, &m, d->now_us);
}

void servo_commands_end_tick(device *d)
{
    servo_info info;
    servo_trouble trouble;
    if (d->servicing.id == 0) {
        return;
    }
    const servo_request_state state = servos_answer(&d->servos, &info, &trouble);
    if (state == SERVO_REQUEST_BUSY) {
        return;
    }
    const device_request request = d->servicing;
    d->servicing.id = 0;
    if (state == SERVO_REQUEST_DONE && request.type == MESSAGE_SERVO_PING) {
        tell(d, request.id, &info);
        return;
    }
    if (state == SERVO_REQUEST_DONE) {
        answers_acknowledge(d, request.id, request.type);
        return;
    }
    const bool failed = state == SERVO_REQUEST_FAILED; /* else: stopped in between */
    const params_refusal why = {.reason =
                                    failed ? servo_commands_reason(trouble.kind) : REASON_STATE,
                                .entry = -1,
                                .value = failed ? (float)trouble.detail : 0.0f,
                                .field = "",
                                .text = failed ? servo_trouble_text(trouble.kind)
                                               : "stopped before the servo had answered"};
    answers_refuse(d, request.id, request.type, &why);
}
