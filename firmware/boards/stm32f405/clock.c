/* clock.c - see clock.h. */
#include "clock.h"

#include <stdbool.h>

enum {
    HSI_HZ = 16000000,
    FULL_HZ = 168000000,
    /* The PLL turns 1 or 2 MHz (2 jitters less, RM0090 7.3.2) into 336, of which P = 2 makes 168 MHz. */
    HSE_STEP_HZ = LIMBER_HSE_HZ % 2000000 == 0 ? 2000000 : 1000000,
    VCO_HZ = 336000000,
    USB_DIVIDER = 7,
    FLASH_WAITS = 5,
    /* A poll takes 8 cycles of the 16 MHz clock or more: so many are at least 100 and 10 ms. */
    HSE_POLLS_N = HSI_HZ / 10 / 8,
    POLLS_N = HSI_HZ / 100 / 8,
};

_Static_assert(LIMBER_HSE_HZ % HSE_STEP_HZ == 0 && LIMBER_HSE_HZ >= 4000000 &&
                   LIMBER_HSE_HZ <= 26000000,
               "LIMBER_HSE_HZ: whole MHz, 4 to 26");

static bool wait(const reg *place, uint32_t field, uint32_t value, int polls_n)
{
    for (int i = 0; i < polls_n; i++) {
        if ((reg_read(place) & field) == value) {
            return true;
        }
    }
    return false;
}

static bool start_pll(rcc_registers *rcc, uint32_t source_bit, uint32_t source_hz, uint32_t step_hz)
{
    reg_clear(&rcc->cr, RCC_CR_PLLON);
    if (!wait(&rcc->cr, RCC_CR_PLLRDY, 0, POLLS_N)) {
        return false;
    }
    reg_write(&rcc->pllcfgr, source_bit | source_hz / step_hz |
                                 VCO_HZ / step_hz * RCC_PLLCFGR_PLLN0 |
                                 USB_DIVIDER * (uint32_t)RCC_PLLCFGR_PLLQ0); /* P: 0 means 2 */
    reg_set(&rcc->cr, RCC_CR_PLLON);
    return wait(&rcc->cr, RCC_CR_PLLRDY, RCC_CR_PLLRDY, POLLS_N);
}

/* Onto the PLL: first flash and buses are made fit for it, and back again where it does not come to it. */
static bool switch_to_pll(rcc_registers *rcc, flash_registers *flash)
{
    reg_write(&flash->acr, FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN | FLASH_WAITS);
    if (!wait(&flash->acr, FLASH_ACR_LATENCY_MASK, FLASH_WAITS, POLLS_N)) {
        return false; /* flash would be read faster than it can */
    }
    reg_change(&rcc->cfgr, RCC_CFGR_PPRE_MASK, RCC_CFGR_PPRE1_4 | RCC_CFGR_PPRE2_2);
    reg_change(&rcc->cfgr, RCC_CFGR_SW_MASK, RCC_CFGR_SW_PLL);
    if (wait(&rcc->cfgr, RCC_CFGR_SWS_MASK, RCC_CFGR_SWS_PLL, POLLS_N)) {
        return true;
    }
    reg_clear(&rcc->cfgr, RCC_CFGR_SW_MASK | RCC_CFGR_PPRE_MASK);
    return false;
}

static clock_state full_speed(clock_kind kind, uint32_t core_hz)
{
    return (clock_state){kind, core_hz, core_hz / 4, core_hz / 2, core_hz / 2};
}

clock_state clock_start(rcc_registers *rcc, flash_registers *flash, pwr_registers *pwr)
{
    reg_set(&rcc->apb1enr, RCC_APB1ENR_PWREN);
    reg_set(&pwr->cr, PWR_CR_VOS); /* scale 1: above 144 MHz it takes the whole voltage */
    reg_set(&rcc->cr, RCC_CR_HSEON);
    if (wait(&rcc->cr, RCC_CR_HSERDY, RCC_CR_HSERDY, HSE_POLLS_N) &&
        start_pll(rcc, RCC_PLLCFGR_PLLSRC, LIMBER_HSE_HZ, HSE_STEP_HZ) &&
        switch_to_pll(rcc, flash)) {
        reg_set(&rcc->cr, RCC_CR_CSSON);
        return full_speed(CLOCK_HSE_PLL, FULL_HZ);
    }
    if (start_pll(rcc, 0, HSI_HZ, 2000000) && switch_to_pll(rcc, flash)) {
        reg_clear(&rcc->cr, RCC_CR_HSEON);
        return full_speed(CLOCK_HSI_PLL, FULL_HZ);
    }
    reg_clear(&rcc->cr, RCC_CR_HSEON | RCC_CR_PLLON);
    return (clock_state){CLOCK_HSI, HSI_HZ, HSI_HZ, HSI_HZ, HSI_HZ};
}

clock_state clock_emulated(uint32_t core_hz)
{
    return full_speed(CLOCK_EMULATED, core_hz);
}
