/* cost.h - what a stretch of code costs on the emulated Cortex-M4F, in instructions, exactly.
 *
 *     cost_begin(); the stretch; cost_end();     // as often as wanted
 *     cost_tell("step", 50);                     // prints "step 50 6410": the dearest of them
 *
 * QEMU with `-icount shift=0` advances virtual time by 1 ns an instruction, and its TIM2, left at its
 * reset prescaler, counts that nanosecond by nanosecond: the counter's difference is the number of
 * instructions, the same in every run. mix_plugin.c watches the same three functions and counts which
 * instructions they are. cost.py reads both.
 */
#ifndef LIMBER_COST_H
#define LIMBER_COST_H

void cost_start(void); /* once, before all others */
void cost_begin(void);
void cost_end(void);
void cost_tell(const char *part, int links_n);

#endif
