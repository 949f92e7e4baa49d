/* device.c - see device.h. */
#include "device.h"

#include <string.h>

#include "crc32c.h"
#include "saved_params.h"

static pose_input_params pose_params(const device *d)
{
    const device_params *p = &d->params.in_force.device;
    pose_input_params params = pose_input_defaults();
    params.mode = p->pose_mode > 0.5f ? POSE_INTERPOLATE : POSE_PREDICT;
    params.hold_us = (uint32_t)(p->pose_hold_ms * 1000.0f);
    params.speed_max_mps = p->pose_speed_mps;
    params.turn_max_radps = p->pose_turn_radps;
    return params;
}

bool device_apply_params(device *d, bool all_new, params_refusal *why)
{
    if (!body_change(&d->body, &d->params.in_force, all_new, why)) {
        return false;
    }
    const pose_input_params poses = pose_params(d);
    (void)pose_input_set(&d->poses, &poses);
    d->input.new_params = true;
    d->to_angles_ticks = d->to_nodes_ticks = 0;
    if (d->config.watcher.changed != NULL) {
        d->config.watcher.changed(d->config.watcher.context, &d->params.in_force, all_new);
    }
    return true;
}

/* What flash holds, if it is fit to run. What is not is a fault of this moment, not a lasting one: it can
 * be cleared, and other settings saved. */
static void load_settings(device *d)
{
    uint32_t payload_n, version;
    params_refusal why;
    if (settings_boot(&d->settings, d->hal, saved_params_bytes_max()) == SETTINGS_E_FLASH) {
        faults_raise(&d->faults, FAULT_FLASH);
    }
    const settings_error error = settings_load(&d->settings, d->settings_bytes,
                                               sizeof d->settings_bytes, &payload_n, &version);
    if (error == SETTINGS_E_NONE && d->settings.origin == SETTINGS_NONE) {
        return; /* never saved: the defaults are right */
    }
    if (error != SETTINGS_OK || version != SAVED_PARAMS_VERSION) {
        faults_raise(&d->faults, FAULT_SETTINGS);
        return;
    }
    saved_params_unpack(d->settings_bytes, payload_n, &d->params.staged);
    d->params.staged.rod.tick_s = d->config.tick_s;
    if (!params_commit(&d->params, true, &why)) {
        params_unstage(&d->params);
        faults_raise(&d->faults, FAULT_SETTINGS);
    }
}

void device_init(device *d, const hal *hal, const device_config *config, const hal_boot *boot)
{
    memset(d, 0, sizeof *d);
    d->hal = hal;
    d->config = *config;
    d->boot = *boot;
    d->now_us = hal->now_us(hal->context);
    link_init(&d->link, hal);
    faults_init(&d->faults);
    supervisor_init(&d->supervisor);
    params_init(&d->params);
    d->params.in_force.rod.tick_s = config->tick_s;
    d->params.in_force.rod.links_n = config->links_n;
    d->params.staged = d->params.in_force;
    load_settings(d);
    params_refusal why;
    if (!body_init(&d->body, &d->params.in_force, &why)) {
        /* each part of the saved set was fit, all together are not: the defaults are */
        faults_raise(&d->faults, FAULT_SETTINGS);
        params_init(&d->params);
        d->params.in_force.rod.tick_s = config->tick_s;
        d->params.in_force.rod.links_n = config->links_n;
        d->params.staged = d->params.in_force;
        (void)body_init(&d->body, &d->params.in_force, &why);
    }
    const pose_input_params poses = pose_params(d);
    (void)pose_input_init(&d->poses, &poses, d->now_us);
    if (config->watcher.changed != NULL) {
        config->watcher.changed(config->watcher.context, &d->params.in_force, true);
    }
    telemetry_hello(d, 0);
}

/* What can be checked without moving anything: the checksum and the solver against known answers. */
static bool self_test(void)
{
    static const float DIAGONAL[3] = {4.0f, 5.0f, 6.0f}, OFF1[3] = {0.0f, 1.0f, 2.0f},
                       OFF2[3] = {0.0f, 0.0f, 1.0f};
    penta factor;
    /* A (1, 1, 1) = (6, 8, 9), A (1, 2, 3) = (9, 17, 23) */
    float b[3][2] = {{6.0f, 9.0f}, {8.0f, 17.0f}, {9.0f, 23.0f}};
    if (penta_factor(&factor, 3, DIAGONAL, OFF1, OFF2) != 0) {
        return false;
    }
    penta_solve2(&factor, b);
    for (int i = 0; i < 3; i++) {
        const float error0 = b[i][0] - 1.0f, error1 = b[i][1] - (float)(i + 1);
        if (!(error0 * error0 + error1 * error1 < 1e-9f)) {
            return false;
        }
    }
    return crc32c("123456789", 9) == 0xE3069283u;
}

static void receive(device *d)
{
    message m;
    frame header;
    link_begin_tick(&d->link);
    while (link_receive(&d->link, &m, &header)) {
        commands_take(d, &m, &header);
    }
}

