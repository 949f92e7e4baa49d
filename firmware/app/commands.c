/* commands.c - what each message does to the device, and the answer it gets (PROTOCOL.md, "Rules"). */
#include <string.h>

#include "device.h"
#include "saved_params.h"

static void copy_text(char *to, size_t room, const char *from)
{
    size_t n = strlen(from);
    n = n < room ? n : room - 1;
    memcpy(to, from, n);
    to[n] = '\0';
}

/* Sends ACK or NACK (reason 0 is an ACK), and keeps it for when the request comes again. */
static void answer(device *d, const message_nack *nack)
{
    message m = {.type = MESSAGE_NACK, .nack = *nack};
    if (nack->reason == 0) {
        m = (message){.type = MESSAGE_ACK, .ack = {nack->request_id, nack->answered}};
    }
    (void)link_send(&d->link, &m, d->now_us);
}

static void keep_answer(device *d, const message_nack *nack)
{
    d->answers[d->answers_next] = *nack;
    d->answers_next = (d->answers_next + 1) % DEVICE_ANSWERS_KEPT_N;
}

static void acknowledge(device *d, uint16_t request_id, uint8_t type)
{
    const message_nack ack = {.request_id = request_id, .answered = type};
    keep_answer(d, &ack);
    d->commands_done++;
    answer(d, &ack);
}

static void refuse(device *d, uint16_t request_id, uint8_t type, const params_refusal *why)
{
    message_nack nack = {.request_id = request_id,
                         .answered = type,
                         .reason = why->reason,
                         .entry = (int16_t)why->entry,
                         .value = why->value,
                         .minimum = why->min,
                         .maximum = why->max};
    copy_text(nack.field, sizeof nack.field, why->field != NULL ? why->field : "");
    copy_text(nack.text, sizeof nack.text,
              why->text != NULL ? why->text
                                : message_value_meaning(&message_values_reasons, why->reason));
    keep_answer(d, &nack);
    d->commands_refused++;
    answer(d, &nack);
}

/* Requests that change something are done once, however often they arrive: the same answer again. */
static bool repeated(device *d, uint16_t request_id, uint8_t type)
{
    for (int i = 0; i < DEVICE_ANSWERS_KEPT_N; i++) {
        const message_nack *before = &d->answers[i];
        if (before->request_id == request_id && before->answered == type && request_id != 0) {
            d->commands_repeated++;
            answer(d, before);
            return true;
        }
    }
    return false;
}

static void refuse_for(device *d, uint16_t request_id, uint8_t type, uint8_t reason,
                       const char *text)
{
    const params_refusal why = {.reason = reason, .entry = -1, .field = "", .text = text};
    refuse(d, request_id, type, &why);
}

/* --- link ---------------------------------------------------------------------------------------- */

