/* fault.h - what made the firmware restart itself, kept across the reset, and why the processor last started.
 *
 * Whatever goes wrong ends in fault_restart: servo supply off first, then a record in memory that a reset
 * leaves alone (.noinit), then the reset. There is no repair in place: after the reset nothing is armed, and
 * BOOT_REPORT says what happened. A wish to restart goes the same way, as HAL_FAULT_NONE.
 *
 * pc and lr come from the exception's frame, and are 0 where the stack had no room for one.
 */
#ifndef LIMBER_FAULT_H
#define LIMBER_FAULT_H

#include "hal.h"
#include "registers.h"

typedef struct {
    uint32_t magic, fault, pc, lr, cfsr, check;
} fault_record;

/* What the processor was at when a fault came. sp: where the exception frame lies. */
typedef struct {
    uint32_t sp, cfsr, mmfar;
} fault_signs;

/* Addresses, end exclusive. */
typedef struct {
    uint32_t guard, stack_bottom, stack_top;
} fault_stack;

void fault_write(fault_record *record, hal_fault fault, uint32_t pc, uint32_t lr, uint32_t cfsr);

/* HAL_FAULT_STACK where the stack ran into its guard, or under it: the access that did it, or the exception
 * that found no room there (ARMv7-M ARM B3.2.15). Else HAL_FAULT_PROCESSOR. */
hal_fault fault_classify(const fault_signs *signs, const fault_stack *stack);

/* Whether the exception frame (8 words at sp) was written and may be read. */
bool fault_frame_readable(const fault_signs *signs, const fault_stack *stack);

/* Once after a reset: cause, fault, pc, lr, cfsr of *boot from the record, or else from RCC_CSR (RM0090 7.3.21).
 * Both are cleared, so that they count once. */
void fault_boot(fault_record *record, rcc_registers *rcc, hal_boot *boot);

/* handlers.c. From anywhere, interrupt and fault handlers included. */
_Noreturn void fault_restart(hal_fault fault, uint32_t pc, uint32_t lr, uint32_t cfsr);

/* The record that fault_restart writes. */
extern fault_record fault_last;

#endif
