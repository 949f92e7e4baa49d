/* telemetry.c - what the device sends unasked: HELLO and BOOT_REPORT once, then ANGLES, NODES, POSE_LOG,
 * HEARTBEAT, TOUCH, STATS, FAULT, LOG, each at its own rate. */
#include <string.h>

#include "device.h"

static uint16_t short_us(uint32_t us)
{
    return us < UINT16_MAX ? (uint16_t)us : UINT16_MAX;
}

void telemetry_log(device *d, uint8_t level, const char *text)
{
    message m = {.type = MESSAGE_LOG, .log = {.level = level}};
    link_text(m.log.text, sizeof m.log.text, text);
    (void)link_send(&d->link, &m, d->now_us);
}

void telemetry_servos(device *d)
{
    static const char *const KINDS[] = {[SERVOS_NONE] = "servos: none; ",
                                        [SERVOS_PWM] = "servos: hobby, on PWM; ",
                                        [SERVOS_BUS] = "servos: on a bus; "};
    message m = {.type = MESSAGE_LOG, .log = {.level = LEVEL_INFO}};
    link_text(m.log.text, sizeof m.log.text, KINDS[d->servos.config.kind]);
    link_text_add_number(m.log.text, sizeof m.log.text, (uint32_t)d->body.map.servos_n);
    link_text_add(m.log.text, sizeof m.log.text, " goals every ");
    link_text_add_number(m.log.text, sizeof m.log.text,
                         (uint32_t)(d->body.map.period_s * 1e6f + 0.5f));
    link_text_add(m.log.text, sizeof m.log.text, " us");
    (void)link_send(&d->link, &m, d->now_us);
}

/* Why it last started, and on what settings. */
static void send_boot_report(device *d)
{
    const hal_boot *boot = &d->boot;
    static const uint8_t ORIGINS[] = {
        [SETTINGS_NONE] = ORIGIN_NEVER_SAVED,
        [SETTINGS_NEWEST] = ORIGIN_NEWEST,
        [SETTINGS_OLDER] = ORIGIN_OLDER,
        [SETTINGS_DAMAGED] = ORIGIN_LOST,
    };
    static const uint8_t FAULTS[] = {
        [HAL_FAULT_NONE] = FAULT_CODE_NONE,
        [HAL_FAULT_PROCESSOR] = FAULT_CODE_PROCESSOR,
        [HAL_FAULT_STACK] = FAULT_CODE_CANARY,
        [HAL_FAULT_WATCHDOG] = FAULT_CODE_WATCHDOG,
    };
    const settings *s = &d->settings;
    const message m = {
        .type = MESSAGE_BOOT_REPORT,
        .boot_report = {
            .cause = (uint8_t)boot->cause,
            .fault = boot->cause == HAL_RESET_FAULT ? FAULTS[boot->fault] : FAULT_CODE_NONE,
            .settings = ORIGINS[s->origin],
            .clock = boot->clock_kind,
            .flags = boot->estop_ignored ? BOOT_ESTOP_IGNORED : 0,
            .clock_hz = boot->clock_hz,
            .settings_sequence = s->active >= 0 ? s->sector[s->active].newest.sequence : 0,
            .pc = boot->pc,
            .lr = boot->lr,
            .cfsr = boot->cfsr}};
    (void)link_send(&d->link, &m, d->now_us);
}

static uint32_t features(const device *d)
{
    const bool bus = d->servos.config.kind == SERVOS_BUS;
    return d->config.features | (bus ? FEATURE_SERVO_POSITIONS : 0u);
}

