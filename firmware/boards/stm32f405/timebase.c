/* timebase.c - see timebase.h. */
#include "timebase.h"

#include <stddef.h>

clock_state timebase_trust(const systick_registers *systick, clock_state reached)
{
    enum { TENMS_SILICON = 18750 };
    const uint32_t tenms = reg_read(&systick->calib) & SYSTICK_CALIB_TENMS_MASK;
    return tenms == TENMS_SILICON ? reached : clock_emulated((tenms + 1) * 800);
}

uint32_t timebase_tick_hz(uint32_t core_hz)
{
    return core_hz >= 100000000u ? 1000 : 100;
}

void timebase_start(timebase *t, systick_registers *systick, scb_registers *scb, uint32_t core_hz)
{
    const uint32_t tick_hz = timebase_tick_hz(core_hz);
    t->systick = systick;
    t->scb = scb;
    t->tick_counts = core_hz / tick_hz;
    t->tick_us = 1000000u / tick_hz;
    t->ticks = 0;
    t->host_clock = NULL;
    reg_write(&systick->rvr, t->tick_counts - 1);
    reg_write(&systick->cvr, 0);
    reg_write(&systick->csr, SYSTICK_CSR_ENABLE | SYSTICK_CSR_TICKINT | SYSTICK_CSR_CLKSOURCE);
}

void timebase_emulated(timebase *t, tim_registers *tim2)
{
    reg_write(&tim2->arr, UINT32_MAX);
    reg_write(&tim2->cr1, TIM_CR1_CEN);
    t->host_ns = reg_read(&tim2->cnt);
    t->host_us = 0;
    t->host_clock = tim2;
}

/* Since the last interrupt, whole microseconds. */
static uint32_t host_passed_us(const timebase *t)
{
    return (reg_read(&t->host_clock->cnt) - t->host_ns) / 1000u;
}

void timebase_interrupt(timebase *t)
{
    if (t->host_clock != NULL) {
        const uint32_t passed_us = host_passed_us(t);
        t->host_us += passed_us;
        t->host_ns += 1000u * passed_us;
    }
    t->ticks++;
}

static uint32_t host_now_us(const timebase *t)
{
    uint32_t ticks, now_us;
    do {
        ticks = t->ticks;
        now_us = t->host_us + host_passed_us(t);
    } while (ticks != t->ticks);
    return now_us;
}

uint32_t timebase_now_us(const timebase *t)
{
    if (t->host_clock != NULL) {
        return host_now_us(t);
    }
    /* the counter runs down to 0, with which the next tick begins, and on from the reload value */
    uint32_t ticks, left, waiting;
    do {
        ticks = t->ticks;
        waiting = 0;
        left = reg_read(&t->systick->cvr);
        if ((reg_read(&t->scb->icsr) & SCB_ICSR_PENDSTSET) != 0) {
            /* the counter has wrapped, perhaps only after it was read: what it shows now is of the new tick */
            left = reg_read(&t->systick->cvr);
            waiting = 1;
        }
    } while (ticks != t->ticks);
    /* fits 32 bits: 168,000 * 1,000 at full speed, 160,000 * 10,000 at 16 MHz */
    return (ticks + waiting) * t->tick_us + (t->tick_counts - left) * t->tick_us / t->tick_counts;
}
