/* fuzz_device.c - whole conversations with the whole device; traps where a person could be hurt.
 *
 * The first byte chooses the servos. Then comes a list of actions; each is a byte that says what, a byte that says how much, and bytes:
 *   0  so many bytes from the line, as they are
 *   1  a message with a right checksum, in session: type, then its payload of so many bytes
 *   2  so many ticks
 *   3  a good pose and a tick, so many times
 * Whatever comes: angles stay finite and in range, servos have torque only where the states say so. */
#include <math.h>
#include <string.h>

#include "bus_model.h"
#include "device.h"

#define PROMISE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            __builtin_trap();                                                                      \
        }                                                                                          \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *input, size_t input_n);

enum { FLASH_BYTES = 32 * 1024, SESSION = 9, LINKS_N = 4 };

static struct {
    hal hal;
    uint32_t now_us;
    uint8_t line[2 * FRAME_WIRE_MAX];
    size_t line_n;
    double now_s; /* the same, for the servos */
    bool rebooted;
    uint8_t servos_kind;
    servo_plant plant;
    bus_model bus;
    uint32_t pulses[HAL_PWM_CHANNELS_N];
    uint8_t flash[HAL_FLASH_SECTORS_N][FLASH_BYTES];
    device device;
    uint16_t pose_seq;
} world;

static bool has_torque(void)
{
    bool some = servo_plant_has_torque(&world.plant);
    for (int i = 0; i < HAL_PWM_CHANNELS_N; i++) {
        some = some || world.pulses[i] != 0;
    }
    return some;
}

static uint32_t now_us(void *context)
{
    (void)context;
    return world.now_us;
}

static size_t line_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    const size_t n = world.line_n < room ? world.line_n : room;
    memcpy(bytes, world.line, n);
    world.line_n -= n;
    memmove(world.line, world.line + n, world.line_n);
    return n;
}

static bool line_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context, (void)bytes;
    PROMISE(bytes_n > 0 && bytes_n <= FRAME_WIRE_MAX);
    return true;
}

static size_t line_free(void *context)
{
    (void)context;
    return 8192;
}

static uint32_t none(void *context)
{
    (void)context;
    return 0;
}

static void servo_supply(void *context, bool on)
{
    (void)context;
    world.plant.powered = on;
}

static bool pwm_start(void *context, float rate_hz)
{
    (void)context;
    PROMISE(rate_hz >= 50.0f && rate_hz <= 333.0f);
    return true;
}

static void pwm_pulse(void *context, int channel, uint32_t width_us)
{
    (void)context;
    PROMISE(channel >= 0 && channel < HAL_PWM_CHANNELS_N);
    PROMISE(width_us == 0 || (width_us >= 500 && width_us <= 2500 && world.plant.powered));
    world.pulses[channel] = width_us;
}

static void pwm_stop(void *context)
{
    (void)context;
    memset(world.pulses, 0, sizeof world.pulses);
}

static bool bus_start(void *context, uint32_t baud)
{
    (void)context;
    bus_wire_start(&world.bus.wire, baud);
    return true;
}

static bool bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    PROMISE(bytes_n > 0 && bytes_n <= HAL_BUS_PACKET_MAX_BYTES);
    return bus_wire_send(&world.bus.wire, bytes, bytes_n, world.now_s);
}

static bool bus_sending(void *context)
{
    (void)context;
    return bus_wire_sending(&world.bus.wire, world.now_s);
}

static size_t bus_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return bus_wire_read(&world.bus.wire, bytes, room, world.now_s);
}

static void bus_abort(void *context)
{
    (void)context;
    bus_wire_abort(&world.bus.wire, world.now_s);
}

static bool yes(void *context)
{
    (void)context;
    return true;
}

static bool no(void *context)
{
    (void)context;
    return false;
}

static uint32_t sector_size(void *context)
{
    (void)context;
    return FLASH_BYTES;
}

static void flash_read(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n)
{
    (void)context;
    PROMISE(offset + bytes_n <= FLASH_BYTES);
    memcpy(bytes, world.flash[sector] + offset, bytes_n);
}

static bool flash_write(void *context, int sector, uint32_t offset, const void *bytes,
                        size_t bytes_n)
{
    (void)context;
    PROMISE(offset % 4 == 0 && bytes_n % 4 == 0 && offset + bytes_n <= FLASH_BYTES);
    PROMISE(!has_torque());
    for (size_t i = 0; i < bytes_n; i++) {
        world.flash[sector][offset + i] &= ((const uint8_t *)bytes)[i];
    }
    return true;
}

static bool flash_erase(void *context, int sector)
{
    (void)context;
    PROMISE(!world.plant.powered);
    memset(world.flash[sector], 0xFF, FLASH_BYTES);
    return true;
}

static void nothing(void *context)
{
    (void)context;
}

static void reboot(void *context)
{
    (void)context;
    PROMISE(!world.plant.powered);
    world.rebooted = true;
}

