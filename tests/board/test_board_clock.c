/* test_board_clock.c - the clock on a model of RCC: crystals, PLLs and flash that are late, dead or well. */
#include <string.h>

#include "clock.h"
#include "scripted.h"
#include "unity.h"

enum { NEVER = -1, HSI_MHZ = 16, HSE_MHZ = 8 };

/* How many polls each thing takes, or NEVER. */
static struct {
    int hse_polls, pll_polls[2] /* of the HSI, of the HSE */, switch_polls;
    bool flash_dead, switches;
} hardware;
static int hse_waited, pll_waited, switch_waited;
static rcc_registers rcc;
static flash_registers flash;
static pwr_registers pwr;

static bool ready(int polls, int *waited)
{
    return polls != NEVER && (*waited)++ >= polls;
}

static uint32_t pll_source(void)
{
    return (rcc.pllcfgr & RCC_PLLCFGR_PLLSRC) != 0 ? 1 : 0;
}

static bool pll_runs(void)
{
    return (rcc.cr & RCC_CR_PLLON) != 0 && hardware.pll_polls[pll_source()] != NEVER &&
           pll_waited > hardware.pll_polls[pll_source()];
}

static uint32_t read(const reg *place, uint32_t held)
{
    if (place == &rcc.cr) {
        const bool hse = (held & RCC_CR_HSEON) != 0 && ready(hardware.hse_polls, &hse_waited);
        const bool pll =
            (held & RCC_CR_PLLON) != 0 && ready(hardware.pll_polls[pll_source()], &pll_waited);
        return held | (hse ? RCC_CR_HSERDY : 0u) | (pll ? RCC_CR_PLLRDY : 0u);
    }
    if (place == &rcc.cfgr) {
        const bool asked = (held & RCC_CFGR_SW_MASK) == RCC_CFGR_SW_PLL;
        const bool done = asked && ready(hardware.switch_polls, &switch_waited);
        return held | (done ? (uint32_t)RCC_CFGR_SWS_PLL : 0u);
    }
    return held;
}

/* The rules of RM0090: 7.3.2 PLLCFGR is written while the PLL is off; 3.5.1 flash is slowed down before the
 * clock is sped up; 7.2 the buses' limits. */
static bool write(reg *place, uint32_t value)
{
    if (place == &flash.acr && hardware.flash_dead) {
        return true;
    }
    if (place == &rcc.pllcfgr) {
        TEST_ASSERT_EQUAL_HEX32(0, rcc.cr & RCC_CR_PLLON);
        const bool hse = (value & RCC_PLLCFGR_PLLSRC) != 0;
        const uint32_t m = value & 0x3F, n = value >> 6 & 0x1FF, p = 2 + 2 * (value >> 16 & 3),
                       q = value >> 24 & 0xF;
        const uint32_t source = hse ? HSE_MHZ : HSI_MHZ;
        TEST_ASSERT_EQUAL_UINT32(2, source / m); /* MHz into the VCO */
        TEST_ASSERT_EQUAL_UINT32(168, source / m * n / p);
        TEST_ASSERT_EQUAL_UINT32(48, source / m * n / q);
        pll_waited = 0;
    }
    if (place == &rcc.cr && (value & RCC_CR_PLLON) == 0) {
        pll_waited = 0;
    }
    if (place == &rcc.cfgr && (value & RCC_CFGR_SW_MASK) == RCC_CFGR_SW_PLL) {
        TEST_ASSERT_TRUE(pll_runs());
        TEST_ASSERT_EQUAL_HEX32(5, flash.acr & FLASH_ACR_LATENCY_MASK);
        TEST_ASSERT_EQUAL_HEX32(5 << 10 | 4 << 13, value & RCC_CFGR_PPRE_MASK);
        TEST_ASSERT_TRUE((pwr.cr & PWR_CR_VOS) != 0 && (rcc.apb1enr & RCC_APB1ENR_PWREN) != 0);
        hardware.switches = true;
        switch_waited = 0;
    }
    return false;
}

static clock_state start(int hse, int hse_pll, int hsi_pll, int switching, bool flash_dead)
{
    memset(&rcc, 0, sizeof rcc);
    memset(&flash, 0, sizeof flash);
    memset(&pwr, 0, sizeof pwr);
    hardware.hse_polls = hse;
    hardware.pll_polls[0] = hsi_pll;
    hardware.pll_polls[1] = hse_pll;
    hardware.switch_polls = switching;
    hardware.flash_dead = flash_dead;
    hardware.switches = false;
    hse_waited = pll_waited = switch_waited = 0;
    scripted_start((script){read, write});
    return clock_start(&rcc, &flash, &pwr);
}

