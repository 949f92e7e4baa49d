/* device.c - see device.h. */
#include "device.h"

#include <string.h>

#include "crc32c.h"
#include "saved_params.h"
#include "servo_setup.h"
#include "tick_budget.h"

static pose_input_params pose_params(const device_params *p)
{
    pose_input_params params = pose_input_defaults();
    params.mode = p->pose_mode > 0.5f ? POSE_INTERPOLATE : POSE_PREDICT;
    params.hold_us = (uint32_t)(p->pose_hold_ms * 1000.0f);
    params.speed_max_mps = p->pose_speed_mps;
    params.turn_max_radps = p->pose_turn_radps;
    return params;
}

static void configure_servos(device *d, const params_set *set)
{
    servos_config config;
    servo_setup_hardware(set, &config);
    servos_configure(&d->servos, d->hal, &config);
}

bool device_apply_params(device *d, const params_set *set, bool all_new, params_refusal *why)
{
    if (!body_change(&d->body, set, all_new, why)) {
        return false;
    }
    if (all_new) {
        configure_servos(d, set);
    }
    const pose_input_params poses = pose_params(&set->device);
    (void)pose_input_set(&d->poses, &poses);
    d->input.new_params = true;
    d->to_angles_ticks = d->to_nodes_ticks = 0;
    if (d->config.watcher.changed != NULL) {
        d->config.watcher.changed(d->config.watcher.context, set, all_new);
    }
    return true;
}

/* The table's defaults, but for what this device was built with. */
static void default_params(device *d)
{
    params_init(&d->params);
    d->params.in_force.rod.tick_s = d->config.tick_s;
    d->params.in_force.rod.links_n = d->config.links_n;
    d->params.in_force.device.servo_kind = (float)d->config.servos_kind;
    d->params.staged = d->params.in_force;
}

/* What flash holds, if it is fit to run. What is not is a fault of this moment, not a lasting one: it can
 * be cleared, and other settings saved. */
static void load_settings(device *d)
{
    uint32_t payload_n, version;
    static const tick_load NOTHING_MORE = {0, false}; /* scene and shape do not outlive a start */
    params_refusal why;
    char text[MESSAGES_TEXT_MAX + 1];
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
    if (!params_commit(&d->params, true, &why) ||
        !tick_budget_check(&d->params.in_force, &NOTHING_MORE, d->boot.clock_hz, text, &why)) {
        telemetry_log(d, LEVEL_ERROR, why.text);
        default_params(d);
        faults_raise(&d->faults, FAULT_SETTINGS);
    }
}

/* Whatever made the firmware restart itself is a fault now: somebody must have seen it before the servos get torque
 * again. */
