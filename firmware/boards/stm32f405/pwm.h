/* pwm.h - hobby servos: eight pulses of 1 us resolution, of TIM3 and TIM4 (RM0090 section 18).
 *
 * Both timers count microseconds and start together. A new width is taken over at the end of a period, whole
 * (preload): no pulse is ever cut or doubled by a change; only pwm_stop cuts, on purpose. No timer interrupt
 * is used. Main loop only, nothing waits.
 */
#ifndef LIMBER_PWM_H
#define LIMBER_PWM_H

#include <stdbool.h>

#include "registers.h"

enum { PWM_TIMERS_N = 2, PWM_CHANNELS_PER_TIMER_N = 4 };

typedef struct {
    tim_registers *timer[PWM_TIMERS_N];
    uint32_t clock_hz;
    uint32_t period_us; /* 0: stopped */
} pwm;

/* clock_hz: of the timers, whole MHz. All outputs low. */
void pwm_init(pwm *p, tim_registers *first, tim_registers *second, uint32_t clock_hz);

/* Periods of this rate from now on, 50 to 333 Hz to the microsecond, no pulse on any channel; false, and
 * stopped, outside of these. */
bool pwm_start(pwm *p, float rate_hz);

/* Width from the next period on, at most 1 us less than the period; 0: none. Nothing where stopped, or where
 * there is no such channel (0 to 7). */
void pwm_pulse(pwm *p, int channel, uint32_t width_us);

/* All outputs low, at once. */
void pwm_stop(pwm *p);

#endif
