/* board.c - see board.h. */
#include "board.h"

#include "fault.h"
#include "flash.h"
#include "pins.h"
#include "pwm.h"
#include "stack.h"
#include "timebase.h"
#include "uart.h"
#include "watchdog.h"

_Static_assert((int)BOARD_BUS_TX_BYTES >= (int)HAL_BUS_PACKET_MAX_BYTES, "a packet fits");

extern uint32_t guard_start[], stack_bottom[]; /* of the linker script */

void usart1_handler(void);
void usart2_handler(void);
void usart6_handler(void);

static timebase clock_ticks;
static uart line, bus;
static pwm pulses;
static flash settings_flash;
static watchdog watch;
static bool emulated;

enum { EMULATED_SLACK_US = 20000 }; /* bytes of the emulated bus go through another process */

static uint8_t line_rx[BOARD_LINK_RX_BYTES], line_tx[BOARD_LINK_TX_BYTES];
static uint8_t bus_rx[BOARD_BUS_RX_BYTES], bus_tx[BOARD_BUS_TX_BYTES];

/* --- interrupts ------------------------------------------------------------------------------------- */

enum { PRIORITY_BUS = 1, PRIORITY_LINK, PRIORITY_TICK };

#if LIMBER_LINK_USART == 1
void usart1_handler(void)
#else
void usart2_handler(void)
#endif
{
    uart_interrupt(&line);
}

void usart6_handler(void)
{
    uart_interrupt(&bus);
}

bool board_tick(void)
{
    timebase_interrupt(&clock_ticks);
    return !watchdog_starved(&watch, clock_ticks.ticks);
}

/* The upper four bits of a byte each (RM0090 12.1); faults keep 0, the most urgent. */
static uint32_t priority_field(int interrupt, uint32_t priority)
{
    return priority << (8 * (interrupt % 4) + 4);
}

static void enable_interrupt(int interrupt, uint32_t priority)
{
    reg_change(&NVIC->ipr[interrupt / 4], priority_field(interrupt, 0xF),
               priority_field(interrupt, priority));
    reg_write(&NVIC->iser[interrupt / 32], 1u << (interrupt % 32));
}

static void start_interrupts(void)
{
    reg_set(&SCB->shcsr, SCB_SHCSR_MEMFAULTENA | SCB_SHCSR_BUSFAULTENA | SCB_SHCSR_USGFAULTENA);
    reg_set(&SCB->shpr[2], priority_field(3, PRIORITY_TICK)); /* SysTick's is the last byte */
    enable_interrupt(INTERRUPT_USART6, PRIORITY_BUS);
    enable_interrupt(PINS_LINK_INTERRUPT, PRIORITY_LINK);
}

/* --- what hal.h asks for, in its order ---------------------------------------------------------------- */

static uint32_t now_us(void *context)
{
    (void)context;
    return timebase_now_us(&clock_ticks);
}

static size_t line_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&line, bytes, room);
}

static bool line_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return uart_write(&line, bytes, bytes_n);
}

static size_t line_free(void *context)
{
    (void)context;
    return uart_free(&line);
}

static uint32_t line_overruns(void *context)
{
    (void)context;
    return line.overruns;
}

static uint32_t line_framing_errors(void *context)
{
    (void)context;
    return line.framing_errors;
}

static void servo_supply(void *context, bool on)
{
    (void)context;
    pins_servo_supply(GPIOB, on);
}

static bool pwm_start_hal(void *context, float rate_hz)
{
    (void)context;
    return pwm_start(&pulses, rate_hz);
}

static void pwm_pulse_hal(void *context, int channel, uint32_t width_us)
{
    (void)context;
    pwm_pulse(&pulses, channel, width_us);
}

static void pwm_stop_hal(void *context)
{
    (void)context;
    pwm_stop(&pulses);
}

static bool bus_start(void *context, uint32_t baud)
{
    (void)context;
    return uart_start(&bus, baud);
}

static bool bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    return bytes_n <= HAL_BUS_PACKET_MAX_BYTES && uart_write(&bus, bytes, bytes_n);
}

static bool bus_sending(void *context)
{
    (void)context;
    return uart_sending(&bus);
}

static size_t bus_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    return uart_read(&bus, bytes, room);
}

static void bus_abort(void *context)
{
    (void)context;
    uart_abort(&bus);
}

static bool estop_pressed(void *context)
{
    (void)context;
    return !emulated && pins_estop(GPIOC);
}

static uint32_t flash_sector_size(void *context)
{
    (void)context;
    return FLASH_SECTOR_BYTES;
}

