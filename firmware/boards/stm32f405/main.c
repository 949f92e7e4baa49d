/* main.c - the firmware: the board, the device, and a tick of it for every tick of the clock. */
#include "board.h"
#include "device.h"

#ifndef LIMBER_BUILD
#define LIMBER_BUILD "unknown"
#endif

_Static_assert(sizeof LIMBER_BUILD <= 24 + 1, "build: at most 24 bytes");

int main(void);

/* Steady with torque, a flash a second without, quick where a fault or the e-stop is latched. */
static bool led(supervisor_state state, uint32_t now_us)
{
    const bool latched = state == SUPERVISOR_FAULT || state == SUPERVISOR_ESTOP;
    const bool torque = state >= SUPERVISOR_ARMING && state <= SUPERVISOR_RELAX;
    const uint32_t period_us = latched ? 200000 : 1000000;
    return torque || now_us % period_us < 100000;
}

int main(void)
{
    static device the_device;
    static hal the_hal;
    hal_boot boot;
    board_start(&the_hal, &boot);
    const float tick_hz = (float)board_tick_hz();
    const device_config config = {
        .tick_s = 1.0f / tick_hz,
        .tick_max_hz = tick_hz,
        .line_baud = LIMBER_LINK_BAUD,
        .features = FEATURE_NODES | FEATURE_POSE_LOG | FEATURE_SETTINGS | FEATURE_SERVO_ASSIGN |
                    (boot.estop_ignored ? 0u : (uint32_t)FEATURE_ESTOP_INPUT),
        .name = "limber-stm32f405",
        .build = LIMBER_BUILD,
        .links_n = 4,
    };
    device_init(&the_device, &the_hal, &config, &boot);
    board_watch();
    for (uint32_t tick = 0;;) {
        tick = board_wait(tick);
        device_tick(&the_device);
        board_led(led(the_device.supervisor.state, the_device.now_us));
    }
}
