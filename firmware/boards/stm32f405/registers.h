/* registers.h - the STM32F405's registers, as far as this firmware uses them.
 *
 * Names are those of RM0090 and of the ARMv7-M Architecture Reference Manual (ARM DDI 0403), in small letters.
 * Places and bits are held against independent sources by tests/board/offsets_test.py.
 *
 * Drivers take a pointer to their block and touch it through the functions below only. On the board these
 * are one load or store each; the tests compile the same drivers with REGISTERS_SCRIPTED and answer for
 * the hardware (tests/board/scripted.h).
 */
#ifndef LIMBER_REGISTERS_H
#define LIMBER_REGISTERS_H

#include <stdint.h>

typedef volatile uint32_t reg;

#ifdef REGISTERS_SCRIPTED
uint32_t reg_read(const reg *place);
void reg_write(reg *place, uint32_t value);
static inline void memory_barrier(void) {}
static inline uint32_t interrupts_hold(void)
{
    return 0;
}
static inline void interrupts_release(uint32_t held)
{
    (void)held;
}
#else
static inline uint32_t reg_read(const reg *place)
{
    return *place;
}

static inline void reg_write(reg *place, uint32_t value)
{
    *place = value;
}

/* All before it has reached memory and is in force before anything after it happens. */
static inline void memory_barrier(void)
{
    __asm__ volatile("dsb \n isb" ::: "memory");
}

/* Between these two no interrupt comes in; faults do. May be nested. */
static inline uint32_t interrupts_hold(void)
{
    uint32_t held;
    __asm__ volatile("mrs %0, primask \n cpsid i" : "=r"(held)::"memory");
    return held;
}

static inline void interrupts_release(uint32_t held)
{
    __asm__ volatile("msr primask, %0" ::"r"(held) : "memory");
}
#endif

static inline void reg_set(reg *place, uint32_t bits)
{
    reg_write(place, reg_read(place) | bits);
}

static inline void reg_clear(reg *place, uint32_t bits)
{
    reg_write(place, reg_read(place) & ~bits);
}

static inline void reg_change(reg *place, uint32_t field, uint32_t value)
{
    reg_write(place, (reg_read(place) & ~field) | value);
}

/* --- RM0090 section 7: reset and clock control -------------------------------------------------------- */

typedef struct {
    reg cr, pllcfgr, cfgr, cir, ahb1rstr, ahb2rstr, ahb3rstr, reserved0, apb1rstr, apb2rstr,
        reserved1[2];
    reg ahb1enr, ahb2enr, ahb3enr, reserved2, apb1enr, apb2enr, reserved3[2], reserved4[8], bdcr,
        csr;
} rcc_registers;
#define RCC ((rcc_registers *)0x40023800u)

enum {
    RCC_CR_HSEON = 1 << 16,
    RCC_CR_HSERDY = 1 << 17,
    RCC_CR_CSSON = 1 << 19,
    RCC_CR_PLLON = 1 << 24,
    RCC_CR_PLLRDY = 1 << 25,
    RCC_PLLCFGR_PLLN0 = 1 << 6, /* lowest bit of the field */
    RCC_PLLCFGR_PLLP0 = 1 << 16,
    RCC_PLLCFGR_PLLSRC = 1 << 22,
    RCC_PLLCFGR_PLLQ0 = 1 << 24,
    RCC_CFGR_SW0 = 1 << 0,
    RCC_CFGR_SW_MASK = 3 << 0,
    RCC_CFGR_SW_PLL = 2 << 0,
    RCC_CFGR_SWS_MASK = 3 << 2,
    RCC_CFGR_SWS_PLL = 2 << 2,
    RCC_CFGR_PPRE_MASK = 0x3F << 10,
    RCC_CFGR_PPRE1_4 = 5 << 10,
    RCC_CFGR_PPRE2_2 = 4 << 13,
    RCC_AHB1ENR_GPIOAEN = 1 << 0,
    RCC_AHB1ENR_GPIOBEN = 1 << 1,
    RCC_AHB1ENR_GPIOCEN = 1 << 2,
    RCC_APB1ENR_TIM3EN = 1 << 1,
    RCC_APB1ENR_TIM4EN = 1 << 2,
    RCC_APB1ENR_USART2EN = 1 << 17,
    RCC_APB1ENR_PWREN = 1 << 28,
    RCC_APB2ENR_USART1EN = 1 << 4,
    RCC_APB2ENR_USART6EN = 1 << 5,
    RCC_CSR_RMVF = 1 << 24,
    RCC_CSR_BORRSTF = 1 << 25,
    RCC_CSR_PADRSTF = 1 << 26, /* PINRSTF in RM0090 */
    RCC_CSR_PORRSTF = 1 << 27,
    RCC_CSR_SFTRSTF = 1 << 28,
    RCC_CSR_WDGRSTF = 1 << 29, /* IWDGRSTF in RM0090 */
};

