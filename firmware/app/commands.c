/* commands.c - what each message does to the device, and the answer it gets (PROTOCOL.md, "Rules"). */
#include <string.h>

#include "answers.h"

/* --- link ---------------------------------------------------------------------------------------- */

static void take_hello(device *d, const message_hello *hello, const frame *header)
{
    if (hello->protocol_major != PROTOCOL_MAJOR) {
        answers_refuse_for(d, hello->request_id, MESSAGE_HELLO, REASON_VERSION, NULL);
        return;
    }
    const float hold_s = d->params.in_force.device.pose_hold_ms * 1e-3f;
    if (hello->pose_hz > 0.0f && hello->pose_hz * hold_s < 1.0f) {
        /* refused now, rather than held and released between any two poses */
        const params_refusal why = {
            REASON_POSES_TOO_SLOW,
            -1,
            hello->pose_hz,
            1.0f / hold_s,
            0.0f,
            "pose_hz",
            "slower than the pose_hold parameter allows: resample, or raise it"};
        answers_refuse(d, hello->request_id, MESSAGE_HELLO, &why);
        return;
    }
    if (header->session != d->link.session) { /* a HELLO that is repeated opens nothing again */
        d->link.session = header->session;
        pose_input_open(&d->poses, header->session);
        memset(d->answers, 0, sizeof d->answers);
        params_unstage(&d->params); /* what another tool began and did not finish */
    }
    telemetry_hello(d, hello->request_id);
}

static void take_timesync(device *d, const message_timesync *sync)
{
    const message answer = {
        .type = MESSAGE_TIMESYNC_ANSWER,
        .timesync_answer = {sync->t1_us, d->now_us, d->hal->now_us(d->hal->context)}};
    (void)link_send(&d->link, &answer, d->now_us);
    if (sync->last_known != 0) {
        const clock_exchange exchange = {.sender_sent_us = sync->last_t1_us,
                                         .device_received_us = sync->last_t2_us,
                                         .device_sent_us = sync->last_t3_us,
                                         .sender_received_us = sync->last_t4_us};
        (void)clock_map_exchange(&d->poses.clock, &exchange);
    }
}

static void take_pose(device *d, const message_pose *pose, const frame *header)
{
    const float *p = pose->position_m, *q = pose->quaternion_xyzw;
    const pose_sample sample = {
        .pose = {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}},
        .sent_us = header->t_us,
        .age_us = pose->age_us,
        .seq = header->seq,
        .session = header->session,
    };
    (void)pose_input_receive(&d->poses, &sample, d->now_us);
}

/* --- control ------------------------------------------------------------------------------------- */

static void take_arm(device *d, uint16_t request_id)
{
    if (d->saving.id != 0 || d->servicing.id != 0 || d->arming.id != 0) {
        answers_refuse_for(d, request_id, MESSAGE_ARM, REASON_BUSY,
                           "a SAVE, an ARM or a request to a servo is under way");
        return;
    }
    const pose_stream stream = pose_input_stream(&d->poses);
    if (stream.state == POSE_STREAM_SLOW) {
        const params_refusal why = {
            REASON_POSES_TOO_SLOW,
            -1,
            (float)stream.interval_us * 1e-3f,
            0.0f,
            d->params.in_force.device.pose_hold_ms,
            "pose_hold",
            "ms between poses: more than pose_hold allows; resample, or raise it"};
        answers_refuse(d, request_id, MESSAGE_ARM, &why);
        return;
    }
    const uint32_t poses = stream.state == POSE_STREAM_GOOD ? WHEN_POSES : 0u;
    const char *no = supervisor_no_arm(d->supervisor.state, poses);
    if (no != NULL) {
        const bool latched = d->supervisor.state >= SUPERVISOR_FAULT;
        const uint8_t reason = latched ? REASON_LATCHED
                               : supervisor_no_arm(d->supervisor.state, WHEN_POSES) == NULL
                                   ? REASON_NO_POSES
                                   : REASON_STATE;
        answers_refuse_for(d, request_id, MESSAGE_ARM, reason, no);
        return;
    }
    arming_begin(d, request_id); /* answered when the servos have torque, or cannot have it */
}

static void take_clear(device *d, uint16_t request_id)
{
    if (d->hal->estop_pressed(d->hal->context)) {
        answers_refuse_for(d, request_id, MESSAGE_CLEAR_FAULT, REASON_ESTOP_OPEN, NULL);
        return;
    }
    d->clear = true;
    answers_acknowledge(d, request_id, MESSAGE_CLEAR_FAULT);
}

/* --- all of them ----------------------------------------------------------------------------------- */

/* Whether the message comes from the session of the last HELLO. Whoever wants it to stop is obeyed, from
 * anywhere; strange poses are pose_input's to count. */
