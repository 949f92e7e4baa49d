/* pins.c - see pins.h. */
#include "pins.h"

enum { SUPPLY_PIN = 12, ESTOP_PIN = 0, LED_PIN = 12 };

typedef enum { INPUT, OUTPUT, ALTERNATE } pin_mode;
typedef enum { NO_PULL, PULL_UP } pin_pull;
typedef enum { SLOW = 0, FAST = 2 } pin_speed; /* FAST: 50 MHz, for edges of a 4 Mbaud line */

typedef struct {
    uint8_t port, pin, mode, function, pull, speed;
} pin_setting;

enum { A, B, C };

/* The functions: 2 is TIM3 and TIM4, 7 USART1 and USART2, 8 USART6. A received line is pulled up, so that one
 * that is not plugged in is silent. */
static const pin_setting PINS[] = {
    {B, SUPPLY_PIN, OUTPUT, 0, NO_PULL, SLOW}, {C, ESTOP_PIN, INPUT, 0, PULL_UP, SLOW},
    {C, LED_PIN, OUTPUT, 0, NO_PULL, SLOW},
#if LIMBER_LINK_USART == 1
    {A, 9, ALTERNATE, 7, NO_PULL, FAST},       {A, 10, ALTERNATE, 7, PULL_UP, FAST},
#else
    {A, 2, ALTERNATE, 7, NO_PULL, FAST},       {A, 3, ALTERNATE, 7, PULL_UP, FAST},
#endif
    {C, 6, ALTERNATE, 8, NO_PULL, FAST},       {A, 6, ALTERNATE, 2, NO_PULL, SLOW},
    {A, 7, ALTERNATE, 2, NO_PULL, SLOW},       {B, 0, ALTERNATE, 2, NO_PULL, SLOW},
    {B, 1, ALTERNATE, 2, NO_PULL, SLOW},       {B, 6, ALTERNATE, 2, NO_PULL, SLOW},
    {B, 7, ALTERNATE, 2, NO_PULL, SLOW},       {B, 8, ALTERNATE, 2, NO_PULL, SLOW},
    {B, 9, ALTERNATE, 2, NO_PULL, SLOW},
};

static void set_up(gpio_registers *port, const pin_setting *s)
{
    const uint32_t two = 2u * s->pin, four = 4u * (s->pin & 7u);
    reg *function = s->pin < 8 ? &port->afrl : &port->afrh;
    reg_change(function, 0xFu << four, (uint32_t)s->function << four);
    reg_change(&port->ospeedr, 3u << two, (uint32_t)s->speed << two);
    reg_change(&port->pupdr, 3u << two, (uint32_t)s->pull << two);
    reg_change(&port->moder, 3u << two, (uint32_t)s->mode << two);
}

void pins_start(rcc_registers *rcc, const pins_ports *ports)
{
    reg_set(&rcc->ahb1enr, RCC_AHB1ENR_GPIOAEN | RCC_AHB1ENR_GPIOBEN | RCC_AHB1ENR_GPIOCEN);
    reg_set(&rcc->apb1enr, RCC_APB1ENR_TIM3EN | RCC_APB1ENR_TIM4EN |
                               (LIMBER_LINK_USART == 2 ? RCC_APB1ENR_USART2EN : 0u));
    reg_set(&rcc->apb2enr,
            RCC_APB2ENR_USART6EN | (LIMBER_LINK_USART == 1 ? RCC_APB2ENR_USART1EN : 0u));
    (void)reg_read(
        &rcc->apb2enr); /* a block answers two cycles after its clock comes (errata ES0182) */
    memory_barrier();
    pins_servo_supply(ports->port[B], false); /* its level is right before it becomes an output */
    for (unsigned i = 0; i < sizeof PINS / sizeof PINS[0]; i++) {
        set_up(ports->port[PINS[i].port], &PINS[i]);
    }
}

/* BSRR sets with its lower half and resets with its upper: one store, so nothing can come between. */
static void drive(gpio_registers *port, int pin, bool high)
{
    reg_write(&port->bsrr, 1u << (high ? pin : pin + 16));
}

void pins_servo_supply(gpio_registers *port_b, bool on)
{
    drive(port_b, SUPPLY_PIN, on);
}

bool pins_estop(const gpio_registers *port_c)
{
    return (reg_read(&port_c->idr) & 1u << ESTOP_PIN) != 0;
}

void pins_led(gpio_registers *port_c, bool on)
{
    drive(port_c, LED_PIN, !on);
}
