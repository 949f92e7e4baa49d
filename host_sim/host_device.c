/* host_device.c - see host_device.h. */
#include "host_device.h"

#include <string.h>

#include "sim.h"

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

static void servo_power(void *context, bool on)
{
    host_device *h = context;
    h->plant.powered = on;
}

static void servo_write(void *context, const float *goals_rad, int servos_n)
{
    host_device *h = context;
    servo_plant_write(&h->plant, goals_rad, servos_n);
}

static bool servo_read(void *context, float *positions_rad, int servos_n)
{
    const host_device *h = context;
    memcpy(positions_rad, h->plant.positions_rad, (size_t)servos_n * sizeof *positions_rad);
    return true;
}

static bool servo_healthy(void *context)
{
    const host_device *h = context;
    return !h->plant.failed;
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

void host_device_start(host_device *h, float tick_s, int links_n)
{
    h->hal = (hal){.context = h,
                   .now_us = now_us,
                   .line_read = line_read_hal,
                   .line_write = line_write_hal,
                   .line_free = line_free_hal,
                   .line_overruns = no_count,
                   .line_framing_errors = no_count,
                   .servo_power = servo_power,
                   .servo_write = servo_write,
                   .servo_read = servo_read,
                   .servo_healthy = servo_healthy,
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
                                            FEATURE_SERVO_POSITIONS | FEATURE_SIMULATED,
                                .name = "limber-sim",
                                .build = SIM_VERSION,
                                .links_n = links_n,
                                .watcher = body_log_watcher(&h->log)};
    h->boot.clock_kind = CLOCK_HOST;
    h->boot.estop_ignored = true;
    h->plant.powered = false;
    device_init(&h->device, &h->hal, &h->config, &h->boot);
}

/* What the script says goes wrong beside the line. */
static void inject(host_device *h)
{
    h->plant.failed = injection_now(&h->injection, INJECT_SERVO, h->elapsed_s) != NULL;
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
    if (h->rebooting) { /* power and program start afresh; flash and the world stay */
        h->rebooting = false;
        h->boot.cause = h->flash.cut ? HAL_RESET_POWER : HAL_RESET_SOFTWARE;
        h->flash.cut = false;
        h->flash.writes_left = -1;
        host_device_start(h, h->config.tick_s, h->config.links_n);
    }
}