void telemetry_hello(device *d, uint16_t request_id)
{
    const params_set *set = &d->params.in_force;
    message m = {.type = MESSAGE_HELLO,
                 .hello = {.request_id = request_id,
                           .protocol_major = PROTOCOL_MAJOR,
                           .protocol_minor = PROTOCOL_MINOR,
                           .layout_hash = messages_layout_hash(),
                           .features = features(d),
                           .links_max = ROD_MAX_LINKS,
                           .links_n = (uint16_t)set->rod.links_n,
                           .tick_max_hz = d->config.tick_max_hz,
                           .tick_hz = 1.0f / d->config.tick_s,
                           .angles_hz = set->device.angles_hz,
                           .line_baud = d->config.line_baud}};
    link_text(m.hello.device, sizeof m.hello.device, d->config.name);
    link_text(m.hello.build, sizeof m.hello.build, d->config.build);
    (void)link_send(&d->link, &m, d->now_us);
    send_boot_report(d);
    telemetry_servos(d);
}

static int16_t tenth_mrad(float angle_rad)
{
    const float scaled = angle_rad * 10000.0f;
    if (!(scaled >= -32767.0f && scaled <= 32767.0f)) {
        return MESSAGES_ANGLE_INVALID;
    }
    return (int16_t)(scaled < 0.0f ? scaled - 0.5f : scaled + 0.5f);
}

/* The base has been carried on past the newest pose. */
static bool is_predicted(const device *d)
{
    return d->pose.valid && d->params.in_force.device.pose_mode < 0.5f &&
           d->pose.received_us != d->now_us;
}

static void send_angles(device *d)
{
    const int links_n = d->params.in_force.rod.links_n;
    const uint32_t now_us = d->hal->now_us(d->hal->context);
    const uint32_t acted = d->body.limited;
    message m = {.type = MESSAGE_ANGLES,
                 .angles = {.tick = d->tick,
                            .pose_seq = d->pose.seq,
                            .received_ago_us = short_us(now_us - d->pose.received_us),
                            .solved_ago_us = short_us(now_us - d->solved_us),
                            .state = (uint8_t)d->supervisor.state,
                            .angles_n = (uint16_t)links_n}};
    m.angles.flags =
        (uint8_t)((d->body.finite ? 0 : ANGLES_NOT_FINITE) |
                  (acted & SERVO_AT_ANGLE ? ANGLES_LIMITED_ANGLE : 0) |
                  (acted & SERVO_AT_ACCEL ? ANGLES_LIMITED_ACCELERATION : 0) |
                  (acted & SERVO_AT_RATE ? ANGLES_LIMITED_RATE : 0) |
                  (servo_blend_done(&d->body.blend) ? 0 : ANGLES_BLENDING) |
                  (is_predicted(d) ? ANGLES_PREDICTED : 0) | (d->pose.valid ? 0 : ANGLES_NO_POSE));
    for (int i = 0; i < links_n; i++) {
        m.angles.angles_tenth_mrad[i][ROD_THETA] = tenth_mrad(body_angle_rad(&d->body, 2 * i));
        m.angles.angles_tenth_mrad[i][ROD_PHI] = tenth_mrad(body_angle_rad(&d->body, 2 * i + 1));
    }
    (void)link_send(&d->link, &m, now_us);
}

static void send_nodes(device *d)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1];
    const int nodes_n = rod_nodes(&d->body.rod, nodes_m);
    for (int first = 0; first < nodes_n; first += MESSAGES_NODES_MAX) {
        const int left = nodes_n - first;
        message m = {
            .type = MESSAGE_NODES,
            .nodes = {.tick = d->tick,
                      .first_node = (uint16_t)first,
                      .rod_nodes_n = (uint16_t)nodes_n,
                      .nodes_n =
                          (uint16_t)(left < MESSAGES_NODES_MAX ? left : MESSAGES_NODES_MAX)}};
        for (int i = 0; i < m.nodes.nodes_n; i++) {
            m.nodes.nodes_m[i][0] = nodes_m[first + i].x;
            m.nodes.nodes_m[i][1] = nodes_m[first + i].y;
            m.nodes.nodes_m[i][2] = nodes_m[first + i].z;
        }
        (void)link_send(&d->link, &m, d->now_us);
    }
}

