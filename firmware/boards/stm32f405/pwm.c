/* pwm.c - see pwm.h. */
#include "pwm.h"

static void outputs(tim_registers *t, uint32_t mode)
{
    reg_write(&t->ccmr1, mode);
    reg_write(&t->ccmr2, mode);
}

void pwm_init(pwm *p, tim_registers *first, tim_registers *second, uint32_t clock_hz)
{
    *p = (pwm){{first, second}, clock_hz, 0};
    pwm_stop(p);
    for (int i = 0; i < PWM_TIMERS_N; i++) {
        reg_write(&p->timer[i]->ccer, TIM_CCER_ALL);
    }
}

bool pwm_start(pwm *p, float rate_hz)
{
    pwm_stop(p);
    if (!(rate_hz >= 50.0f && rate_hz <= 333.0f)) {
        return false;
    }
    p->period_us = (uint32_t)(1e6f / rate_hz + 0.5f);
    for (int i = 0; i < PWM_TIMERS_N; i++) {
        tim_registers *t = p->timer[i];
        reg_write(&t->psc, p->clock_hz / 1000000u - 1);
        reg_write(&t->arr, p->period_us - 1);
        for (int channel = 0; channel < PWM_CHANNELS_PER_TIMER_N; channel++) {
            reg_write(&t->ccr[channel], 0);
        }
        outputs(t, TIM_CCMR_PWM_PRELOAD);
        reg_write(&t->egr, TIM_EGR_UG); /* takes them all over, and starts the count at 0 */
    }
    for (int i = 0; i < PWM_TIMERS_N; i++) {
        reg_write(&p->timer[i]->cr1, TIM_CR1_ARPE | TIM_CR1_CEN);
    }
    return true;
}

void pwm_pulse(pwm *p, int channel, uint32_t width_us)
{
    if (p->period_us == 0 || channel < 0 || channel >= PWM_TIMERS_N * PWM_CHANNELS_PER_TIMER_N) {
        return;
    }
    const uint32_t most_us = p->period_us - 1;
    reg_write(
        &p->timer[channel / PWM_CHANNELS_PER_TIMER_N]->ccr[channel % PWM_CHANNELS_PER_TIMER_N],
        width_us < most_us ? width_us : most_us);
}

void pwm_stop(pwm *p)
{
    p->period_us = 0;
    for (int i = 0; i < PWM_TIMERS_N; i++) {
        outputs(p->timer[i], TIM_CCMR_LOW);
        reg_write(&p->timer[i]->cr1, 0);
    }
}