/* --- section 5: power --------------------------------------------------------------------------------- */

typedef struct {
    reg cr, csr;
} pwr_registers;
#define PWR ((pwr_registers *)0x40007000u)

enum { PWR_CR_VOS = 1 << 14 };

/* --- section 3: flash --------------------------------------------------------------------------------- */

typedef struct {
    reg acr, keyr, optkeyr, sr, cr;
} flash_registers;
#define FLASH ((flash_registers *)0x40023C00u)

enum {
    FLASH_ACR_LATENCY_MASK = 7 << 0,
    FLASH_ACR_PRFTEN = 1 << 8,
    FLASH_ACR_ICEN = 1 << 9,
    FLASH_ACR_DCEN = 1 << 10,
    FLASH_ACR_DCRST = 1 << 12,
    FLASH_SR_EOP = 1 << 0,
    FLASH_SR_OPERR = 1 << 1,
    FLASH_SR_WRPERR = 1 << 4,
    FLASH_SR_PGAERR = 1 << 5,
    FLASH_SR_PGPERR = 1 << 6,
    FLASH_SR_PGSERR = 1 << 7,
    FLASH_SR_BSY = 1 << 16,
    FLASH_CR_PG = 1 << 0,
    FLASH_CR_SER = 1 << 1,
    FLASH_CR_SNB0 = 1 << 3,
    FLASH_CR_PSIZE_WORD = 2 << 8,
    FLASH_CR_STRT = 1 << 16,
};
#define FLASH_CR_LOCK (1u << 31)

/* --- section 8: pins ---------------------------------------------------------------------------------- */

typedef struct {
    reg moder, otyper, ospeedr, pupdr, idr, odr, bsrr, lckr, afrl, afrh;
} gpio_registers;
#define GPIOA ((gpio_registers *)0x40020000u)
#define GPIOB ((gpio_registers *)0x40020400u)
#define GPIOC ((gpio_registers *)0x40020800u)

/* --- section 18: timers TIM2 to TIM5 ------------------------------------------------------------------ */

typedef struct {
    reg cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr, reserved0, ccr[4];
} tim_registers;
#define TIM2 ((tim_registers *)0x40000000u)
#define TIM3 ((tim_registers *)0x40000400u)
#define TIM4 ((tim_registers *)0x40000800u)

enum {
    TIM_CR1_CEN = 1 << 0,
    TIM_CR1_ARPE = 1 << 7,
    TIM_EGR_UG = 1 << 0,
    /* both channels of a CCMR; the modes of OCxM are in 18.4.7 */
    TIM_CCMR_LOW = 0x4040,         /* 100: forced inactive, at once */
    TIM_CCMR_PWM_PRELOAD = 0x6868, /* 110: PWM mode 1; widths are taken over at the next period */
    TIM_CCER_ALL = 0x1111,         /* CC1E to CC4E */
};

