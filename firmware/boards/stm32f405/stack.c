/* stack.c - see stack.h. */
#include "stack.h"

enum { PATTERN = 0x5AFE57AC, GUARD_SIZE = 12 /* 2^(11 + 1) bytes */ };

_Static_assert(STACK_GUARD_BYTES == 2 << GUARD_SIZE, "the region's size is the guard's");

void stack_guard(mpu_registers *mpu, uint32_t guard, uint32_t *bottom)
{
    volatile uint32_t *word = bottom;
    for (int i = 0; i < STACK_PATTERN_WORDS; i++) {
        word[i] = PATTERN;
    }
    reg_write(&mpu->rnr, 0);
    reg_write(&mpu->rbar, guard);
    reg_write(&mpu->rasr, GUARD_SIZE * (uint32_t)MPU_RASR_SIZE0 | MPU_RASR_ENABLE);
    reg_write(&mpu->ctrl, MPU_CTRL_ENABLE | MPU_CTRL_PRIVDEFENA);
    memory_barrier();
}

bool stack_intact(const uint32_t *bottom)
{
    const volatile uint32_t *word = bottom;
    for (int i = 0; i < STACK_PATTERN_WORDS; i++) {
        if (word[i] != PATTERN) {
            return false;
        }
    }
    return true;
}
