/* count_board.c - see count_board.h. */
#include "count_board.h"

#include <stdio.h>

#include "servo_wire_hal.h"

enum { LINE_RX_BYTES = 1024, LINE_TX_BYTES = 2048, BUS_RX_BYTES = 512, BUS_TX_BYTES = 1024 };
enum { TICK_US = 1000 };

count_board counted;
static usart_registers line_registers, bus_registers;
static systick_registers systick;
static scb_registers scb;
static iwdg_registers iwdg;
static uint8_t line_rx[LINE_RX_BYTES], line_tx[LINE_TX_BYTES];
static uint8_t bus_rx[BUS_RX_BYTES], bus_tx[BUS_TX_BYTES];
static uint16_t seq;

void setUp(void) {} /* Unity, which the servos complain through, wants them */
void tearDown(void) {}

/* --- the hal: as board.c's ------------------------------------------------------------------------------- */

static uint32_t now_us(void *context)
{
    (void)context;
    return timebase_now_us(&counted.clock);
}

static size_t line_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&counted.line, bytes, room);
}

static bool line_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return uart_write(&counted.line, bytes, bytes_n);
}

static size_t line_free(void *context)
{
    (void)context;
    return uart_free(&counted.line);
}

static uint32_t none(void *context)
{
    (void)context;
    return 0;
}

static bool bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return uart_write(&counted.bus, bytes, bytes_n);
}

static bool bus_sending(void *context)
{
    (void)context;
    return uart_sending(&counted.bus) || w.sending;
}

static size_t bus_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&counted.bus, bytes, room);
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
    watchdog_feed(&counted.watch, counted.clock.ticks);
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
void count_board_pass(void)
{
    uint8_t packet[HAL_BUS_PACKET_MAX_BYTES];
    (void)leave(&counted.line, NULL);
    const size_t packet_n = leave(&counted.bus, packet);
    w.log_n = 0;
    w.supply = true;
    if (packet_n > 0) {
        (void)hal_bus_write(NULL, packet, packet_n);
    }
    wire_until(w.now_us + TICK_US);
    const size_t answer_n = hal_bus_read(NULL, packet, sizeof packet);
    arrive(&counted.bus, packet, answer_n);
    timebase_interrupt(&counted.clock);
}

void count_board_say(const message *m)
{
    uint8_t bytes[FRAME_WIRE_MAX];
    arrive(&counted.line, bytes, messages_encode(m, 1, ++seq, w.now_us, bytes, sizeof bytes));
}

rod_pose count_board_hand(void)
{
    const float turned = 0.0026f * (float)counted.clock.ticks;
    const trig_pair turn = trig_sincos(turned), tilt = trig_sincos(0.2f * turned);
    return (rod_pose){{0.15f * turn.cos, 0.15f * turn.sin, 0.02f * tilt.sin},
                      {0.0f, tilt.sin, 0.0f, tilt.cos}};
}

void count_board_say_pose(void)
{
    const rod_pose hand = count_board_hand();
    const vec3 p = hand.position_m;
    const quat q = hand.orientation;
    count_board_say(&(message){
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
    timebase_start(&counted.clock, &systick, &scb, 168000000);
    systick.cvr = 84000;
    uart_init(&counted.line, &line_registers, 84000000, false, line_rx, sizeof line_rx, line_tx,
              sizeof line_tx);
    uart_init(&counted.bus, &bus_registers, 84000000, true, bus_rx, sizeof bus_rx, bus_tx,
              sizeof bus_tx);
    (void)uart_start(&counted.line, 1000000);
    (void)uart_start(&counted.bus, 4000000);
    (void)watchdog_start(&counted.watch, &iwdg, 1000, counted.clock.ticks);
    (void)wire_fresh(2 * links_n);
    const device_config config = {.tick_s = 1e-3f,
                                  .name = "cost",
                                  .build = "",
                                  .links_n = links_n,
                                  .servos_kind = SERVOS_BUS};
    const hal_boot boot = {0};
    device_init(&counted.device, &board, &config, &boot);
}

static bool set(const char *name, float value)
{
    params_refusal why;
    return params_stage(&counted.device.params, name, 0, &value, 1, &why);
}

/* One tick with a pose. */
static void tick_with_pose(void)
{
    count_board_pass();
    count_board_say_pose();
    device_tick(&counted.device);
}

bool count_board_follow(int model, int links_n)
{
    params_refusal why;
    start_device(links_n);
    if (!set("model", (float)model) || !set("spring", 2000.0f) || !set("smoothing", 50.0f) ||
        !set("servo_baud", 4e6f) || !set("angles_rate", 1000.0f) ||
        !params_commit(&counted.device.params, true, &why) ||
        !device_apply_params(&counted.device, &counted.device.params.in_force, true, &why)) {
        printf("parameters refused: %s\n", why.text);
        return false;
    }
    count_board_say(
        &(message){.type = MESSAGE_HELLO,
                   .hello = {.request_id = 1, .protocol_major = PROTOCOL_MAJOR, .pose_hz = 1e3f}});
    for (int i = 0; i < 400; i++) {
        tick_with_pose();
    }
    count_board_say(&(message){.type = MESSAGE_ARM, .arm = {.request_id = 2}});
    for (int i = 0; i < 6000 && counted.device.supervisor.state != SUPERVISOR_ACTIVE; i++) {
        tick_with_pose();
    }
    if (counted.device.supervisor.state != SUPERVISOR_ACTIVE) {
        printf("not ACTIVE but %d\n", (int)counted.device.supervisor.state);
        return false;
    }
    return true;
}

uint32_t count_board_now_us(void)
{
    return now_us(NULL);
}