void setUp(void) {}
void tearDown(void) {}

static void full_speed(const clock_state *clock, clock_kind kind)
{
    TEST_ASSERT_EQUAL_INT(kind, clock->kind);
    TEST_ASSERT_EQUAL_UINT32(168000000, clock->core_hz);
    TEST_ASSERT_EQUAL_UINT32(42000000, clock->apb1_hz);
    TEST_ASSERT_EQUAL_UINT32(84000000, clock->apb2_hz);
    TEST_ASSERT_EQUAL_UINT32(84000000, clock->apb1_timer_hz);
    TEST_ASSERT_EQUAL_HEX32(RCC_CFGR_SW_PLL, rcc.cfgr & RCC_CFGR_SW_MASK);
    TEST_ASSERT_TRUE((flash.acr & FLASH_ACR_PRFTEN) != 0 && (flash.acr & FLASH_ACR_ICEN) != 0 &&
                     (flash.acr & FLASH_ACR_DCEN) != 0);
}

static void slow(const clock_state *clock)
{
    TEST_ASSERT_EQUAL_INT(CLOCK_HSI, clock->kind);
    TEST_ASSERT_EQUAL_UINT32(16000000, clock->core_hz);
    TEST_ASSERT_EQUAL_UINT32(16000000, clock->apb1_hz);
    TEST_ASSERT_EQUAL_UINT32(16000000, clock->apb2_hz);
    TEST_ASSERT_EQUAL_UINT32(16000000, clock->apb1_timer_hz);
    TEST_ASSERT_EQUAL_HEX32(0, rcc.cfgr & (RCC_CFGR_SW_MASK | RCC_CFGR_PPRE_MASK));
    TEST_ASSERT_EQUAL_HEX32(0, rcc.cr & (RCC_CR_HSEON | RCC_CR_PLLON));
    TEST_ASSERT_TRUE(scripted_reads_n < 300000); /* a fifth of a second at the utmost */
}

static void crystal_and_pll_late_or_at_once(void)
{
    static const int POLLS[] = {0, 1, 7, 1000, 19000};
    for (int i = 0; i < 5; i++) {
        for (int j = 0; j < 5; j++) {
            const clock_state clock = start(10 * POLLS[i], POLLS[j], NEVER, POLLS[i], false);
            full_speed(&clock, CLOCK_HSE_PLL);
            TEST_ASSERT_TRUE((rcc.cr & RCC_CR_CSSON) != 0);
        }
    }
}

static void no_crystal_is_the_internal_oscillator_through_the_pll(void)
{
    const clock_state clock = start(NEVER, 0, 500, 2, false);
    full_speed(&clock, CLOCK_HSI_PLL);
    TEST_ASSERT_EQUAL_HEX32(0, rcc.cr & (RCC_CR_HSEON | RCC_CR_CSSON));
    TEST_ASSERT_TRUE(scripted_reads_n > 200000); /* it was waited for: 16 MHz * 0.1 s / 8 */
    TEST_ASSERT_TRUE(scripted_reads_n < 300000);
}

static void a_pll_that_the_crystal_does_not_start_is_tried_with_the_other(void)
{
    const clock_state clock = start(3, NEVER, 3, 0, false);
    full_speed(&clock, CLOCK_HSI_PLL);
}

static void no_pll_is_16_mhz(void)
{
    clock_state clock = start(3, NEVER, NEVER, 0, false);
    slow(&clock);
    clock = start(NEVER, NEVER, NEVER, NEVER, false);
    slow(&clock);
    TEST_ASSERT_FALSE(hardware.switches);
}

static void a_switch_that_never_comes_is_taken_back(void)
{
    const clock_state clock = start(3, 3, 3, NEVER, false);
    slow(&clock);
    TEST_ASSERT_TRUE(hardware.switches);
}

static void flash_that_does_not_slow_down_keeps_the_clock_slow(void)
{
    const clock_state clock = start(0, 0, 0, 0, true);
    slow(&clock);
    TEST_ASSERT_FALSE(hardware.switches);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(crystal_and_pll_late_or_at_once);
    RUN_TEST(no_crystal_is_the_internal_oscillator_through_the_pll);
    RUN_TEST(a_pll_that_the_crystal_does_not_start_is_tried_with_the_other);
    RUN_TEST(no_pll_is_16_mhz);
    RUN_TEST(a_switch_that_never_comes_is_taken_back);
    RUN_TEST(flash_that_does_not_slow_down_keeps_the_clock_slow);
    return UNITY_END();
}
