/* uart.c - see uart.h. */
#include "uart.h"

/* USARTDIV is a fixed-point number of 1/16 (1/8 with OVER8): either way what it comes to are clock cycles a bit
 * (RM0090 30.3.4). */
bool uart_divider(uint32_t clock_hz, uint32_t baud, uint32_t *cycles_per_bit, bool *over8)
{
    enum { CYCLES_MIN = 8, CYCLES_OVER16_MIN = 16, CYCLES_MAX = 0xFFFF };
    if (baud == 0 || baud > clock_hz) {
        return false;
    }
    const uint32_t cycles = (clock_hz + baud / 2) / baud;
    if (cycles < CYCLES_MIN || cycles > CYCLES_MAX) {
        return false;
    }
    const uint32_t made = cycles * baud;
    const uint32_t off = made > clock_hz ? made - clock_hz : clock_hz - made;
    *cycles_per_bit = cycles;
    *over8 = cycles < CYCLES_OVER16_MIN;
    return off <= made / 100;
}

void uart_init(uart *u, usart_registers *registers, uint32_t clock_hz, bool half_duplex,
               uint8_t *rx, uint32_t rx_size, uint8_t *tx, uint32_t tx_size)
{
    *u = (uart){.registers = registers,
                .clock_hz = clock_hz,
                .half_duplex = half_duplex,
                .rx = {.bytes = rx, .size = rx_size},
                .tx = {.bytes = tx, .size = tx_size}};
}

bool uart_start(uart *u, uint32_t baud)
{
    usart_registers *r = u->registers;
    uint32_t cycles;
    bool over8;
    if (!uart_divider(u->clock_hz, baud, &cycles, &over8)) {
        return false;
    }
    reg_write(&r->cr1, 0); /* no interrupt of it from here on: both ends of the rings are ours */
    (void)reg_read(&r->sr);
    (void)reg_read(&r->dr); /* a byte of the old rate */
    u->rx.in = u->rx.out = u->tx.in = u->tx.out = 0;
    u->sender = UART_QUIET;
    /* with 8 samples the fraction has three bits, and the fourth stays 0 (30.6.3) */
    reg_write(&r->brr, over8 ? (cycles & ~7u) << 1 | (cycles & 7u) : cycles);
    reg_write(&r->cr2, 0); /* one stop bit */
    reg_write(&r->cr3, u->half_duplex ? USART_CR3_HDSEL : 0);
    reg_write(&r->cr1, USART_CR1_UE | (over8 ? USART_CR1_OVER8 : 0u) | USART_CR1_RXNEIE |
                           USART_CR1_TE | USART_CR1_RE);
    return true;
}

/* CR1 is changed by the interrupt, too, which must not come between its being read and written. */
static void wake_sender(uart *u)
{
    const uint32_t held = interrupts_hold();
    u->sender = UART_SENDING;
    reg_change(&u->registers->cr1, USART_CR1_TCIE | (u->half_duplex ? USART_CR1_RE : 0u),
               USART_CR1_TXEIE);
    interrupts_release(held);
}

bool uart_write(uart *u, const uint8_t *bytes, size_t bytes_n)
{
    if ((u->half_duplex && u->sender == UART_SENDING) || !ring_put(&u->tx, bytes, bytes_n)) {
        return false;
    }
    if (bytes_n > 0) {
        wake_sender(u);
    }
    return true;
}

size_t uart_free(const uart *u)
{
    return ring_free(&u->tx);
}

bool uart_sending(const uart *u)
{
    return u->sender != UART_QUIET;
}

size_t uart_read(uart *u, uint8_t *bytes, size_t room)
{
    return ring_take(&u->rx, bytes, room);
}

void uart_abort(uart *u)
{
    const uint32_t held = interrupts_hold(); /* taking from tx is the interrupt's */
    ring_drop_all(&u->tx);
    if (u->sender == UART_SENDING) {
        u->sender = UART_ABORTING;
    }
    interrupts_release(held);
    ring_drop_all(&u->rx);
}

static void receive(uart *u, uint32_t status)
{
    const uint8_t byte =
        (uint8_t)reg_read(&u->registers->dr); /* after SR: clears its errors (30.6.1) */
    if ((status & USART_SR_ORE) != 0) {
        u->overruns++; /* the byte in DR is good, the one after it is lost */
    }
    if ((status & USART_SR_RXNE) == 0) {
        return;
    }
    if ((status & USART_SR_FE) != 0) {
        u->framing_errors++;
    } else if (!ring_put_byte(&u->rx, byte)) {
        u->overruns++;
    }
}

/* The transmitter has room: the next byte, or from now on only the end of the last one is waited for. */
static void send(uart *u)
{
    usart_registers *r = u->registers;
    uint8_t byte;
    if (ring_take_byte(&u->tx, &byte)) {
        reg_write(&r->dr, byte);
    } else {
        reg_change(&r->cr1, USART_CR1_TXEIE, u->half_duplex ? USART_CR1_TCIE : 0u);
    }
}

static void end_sending(uart *u)
{
    reg_change(&u->registers->cr1, USART_CR1_TCIE, u->half_duplex ? USART_CR1_RE : 0u);
    u->sender = UART_QUIET;
}

void uart_interrupt(uart *u)
{
    usart_registers *r = u->registers;
    const uint32_t status = reg_read(&r->sr), enabled = reg_read(&r->cr1);
    if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0) {
        receive(u, status);
    }
    if ((status & enabled & USART_CR1_TXEIE) != 0) {
        send(u);
    } else if ((status & enabled & USART_CR1_TCIE) != 0) {
        end_sending(u);
    }
}