static bool in_session(const device *d, const message *m, const frame *header)
{
    static const uint8_t FROM_ANYWHERE[] = {MESSAGE_HELLO, MESSAGE_PING, MESSAGE_POSE,
                                            MESSAGE_DISARM, MESSAGE_ESTOP};
    if (d->link.session != 0 && header->session == d->link.session) {
        return true;
    }
    return memchr(FROM_ANYWHERE, m->type, sizeof FROM_ANYWHERE) != NULL;
}

/* A request that was sent again because its answer takes a while: that will come. */
static bool is_under_way(device *d, uint16_t request_id, uint8_t type)
{
    const device_request *all[] = {&d->saving, &d->arming, &d->servicing};
    for (int i = 0; i < 3; i++) {
        if (request_id != 0 && all[i]->id == request_id && all[i]->type == type) {
            d->commands_repeated++;
            return true;
        }
    }
    return false;
}

void commands_take(device *d, const message *m, const frame *header)
{
    /* every request begins with its id */
    const uint16_t request_id = m->arm.request_id;
    const bool stops = m->type == MESSAGE_DISARM || m->type == MESSAGE_ESTOP; /* every time */
    const bool changes = m->type >= MESSAGE_ARM && m->type <= MESSAGE_SHAPE &&
                         m->type != MESSAGE_PARAM_LIST && m->type != MESSAGE_PARAM_GET &&
                         m->type != MESSAGE_PRESET_LIST && m->type != MESSAGE_SCENE_GET;
    if (!in_session(d, m, header)) {
        if (changes) {
            answers_refuse_for(d, request_id, m->type, REASON_SESSION, NULL);
        }
        return;
    }
    if (changes && !stops && request_id == 0) {
        const params_refusal why = {.reason = REASON_BOUNDS,
                                    .entry = -1,
                                    .min = 1.0f,
                                    .max = (float)UINT16_MAX,
                                    .field = "request_id"};
        answers_refuse(d, request_id, m->type, &why);
        return;
    }
    if (changes && !stops &&
        (is_under_way(d, request_id, m->type) || answers_repeat(d, request_id, m->type))) {
        return;
    }
    switch (m->type) {
    case MESSAGE_HELLO:
        take_hello(d, &m->hello, header);
        break;
    case MESSAGE_PING: {
        const message pong = {.type = MESSAGE_PONG, .pong = {m->ping.token}};
        (void)link_send(&d->link, &pong, d->now_us);
        break;
    }
    case MESSAGE_TIMESYNC:
        take_timesync(d, &m->timesync);
        break;
    case MESSAGE_STATS_GET:
        telemetry_stats(d, m->stats_get.request_id);
        break;
    case MESSAGE_POSE:
        take_pose(d, &m->pose, header);
        break;
    case MESSAGE_ARM:
        take_arm(d, request_id);
        break;
    case MESSAGE_DISARM:
        d->disarm = true;
        answers_acknowledge(d, request_id, MESSAGE_DISARM);
        break;
    case MESSAGE_ESTOP:
        d->estop = true;
        answers_acknowledge(d, request_id, MESSAGE_ESTOP);
        break;
    case MESSAGE_CLEAR_FAULT:
        take_clear(d, request_id);
        break;
    case MESSAGE_REBOOT:
        if (m->reboot.into != REBOOT_FIRMWARE && (d->config.features & FEATURE_BOOTLOADER) == 0) {
            answers_refuse_for(d, request_id, MESSAGE_REBOOT, REASON_UNSUPPORTED, NULL);
        } else {
            d->reboot = (uint8_t)(1 + m->reboot.into);
            answers_acknowledge(d, request_id, MESSAGE_REBOOT);
        }
        break;
    case MESSAGE_PARAM_LIST:
    case MESSAGE_PARAM_GET:
    case MESSAGE_PARAM_SET:
    case MESSAGE_PARAM_COMMIT:
    case MESSAGE_PARAM_SAVE:
    case MESSAGE_PARAM_DEFAULTS:
    case MESSAGE_PRESET_LIST:
    case MESSAGE_PRESET:
        param_commands_take(d, m);
        break;
    case MESSAGE_SERVO_ASSIGN:
    case MESSAGE_SERVO_PING:
    case MESSAGE_SERVO_SET_BAUD:
    case MESSAGE_SERVO_TEST:
        servo_commands_take(d, m);
        break;
    case MESSAGE_SCENE_PUT:
    case MESSAGE_SCENE_GET:
    case MESSAGE_SHAPE:
        scene_commands_take(d, m);
        break;
    default: /* of a kind that only the device sends */
        d->link.counts.unknown++;
        break;
    }
}

void commands_end_tick(device *d)
{
    param_commands_end_tick(d);
    servo_commands_end_tick(d);
    if (d->reboot != 0 && d->link.queue_n == 0 &&
        d->hal->line_free(d->hal->context) == d->link.line_room) { /* the answer is out */
        servos_off(&d->servos);
        d->hal->reboot(d->hal->context);
    }
}
