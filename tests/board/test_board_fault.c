/* test_board_fault.c - what is kept of a fault, how it is told from others, and the stack's guard and pattern. */
#include <string.h>

#include "fault.h"
#include "scripted.h"
#include "stack.h"
#include "unity.h"

static rcc_registers rcc;
static fault_record record;
static const fault_stack STACK = {0x10001000, 0x10002000, 0x10005000};

void setUp(void)
{
    memset(&rcc, 0, sizeof rcc);
    memset(&record, 0xA5, sizeof record);
    scripted_start((script){NULL, NULL});
}

void tearDown(void) {}

static hal_boot boot_with(uint32_t csr)
{
    hal_boot boot = {0};
    rcc.csr = csr;
    fault_boot(&record, &rcc, &boot);
    TEST_ASSERT_TRUE((rcc.csr & RCC_CSR_RMVF) != 0); /* so that it counts once */
    return boot;
}

static void a_record_is_told_once(void)
{
    for (hal_fault fault = HAL_FAULT_PROCESSOR; fault <= HAL_FAULT_WATCHDOG; fault++) {
        fault_write(&record, fault, 0x08001234, 0x08005678, 0x8200);
        hal_boot boot = boot_with(RCC_CSR_SFTRSTF | RCC_CSR_PADRSTF);
        TEST_ASSERT_EQUAL_INT(HAL_RESET_FAULT, boot.cause);
        TEST_ASSERT_EQUAL_INT(fault, boot.fault);
        TEST_ASSERT_EQUAL_HEX32(0x08001234, boot.pc);
        TEST_ASSERT_EQUAL_HEX32(0x08005678, boot.lr);
        TEST_ASSERT_EQUAL_HEX32(0x8200, boot.cfsr);
        boot = boot_with(RCC_CSR_PORRSTF | RCC_CSR_PADRSTF);
        TEST_ASSERT_EQUAL_INT(HAL_RESET_POWER, boot.cause);
        TEST_ASSERT_EQUAL_INT(HAL_FAULT_NONE, boot.fault);
        TEST_ASSERT_EQUAL_HEX32(0, boot.pc);
    }
}

static void a_wish_to_restart_is_no_fault(void)
{
    fault_write(&record, HAL_FAULT_NONE, 0, 0, 0);
    const hal_boot boot = boot_with(RCC_CSR_PORRSTF); /* as an emulator has it */
    TEST_ASSERT_EQUAL_INT(HAL_RESET_SOFTWARE, boot.cause);
    TEST_ASSERT_EQUAL_INT(HAL_FAULT_NONE, boot.fault);
}

static void no_bit_of_a_record_may_differ(void)
{
    for (size_t bit = 0; bit < 8 * sizeof record; bit++) {
        fault_write(&record, HAL_FAULT_STACK, 1, 2, 3);
        uint8_t *bytes = (uint8_t *)&record;
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_EQUAL_INT(HAL_RESET_PIN, boot_with(RCC_CSR_PADRSTF).cause);
    }
    memset(&record, 0, sizeof record);
    TEST_ASSERT_EQUAL_INT(HAL_RESET_PIN, boot_with(RCC_CSR_PADRSTF).cause);
}

static void causes_without_a_record(void)
{
    static const struct {
        uint32_t csr;
        hal_reset_cause cause;
    } ROWS[] = {
        {RCC_CSR_PADRSTF, HAL_RESET_PIN},
        {RCC_CSR_PADRSTF | RCC_CSR_SFTRSTF, HAL_RESET_SOFTWARE},
        {RCC_CSR_PADRSTF | RCC_CSR_WDGRSTF, HAL_RESET_WATCHDOG},
        {RCC_CSR_PADRSTF | RCC_CSR_PORRSTF | RCC_CSR_BORRSTF, HAL_RESET_POWER},
        {RCC_CSR_PADRSTF | RCC_CSR_BORRSTF, HAL_RESET_POWER},
        {0, HAL_RESET_POWER},
    };
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        TEST_ASSERT_EQUAL_INT(ROWS[i].cause, boot_with(ROWS[i].csr).cause);
    }
}