static void start(void)
{
    const device_config config = {.tick_s = 1e-3f,
                                  .tick_max_hz = 1000.0f,
                                  .name = "fuzz",
                                  .build = "",
                                  .links_n = LINKS_N,
                                  .servos_kind = world.servos_kind};
    static const hal_boot BOOT = {.clock_kind = CLOCK_HOST};
    world.rebooted = false;
    device_init(&world.device, &world.hal, &config, &BOOT);
}

static void say(uint8_t type, uint16_t seq, const uint8_t *payload, size_t payload_n)
{
    const frame f = {type, SESSION, seq, world.now_us, payload, payload_n};
    if (world.line_n + FRAME_WIRE_BYTES(payload_n) <= sizeof world.line) {
        world.line_n +=
            frame_encode(&f, world.line + world.line_n, sizeof world.line - world.line_n);
    }
}

static void tick(void)
{
    device_tick(&world.device);
    world.now_us += 1000;
    world.now_s += 1e-3;
    bus_model_run(&world.bus, world.now_s);
    servo_plant_tick(&world.plant, 1e-3f);
    const device *d = &world.device;
    const supervisor_state state = d->supervisor.state;
    const bool may_move = state >= SUPERVISOR_ARMING && state <= SUPERVISOR_RELAX;
    const bool tested = state == SUPERVISOR_DISARMED && d->servos.state == SERVOS_SERVICE;
    PROMISE(!has_torque() || may_move || tested);
    PROMISE(!world.plant.powered || may_move || state == SUPERVISOR_DISARMED ||
            state == SUPERVISOR_LIMP);
    const rod_joint *angles = rod_angles(&d->body.rod);
    /* contour has stops; an elastic rod an object or a shape can turn to anywhere */
    const float most = d->params.in_force.rod.model == ROD_MODEL_CONTOUR ? 1.6f : 3.2f;
    for (int i = 0; i < d->params.in_force.rod.links_n; i++) {
        PROMISE(fabsf(angles[i][0]) < most && fabsf(angles[i][1]) < most);
    }
    if (world.rebooted) {
        start();
    }
}

static void good_pose(void)
{
    const message m = {.type = MESSAGE_POSE, .pose = {.quaternion_xyzw = {0.0f, 0.0f, 0.0f, 1.0f}}};
    uint8_t payload[64];
    const int n = messages_pack(&m, payload, sizeof payload);
    say(MESSAGE_POSE, ++world.pose_seq, payload, (size_t)n);
    tick();
}

static void say_hello(void)
{
    const message m = {.type = MESSAGE_HELLO,
                       .hello = {.request_id = 1, .protocol_major = PROTOCOL_MAJOR}};
    uint8_t payload[128];
    const int n = messages_pack(&m, payload, sizeof payload);
    say(MESSAGE_HELLO, 0, payload, (size_t)n);
    tick();
}

int LLVMFuzzerTestOneInput(const uint8_t *input, size_t input_n)
{
    memset(&world, 0, sizeof world);
    memset(world.flash, 0xFF, sizeof world.flash);
    servo_plant_init(&world.plant, 3, 15.0f);
    bus_model_init(&world.bus, &world.plant, 2 * LINKS_N, 1000000);
    world.servos_kind = input_n > 0 ? input[0] % SERVOS_KINDS_N : SERVOS_BUS;
    world.hal = (hal){.now_us = now_us,
                      .line_read = line_read,
                      .line_write = line_write,
                      .line_free = line_free,
                      .line_overruns = none,
                      .line_framing_errors = none,
                      .servo_supply = servo_supply,
                      .pwm_start = pwm_start,
                      .pwm_pulse = pwm_pulse,
                      .pwm_stop = pwm_stop,
                      .bus_start = bus_start,
                      .bus_write = bus_write,
                      .bus_sending = bus_sending,
                      .bus_read = bus_read,
                      .bus_abort = bus_abort,
                      .estop_pressed = no,
                      .flash_sector_size = sector_size,
                      .flash_read = flash_read,
                      .flash_write = flash_write,
                      .flash_erase = flash_erase,
                      .stack_intact = yes,
                      .watchdog_feed = nothing,
                      .reboot = reboot};
    start();
    say_hello();
    for (size_t at = 1; at + 2 <= input_n;) {
        const uint8_t what = input[at] % 4;
        size_t n = input[at + 1];
        at += 2;
        if (what >= 2) {
            for (size_t i = 0; i < n; i++) {
                what == 2 ? tick() : good_pose();
            }
            continue;
        }
        n = n < input_n - at ? n : input_n - at;
        if (what == 0 && world.line_n + n <= sizeof world.line) {
            memcpy(world.line + world.line_n, input + at, n);
            world.line_n += n;
        } else if (what == 1 && n > 0) {
            say(input[at], input[at], input + at + 1, n - 1);
        }
        at += n;
        tick();
    }
    return 0;
}