static void flash_read_hal(void *context, int sector, uint32_t offset, void *bytes, size_t bytes_n)
{
    (void)context;
    flash_read(&settings_flash, sector, offset, bytes, bytes_n);
}

static bool flash_write_hal(void *context, int sector, uint32_t offset, const void *bytes,
                            size_t bytes_n)
{
    (void)context;
    return flash_write(&settings_flash, sector, offset, bytes, bytes_n);
}

static bool flash_erase_hal(void *context, int sector)
{
    (void)context;
    return flash_erase(&settings_flash, sector);
}

static bool stack_intact_hal(void *context)
{
    (void)context;
    return stack_intact(stack_bottom);
}

static void watchdog_feed_hal(void *context)
{
    (void)context;
    watchdog_feed(&watch, clock_ticks.ticks);
}

static void reboot(void *context)
{
    (void)context;
    fault_restart(HAL_FAULT_NONE, 0, 0, 0);
}

static const hal BOARD_HAL = {
    .now_us = now_us,
    .line_read = line_read,
    .line_write = line_write,
    .line_free = line_free,
    .line_overruns = line_overruns,
    .line_framing_errors = line_framing_errors,
    .servo_supply = servo_supply,
    .pwm_start = pwm_start_hal,
    .pwm_pulse = pwm_pulse_hal,
    .pwm_stop = pwm_stop_hal,
    .bus_start = bus_start,
    .bus_write = bus_write,
    .bus_sending = bus_sending,
    .bus_read = bus_read,
    .bus_abort = bus_abort,
    .estop_pressed = estop_pressed,
    .flash_sector_size = flash_sector_size,
    .flash_read = flash_read_hal,
    .flash_write = flash_write_hal,
    .flash_erase = flash_erase_hal,
    .stack_intact = stack_intact_hal,
    .watchdog_feed = watchdog_feed_hal,
    .reboot = reboot,
};

/* --- from reset to the main loop ------------------------------------------------------------------------ */

static void start_serial(const clock_state *clock)
{
    const uint32_t line_hz = PINS_LINK == USART2 ? clock->apb1_hz : clock->apb2_hz;
    uart_init(&line, PINS_LINK, line_hz, false, line_rx, sizeof line_rx, line_tx, sizeof line_tx);
    uart_init(&bus, USART6, clock->apb2_hz, true, bus_rx, sizeof bus_rx, bus_tx, sizeof bus_tx);
    (void)uart_start(&line, LIMBER_LINK_BAUD); /* 16 MHz make it, too */
}

void board_start(hal *hal, hal_boot *boot)
{
    static const pins_ports PORTS = {{GPIOA, GPIOB, GPIOC}};
    pins_start(RCC, &PORTS);
    *boot = (hal_boot){0};
    fault_boot(&fault_last, RCC, boot);
    stack_guard(MPU, (uint32_t)guard_start, stack_bottom);

    const clock_state clock = timebase_trust(SYSTICK, clock_start(RCC, FLASH, PWR));
    emulated = clock.kind == CLOCK_EMULATED;
    boot->clock_kind = (uint8_t)clock.kind;
    boot->clock_hz = clock.core_hz;
    boot->estop_ignored = emulated;

    flash_init(&settings_flash, FLASH, FLASH_SECTOR_10, FLASH_SECTOR_11);
    pwm_init(&pulses, TIM3, TIM4, clock.apb1_timer_hz);
    start_serial(&clock);
    start_interrupts();
    timebase_start(&clock_ticks, SYSTICK, SCB, clock.core_hz);
    if (emulated) {
        timebase_emulated(&clock_ticks, TIM2);
    }
    *hal = BOARD_HAL;
    hal->bus_slack_us = emulated ? EMULATED_SLACK_US : 0;
}

uint32_t board_tick_hz(void)
{
    return 1000000u / clock_ticks.tick_us;
}

void board_watch(void)
{
    (void)watchdog_start(&watch, IWDG, board_tick_hz(), clock_ticks.ticks);
}

uint32_t board_wait(uint32_t last)
{
    while (clock_ticks.ticks == last) {
        /* an interrupt that comes after the question still ends the sleep, and runs after the release */
        const uint32_t held = interrupts_hold();
        if (clock_ticks.ticks == last) {
            __asm__ volatile("wfi");
        }
        interrupts_release(held);
    }
    return clock_ticks.ticks;
}

void board_led(bool on)
{
    pins_led(GPIOC, on);
}