static void raise_boot_faults(device *d)
{
    const hal_boot *boot = &d->boot;
    if (boot->cause == HAL_RESET_WATCHDOG) {
        faults_raise(&d->faults, FAULT_WATCHDOG);
    }
    if (boot->cause == HAL_RESET_FAULT) {
        faults_raise(&d->faults, boot->fault == HAL_FAULT_STACK      ? FAULT_CANARY
                                 : boot->fault == HAL_FAULT_WATCHDOG ? FAULT_WATCHDOG
                                                                     : FAULT_PROCESSOR);
    }
    if (boot->clock_kind == CLOCK_INTERNAL) {
        faults_raise(&d->faults, FAULT_CLOCK);
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
    raise_boot_faults(d);
    default_params(d);
    load_settings(d);
    params_refusal why;
    if (!body_init(&d->body, &d->params.in_force, &why)) {
        /* each part of the saved set was fit, all together are not: the defaults are */
        faults_raise(&d->faults, FAULT_SETTINGS);
        default_params(d);
        (void)body_init(&d->body, &d->params.in_force, &why);
    }
    configure_servos(d, &d->params.in_force);
    const pose_input_params poses = pose_params(&d->params.in_force.device);
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
    d->checked_in = CHECKED_RECEIVE;
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

/* What entering a new state asks for. */
static void change_state(device *d, supervisor_state before, const supervisor_rule *rule)
{
    const supervisor_state state = d->supervisor.state;
    d->blend_due_us = rule->blend_us;
    d->holds += state == SUPERVISOR_HOLD;
    if (before >= SUPERVISOR_FAULT && state == SUPERVISOR_DISARMED) {
        faults_clear(&d->faults);
        d->fault_seen = 0;
    }
    if (supervisor_duties[state].servo_power) {
        servos_torque(&d->servos, body_goals(&d->body), d->now_us);
    } else {
        servos_off(&d->servos);
    }
    telemetry_log(d, state >= SUPERVISOR_FAULT ? LEVEL_ERROR : LEVEL_INFO, rule->why);
}

/* What the body follows in this tick. Torque comes to a bus of servos in several packets: until the last of them is
 * in force the goals stand still where the servos are, and only then does the state's time begin, with its blend. */
static void choose_follow(device *d)
{
    const bool moves = supervisor_duties[d->supervisor.state].servo_power;
    d->input.follow = (uint8_t)supervisor_duties[d->supervisor.state].follow;
    if (moves && !servos_started(&d->servos)) {
        d->input.follow = FOLLOW_HOLD;
        supervisor_start_over(&d->supervisor);
        return;
    }
    d->input.blend_us = d->blend_due_us;
    d->blend_due_us = 0;
}

/* One step of the states. */
static void supervise(device *d)
{
    const supervisor_duty *before = &supervisor_duties[d->supervisor.state];
    if (before->self_test && !d->self_test_passed) {
        d->self_test_passed = self_test();
        faults_set(&d->faults, FAULT_SELF_TEST, !d->self_test_passed);
    }
    faults_set(&d->faults, FAULT_SERVO, !servos_healthy(&d->servos));
    if (d->disarm) {
        servos_off(&d->servos); /* in whatever state: one that is being tested or looked for, too */
    }
    arming_before_states(d);
    const supervisor_state state = d->supervisor.state;
    const supervisor_rule *rule = supervisor_step(&d->supervisor, conditions(d), d->now_us);
    if (rule != NULL) {
        change_state(d, state, rule);
    }
    arming_after_states(d);
    d->arm = d->disarm = d->clear = d->estop = false;
    choose_follow(d);
    d->checked_in |= CHECKED_STATES;
}

static void move(device *d)
{
    d->input.has_base = d->pose.valid;
    d->input.restart = d->pose.restart;
    d->input.base = d->pose.base;
    body_tick(&d->body, &d->input);
    faults_solver(&d->faults, d->body.finite);
    if (d->body.goals_new && d->input.follow != FOLLOW_NOTHING) {
        servos_goals(&d->servos, body_goals(&d->body));
    }
    servos_tick(&d->servos, d->now_us);
    d->checked_in |= CHECKED_SERVOS;
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
    const float tick_us = d->config.tick_s * 1e6f;
    d->deadline_misses += (float)taken_us > tick_us;
    /* a tick in which the rod becomes another one was asked for, and may take two */
    const bool late = (float)taken_us > (d->input.new_params ? 2.0f * tick_us : tick_us);
    if (late &&
        d->boot.clock_kind != CLOCK_EMULATOR) { /* whose clock runs on while its host is busy */
        faults_raise(&d->faults, FAULT_DEADLINE);
    } else {
        d->checked_in |= CHECKED_DEADLINE;
    }
}

/* What did not come round is not covered up: unfed, the hardware restarts the board. */
static void feed_watchdog(device *d)
{
    const bool intact = d->hal->stack_intact(d->hal->context);
    faults_set(&d->faults, FAULT_CANARY, !intact);
    d->checked_in |= intact ? CHECKED_STACK : 0;
    if (d->checked_in == CHECKED_ALL) {
        d->hal->watchdog_feed(d->hal->context);
    }
    d->checked_in = 0;
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
    feed_watchdog(d);
    d->tick++;
}