static void send_pose_log(device *d)
{
    const vec3 p = d->input.base.position_m;
    const quat q = d->input.base.orientation;
    const message m = {.type = MESSAGE_POSE_LOG,
                       .pose_log = {.tick = d->tick,
                                    .position_m = {p.x, p.y, p.z},
                                    .quaternion_xyzw = {q.x, q.y, q.z, q.w},
                                    .params_generation = d->params.generation,
                                    .state = (uint8_t)d->supervisor.state,
                                    .flags = (uint8_t)((d->input.restart ? POSE_LOG_RESTART : 0) |
                                                       (d->pose_log_gap ? POSE_LOG_GAP : 0))}};
    d->pose_log_gap = !link_send(&d->link, &m, d->now_us);
}

static void send_heartbeat(device *d)
{
    const pose_stream stream = pose_input_stream(&d->poses);
    const supervisor_duty *duty = &supervisor_duties[d->supervisor.state];
    const message m = {
        .type = MESSAGE_HEARTBEAT,
        .heartbeat = {
            .state = (uint8_t)d->supervisor.state,
            .fault = (uint8_t)(d->faults.first + 1),
            .flags = (uint8_t)((duty->servo_power ? HEARTBEAT_TORQUE : 0) |
                               (d->hal->estop_pressed(d->hal->context) ? HEARTBEAT_ESTOP_OPEN : 0) |
                               (d->params.is_staged ? HEARTBEAT_STAGED : 0) |
                               (d->unsaved ? HEARTBEAT_UNSAVED : 0) |
                               (stream.state == POSE_STREAM_GOOD ? HEARTBEAT_POSES_GOOD : 0) |
                               (d->poses.clock.synced ? HEARTBEAT_CLOCK_KNOWN : 0)),
            .uptime_ms = d->uptime_ms,
            .tick = d->tick,
            .params_generation = d->params.generation,
            .tick_mean_us = short_us(d->ticks_timed_n > 0 ? d->tick_time_us / d->ticks_timed_n : 0),
            .tick_max_us = short_us(d->tick_worst_us)}};
    d->tick_time_us = d->ticks_timed_n = d->tick_worst_us = 0;
    (void)link_send(&d->link, &m, d->now_us);
}

static void send_rod_stats(device *d, uint16_t request_id)
{
    const message m = {
        .type = MESSAGE_ROD_STATS,
        .rod_stats = {.request_id = request_id, .lengths_restored = rod_restored_n(&d->body.rod)}};
    (void)link_send(&d->link, &m, d->now_us);
}

void telemetry_stats(device *d, uint16_t request_id)
{
    send_rod_stats(d, request_id);
    const frame_counts *f = &d->link.decoder.counts;
    const link_counts *l = &d->link.counts;
    const uint32_t *verdicts = d->poses.count;
    const message m = {.type = MESSAGE_STATS,
                       .stats = {.request_id = request_id,
                                 .uptime_ms = d->uptime_ms,
                                 .frames_good = f->good,
                                 .frames_crc = f->crc,
                                 .frames_cobs = f->cobs,
                                 .frames_too_short = f->too_short,
                                 .frames_too_long = f->too_long,
                                 .messages_unknown = l->unknown,
                                 .messages_length = l->length,
                                 .poses_accepted = verdicts[POSE_ACCEPTED],
                                 .poses_duplicate = verdicts[POSE_DUPLICATE],
                                 .poses_late = verdicts[POSE_LATE],
                                 .poses_lost = d->poses.sequence.lost,
                                 .poses_wrong_session = verdicts[POSE_WRONG_SESSION],
                                 .poses_stale = verdicts[POSE_STALE],
                                 .poses_future = verdicts[POSE_FUTURE],
                                 .poses_not_finite = verdicts[POSE_NOT_FINITE],
                                 .poses_bad_quaternion = verdicts[POSE_BAD_QUATERNION],
                                 .poses_teleport = verdicts[POSE_TELEPORT],
                                 .poses_too_fast = verdicts[POSE_TOO_FAST],
                                 .commands_done = d->commands_done,
                                 .commands_refused = d->commands_refused,
                                 .commands_repeated = d->commands_repeated,
                                 .deadline_misses = d->deadline_misses,
                                 .solver_not_finite = d->faults.solver_failures,
                                 .limited_angle = d->limited_ticks[1],
                                 .limited_acceleration = d->limited_ticks[2],
                                 .limited_rate = d->limited_ticks[3],
                                 .holds = d->holds,
                                 .servo_errors = d->faults.counts[FAULT_SERVO],
                                 .line_overruns = d->hal->line_overruns(d->hal->context),
                                 .line_framing = d->hal->line_framing_errors(d->hal->context),
                                 .dropped_logs = l->dropped[MESSAGE_DROP_LOGS],
                                 .dropped_telemetry = l->dropped[MESSAGE_DROP_TELEMETRY],
                                 .dropped_nodes = l->dropped[MESSAGE_DROP_NODES],
                                 .dropped_angles = l->dropped[MESSAGE_DROP_ANGLES],
                                 .answers_lost = l->answers_lost,
                                 .clock_exchanges = d->poses.clock.used,
                                 .clock_left_out = d->poses.clock.left_out,
                                 .clock_jumps = d->poses.clock.jumps,
                                 .tick_max_us = d->tick_max_us}};
    (void)link_send(&d->link, &m, d->now_us);
}