static void take_hello(device *d, const message_hello *hello, const frame *header)
{
    if (hello->protocol_major != PROTOCOL_MAJOR) {
        refuse_for(d, hello->request_id, MESSAGE_HELLO, REASON_VERSION, NULL);
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
        refuse(d, hello->request_id, MESSAGE_HELLO, &why);
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
    if (d->save_request != 0) {
        refuse_for(d, request_id, MESSAGE_ARM, REASON_BUSY, "a SAVE is under way");
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
        refuse(d, request_id, MESSAGE_ARM, &why);
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
        refuse_for(d, request_id, MESSAGE_ARM, reason, no);
        return;
    }
    d->arm = true;
    acknowledge(d, request_id, MESSAGE_ARM);
}

static void take_clear(device *d, uint16_t request_id)
{
    if (d->hal->estop_pressed(d->hal->context)) {
        refuse_for(d, request_id, MESSAGE_CLEAR_FAULT, REASON_ESTOP_OPEN, NULL);
        return;
    }
    d->clear = true;
    acknowledge(d, request_id, MESSAGE_CLEAR_FAULT);
}

/* --- parameters ---------------------------------------------------------------------------------- */

static void take_param_list(device *d, const message_param_list *list)
{
    params_info info;
    if (!params_describe(&d->params.in_force, list->index, &info)) {
        refuse_for(d, list->request_id, MESSAGE_PARAM_LIST, REASON_INDEX, NULL);
        return;
    }
    message m = {.type = MESSAGE_PARAM_INFO,
                 .param_info = {.request_id = list->request_id,
                                .index = list->index,
                                .params_n = (uint16_t)params_count(),
                                .entries_n = info.entries_n,
                                .kind = info.kind,
                                .flags = info.flags,
                                .minimum = info.min,
                                .maximum = info.max,
                                .initial = info.initial}};
    copy_text(m.param_info.name, sizeof m.param_info.name, info.name);
    copy_text(m.param_info.unit, sizeof m.param_info.unit, info.unit);
    copy_text(m.param_info.text, sizeof m.param_info.text, info.what);
    for (int i = 0; info.choices != NULL && i <= (int)info.max; i++) {
        const size_t used = strlen(m.param_info.text);
        copy_text(m.param_info.text + used, sizeof m.param_info.text - used, i == 0 ? " [" : "|");
        const size_t then = strlen(m.param_info.text);
        copy_text(m.param_info.text + then, sizeof m.param_info.text - then, info.choices[i]);
    }
    if (info.choices != NULL) {
        const size_t used = strlen(m.param_info.text);
        copy_text(m.param_info.text + used, sizeof m.param_info.text - used, "]");
    }
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_param_get(device *d, const message_param_get *get)
{
    const params_set *set = get->which == PARAM_STAGED ? &d->params.staged : &d->params.in_force;
    params_info info;
    const int index = params_find(get->name);
    if (!params_describe(set, index, &info)) {
        const params_refusal why = {.reason = REASON_NAME, .entry = -1, .field = get->name};
        refuse(d, get->request_id, MESSAGE_PARAM_GET, &why);
        return;
    }
    message m = {.type = MESSAGE_PARAM_VALUE,
                 .param_value = {.request_id = get->request_id, .which = get->which}};
    copy_text(m.param_value.name, sizeof m.param_value.name, info.name);
    m.param_value.values_n = info.entries_n;
    for (int entry = 0; entry < info.entries_n; entry++) {
        m.param_value.values[entry] = params_get(set, index, entry);
    }
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_param_set(device *d, const message_param_set *set)
{
    params_refusal why;
    if (params_stage(&d->params, set->name, set->first, set->values, set->values_n, &why)) {
        acknowledge(d, set->request_id, MESSAGE_PARAM_SET);
    } else {
        refuse(d, set->request_id, MESSAGE_PARAM_SET, &why);
    }
}

/* What is staged is in force from this tick on, or not at all. */
static void commit(device *d, uint16_t request_id, uint8_t type)
{
    const bool all_allowed = supervisor_duties[d->supervisor.state].change_all;
    const params_set before = d->params.in_force;
    params_refusal why;
    if (!params_commit(&d->params, all_allowed, &why)) {
        refuse(d, request_id, type, &why);
        return;
    }
    if (!device_apply_params(d, all_allowed, &why)) {
        d->params.staged = d->params.in_force; /* still staged, not in force */
        d->params.in_force = before;
        d->params.is_staged = true;
        refuse(d, request_id, type, &why);
        return;
    }
    d->unsaved = true;
    acknowledge(d, request_id, type);
}

static void take_preset(device *d, const message_preset *preset)
{
    params_refusal why;
    const params_set staged = d->params.staged;
    if (!params_stage_preset(&d->params, preset->name, &why)) {
        refuse(d, preset->request_id, MESSAGE_PRESET, &why);
        return;
    }
    const uint32_t generation = d->params.generation;
    commit(d, preset->request_id, MESSAGE_PRESET);
    if (d->params.generation == generation) {
        d->params.staged = staged; /* refused: nothing has happened */
    }
}

static void take_preset_list(device *d, const message_preset_list *list)
{
    if (list->index >= ROD_PRESETS_N) {
        refuse_for(d, list->request_id, MESSAGE_PRESET_LIST, REASON_INDEX, NULL);
        return;
    }
    message m = {.type = MESSAGE_PRESET_INFO,
                 .preset_info = {list->request_id, list->index, ROD_PRESETS_N, "", ""}};
    copy_text(m.preset_info.name, sizeof m.preset_info.name, rod_presets[list->index].name);
    copy_text(m.preset_info.text, sizeof m.preset_info.text, rod_presets[list->index].what);
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_save(device *d, uint16_t request_id)
{
    if (!supervisor_duties[d->supervisor.state].save) {
        refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_STATE, "only while DISARMED");
    } else if (d->save_request != 0) {
        refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_BUSY, NULL);
    } else {
        const uint32_t bytes_n = saved_params_pack(&d->params.in_force, d->settings_bytes);
        const settings_error error =
            settings_save_begin(&d->settings, SAVED_PARAMS_VERSION, d->settings_bytes, bytes_n);
        if (error < 0) {
            refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_FLASH, settings_error_text(error));
        } else {
            d->save_request = request_id; /* answered when it is done: commands_end_tick */
        }
    }
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

void commands_take(device *d, const message *m, const frame *header)
{
    /* every request begins with its id */
    const uint16_t request_id = m->arm.request_id;
    const bool changes = m->type >= MESSAGE_ARM && m->type <= MESSAGE_SERVO_ASSIGN &&
                         m->type != MESSAGE_PARAM_LIST && m->type != MESSAGE_PARAM_GET &&
                         m->type != MESSAGE_PRESET_LIST;
    if (!in_session(d, m, header)) {
        if (changes) {
            refuse_for(d, request_id, m->type, REASON_SESSION, NULL);
        }
        return;
    }
    if (changes && m->type != MESSAGE_ESTOP && repeated(d, request_id, m->type)) {
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
        acknowledge(d, request_id, MESSAGE_DISARM);
        break;
    case MESSAGE_ESTOP:
        d->estop = true;
        acknowledge(d, request_id, MESSAGE_ESTOP);
        break;
    case MESSAGE_CLEAR_FAULT:
        take_clear(d, request_id);
        break;
    case MESSAGE_REBOOT:
        if (m->reboot.into != REBOOT_FIRMWARE && (d->config.features & FEATURE_BOOTLOADER) == 0) {
            refuse_for(d, request_id, MESSAGE_REBOOT, REASON_UNSUPPORTED, NULL);
        } else {
            d->reboot = (uint8_t)(1 + m->reboot.into);
            acknowledge(d, request_id, MESSAGE_REBOOT);
        }
        break;
    case MESSAGE_PARAM_LIST:
        take_param_list(d, &m->param_list);
        break;
    case MESSAGE_PARAM_GET:
        take_param_get(d, &m->param_get);
        break;
    case MESSAGE_PARAM_SET:
        take_param_set(d, &m->param_set);
        break;
    case MESSAGE_PARAM_COMMIT:
        commit(d, request_id, MESSAGE_PARAM_COMMIT);
        break;
    case MESSAGE_PARAM_SAVE:
        take_save(d, request_id);
        break;
    case MESSAGE_PARAM_DEFAULTS:
        params_stage_defaults(&d->params);
        acknowledge(d, request_id, MESSAGE_PARAM_DEFAULTS);
        break;
    case MESSAGE_PRESET_LIST:
        take_preset_list(d, &m->preset_list);
        break;
    case MESSAGE_PRESET:
        take_preset(d, &m->preset);
        break;
    case MESSAGE_SERVO_ASSIGN:
        refuse_for(d, request_id, m->type, REASON_UNSUPPORTED, NULL);
        break;
    default: /* of a kind that only the device sends */
        d->link.counts.unknown++;
        break;
    }
}

void commands_end_tick(device *d)
{
    if (d->save_request != 0) {
        const settings_error error = settings_save_step(&d->settings);
        if (error != SETTINGS_BUSY) {
            const uint16_t request_id = d->save_request;
            d->save_request = 0;
            if (error == SETTINGS_E_FLASH || error == SETTINGS_E_READ_BACK) {
                faults_raise(&d->faults, FAULT_FLASH);
            }
            if (error == SETTINGS_OK) {
                d->unsaved = false;
                acknowledge(d, request_id, MESSAGE_PARAM_SAVE);
            } else {
                refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_FLASH,
                           settings_error_text(error));
            }
        }
    }
    if (d->reboot != 0 && d->link.queue_n == 0 &&
        d->hal->line_free(d->hal->context) == d->link.line_room) { /* the answer is out */
        d->hal->servo_power(d->hal->context, false);
        d->hal->reboot(d->hal->context);
    }
}
