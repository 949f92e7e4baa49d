/* clock.h - the fastest clock that this board can have right now, and which one it became.
 *
 *     crystal -> PLL -> 168 MHz   else   internal oscillator -> PLL -> 168 MHz   else   internal, 16 MHz
 *
 * The crystal's frequency is a build option, LIMBER_HSE_HZ (8 MHz). RM0090: 7.2 clocks, 7.3.2 PLL, 3.5.1 flash
 * wait states (5 at 168 MHz and 3.3 V), 5.1.3 regulator. The internal oscillator is good to 1 % at room
 * temperature, a crystal to 0.005 %: the PC's clock map does not mind, a UART just bears it.
 *
 * Should the crystal stop later, the clock security system (7.2.7) raises an NMI, which restarts
 * the firmware (fault.h); it then comes up on the internal oscillator.
 */
#ifndef LIMBER_CLOCK_H
#define LIMBER_CLOCK_H

#include "registers.h"

#ifndef LIMBER_HSE_HZ
#define LIMBER_HSE_HZ 8000000
#endif

/* hal_boot.clock_kind */
typedef enum { CLOCK_HSE_PLL, CLOCK_HSI_PLL, CLOCK_HSI, CLOCK_EMULATED } clock_kind;

typedef struct {
    clock_kind kind;
    uint32_t core_hz;
    uint32_t apb1_hz, apb2_hz; /* USART2; USART1 and USART6 */
    uint32_t
        apb1_timer_hz; /* TIM3, TIM4: twice their bus where that is slower than the core (7.2) */
} clock_state;

/* Call once after reset, with the clock as reset leaves it and no interrupt enabled. Waits 0.1 s for the
 * crystal at most, and 10 ms for each other step; never fails. */
clock_state clock_start(rcc_registers *rcc, flash_registers *flash, pwr_registers *pwr);

/* What an emulator says its core runs at; its buses are those of the 168 MHz board. */
clock_state clock_emulated(uint32_t core_hz);

#endif
