/* pins.h - every pin of the board, and the few that are set and read directly.
 *
 *     PA9  PA10  the link, USART1 TX and RX: the same wires the ROM boot loader listens on (AN2606)
 *     PA2  PA3   or there: USART2, with the build option LIMBER_LINK=usart2
 *     PC6        the servo bus, USART6: one wire, external pull-up 4.7 kOhm to 3.3 or 5 V
 *     PA6 PA7 PB0 PB1   hobby servos 1 to 4: TIM3 channels 1 to 4
 *     PB6 PB7 PB8 PB9   hobby servos 5 to 8: TIM4 channels 1 to 4
 *     PC0        e-stop: a normally closed loop to ground; high, or cut, is stop
 *     PB12       servo supply: high is on; external pull-down 10 kOhm, so that it is off in reset
 *     PC12       status LED of the Olimex STM32-H405, low is on
 *
 * PC0 and PB12 are pins that the ROM boot loader does not drive. All of these bear 5 V as long as their internal
 * pull-up is off (data sheet DS8626, absolute maximum ratings): the bus has none, since X series servos pull it
 * to 5 V; the e-stop and the link's RX have one and stay within 3.3 V. Alternate functions: DS8626, table 9.
 */
#ifndef LIMBER_PINS_H
#define LIMBER_PINS_H

#include <stdbool.h>

#include "registers.h"

#ifndef LIMBER_LINK_USART
#define LIMBER_LINK_USART 1 /* or 2 */
#endif
#if LIMBER_LINK_USART == 1
#define PINS_LINK USART1
enum { PINS_LINK_INTERRUPT = INTERRUPT_USART1 };
#elif LIMBER_LINK_USART == 2
#define PINS_LINK USART2
enum { PINS_LINK_INTERRUPT = INTERRUPT_USART2 };
#else
#error "LIMBER_LINK_USART: 1 or 2"
#endif

typedef struct {
    gpio_registers *port[3]; /* A, B, C */
} pins_ports;

/* Clocks the ports, and the USARTs and timers in use; then sets the pins up, the supply first: off. */
void pins_start(rcc_registers *rcc, const pins_ports *ports);

/* These may be called from anywhere, fault handlers included. */
void pins_servo_supply(gpio_registers *port_b, bool on);
bool pins_estop(const gpio_registers *port_c);
void pins_led(gpio_registers *port_c, bool on);

#endif
