/* hal.h - everything the app needs of hardware, as one struct of functions.
 *
 * A board, the simulator and every test fill one in; the app knows no register and no clock of its own.
 * All functions are called from the main loop only, never from an interrupt, and none blocks: what
 * cannot be done at once is refused or done in part, and the return value says so. `context` is handed
 * back to each of them.
 */
#ifndef LIMBER_HAL_H
#define LIMBER_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Why the processor last started, for BOOT_REPORT. */
typedef enum {
    HAL_RESET_POWER,
    HAL_RESET_PIN,
    HAL_RESET_SOFTWARE,
    HAL_RESET_WATCHDOG,
    HAL_RESET_FAULT, /* the fault handler restarted; pc, lr and cfsr tell where */
} hal_reset_cause;

typedef struct {
    hal_reset_cause cause;
    uint32_t pc, lr, cfsr;
    uint32_t clock_hz; /* of the core, as reached */
    uint8_t
        clock_kind; /* 0 HSE through the PLL, 1 HSI through the PLL, 2 HSI, 3 emulator, 4 host */
    bool estop_ignored; /* no such pin here (emulator, host) */
} hal_boot;

/* Two flash sectors for settings. Erased bytes read 0xFF; a write may only clear bits. */
enum { HAL_FLASH_SECTORS_N = 2 };

typedef struct {
    void *context;

    /* Microseconds since some moment, wrapping at 2^32; never runs backwards. */
    uint32_t (*now_us)(void *context);

    /* The line to the PC. Read: up to room bytes that have arrived; returns how many. Write: takes what
     * fits its queue, all or nothing; returns whether it did. Free: the room in that queue, bytes. */
    size_t (*line_read)(void *context, uint8_t *bytes, size_t room);
    bool (*line_write)(void *context, const uint8_t *bytes, size_t bytes_n);
    size_t (*line_free)(void *context);
    /* Bytes lost since the start: for want of room, and to framing errors of the UART. */
    uint32_t (*line_overruns)(void *context);
    uint32_t (*line_framing_errors)(void *context);

    /* Servos, in radians of the joint's servo shaft, servo 0 ... servos_n - 1 (theta_1, phi_1, theta_2 ...).
     * Power: cuts or gives supply and torque; cutting aborts any transfer under way. Write: new goals, all at
     * once. Read: the present positions where the servos tell (returns false where they cannot: hobby PWM).
     * Healthy: false once a servo has reported an error or does not answer. */
    void (*servo_power)(void *context, bool on);
    void (*servo_write)(void *context, const float *goals_rad, int servos_n);
    bool (*servo_read)(void *context, float *positions_rad, int servos_n);
    bool (*servo_healthy)(void *context);

    /* The e-stop input: true means stop. */
    bool (*estop_pressed)(void *context);

    /* Flash, see above. Offsets and sizes in bytes, writes in multiples of 4 at multiples of 4. Erase may take
     * 2 s and is called only before the servos have power. False: the hardware reported an error. */
    uint32_t (*flash_sector_size)(void *context);
    void (*flash_read)(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n);
    bool (*flash_write)(void *context, int sector, uint32_t offset, const void *bytes,
                        size_t bytes_n);
    bool (*flash_erase)(void *context, int sector);

    /* Once a tick, by the main loop, and only if all of it checked in. */
    void (*watchdog_feed)(void *context);
    void (*reboot)(void *context);
} hal;

#endif
