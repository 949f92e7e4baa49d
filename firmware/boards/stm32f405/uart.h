/* uart.h - a serial line, 8N1, by interrupt from and to rings: the link to the PC, or the servos' one wire.
 *
 *     uart_init(&u, USART1, 84000000, false, rx, sizeof rx, tx, sizeof tx);
 *     uart_start(&u, 1000000);
 *     its interrupt handler: uart_interrupt(&u);
 *
 * RM0090 section 30. An interrupt for each byte, under 120 cycles (COST.md): at 4 Mbaud there are 420 of them between two
 * bytes, so this is the highest of the priorities. No DMA and no idle-line detection: QEMU has neither, and the
 * image tested there is the image that is flashed.
 *
 * One wire (half_duplex; 30.3.10, HDSEL): transmitter and receiver share the TX pin, which the hardware drives
 * only while it sends and lets go of after the stop bit; there is no direction pin. The pin may
 * therefore be push-pull, which 4 Mbaud need (a pull-up alone rises too slowly), and needs an external
 * pull-up for when nobody drives it. The receiver would hear every byte sent: it is switched off (RE) with
 * the first and on again when the last has left (TC), within an interrupt's latency, under 1 us. The earliest
 * a servo answers is 2 us (Return Delay Time; 500 us as delivered).
 *
 * Main loop only, but for uart_interrupt. Nothing waits.
 */
#ifndef LIMBER_UART_H
#define LIMBER_UART_H

#include "registers.h"
#include "ring.h"

typedef enum { UART_QUIET, UART_SENDING, UART_ABORTING } uart_sender;

/* Private, but for the counts. */
typedef struct {
    usart_registers *registers;
    uint32_t clock_hz;
    bool half_duplex;
    ring rx, tx;
    volatile uart_sender sender;      /* of one wire */
    volatile uint32_t overruns;       /* bytes lost for want of room, here or in the hardware */
    volatile uint32_t framing_errors; /* bytes dropped since their stop bit was not there */
} uart;

/* The divider for a rate: clock cycles a bit, and whether 8 samples a bit must do instead of 16. False where the
 * rate comes out more than 1 % off, or takes less than 8 cycles a bit or more than 65,535. */
bool uart_divider(uint32_t clock_hz, uint32_t baud, uint32_t *cycles_per_bit, bool *over8);

/* Sizes are powers of two; the buffers outlive *u. clock_hz is that of the peripheral's bus. */
void uart_init(uart *u, usart_registers *registers, uint32_t clock_hz, bool half_duplex,
               uint8_t *rx, uint32_t rx_size, uint8_t *tx, uint32_t tx_size);

/* From now on at this rate, with nothing under way and both rings empty; false, and as it was, where the clock
 * cannot make the rate. The interrupt must be enabled in the NVIC by the caller. */
bool uart_start(uart *u, uint32_t baud);

/* All of them or none. On one wire: none also while others are being sent. */
bool uart_write(uart *u, const uint8_t *bytes, size_t bytes_n);
size_t uart_free(const uart *u);

/* Of one wire: until the last stop bit is out. */
bool uart_sending(const uart *u);

/* What has come, up to room bytes; returns how many. */
size_t uart_read(uart *u, uint8_t *bytes, size_t room);

/* One wire: the byte on the line and the one behind it in the transmitter are the last (taking TE away instead
 * would spoil them and hold the line, 30.3.2), what has come is forgotten, and a write is taken at once. */
void uart_abort(uart *u);

void uart_interrupt(uart *u);

#endif
