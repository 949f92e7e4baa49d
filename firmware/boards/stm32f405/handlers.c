/* handlers.c - exceptions that need the processor as it was: faults, SysTick, and the restart they end in. */
#include <stdlib.h>

#include "board.h"
#include "fault.h"
#include "pins.h"
#include "stack.h"

extern uint32_t guard_start[], stack_bottom[], stack_top[]; /* of the linker script */

void fault_handler(void);
void fault_capture(uint32_t sp);
void systick_handler(void);

__attribute__((section(".noinit"))) fault_record fault_last;

/* Where an exception puts pc and lr on the stack (ARMv7-M ARM, B1.5.6), in words. */
enum { FRAME_LR = 5, FRAME_PC = 6 };

_Noreturn void fault_restart(hal_fault fault, uint32_t pc, uint32_t lr, uint32_t cfsr)
{
    pins_servo_supply(GPIOB, false);
    (void)interrupts_hold();
    fault_write(&fault_last, fault, pc, lr, cfsr);
    memory_barrier();
    reg_write(&SCB->aircr, SCB_AIRCR_VECTKEY | SCB_AIRCR_SYSRESETREQ);
    memory_barrier();
    for (;;) {
    }
}

/* Faults, NMI (the crystal stopped) and interrupts that nobody asked for. The stack may be what is broken: nothing
 * is pushed before another one is in use. LR tells which stack the exception used (B1.5.8). */
__attribute__((naked)) void fault_handler(void)
{
    __asm__ volatile("tst lr, #4               \n"
                     "ite eq                   \n"
                     "mrseq r0, msp            \n"
                     "mrsne r0, psp            \n"
                     "ldr r1, =fault_stack_top \n"
                     "msr msp, r1              \n"
                     "b fault_capture          \n");
}

__attribute__((used)) void fault_capture(uint32_t sp)
{
    pins_servo_supply(GPIOB, false);
    const fault_signs signs = {sp, reg_read(&SCB->cfsr), reg_read(&SCB->mmfar)};
    const fault_stack stack = {(uint32_t)guard_start, (uint32_t)stack_bottom, (uint32_t)stack_top};
    uint32_t pc = 0, lr = 0;
    if (fault_frame_readable(&signs, &stack)) {
        const uint32_t *frame = (const uint32_t *)sp;
        pc = frame[FRAME_PC];
        lr = frame[FRAME_LR];
    }
    fault_restart(fault_classify(&signs, &stack), pc, lr, signs.cfsr);
}

/* Hands over where the interrupted program was. */
__attribute__((naked)) void systick_handler(void)
{
    __asm__ volatile("mov r0, sp             \n"
                     "b board_tick_interrupt \n");
}

void board_tick_interrupt(const uint32_t *frame)
{
    if (!board_tick()) { /* the app does not feed over a spoilt stack, either */
        fault_restart(stack_intact(stack_bottom) ? HAL_FAULT_WATCHDOG : HAL_FAULT_STACK,
                      frame[FRAME_PC], frame[FRAME_LR], 0);
    }
}

/* main does not return. Here so that start-up, which serves programs that do, brings no C library's. */
_Noreturn void exit(int status)
{
    _Exit(status);
}

_Noreturn void _Exit(int status)
{
    fault_restart(HAL_FAULT_PROCESSOR, (uint32_t)status, 0, 0);
}
