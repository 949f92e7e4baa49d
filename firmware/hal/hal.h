/* hal.h - everything the app needs of hardware, as one struct of functions.
 *
 * A board, the simulator and every test fill one in; the app knows no register and no clock of its own.
 * All functions are called from the main loop only, never from an interrupt, and none but flash_erase blocks: what
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
    HAL_RESET_FAULT, /* the firmware restarted itself: `fault` says why; pc, lr and cfsr tell where */
} hal_reset_cause;

/* What the firmware had found wrong with itself before it restarted. */
typedef enum {
    HAL_FAULT_NONE,
    HAL_FAULT_PROCESSOR, /* a fault exception: cfsr tells which */
    HAL_FAULT_STACK,     /* the stack ran into its guard */
    HAL_FAULT_WATCHDOG,  /* the main loop did not come round in time: pc is where it was */
} hal_fault;

typedef struct {
    hal_reset_cause cause;
    hal_fault fault; /* with HAL_RESET_FAULT */
    uint32_t pc, lr, cfsr;
    uint32_t
        clock_hz; /* of the core, as reached; what a tick may take is told from it (0: anything) */
    uint8_t
        clock_kind; /* 0 HSE through the PLL, 1 HSI through the PLL, 2 HSI, 3 emulator, 4 host */
    bool estop_ignored; /* no such pin here (emulator, host) */
} hal_boot;

enum {
    HAL_PWM_CHANNELS_N = 8,
    HAL_BUS_PACKET_MAX_BYTES = 880, /* goals of 128 servos, and a stuffed byte after every third */
};

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

    /* The supply of all servos, one switch. Off at start. */
    void (*servo_supply)(void *context, bool on);

    /* Hobby servos, channels 0 ... HAL_PWM_CHANNELS_N - 1. Start: pulses at this rate from now on, none on any
     * channel yet; false where it cannot be made. Pulse: its width from the next period on, 0: none. Stop: no
     * pulse on any channel, at once. */
    bool (*pwm_start)(void *context, float rate_hz);
    void (*pwm_pulse)(void *context, int channel, uint32_t width_us);
    void (*pwm_stop)(void *context);

    /* The servo bus: one wire, half duplex, 8N1. Start: at this rate from now on, nothing under way; false where the
     * clock cannot make it within 1 %. Write: takes the whole packet and sends it by itself, or nothing while one is
     * under way (or it is longer than HAL_BUS_PACKET_MAX_BYTES). Sending: until the last stop bit is out.
     * Read: bytes that have come; whether the packet's own echo is among them depends on the wiring. Abort: ends what
     * is under way within two bytes and forgets what has come. */
    bool (*bus_start)(void *context, uint32_t baud);
    bool (*bus_write)(void *context, const uint8_t *bytes, size_t bytes_n);
    bool (*bus_sending)(void *context);
    size_t (*bus_read)(void *context, uint8_t *bytes, size_t room);
    void (*bus_abort)(void *context);
    /* How much later than its bytes take an answer may be seen: 0, but where an emulator's host carries them. */
    uint32_t bus_slack_us;

    /* The e-stop input: true means stop. */
    bool (*estop_pressed)(void *context);

    /* Flash, see above. Offsets and sizes in bytes, writes in multiples of 4 at multiples of 4. Erase may take
     * 2 s and is called only before the servos have power. False: the hardware reported an error. */
    uint32_t (*flash_sector_size)(void *context);
    void (*flash_read)(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n);
    bool (*flash_write)(void *context, int sector, uint32_t offset, const void *bytes,
                        size_t bytes_n);
    bool (*flash_erase)(void *context, int sector);

    /* False once the stack has grown over its end: nothing is to be trusted from then on. */
    bool (*stack_intact)(void *context);

    /* Once a tick, by the main loop, and only if all of it checked in. */
    void (*watchdog_feed)(void *context);
    void (*reboot)(void *context);
} hal;

#endif