static uint32_t conditions(const device *d)
{
    const pose_stream stream = pose_input_stream(&d->poses);
    const bool relaxed = d->body.follow == FOLLOW_STRAIGHT && servo_blend_done(&d->body.blend) &&
                         servo_map_settled(&d->body.map);
    return (d->estop || d->hal->estop_pressed(d->hal->context) ? WHEN_ESTOP : 0u) |
           (faults_any(&d->faults) ? WHEN_FAULT : 0u) | WHEN_READY |
           (d->self_test_passed ? WHEN_TESTED : 0u) | (d->arm ? WHEN_ARM : 0u) |
           (d->disarm ? WHEN_DISARM : 0u) | (d->clear ? WHEN_CLEAR : 0u) |
           (stream.state == POSE_STREAM_GOOD ? WHEN_POSES : 0u) | (relaxed ? WHEN_RELAXED : 0u);
}

/* Before the servos get torque: their goals are where they are. Hobby servos cannot tell; theirs are
 * straight, and the first move is theirs alone (README, safety table). */
static void place_servos(device *d)
{
    float positions_rad[SERVOS_MAX];
    if (!d->hal->servo_read(d->hal->context, positions_rad, d->body.map.servos_n)) {
        return;
    }
    if (body_place(&d->body, positions_rad) != SERVO_OK) {
        faults_raise(&d->faults, FAULT_SERVO_MAP);
        return;
    }
    d->input.placed = true;
    if (d->config.watcher.placed != NULL) {
        d->config.watcher.placed(d->config.watcher.context, positions_rad, d->body.map.servos_n);
    }
}

/* One step of the states, and what entering a new one asks for. */
static void supervise(device *d)
{
    const supervisor_duty *before = &supervisor_duties[d->supervisor.state];
    if (before->self_test && !d->self_test_passed) {
        d->self_test_passed = self_test();
        faults_set(&d->faults, FAULT_SELF_TEST, !d->self_test_passed);
    }
    faults_set(&d->faults, FAULT_SERVO, !d->hal->servo_healthy(d->hal->context));
    const supervisor_state state = d->supervisor.state;
    const supervisor_rule *rule = supervisor_step(&d->supervisor, conditions(d), d->now_us);
    const supervisor_duty *duty = &supervisor_duties[d->supervisor.state];
    d->arm = d->disarm = d->clear = d->estop = false;
    d->input.follow = (uint8_t)duty->follow;
    if (rule == NULL) {
        return;
    }
    d->input.blend_us = rule->blend_us;
    d->holds += d->supervisor.state == SUPERVISOR_HOLD;
    if (state == SUPERVISOR_FAULT || state == SUPERVISOR_ESTOP) {
        if (d->supervisor.state == SUPERVISOR_DISARMED) {
            faults_clear(&d->faults);
            d->fault_seen = 0;
        }
    }
    if (duty->servo_power && !before->servo_power) {
        place_servos(d);
        d->hal->servo_write(d->hal->context, body_goals(&d->body), d->body.map.servos_n);
    }
    if (duty->servo_power != before->servo_power) {
        d->hal->servo_power(d->hal->context, duty->servo_power);
    }
    telemetry_log(d, d->supervisor.state >= SUPERVISOR_FAULT ? LEVEL_ERROR : LEVEL_INFO, rule->why);
}

static void move(device *d)
{
    d->input.has_base = d->pose.valid;
    d->input.restart = d->pose.restart;
    d->input.base = d->pose.base;
    body_tick(&d->body, &d->input);
    faults_solver(&d->faults, d->body.finite);
    if (d->body.goals_new && d->input.follow != FOLLOW_NOTHING) {
        d->hal->servo_write(d->hal->context, body_goals(&d->body), d->body.map.servos_n);
    }
    for (int i = 0; i < SERVO_LIMITERS_N; i++) {
        d->limited_ticks[i] += d->body.goals_new && (d->body.limited & 1u << i) != 0;
    }
    if (d->config.watcher.ticked != NULL) {
        d->config.watcher.ticked(d->config.watcher.context, &d->input, &d->body);
    }
}

static void check_time(device *d)
{
    const uint32_t taken_us = d->hal->now_us(d->hal->context) - d->now_us;
    d->tick_time_us += taken_us;
    d->ticks_timed_n++;
    d->tick_worst_us = taken_us > d->tick_worst_us ? taken_us : d->tick_worst_us;
    d->tick_max_us = taken_us > d->tick_max_us ? taken_us : d->tick_max_us;
    if ((float)taken_us > d->config.tick_s * 1e6f) {
        d->deadline_misses++;
        faults_raise(&d->faults, FAULT_DEADLINE);
    }
}

void device_tick(device *d)
{
    const uint32_t last_us = d->now_us;
    d->now_us = d->hal->now_us(d->hal->context);
    d->uptime_rest_us += d->now_us - last_us;
    d->uptime_ms += d->uptime_rest_us / 1000u;
    d->uptime_rest_us %= 1000u;
    d->input = (body_input){.follow = d->input.follow};

    receive(d);
    d->pose = pose_input_tick(&d->poses, d->now_us);
    supervise(d);
    faults_end_tick(&d->faults);
    move(d);
    d->solved_us = d->hal->now_us(d->hal->context);
    commands_end_tick(d);
    telemetry_send(d);
    check_time(d);
    d->hal->watchdog_feed(d->hal->context);
    d->tick++;
}
