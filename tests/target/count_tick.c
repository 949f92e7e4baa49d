/* count_tick.c - what a tick of the whole device costs on the Cortex-M4F, and its parts: see cost.h.
 *
 * The device with two servos a link on a bus, ACTIVE, a pose in every tick and ANGLES out in every tick. Its line
 * and its bus are the board's own drivers (uart.h, timebase.h) on registers that are memory, and the servos
 * those of tests/servos; between the ticks this program does the hardware's part, and calls the
 * interrupt handlers, which are counted by themselves.
 */
#include <stdio.h>

#include "cost.h"
#include "device.h"
#include "servo_wire_hal.h"
#include "timebase.h"
#include "uart.h"
#include "watchdog.h"

enum { LINE_RX_BYTES = 1024, LINE_TX_BYTES = 2048, BUS_RX_BYTES = 512, BUS_TX_BYTES = 1024 };
enum { TICK_US = 1000, TICKS_N = 100, NEVER = 100000 };

static usart_registers line_registers, bus_registers;
static systick_registers systick;
static scb_registers scb;
static iwdg_registers iwdg;
static uart line, bus;
static timebase clock_ticks;
static watchdog watch;
static uint8_t line_rx[LINE_RX_BYTES], line_tx[LINE_TX_BYTES];
static uint8_t bus_rx[BUS_RX_BYTES], bus_tx[BUS_TX_BYTES];
static device d;
static uint16_t seq;

void setUp(void) {}
void tearDown(void) {}

/* --- the hal: as board.c's ------------------------------------------------------------------------------- */

static uint32_t now_us(void *context)
{
    (void)context;
    return timebase_now_us(&clock_ticks);
}

static size_t line_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&line, bytes, room);
}

static bool line_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return uart_write(&line, bytes, bytes_n);
}

static size_t line_free(void *context)
{
    (void)context;
    return uart_free(&line);
}

static uint32_t none(void *context)
{
    (void)context;
    return 0;
}

static bool bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return uart_write(&bus, bytes, bytes_n);
}

static bool bus_sending(void *context)
{
    (void)context;
    return uart_sending(&bus) || w.sending;
}

static size_t bus_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&bus, bytes, room);
}

static bool never(void *context)
{
    (void)context;
    return false;
}

static bool always(void *context)
{
    (void)context;
    return true;
}

static uint32_t sector_size(void *context)
{
    (void)context;
    return 131072;
}

static void flash_read(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n)
{
    (void)context, (void)sector, (void)offset;
    memset(bytes, 0xFF, bytes_n);
}

static void feed(void *context)
{
    (void)context;
    watchdog_feed(&watch, clock_ticks.ticks);
}

/* --- the hardware ---------------------------------------------------------------------------------------- */

/* Bytes arrive, one interrupt each. */
static void arrive(uart *u, const uint8_t *bytes, size_t bytes_n)
{
    for (size_t i = 0; i < bytes_n; i++) {
        u->registers->sr = USART_SR_RXNE;
        u->registers->dr = bytes[i];
        uart_interrupt(u);
    }
    u->registers->sr = 0;
}

/* What is to be sent leaves, one interrupt each; into bytes, if that is not NULL. Returns how many. */
static size_t leave(uart *u, uint8_t *bytes)
{
    size_t n = 0;
    for (size_t left = ring_used(&u->tx); left > 0; left--) {
        u->registers->sr = USART_SR_TXE;
        uart_interrupt(u);
        if (bytes != NULL) {
            bytes[n++] = (uint8_t)u->registers->dr;
        }
    }
    u->registers->sr = USART_SR_TXE | USART_SR_TC;
    uart_interrupt(u); /* nothing more */
    uart_interrupt(u); /* the last stop bit */
    u->registers->sr = 0;
    return n;
}

/* From one tick to the next: the servos get what was sent, and answer. */
static void pass_a_tick(void)
{
    uint8_t packet[HAL_BUS_PACKET_MAX_BYTES];
    (void)leave(&line, NULL);
    const size_t packet_n = leave(&bus, packet);
    w.log_n = 0;
    w.supply = true;
    if (packet_n > 0) {
        (void)hal_bus_write(NULL, packet, packet_n);
    }
    wire_until(w.now_us + TICK_US);
    const size_t answer_n = hal_bus_read(NULL, packet, sizeof packet);
    arrive(&bus, packet, answer_n);
    timebase_interrupt(&clock_ticks);
}

