/* startup.c - from reset to main on a Cortex-M4F (ARMv7-M ARM, B1.5.5 reset, B1.4.7 CPACR).
 *
 * The firmware and the test programs start here alike. Handlers are weak: who has a better one defines it.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern uint32_t data_start[], data_end[], data_image[], bss_start[], bss_end[], stack_top[];

int main(int argc, char **argv);
void reset_handler(void);
void fault_handler(void);
void systick_handler(void);
void usart1_handler(void);
void usart2_handler(void);
void usart6_handler(void);

/* The program's arguments, and whatever must wake before main: weak, so that a program which runs on an
 * emulator and has a host to talk to brings its own. */
int startup_arguments(char ***argv);
__attribute__((weak)) int startup_arguments(char ***argv)
{
    static char *none[] = {NULL};
    *argv = none;
    return 0;
}

__attribute__((naked)) void reset_handler(void)
{
    /* The FPU comes first: the compiler may use its registers anywhere in C. */
    __asm__ volatile("ldr r0, =0xE000ED88 \n"
                     "ldr r1, [r0]        \n"
                     "orr r1, #0xF00000   \n"
                     "str r1, [r0]        \n"
                     "dsb                 \n"
                     "isb                 \n"
                     "b start_program    \n");
}

__attribute__((used)) static void start_program(void) __asm__("start_program");
static void start_program(void)
{
    /* the linker script's symbols bound one object each, which no checker can know */
    // cppcheck-suppress comparePointers
    memcpy(data_start, data_image, (size_t)((char *)data_end - (char *)data_start));
    // cppcheck-suppress comparePointers
    memset(bss_start, 0, (size_t)((char *)bss_end - (char *)bss_start));
    char **argv;
    const int argc = startup_arguments(&argv);
    exit(main(argc, argv));
}

__attribute__((weak)) void fault_handler(void)
{
    _Exit(70); /* EX_SOFTWARE: ends an emulated program instead of hanging it */
}

/* An interrupt that nobody asked for. Registers and stack reach fault_handler as they are. */
__attribute__((naked, used)) static void unexpected(void)
{
    __asm__ volatile("b fault_handler");
}

__attribute__((weak, alias("unexpected"))) void systick_handler(void);
__attribute__((weak, alias("unexpected"))) void usart1_handler(void);
__attribute__((weak, alias("unexpected"))) void usart2_handler(void);
__attribute__((weak, alias("unexpected"))) void usart6_handler(void);

/* The 16 of the core (ARMv7-M ARM, table B1-4), then the chip's 82 (RM0090, table 61). */
__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16 + 82] = {
    (uintptr_t)stack_top,                  /* 0: main stack */
    (uintptr_t)reset_handler,              /* 1 */
    [2 ... 14] = (uintptr_t)fault_handler, /* NMI, faults, calls: none is asked for */
    [15] = (uintptr_t)systick_handler,
    [16 ... 16 + 36] = (uintptr_t)fault_handler,
    [16 + 37] = (uintptr_t)usart1_handler,
    [16 + 38] = (uintptr_t)usart2_handler,
    [16 + 39 ... 16 + 70] = (uintptr_t)fault_handler,
    [16 + 71] = (uintptr_t)usart6_handler,
    [16 + 72 ... 16 + 81] = (uintptr_t)fault_handler,
};
