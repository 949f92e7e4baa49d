/* host_device.c - see host_device.h. */
#include "host_device.h"

#include <string.h>

#include "sim.h"

enum { BUS_BAUD_MIN = 9600, BUS_BAUD_MAX = 4500000 };
enum {
    BOARD_CLOCK_HZ = 168000000
}; /* what does not fit the board's tick is refused here as well */
#define HOBBY_US_PER_RAD 636.6198f

static uint32_t now_us(void *context)
{
    const host_device *h = context;
    /* the same all through a tick: what this machine does in between is no business of the device's */
    return (uint32_t)(uint64_t)(h->elapsed_s * 1e6 + 0.5) + h->jumped_us;
}

static size_t line_read_hal(void *context, uint8_t *bytes, size_t room)
{
    host_device *h = context;
    if (h->late || injection_now(&h->injection, INJECT_STALL, h->elapsed_s) != NULL) {
        return 0;
    }
    const size_t n = line_read(&h->line, bytes, room);
    return injection_spoil(&h->injection, h->elapsed_s, bytes, n);
}

static bool line_write_hal(void *context, const uint8_t *bytes, size_t bytes_n)
{
    host_device *h = context;
    return line_write(&h->line, bytes, bytes_n);
}

static size_t line_free_hal(void *context)
{
    const host_device *h = context;
    return line_free(&h->line);
}

static uint32_t no_count(void *context)
{
    (void)context;
    return 0;
}

static void servo_supply(void *context, bool on)
{
    host_device *h = context;
    h->plant.powered = on;
}

/* --- hobby servos: 500 ... 2500 us are half a turn, whatever the device believes ------------------------- */

static bool pwm_start(void *context, float rate_hz)
{
    (void)context;
    return rate_hz >= 50.0f && rate_hz <= 333.0f;
}

static void pwm_pulse(void *context, int channel, uint32_t width_us)
{
    host_device *h = context;
    if (h->servos.kind == SERVOS_PWM && channel >= 0 && channel < HAL_PWM_CHANNELS_N) {
        servo_plant_torque(&h->plant, channel, width_us > 0);
        servo_plant_goal(&h->plant, channel, ((float)width_us - 1500.0f) / HOBBY_US_PER_RAD);
    }
}

static void pwm_stop(void *context)
{
    for (int channel = 0; channel < HAL_PWM_CHANNELS_N; channel++) {
        pwm_pulse(context, channel, 0);
    }
}

/* --- the servo bus -------------------------------------------------------------------------------------- */

static bool bus_start(void *context, uint32_t baud)
{
    host_device *h = context;
    const bool can = baud >= BUS_BAUD_MIN && baud <= BUS_BAUD_MAX;
    if (can) {
        bus_wire_start(&h->bus.wire, baud);
    }
    return can;
}

static bool bus_sending(void *context)
{
    const host_device *h = context;
    return bus_wire_sending(&h->bus.wire, h->elapsed_s);
}

static bool bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    host_device *h = context;
    return bytes_n <= HAL_BUS_PACKET_MAX_BYTES && !bus_sending(h) &&
           bus_wire_send(&h->bus.wire, bytes, bytes_n, h->elapsed_s);
}

static size_t bus_read(void *context, uint8_t *bytes, size_t room)
{
    host_device *h = context;
    return bus_wire_read(&h->bus.wire, bytes, room, h->elapsed_s);
}

static void bus_abort(void *context)
{
    host_device *h = context;
    bus_wire_abort(&h->bus.wire, h->elapsed_s);
}

/* --- the rest ------------------------------------------------------------------------------------------- */

static bool stack_intact(void *context)
{
    (void)context;
    return true;
}

static bool estop_pressed(void *context)
{
    host_device *h = context;
    return injection_now(&h->injection, INJECT_ESTOP, h->elapsed_s) != NULL;
}

static uint32_t sector_size(void *context)
{
    (void)context;
    return FLASH_FILE_SECTOR_BYTES;
}

static void flash_read(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n)
{
    const host_device *h = context;
    memcpy(bytes, h->flash.bytes[sector] + offset, bytes_n);
}

static bool flash_write(void *context, int sector, uint32_t offset, const void *bytes,
                        size_t bytes_n)
{
    host_device *h = context;
    return flash_file_write(&h->flash, sector, offset, bytes, bytes_n);
}

static bool flash_erase(void *context, int sector)
{
    host_device *h = context;
    return flash_file_erase(&h->flash, sector);
}

static void nothing(void *context)
{
    (void)context;
}