static void say(const message *m)
{
    uint8_t bytes[FRAME_WIRE_MAX];
    arrive(&line, bytes, messages_encode(m, 1, ++seq, w.now_us, bytes, sizeof bytes));
}

static rod_pose hand_now(void)
{
    const float turned = 0.0026f * (float)clock_ticks.ticks;
    const trig_pair turn = trig_sincos(turned), tilt = trig_sincos(0.2f * turned);
    return (rod_pose){{0.15f * turn.cos, 0.15f * turn.sin, 0.02f * tilt.sin},
                      {0.0f, tilt.sin, 0.0f, tilt.cos}};
}

static void say_pose(void)
{
    const rod_pose hand = hand_now();
    const vec3 p = hand.position_m;
    const quat q = hand.orientation;
    say(&(message){
        .type = MESSAGE_POSE,
        .pose = {.position_m = {p.x, p.y, p.z}, .quaternion_xyzw = {q.x, q.y, q.z, q.w}}});
}

/* --- the device, until it follows -------------------------------------------------------------------------- */

static void start_device(int links_n)
{
    static hal board;
    board = (hal){.now_us = now_us, .line_read = line_read, .line_write = line_write};
    board.line_free = line_free;
    board.line_overruns = board.line_framing_errors = none;
    board.servo_supply = hal_supply;
    board.pwm_stop = hal_pwm_stop;
    board.bus_start = hal_bus_start;
    board.bus_write = bus_write;
    board.bus_sending = bus_sending;
    board.bus_read = bus_read;
    board.bus_abort = hal_bus_abort;
    board.estop_pressed = never;
    board.flash_sector_size = sector_size;
    board.flash_read = flash_read;
    board.stack_intact = always;
    board.watchdog_feed = feed;
    timebase_start(&clock_ticks, &systick, &scb, 168000000);
    systick.cvr = 84000;
    uart_init(&line, &line_registers, 84000000, false, line_rx, sizeof line_rx, line_tx,
              sizeof line_tx);
    uart_init(&bus, &bus_registers, 84000000, true, bus_rx, sizeof bus_rx, bus_tx, sizeof bus_tx);
    (void)uart_start(&line, 1000000);
    (void)uart_start(&bus, 4000000);
    (void)watchdog_start(&watch, &iwdg, 1000, clock_ticks.ticks);
    (void)wire_fresh(2 * links_n);
    const device_config config = {.tick_s = 1e-3f,
                                  .name = "cost",
                                  .build = "",
                                  .links_n = links_n,
                                  .servos_kind = SERVOS_BUS};
    const hal_boot boot = {0};
    device_init(&d, &board, &config, &boot);
}

static bool set(const char *name, float value)
{
    params_refusal why;
    return params_stage(&d.params, name, 0, &value, 1, &why);
}

/* One tick with a pose. */
static void tick_with_pose(void)
{
    pass_a_tick();
    say_pose();
    device_tick(&d);
}

static bool follow(int links_n)
{
    params_refusal why;
    start_device(links_n);
    if (!set("spring", 2000.0f) || !set("smoothing", 50.0f) || !set("servo_baud", 4e6f) ||
        !set("angles_rate", 1000.0f) || !params_commit(&d.params, true, &why) ||
        !device_apply_params(&d, &d.params.in_force, true, &why)) {
        printf("parameters refused: %s\n", why.text);
        return false;
    }
    say(&(message){.type = MESSAGE_HELLO,
                   .hello = {.request_id = 1, .protocol_major = PROTOCOL_MAJOR, .pose_hz = 1e3f}});
    for (int i = 0; i < 400; i++) {
        tick_with_pose();
    }
    say(&(message){.type = MESSAGE_ARM, .arm = {.request_id = 2}});
    for (int i = 0; i < 6000 && d.supervisor.state != SUPERVISOR_ACTIVE; i++) {
        tick_with_pose();
    }
    return d.supervisor.state == SUPERVISOR_ACTIVE;
}

/* --- what is counted ---------------------------------------------------------------------------------------- */