/* While anything touches, and once more when nothing does. */
static void send_touch(device *d)
{
    vec3 force;
    const int contacts_n = body_touch(&d->body, BODY_ANY_OBJECT, &force);
    if (contacts_n == 0 && !d->touch_told) {
        return;
    }
    const message m = {.type = MESSAGE_TOUCH,
                       .touch = {d->tick, (uint16_t)contacts_n, {force.x, force.y, force.z}}};
    if (link_send(&d->link, &m, d->now_us)) {
        d->touch_told = contacts_n > 0;
    }
}

/* Each cause is told once, when it comes. */
static void send_faults(device *d)
{
    const uint32_t new_causes = d->faults.latched & ~d->fault_seen;
    for (int cause = 0; cause < FAULT_CAUSES_N; cause++) {
        if ((new_causes & 1u << cause) != 0) {
            message m = {.type = MESSAGE_FAULT,
                         .fault = {.fault = (uint8_t)(cause + 1),
                                   .state = (uint8_t)d->supervisor.state,
                                   .tick = d->tick}};
            link_text(m.fault.text, sizeof m.fault.text, fault_infos[cause].text);
            if (cause == FAULT_SERVO) {
                m.fault.detail = d->servos.trouble.id;
                arming_trouble(d, m.fault.text, sizeof m.fault.text);
            }
            (void)link_send(&d->link, &m, d->now_us);
        }
    }
    d->fault_seen |= new_causes;
}

/* True once every period; a rate of 0 is never. */
static bool is_due(const device *d, uint32_t *ticks_left, float rate_hz)
{
    if (!(rate_hz > 0.0f)) {
        return false;
    }
    if (*ticks_left > 0) {
        (*ticks_left)--;
        return false;
    }
    const float ticks = 1.0f / (rate_hz * d->config.tick_s);
    *ticks_left = ticks > 1.0f ? (uint32_t)(ticks + 0.5f) - 1u : 0u;
    return true;
}

void telemetry_send(device *d)
{
    const device_params *p = &d->params.in_force.device;
    send_faults(d);
    if (is_due(d, &d->to_angles_ticks, p->angles_hz)) {
        send_angles(d);
    }
    if (is_due(d, &d->to_nodes_ticks, p->nodes_hz)) {
        send_nodes(d);
    }
    if (p->pose_log > 0.5f && d->input.has_base) {
        send_pose_log(d);
    }
    if (is_due(d, &d->to_heartbeat_ticks, 10.0f)) {
        send_heartbeat(d);
        send_touch(d);
    }
    if (is_due(d, &d->to_stats_ticks, 1.0f)) {
        telemetry_stats(d, 0);
    }
}
