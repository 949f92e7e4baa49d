/* fault.c - see fault.h. What needs no processor of its own; the rest is in handlers.c. */
#include "fault.h"

enum {
    MAGIC = 0x4C46524D,
    FRAME_BYTES = 32,
    /* the exception's frame, or the FPU's part of it later, did not get onto the stack */
    NO_ROOM = SCB_CFSR_MSTKERR | SCB_CFSR_MLSPERR | SCB_CFSR_STKERR | SCB_CFSR_LSPERR,
};

/* Chance may leave anything in memory that was never written; a sum alone would take all zeros. */
static uint32_t check(const fault_record *r)
{
    return ~(r->magic + 3u * r->fault + 5u * r->pc + 7u * r->lr + 11u * r->cfsr);
}

void fault_write(fault_record *record, hal_fault fault, uint32_t pc, uint32_t lr, uint32_t cfsr)
{
    *record = (fault_record){MAGIC, fault, pc, lr, cfsr, 0};
    record->check = check(record);
}

hal_fault fault_classify(const fault_signs *signs, const fault_stack *stack)
{
    const bool no_room = (signs->cfsr & NO_ROOM) != 0;
    const bool touched = (signs->cfsr & SCB_CFSR_MMARVALID) != 0 && signs->mmfar >= stack->guard &&
                         signs->mmfar < stack->stack_bottom;
    return no_room || touched || signs->sp < stack->stack_bottom ? HAL_FAULT_STACK
                                                                 : HAL_FAULT_PROCESSOR;
}

bool fault_frame_readable(const fault_signs *signs, const fault_stack *stack)
{
    return (signs->cfsr & NO_ROOM) == 0 && signs->sp % 4 == 0 && signs->sp >= stack->stack_bottom &&
           signs->sp <= stack->stack_top - FRAME_BYTES;
}

static hal_reset_cause cause_of(uint32_t csr)
{
    if ((csr & RCC_CSR_WDGRSTF) != 0) {
        return HAL_RESET_WATCHDOG;
    }
    if ((csr & RCC_CSR_SFTRSTF) != 0) {
        return HAL_RESET_SOFTWARE;
    }
    /* every reset pulls the pin as well: it is the cause where there is no other */
    const bool power = (csr & (RCC_CSR_PORRSTF | RCC_CSR_BORRSTF)) != 0;
    return power || (csr & RCC_CSR_PADRSTF) == 0 ? HAL_RESET_POWER : HAL_RESET_PIN;
}

void fault_boot(fault_record *record, rcc_registers *rcc, hal_boot *boot)
{
    boot->cause = cause_of(reg_read(&rcc->csr));
    if (record->magic == MAGIC && record->check == check(record) &&
        record->fault <= HAL_FAULT_WATCHDOG) {
        boot->cause = record->fault == HAL_FAULT_NONE ? HAL_RESET_SOFTWARE : HAL_RESET_FAULT;
        boot->fault = (hal_fault)record->fault;
        boot->pc = record->pc;
        boot->lr = record->lr;
        boot->cfsr = record->cfsr;
    }
    record->magic = 0;
    reg_set(&rcc->csr, RCC_CSR_RMVF);
}