/* --- section 30: serial lines ------------------------------------------------------------------------- */

typedef struct {
    reg sr, dr, brr, cr1, cr2, cr3, gtpr;
} usart_registers;
#define USART1 ((usart_registers *)0x40011000u)
#define USART2 ((usart_registers *)0x40004400u)
#define USART6 ((usart_registers *)0x40011400u)

enum {
    USART_SR_FE = 1 << 1,
    USART_SR_ORE = 1 << 3,
    USART_SR_RXNE = 1 << 5,
    USART_SR_TC = 1 << 6,
    USART_SR_TXE = 1 << 7,
    USART_CR1_RE = 1 << 2,
    USART_CR1_TE = 1 << 3,
    USART_CR1_RXNEIE = 1 << 5,
    USART_CR1_TCIE = 1 << 6,
    USART_CR1_TXEIE = 1 << 7,
    USART_CR1_UE = 1 << 13,
    USART_CR1_OVER8 = 1 << 15,
    USART_CR3_HDSEL = 1 << 3,
};

/* --- section 21: independent watchdog ----------------------------------------------------------------- */

typedef struct {
    reg kr, pr, rlr, sr;
} iwdg_registers;
#define IWDG ((iwdg_registers *)0x40003000u)

enum { IWDG_SR_PVU = 1 << 0, IWDG_SR_RVU = 1 << 1 };

/* --- the core: ARMv7-M, B3.2 (SCB), B3.3 (SysTick), B3.4 (NVIC), B3.5 (MPU) ----------------------------- */

typedef struct {
    reg csr, rvr, cvr, calib;
} systick_registers;
#define SYSTICK ((systick_registers *)0xE000E010u)

enum {
    SYSTICK_CSR_ENABLE = 1 << 0,
    SYSTICK_CSR_TICKINT = 1 << 1,
    SYSTICK_CSR_CLKSOURCE = 1 << 2,
    SYSTICK_CALIB_TENMS_MASK = 0xFFFFFF,
};

typedef struct {
    reg icsr, vtor, aircr, scr, ccr, shpr[3], shcsr, cfsr, hfsr, dfsr, mmfar, bfar;
} scb_registers;
#define SCB ((scb_registers *)0xE000ED04u)

enum {
    SCB_ICSR_PENDSTSET = 1 << 26,
    SCB_AIRCR_SYSRESETREQ = 1 << 2,
    SCB_SHCSR_MEMFAULTENA = 1 << 16,
    SCB_SHCSR_BUSFAULTENA = 1 << 17,
    SCB_SHCSR_USGFAULTENA = 1 << 18,
    SCB_CFSR_MSTKERR = 1 << 4,
    SCB_CFSR_MLSPERR = 1 << 5,
    SCB_CFSR_MMARVALID = 1 << 7,
    SCB_CFSR_STKERR = 1 << 12,
    SCB_CFSR_LSPERR = 1 << 13,
};
#define SCB_AIRCR_VECTKEY 0x05FA0000u

typedef struct {
    reg iser[16], reserved0[176], ipr[124]; /* ipr: four interrupts a word, a byte each */
} nvic_registers;
#define NVIC ((nvic_registers *)0xE000E100u)

enum { INTERRUPT_USART1 = 37, INTERRUPT_USART2 = 38, INTERRUPT_USART6 = 71 };

typedef struct {
    reg type, ctrl, rnr, rbar, rasr;
} mpu_registers;
#define MPU ((mpu_registers *)0xE000ED90u)

enum {
    MPU_CTRL_ENABLE = 1 << 0,
    MPU_CTRL_PRIVDEFENA = 1 << 2, /* the default memory map where no region lies */
    MPU_RASR_ENABLE = 1 << 0,
    MPU_RASR_SIZE0 = 1 << 1, /* of 2^(SIZE + 1) bytes; with AP = 0 there is no access at all */
};

#endif
