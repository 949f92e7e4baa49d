/* watchdog.c - see watchdog.h. */
#include "watchdog.h"

enum {
    KEY_START = 0xCCCC,
    KEY_UNLOCK = 0x5555,
    KEY_FEED = 0xAAAA,
    PRESCALER_4 = 0,
    LSI_HZ = 32000,
    RELOAD = WATCHDOG_HARD_MS * (LSI_HZ / 4) / 1000,
    /* settings take five cycles of the slow oscillator, 0.3 ms at most; polls of 8 cycles or more, 1 ms at 168
     * MHz and 11 ms at 16 MHz */
    POLLS_N = 168000000 / 1000 / 8,
};

bool watchdog_start(watchdog *w, iwdg_registers *iwdg, uint32_t tick_hz, uint32_t now)
{
    w->iwdg = iwdg;
    w->limit_ticks = WATCHDOG_SOFT_MS * tick_hz / 1000;
    w->fed = now;
    w->watching = true;
    reg_write(&iwdg->kr, KEY_START); /* its oscillator, which the settings need, starts with it */
    reg_write(&iwdg->kr, KEY_UNLOCK);
    reg_write(&iwdg->pr, PRESCALER_4);
    reg_write(&iwdg->rlr, RELOAD);
    bool taken = false;
    for (int i = 0; i < POLLS_N && !taken; i++) {
        taken = (reg_read(&iwdg->sr) & (IWDG_SR_PVU | IWDG_SR_RVU)) == 0;
    }
    reg_write(&iwdg->kr, KEY_FEED);
    return taken;
}

void watchdog_feed(watchdog *w, uint32_t now)
{
    w->fed = now;
    if (w->watching) {
        reg_write(&w->iwdg->kr, KEY_FEED);
    }
}

bool watchdog_starved(const watchdog *w, uint32_t now)
{
    return w->watching && now - w->fed > w->limit_ticks;
}