static void the_stack_is_told_from_the_rest(void)
{
    static const struct {
        fault_signs signs;
        hal_fault fault;
        bool readable;
    } ROWS[] = {
        {{0x10004000, 0x8200, 0}, HAL_FAULT_PROCESSOR, true}, /* PRECISERR: a bus error elsewhere */
        {{0x10004000, 0x0082, 0x20000000}, HAL_FAULT_PROCESSOR, true}, /* DACCVIOL elsewhere */
        {{0x10002000, 0x0082, 0x10001FFC},
         HAL_FAULT_STACK,
         true}, /* in the guard, frame above it */
        {{0x10002000, 0x0082, 0x10001000}, HAL_FAULT_STACK, true},
        {{0x10002000, 0x0082, 0x10000FFC}, HAL_FAULT_PROCESSOR, true},
        {{0x10002000, 0x0002, 0x10001FFC}, HAL_FAULT_PROCESSOR, true}, /* MMFAR is not valid */
        {{0x10001FE8, 0x0010, 0}, HAL_FAULT_STACK, false},             /* MSTKERR */
        {{0x10002000, 0x0020, 0}, HAL_FAULT_STACK, false},             /* MLSPERR */
        {{0x0FFFFF00, 0x1000, 0}, HAL_FAULT_STACK, false},             /* STKERR: under the CCM */
        {{0x10001800, 0x0000, 0}, HAL_FAULT_STACK, false},
        {{0x10004FF0, 0x8200, 0}, HAL_FAULT_PROCESSOR, false}, /* half of the frame is not there */
        {{0x10004002, 0x8200, 0}, HAL_FAULT_PROCESSOR, false},
        {{0xFFFFFFE0, 0x8200, 0}, HAL_FAULT_PROCESSOR, false},
    };
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        TEST_ASSERT_EQUAL_INT(ROWS[i].fault, fault_classify(&ROWS[i].signs, &STACK));
        TEST_ASSERT_EQUAL_INT(ROWS[i].readable, fault_frame_readable(&ROWS[i].signs, &STACK));
    }
}

static void the_guard_is_8_kb_without_any_access(void)
{
    static mpu_registers mpu;
    static uint32_t words[64];
    stack_guard(&mpu, 0x10002000, words);
    TEST_ASSERT_EQUAL_HEX32(0x10002000, mpu.rbar);
    TEST_ASSERT_EQUAL_UINT32(8192, 2u << (mpu.rasr >> 1 & 0x1F));
    TEST_ASSERT_EQUAL_HEX32(0, mpu.rasr & 7u << 24); /* AP: nobody */
    TEST_ASSERT_TRUE((mpu.rasr & 1) != 0 && (mpu.ctrl & 1) != 0);
    TEST_ASSERT_TRUE((mpu.ctrl & MPU_CTRL_PRIVDEFENA) != 0); /* all else stays as it was */
    TEST_ASSERT_TRUE(scripted_last_write(&mpu.ctrl) > scripted_last_write(&mpu.rasr));
}

static void any_word_of_the_pattern_shows(void)
{
    static mpu_registers mpu;
    static uint32_t words[64];
    for (int i = 0; i < STACK_PATTERN_WORDS; i++) {
        stack_guard(&mpu, 0x10002000, words);
        TEST_ASSERT_TRUE(stack_intact(words));
        words[i] ^= 1;
        TEST_ASSERT_FALSE(stack_intact(words));
    }
    stack_guard(&mpu, 0x10002000, words);
    words[STACK_PATTERN_WORDS] = 1; /* the stack's own */
    TEST_ASSERT_TRUE(stack_intact(words));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_record_is_told_once);
    RUN_TEST(a_wish_to_restart_is_no_fault);
    RUN_TEST(no_bit_of_a_record_may_differ);
    RUN_TEST(causes_without_a_record);
    RUN_TEST(the_stack_is_told_from_the_rest);
    RUN_TEST(the_guard_is_8_kb_without_any_access);
    RUN_TEST(any_word_of_the_pattern_shows);
    return UNITY_END();
}