static void reboot(void *context)
{
    host_device *h = context;
    h->rebooting = true;
}

/* A board forgets what stands around it; here the world remembers. */
static void put_objects(host_device *h)
{
    params_refusal why;
    char text[MESSAGES_TEXT_MAX + 1];
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        const scene_object *object = &h->objects.body[i].object;
        if (object->kind != SCENE_NONE && !device_put_object(&h->device, i, object, text, &why)) {
            telemetry_log(&h->device, LEVEL_WARNING, why.text);
        }
    }
}

/* Program and processor start; the world is as it was. */
static void boot(host_device *h, float tick_s, int links_n)
{
    h->hal = (hal){.context = h,
                   .now_us = now_us,
                   .line_read = line_read_hal,
                   .line_write = line_write_hal,
                   .line_free = line_free_hal,
                   .line_overruns = no_count,
                   .line_framing_errors = no_count,
                   .servo_supply = servo_supply,
                   .pwm_start = pwm_start,
                   .pwm_pulse = pwm_pulse,
                   .pwm_stop = pwm_stop,
                   .bus_start = bus_start,
                   .bus_write = bus_write,
                   .bus_sending = bus_sending,
                   .bus_read = bus_read,
                   .bus_abort = bus_abort,
                   .stack_intact = stack_intact,
                   .estop_pressed = estop_pressed,
                   .flash_sector_size = sector_size,
                   .flash_read = flash_read,
                   .flash_write = flash_write,
                   .flash_erase = flash_erase,
                   .watchdog_feed = nothing,
                   .reboot = reboot};
    h->config = (device_config){.tick_s = tick_s,
                                .tick_max_hz = 2000.0f,
                                .line_baud = h->line_baud,
                                .features = FEATURE_NODES | FEATURE_POSE_LOG | FEATURE_SETTINGS |
                                            FEATURE_SERVO_ASSIGN | FEATURE_SIMULATED,
                                .name = "limber-sim",
                                .build = SIM_VERSION,
                                .links_n = links_n,
                                .servos_kind = (uint8_t)h->servos.kind,
                                .watcher = body_log_watcher(&h->log)};
    h->boot.clock_kind = CLOCK_HOST;
    h->boot.clock_hz = BOARD_CLOCK_HZ;
    h->boot.estop_ignored = true;
    servo_supply(h, false);
    pwm_stop(h);
    bus_abort(h);
    body_log_start(&h->log);
    device_init(&h->device, &h->hal, &h->config, &h->boot);
    put_objects(h);
}

void host_device_start(host_device *h, float tick_s, int links_n)
{
    host_servos *servos = &h->servos;
    if (servos->baud == 0) {
        *servos = (host_servos){.kind = SERVOS_BUS, .baud = HOST_SERVOS_BAUD};
    }
    const int servos_n = servos->servos_n > 0 ? servos->servos_n : 2 * links_n;
    bus_model_init(&h->bus, &h->plant, servos->kind == SERVOS_BUS ? servos_n : 0, servos->baud);
    h->bus.wire.echo = servos->echo;
    boot(h, tick_s, links_n);
}

/* What the script says goes wrong beside the line. */
static void inject(host_device *h)
{
    bus_model_inject(&h->bus, &h->injection, h->elapsed_s);
    injected_fault *clock = injection_now(&h->injection, INJECT_CLOCK, h->elapsed_s);
    if (clock != NULL && !clock->done) {
        clock->done = true;
        h->jumped_us += (uint32_t)(clock->amount * 1e6);
    }
    injected_fault *cut = injection_now(&h->injection, INJECT_CUT, h->elapsed_s);
    if (cut != NULL && !cut->done) {
        cut->done = true;
        h->flash.writes_left = (long)cut->amount;
    }
    h->rebooting = h->rebooting || h->flash.cut;
}

void host_device_tick(host_device *h)
{
    inject(h);
    device_tick(&h->device);
    line_flush(&h->line);
    servo_plant_tick(&h->plant, h->config.tick_s);
    h->elapsed_s += (double)h->config.tick_s;
    bus_model_run(&h->bus, h->elapsed_s);
    if (h->rebooting) { /* power and program start afresh; flash and the world stay */
        h->rebooting = false;
        h->boot.cause = h->flash.cut ? HAL_RESET_POWER : HAL_RESET_SOFTWARE;
        h->flash.cut = false;
        h->flash.writes_left = -1;
        boot(h, h->config.tick_s, h->config.links_n);
    }
}
