/* timebase.h - ticks and microseconds, both of SysTick (ARMv7-M B3.3).
 *
 * A tick is 1 ms where the core runs at 100 MHz or more, and 10 ms where it fell back to 16 MHz, so that one
 * tick's work still fits. All time comes from here: there is no second clock to disagree with. (On an emulator
 * it is its host's: timebase_emulated.)
 *
 * Whether to believe the clock reached (clock.h): SYST_CALIB.TENMS reads 18,750 on this chip (RM0090 12.1.3);
 * where it reads anything else an emulator counts SysTick, at (TENMS + 1) * 800 Hz.
 *
 * Time stands still while flash is erased or programmed, since the core does (flash.h), and an interrupt held
 * off for more than a tick loses one.
 */
#ifndef LIMBER_TIMEBASE_H
#define LIMBER_TIMEBASE_H

#include "clock.h"

typedef struct {
    systick_registers *systick;
    scb_registers *scb;
    uint32_t tick_counts, tick_us;
    volatile uint32_t ticks;            /* wraps */
    tim_registers *host_clock;          /* of an emulator, else NULL */
    volatile uint32_t host_ns, host_us; /* its reading at the last interrupt, and what that was */
} timebase;

/* The clock as reached, or CLOCK_EMULATED where SYST_CALIB tells an emulator. */
clock_state timebase_trust(const systick_registers *systick, clock_state reached);

/* How often core_hz can tick. */
uint32_t timebase_tick_hz(uint32_t core_hz);

/* Starts SysTick with its interrupt; core_hz at most 2^24 tick_hz. */
void timebase_start(timebase *t, systick_registers *systick, scb_registers *scb, uint32_t core_hz);

/* On an emulator, right after the start: microseconds come from tim2, which QEMU lets count ns. It runs on while its
 * host is busy, and several ticks then come as one interrupt; a clock that counted those would fall behind the
 * PC's by some percent. */
void timebase_emulated(timebase *t, tim_registers *tim2);

/* SysTick's interrupt, first thing. */
void timebase_interrupt(timebase *t);

/* Microseconds since the start, wrapping at 2^32; never backwards. From anywhere, interrupts held or not and
 * interrupt handlers included: a tick whose interrupt still waits is counted. About 40 cycles. */
uint32_t timebase_now_us(const timebase *t);

#endif
