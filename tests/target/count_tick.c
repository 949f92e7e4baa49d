/* count_tick.c - what a tick of the whole device costs on the Cortex-M4F, its parts, and the interrupts beside it: see
 * cost.h and count_board.h.
 */
#include <stdio.h>

#include "cost.h"
#include "count_board.h"
#include "tick_budget.h"

enum { TICKS_N = 100, NEVER = 100000 };

static device *const d = &counted.device;

/* Ticks in which servos get goals: the dear ones. HEARTBEAT and STATS in each of them, or in none. */
static void count_ticks(const char *name, int links_n, uint32_t telemetry_ticks)
{
    for (int left = TICKS_N; left > 0;) {
        count_board_pass();
        count_board_say_pose();
        d->to_heartbeat_ticks = d->to_stats_ticks = telemetry_ticks;
        if (d->body.ticks_to_servos > 0) {
            device_tick(d);
            continue;
        }
        cost_begin();
        device_tick(d);
        cost_end();
        left--;
    }
    cost_tell(name, links_n);
}

/* Ticks in which the rod becomes another one: all of the parameters are checked, and the blend begins. */
static void count_presets(const char *name, int links_n)
{
    static const char *const NAMES[] = {"foil", "whip", "ribbon"};
    const uint32_t refused = d->commands_refused;
    for (int i = 0; i < TICKS_N / 10; i++) {
        message m = {.type = MESSAGE_PRESET, .preset = {.request_id = (uint16_t)(1000 + i)}};
        link_text(m.preset.name, sizeof m.preset.name, NAMES[i % 3]);
        count_board_pass();
        count_board_say_pose();
        count_board_say(&m);
        d->to_heartbeat_ticks = d->to_stats_ticks = NEVER;
        cost_begin();
        device_tick(d);
        cost_end();
    }
    cost_tell(name, links_n);
    if (d->commands_refused != refused) {
        printf("presets were refused\n");
    }
}

typedef enum { DECODE, POSE_INPUT, BLEND_LIMITS, SERVO_ENCODE, ANGLES_REPLY, PARTS_N } part;
static const char *const PART_NAMES[PARTS_N] = {"decode", "pose_input", "blend_limits",
                                                "servo_encode", "angles_reply"};

static void prepare(part which)
{
    count_board_pass();
    d->now_us = count_board_now_us();
    if (which == DECODE) {
        count_board_say_pose();
    } else if (which == SERVO_ENCODE) {
        servos_tick(&d->servos, d->now_us); /* takes the answer */
        count_board_pass();
    } else {
        d->to_heartbeat_ticks = d->to_stats_ticks = NEVER;
        d->to_angles_ticks = 0;
    }
}

static void do_part(part which, const pose_sample *sample)
{
    static float targets_rad[SERVOS_MAX];
    message m;
    frame header;
    switch (which) {
    case DECODE:
        link_begin_tick(&d->link);
        while (link_receive(&d->link, &m, &header)) {
        }
        break;
    case POSE_INPUT:
        (void)pose_input_receive(&d->poses, sample, d->now_us);
        (void)pose_input_tick(&d->poses, d->now_us);
        break;
    case BLEND_LIMITS:
        servo_map_targets(&d->body.map, rod_angles(&d->body.rod), d->params.in_force.rod.links_n,
                          targets_rad);
        servo_blend_mix(&d->body.blend, targets_rad);
        (void)servo_map_follow(&d->body.map, targets_rad);
        break;
    case SERVO_ENCODE:
        servos_goals(&d->servos, body_goals(&d->body));
        servos_tick(&d->servos, d->now_us);
        break;
    default:
        telemetry_send(d);
        break;
    }
}

static void count_part(part which, int links_n)
{
    servo_blend_from_motion(&d->body.blend, &d->body.map, body_goals(&d->body), 60000000);
    for (int i = 0; i < TICKS_N; i++) {
        prepare(which);
        const pose_sample sample = {.pose = count_board_hand(),
                                    .sent_us = d->now_us,
                                    .seq = (uint16_t)(d->poses.sequence.newest + 1),
                                    .session = 1};
        cost_begin();
        do_part(which, &sample);
        cost_end();
    }
    cost_tell(PART_NAMES[which], links_n);
}

/* One interrupt each, as uart.c and the board's SysTick handler have them. */
static void count_interrupts(void)
{
    for (int i = 0; i < TICKS_N; i++) {
        counted.line.registers->sr = USART_SR_RXNE;
        cost_begin();
        uart_interrupt(&counted.line);
        cost_end();
    }
    cost_tell("interrupt_byte_in", 0);
    uint8_t bytes[TICKS_N] = {0};
    (void)uart_write(&counted.line, bytes, sizeof bytes);
    for (int i = 0; i < TICKS_N; i++) {
        counted.line.registers->sr = USART_SR_TXE;
        cost_begin();
        uart_interrupt(&counted.line);
        cost_end();
    }
    cost_tell("interrupt_byte_out", 0);
    for (int i = 0; i < TICKS_N; i++) {
        cost_begin();
        timebase_interrupt(&counted.clock);
        (void)watchdog_starved(&counted.watch, counted.clock.ticks);
        cost_end();
    }
    cost_tell("interrupt_tick", 0);
}

static void tell_budget(const char *name, int model, int links_n, float tick_s, int objects_n)
{
    const tick_load load = {.objects_n = objects_n};
    printf("# budget %s %d %lu\n", name, links_n,
           (unsigned long)tick_budget_cycles(model, links_n, tick_s, &load));
}

/* The same device with the other model; its parts but for the step are the same. */
static bool count_model(int model, int links_n)
{
    const bool elastic = model == ROD_MODEL_ELASTIC;
    if (!count_board_follow(model, links_n)) {
        return false;
    }
    count_ticks(elastic ? "elastic_tick" : "tick", links_n, NEVER);
    count_ticks(elastic ? "elastic_tick_full" : "tick_full", links_n, 0);
    count_presets(elastic ? "elastic_tick_preset" : "tick_preset", links_n);
    if (d->supervisor.state != SUPERVISOR_ACTIVE) {
        printf("no longer ACTIVE but %d\n", (int)d->supervisor.state);
        return false;
    }
    for (part which = 0; which < PARTS_N && !elastic; which++) {
        count_part(which, links_n);
    }
    tell_budget(elastic ? "elastic" : "contour", model, links_n, 1e-3f, 0);
    tell_budget(elastic ? "elastic_among" : "contour_among", model, links_n, 1e-3f,
                SCENE_OBJECTS_MAX);
    if (elastic) {
        tell_budget("elastic_4ms", model, links_n, 4e-3f, 0);
    }
    return true;
}

int main(void)
{
    static const int LINKS_N[] = {4, 10, 20, 50};
    cost_start();
    for (int i = 0; i < 4; i++) {
        for (int model = 0; model < ROD_MODEL_COUNT; model++) {
            if (!count_model(model, LINKS_N[i])) {
                return 1;
            }
        }
    }
    count_interrupts();
    return 0;
}
