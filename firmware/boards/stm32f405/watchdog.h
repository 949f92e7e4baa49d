/* watchdog.h - two watches over the main loop.
 *
 * One in SysTick's interrupt: not fed for 50 ms, it restarts the firmware by way of fault.h, which knows where
 * the main loop was. One in hardware (IWDG, RM0090 section 21) behind it, for when not even that interrupt
 * runs: 100 ms, 68 to 188 with its oscillator of 17 to 47 kHz, and never to be stopped again. It
 * can only tell that it was (HAL_RESET_WATCHDOG). Both start after device_init, which may erase flash for 2 s.
 */
#ifndef LIMBER_WATCHDOG_H
#define LIMBER_WATCHDOG_H

#include <stdbool.h>

#include "registers.h"

enum { WATCHDOG_SOFT_MS = 50, WATCHDOG_HARD_MS = 100 };

typedef struct {
    iwdg_registers *iwdg;
    uint32_t limit_ticks;
    volatile uint32_t fed; /* tick of the last feeding */
    volatile bool watching;
} watchdog;

/* Starts both. False where the hardware one did not take its settings within 1 ms (11 at 16 MHz): it runs all the same,
 * with 0.5 s. tick_hz 100 or 1000; now is the tick. */
bool watchdog_start(watchdog *w, iwdg_registers *iwdg, uint32_t tick_hz, uint32_t now);

/* Main loop only. */
void watchdog_feed(watchdog *w, uint32_t now);

/* For SysTick's interrupt: whether it has not been fed in time. False until started. */
bool watchdog_starved(const watchdog *w, uint32_t now);

#endif
