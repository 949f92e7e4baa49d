/* stack.h - the stack's end: a guard that stops the program which runs over it, and a pattern that shows it.
 *
 * The guard (MPU region 0, ARMv7-M B3.5) is 8 KB right under the stack, with no access at all: more than any
 * function's frame, so that none can step over it. What touches it faults at that instruction, as
 * HAL_FAULT_STACK; the fault handlers do not need this stack. The pattern fills the stack's last words.
 */
#ifndef LIMBER_STACK_H
#define LIMBER_STACK_H

#include <stdbool.h>

#include "registers.h"

enum { STACK_GUARD_BYTES = 8192, STACK_PATTERN_WORDS = 16 };

/* guard: STACK_GUARD_BYTES at a multiple of them; bottom: the stack's lowest word, not in use yet. */
void stack_guard(mpu_registers *mpu, uint32_t guard, uint32_t *bottom);

/* Whether the pattern is whole. */
bool stack_intact(const uint32_t *bottom);

#endif
