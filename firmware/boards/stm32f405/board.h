/* board.h - the STM32F405 board as the app sees it: its hal, made of the drivers beside this file.
 *
 *     board_start(&hal, &boot);   first thing in main
 *     device_init(...);
 *     board_watch();              from here on hal.watchdog_feed is due
 *     tick = board_wait(tick);    and device_tick, for ever
 *
 * One board, so its state is static, in board.c. Main loop only, where nothing else is said.
 *
 * Interrupts, the most urgent first: faults; the servo bus; the link; SysTick. None waits for another.
 */
#ifndef LIMBER_BOARD_H
#define LIMBER_BOARD_H

#include "clock.h"
#include "hal.h"

enum {
    BOARD_LINK_RX_BYTES = 1024, /* 10 ms of 1 Mbaud */
    BOARD_LINK_TX_BYTES = 2048,
    BOARD_BUS_RX_BYTES = 512, /* more than one tick brings at 4 Mbaud */
    BOARD_BUS_TX_BYTES = 1024,
};

#ifndef LIMBER_LINK_BAUD
#define LIMBER_LINK_BAUD 1000000
#endif

/* Pins safe, clock, time, why it was reset, stack guard, link; fills in *hal, which lasts, and *boot. Up to 0.1 s,
 * more than that only where the crystal is dead. */
void board_start(hal *hal, hal_boot *boot);

/* How often board_wait returns. */
uint32_t board_tick_hz(void);

/* Starts the watchdogs; there is no stopping them. */
void board_watch(void);

/* Sleeps until the tick after `last` is due, or not at all if it is over already; returns the tick it is now.
 * Ticks that were missed are not made up for. */
uint32_t board_wait(uint32_t last);

void board_led(bool on);

/* SysTick's interrupt (handlers.c): false once the main loop is overdue. */
bool board_tick(void);
void board_tick_interrupt(const uint32_t *frame);

#endif