/* Ticks in which servos get goals: the dear ones. HEARTBEAT and STATS in each of them, or in none. */
static void count_ticks(const char *name, int links_n, uint32_t telemetry_ticks)
{
    for (int left = TICKS_N; left > 0;) {
        pass_a_tick();
        say_pose();
        d.to_heartbeat_ticks = d.to_stats_ticks = telemetry_ticks;
        if (d.body.ticks_to_servos > 0) {
            device_tick(&d);
            continue;
        }
        cost_begin();
        device_tick(&d);
        cost_end();
        left--;
    }
    cost_tell(name, links_n);
}

typedef enum { DECODE, POSE_INPUT, BLEND_LIMITS, SERVO_ENCODE, ANGLES_REPLY, PARTS_N } part;
static const char *const PART_NAMES[PARTS_N] = {"decode", "pose_input", "blend_limits",
                                                "servo_encode", "angles_reply"};

static void prepare(part which)
{
    pass_a_tick();
    d.now_us = now_us(NULL);
    if (which == DECODE) {
        say_pose();
    } else if (which == SERVO_ENCODE) {
        servos_tick(&d.servos, d.now_us); /* takes the answer */
        pass_a_tick();
    } else {
        d.to_heartbeat_ticks = d.to_stats_ticks = NEVER;
        d.to_angles_ticks = 0;
    }
}

static void do_part(part which, const pose_sample *sample)
{
    static float targets_rad[SERVOS_MAX];
    message m;
    frame header;
    switch (which) {
    case DECODE:
        link_begin_tick(&d.link);
        while (link_receive(&d.link, &m, &header)) {
        }
        break;
    case POSE_INPUT:
        (void)pose_input_receive(&d.poses, sample, d.now_us);
        (void)pose_input_tick(&d.poses, d.now_us);
        break;
    case BLEND_LIMITS:
        servo_map_targets(&d.body.map, rod_angles(&d.body.rod), d.params.in_force.rod.links_n,
                          targets_rad);
        servo_blend_mix(&d.body.blend, targets_rad);
        (void)servo_map_follow(&d.body.map, targets_rad);
        break;
    case SERVO_ENCODE:
        servos_goals(&d.servos, body_goals(&d.body));
        servos_tick(&d.servos, d.now_us);
        break;
    default:
        telemetry_send(&d);
        break;
    }
}

static void count_part(part which, int links_n)
{
    servo_blend_from_motion(&d.body.blend, &d.body.map, body_goals(&d.body), 60000000);
    for (int i = 0; i < TICKS_N; i++) {
        prepare(which);
        const pose_sample sample = {
            .pose = hand_now(), .sent_us = w.now_us, .seq = ++seq, .session = 1};
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
        line_registers.sr = USART_SR_RXNE;
        cost_begin();
        uart_interrupt(&line);
        cost_end();
    }
    cost_tell("interrupt_byte_in", 0);
    uint8_t bytes[TICKS_N] = {0};
    (void)uart_write(&line, bytes, sizeof bytes);
    for (int i = 0; i < TICKS_N; i++) {
        line_registers.sr = USART_SR_TXE;
        cost_begin();
        uart_interrupt(&line);
        cost_end();
    }
    cost_tell("interrupt_byte_out", 0);
    for (int i = 0; i < TICKS_N; i++) {
        cost_begin();
        timebase_interrupt(&clock_ticks);
        (void)watchdog_starved(&watch, clock_ticks.ticks);
        cost_end();
    }
    cost_tell("interrupt_tick", 0);
}

int main(void)
{
    static const int LINKS_N[] = {4, 10, 20, 50};
    cost_start();
    for (int i = 0; i < 4; i++) {
        const int n = LINKS_N[i];
        if (!follow(n)) {
            printf("not ACTIVE but %d\n", (int)d.supervisor.state);
            return 1;
        }
        count_ticks("tick", n, NEVER);
        count_ticks("tick_full", n, 0);
        if (d.supervisor.state != SUPERVISOR_ACTIVE) {
            printf("no longer ACTIVE but %d\n", (int)d.supervisor.state);
            return 1;
        }
        for (part which = 0; which < PARTS_N; which++) {
            count_part(which, n);
        }
    }
    count_interrupts();
    return 0;
}
