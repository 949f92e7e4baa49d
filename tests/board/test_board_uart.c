/* test_board_uart.c - dividers against the manual's tables; both lines on a model of the USART that counts bits. */
#include <string.h>

#include "scripted.h"
#include "uart.h"
#include "unity.h"

static usart_registers usart;
static uart u;
static uint8_t rx[64], tx[64];

/* The transmitter: a byte in the shift register, one waiting in DR; what went out. */
static struct {
    int shifting, waiting; /* the byte, or -1 */
    uint8_t out[256];
    int out_n;
    uint8_t in;
} line;

static uint32_t flags(void)
{
    return (line.waiting < 0 ? USART_SR_TXE : 0u) |
           (line.waiting < 0 && line.shifting < 0 ? USART_SR_TC : 0u);
}

static uint32_t read(const reg *place, uint32_t held)
{
    if (place == &usart.sr) {
        return held | flags();
    }
    if (place == &usart.dr) {
        usart.sr = 0; /* RXNE and, after SR was read, the errors (RM0090 30.6.1) */
        return line.in;
    }
    return held;
}

static bool write(reg *place, uint32_t value)
{
    if (place == &usart.dr) {
        TEST_ASSERT_TRUE((usart.cr1 & USART_CR1_TE) != 0 && (usart.cr1 & USART_CR1_UE) != 0);
        TEST_ASSERT_EQUAL_INT(-1, line.waiting); /* nothing is overwritten */
        if (u.half_duplex) {
            TEST_ASSERT_EQUAL_HEX32(0, usart.cr1 & USART_CR1_RE); /* does not hear itself */
        }
        line.waiting = (int)value;
        if (line.shifting < 0) {
            line.shifting = line.waiting;
            line.waiting = -1;
        }
        return true;
    }
    return false;
}

/* The interrupt, as often as the hardware asks for it. */
static void serve(void)
{
    for (int i = 0; i < 10; i++) {
        const uint32_t asks = (usart.sr | flags()) & usart.cr1;
        const bool overrun = (usart.sr & USART_SR_ORE) != 0 && (usart.cr1 & USART_CR1_RXNEIE) != 0;
        if ((asks & (USART_CR1_RXNEIE | USART_CR1_TXEIE | USART_CR1_TCIE)) == 0 && !overrun) {
            return;
        }
        uart_interrupt(&u);
    }
    TEST_FAIL_MESSAGE("the interrupt does not go away");
}

/* A byte's time: what is shifted out is out. */
static void byte_time(void)
{
    if (line.shifting >= 0) {
        line.out[line.out_n++] = (uint8_t)line.shifting;
    }
    line.shifting = line.waiting;
    line.waiting = -1;
    serve();
}

static void hear(uint8_t byte, uint32_t errors)
{
    if ((usart.cr1 & USART_CR1_RE) != 0) {
        line.in = byte;
        usart.sr |= USART_SR_RXNE | errors;
        serve();
    }
}

static void start(bool half_duplex)
{
    memset(&usart, 0, sizeof usart);
    memset(&line, 0, sizeof line);
    line.shifting = line.waiting = -1;
    scripted_start((script){read, write});
    uart_init(&u, &usart, 84000000, half_duplex, rx, sizeof rx, tx, sizeof tx);
    TEST_ASSERT_TRUE(uart_start(&u, 1000000));
}

void setUp(void) {}
void tearDown(void) {}

/* RM0090 (rev. 11), tables 137, 138 and 141: USARTDIV. The last five are round numbers that need no table. */
static void dividers_are_those_of_the_manual(void)
{
    static const struct {
        uint32_t clock_hz, baud;
        float usartdiv;
    } ROWS[] = {
        {84000000, 2400, 2187.5f},    {84000000, 9600, 546.875f},   {84000000, 19200, 273.4375f},
        {84000000, 57600, 91.125f},   {84000000, 115200, 45.5625f}, {84000000, 230400, 22.8125f},
        {84000000, 460800, 11.375f},  {84000000, 921600, 5.6875f},  {42000000, 2400, 1093.75f},
        {42000000, 19200, 136.75f},   {42000000, 38400, 68.375f},   {42000000, 57600, 45.5625f},
        {42000000, 460800, 5.6875f},  {42000000, 921600, 2.875f},   {16000000, 9600, 104.1875f},
        {16000000, 57600, 17.375f},   {16000000, 115200, 8.6875f},  {16000000, 460800, 2.1875f},
        {84000000, 1000000, 5.25f},   {84000000, 2000000, 2.625f},  {84000000, 3000000, 1.75f},
        {84000000, 4000000, 1.3125f}, {16000000, 1000000, 1.0f},
    };
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        uint32_t cycles;
        bool over8;
        TEST_ASSERT_TRUE(uart_divider(ROWS[i].clock_hz, ROWS[i].baud, &cycles, &over8));
        TEST_ASSERT_FALSE(over8);
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(ROWS[i].usartdiv * 16.0f),
                                 cycles); /* 4 bits of fraction */
    }
}

/* RM0090 table 138: 8 samples a bit where 16 do not fit. 16 MHz, 1.792 Mbaud: 1.125, 0.79 % off. */
static void eight_samples_where_sixteen_do_not_fit(void)
{
    start(false);
    u.clock_hz = 16000000;
    TEST_ASSERT_TRUE(uart_start(&u, 1792000));
    TEST_ASSERT_EQUAL_HEX32(0x11, usart.brr); /* mantissa 1, fraction 1/8 */
    TEST_ASSERT_TRUE((usart.cr1 & USART_CR1_OVER8) != 0);
    TEST_ASSERT_TRUE(uart_start(&u, 2000000));
    TEST_ASSERT_EQUAL_HEX32(0x10, usart.brr);
    u.clock_hz = 84000000;
    TEST_ASSERT_TRUE(uart_start(&u, 6000000)); /* 14 cycles: 1.75 */
    TEST_ASSERT_EQUAL_HEX32(0x16, usart.brr);
    TEST_ASSERT_TRUE(uart_start(&u, 4000000)); /* 21 cycles fit 16 samples: 1 and 5/16 */
    TEST_ASSERT_EQUAL_HEX32(0x15, usart.brr);
    TEST_ASSERT_EQUAL_HEX32(0, usart.cr1 & USART_CR1_OVER8);
}

static void rates_more_than_a_hundredth_off_are_refused(void)
{
    uint32_t cycles, made_n = 0;
    bool over8;
    TEST_ASSERT_FALSE(uart_divider(16000000, 921600, &cycles, &over8));  /* 2.12 % in table 137 */
    TEST_ASSERT_FALSE(uart_divider(16000000, 4000000, &cycles, &over8)); /* 4 cycles */
    TEST_ASSERT_FALSE(uart_divider(16000000, 3000000, &cycles, &over8));
    TEST_ASSERT_FALSE(uart_divider(84000000, 1200, &cycles, &over8)); /* more than 65,535 cycles */
    TEST_ASSERT_FALSE(uart_divider(84000000, 0, &cycles, &over8));
    TEST_ASSERT_FALSE(uart_divider(84000000, UINT32_MAX, &cycles, &over8));
    for (uint32_t baud = 1300; baud < 12000000; baud += 1 + baud / 500) {
        const double exact = 84e6 / (double)baud, near = (double)(uint32_t)(exact + 0.5);
        const double off = 84e6 / near / (double)baud - 1.0;
        const bool fits = near >= 8.0 && off <= 0.01 && off >= -0.01;
        if (off < 0.0099 || off > 0.0101) { /* the limit itself is a matter of rounding */
            TEST_ASSERT_EQUAL_INT(fits, uart_divider(84000000, baud, &cycles, &over8));
        }
        made_n += fits ? 1 : 0;
    }
    TEST_ASSERT_TRUE(made_n > 1000);
}

static void a_refused_rate_leaves_the_line_as_it_was(void)
{
    start(false);
    const usart_registers before = usart;
    TEST_ASSERT_FALSE(uart_start(&u, 900));
    TEST_ASSERT_EQUAL_MEMORY(&before, &usart, sizeof usart);
}

static void the_link_sends_all_in_order_and_goes_quiet(void)
{
    start(false);
    uint8_t sent = 0, bytes[7];
    for (int round = 0; round < 30; round++) {
        for (int i = 0; i < 7; i++) {
            bytes[i] = (uint8_t)(sent + i);
        }
        sent = (uint8_t)(sent + (uart_write(&u, bytes, 7) ? 7 : 0));
        serve();
        for (int i = 0; i < round % 10; i++) {
            byte_time();
        }
    }
    while (line.shifting >= 0 || line.waiting >= 0) {
        byte_time();
    }
    TEST_ASSERT_EQUAL_INT(sent, line.out_n);
    TEST_ASSERT_TRUE(sent > 100); /* the ring went round */
    for (int i = 0; i < line.out_n; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, line.out[i]);
    }
    TEST_ASSERT_EQUAL_HEX32(0, usart.cr1 & (USART_CR1_TXEIE | USART_CR1_TCIE));
    TEST_ASSERT_TRUE((usart.cr1 & USART_CR1_RE) != 0);
}

static void a_full_ring_takes_all_or_nothing(void)
{
    start(false);
    const uint8_t bytes[65] = {0};
    TEST_ASSERT_FALSE(uart_write(&u, bytes, 65));
    TEST_ASSERT_EQUAL_size_t(64, uart_free(&u));
    TEST_ASSERT_TRUE(uart_write(&u, bytes, 60));
    TEST_ASSERT_FALSE(uart_write(&u, bytes, 5));
    TEST_ASSERT_EQUAL_size_t(4, uart_free(&u));
    TEST_ASSERT_TRUE(uart_write(&u, bytes, 4));
    TEST_ASSERT_FALSE(uart_write(&u, bytes, 1));
}

static void what_comes_is_read_and_what_does_not_fit_is_counted(void)
{
    start(false);
    uint8_t got[100];
    for (int i = 0; i < 70; i++) {
        hear((uint8_t)i, 0);
    }
    TEST_ASSERT_EQUAL_UINT32(6, u.overruns);
    TEST_ASSERT_EQUAL_size_t(10, uart_read(&u, got, 10));
    hear(200, 0);
    TEST_ASSERT_EQUAL_size_t(55, uart_read(&u, got + 10, 90));
    for (int i = 0; i < 64; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, got[i]);
    }
    TEST_ASSERT_EQUAL_UINT8(200, got[64]);
    TEST_ASSERT_EQUAL_size_t(0, uart_read(&u, got, 100));
}

static void errors_are_counted_and_bad_bytes_dropped(void)
{
    start(false);
    uint8_t got[4];
    hear(1, 0);
    hear(2, USART_SR_FE);
    hear(3, USART_SR_ORE); /* good itself; the one behind it is lost */
    TEST_ASSERT_EQUAL_UINT32(1, u.framing_errors);
    TEST_ASSERT_EQUAL_UINT32(1, u.overruns);
    TEST_ASSERT_EQUAL_size_t(2, uart_read(&u, got, 4));
    TEST_ASSERT_EQUAL_UINT8(3, got[1]);
    usart.sr = USART_SR_ORE; /* without a byte */
    serve();
    TEST_ASSERT_EQUAL_UINT32(2, u.overruns);
    TEST_ASSERT_EQUAL_size_t(0, uart_read(&u, got, 4));
}

static void one_wire_turns_round_after_the_last_stop_bit(void)
{
    static const uint8_t PACKET[5] = {1, 2, 3, 4, 5};
    uint8_t got[4];
    start(true);
    TEST_ASSERT_EQUAL_HEX32(USART_CR3_HDSEL, usart.cr3);
    TEST_ASSERT_FALSE(uart_sending(&u));
    for (int round = 1; round <= 2; round++) {
        TEST_ASSERT_TRUE(uart_write(&u, PACKET, 5));
        TEST_ASSERT_FALSE(uart_write(&u, PACKET, 5)); /* one at a time */
        serve();
        for (int i = 0; i < 5; i++) {
            TEST_ASSERT_TRUE(uart_sending(&u));
            hear(99, 0); /* its echo */
            byte_time();
        }
        TEST_ASSERT_FALSE(uart_sending(&u));
        TEST_ASSERT_EQUAL_INT(5 * round, line.out_n);
        hear(42, 0);
        TEST_ASSERT_EQUAL_size_t(1, uart_read(&u, got, 4));
        TEST_ASSERT_EQUAL_UINT8(42, got[0]);
    }
    TEST_ASSERT_EQUAL_MEMORY(PACKET, line.out, 5);
}

static void abort_ends_what_is_sent_and_forgets_what_came(void)
{
    static const uint8_t LONG[40] = {7}, STOP[3] = {10, 11, 12};
    uint8_t got[4];
    start(true);
    hear(1, 0);
    TEST_ASSERT_TRUE(uart_write(&u, LONG, 40));
    serve();
    byte_time();
    uart_abort(&u);
    TEST_ASSERT_EQUAL_size_t(0, uart_read(&u, got, 4));
    TEST_ASSERT_TRUE(uart_sending(&u));
    byte_time();
    TEST_ASSERT_TRUE(uart_sending(&u));
    byte_time();
    TEST_ASSERT_FALSE(uart_sending(&u));
    TEST_ASSERT_EQUAL_INT(3, line.out_n); /* the one that was out, and the two in the transmitter */
    hear(2, 0);
    TEST_ASSERT_EQUAL_size_t(1, uart_read(&u, got, 4));

    /* and a packet right behind an abort, at any moment of it */
    for (int wait = 0; wait < 4; wait++) {
        start(true);
        TEST_ASSERT_TRUE(uart_write(&u, LONG, 40));
        serve();
        byte_time();
        uart_abort(&u);
        for (int i = 0; i < wait; i++) {
            byte_time();
        }
        TEST_ASSERT_TRUE(uart_write(&u, STOP, 3));
        serve();
        for (int i = 0; i < 6; i++) {
            byte_time();
        }
        TEST_ASSERT_FALSE(uart_sending(&u));
        TEST_ASSERT_EQUAL_INT(6, line.out_n);
        TEST_ASSERT_EQUAL_MEMORY(STOP, line.out + 3, 3);
        TEST_ASSERT_TRUE((usart.cr1 & USART_CR1_RE) != 0);
    }
}

static void abort_of_nothing_is_nothing(void)
{
    start(true);
    uart_abort(&u);
    TEST_ASSERT_FALSE(uart_sending(&u));
    hear(2, 0);
    uint8_t got[4];
    TEST_ASSERT_EQUAL_size_t(1, uart_read(&u, got, 4));
}

static void a_new_rate_ends_everything(void)
{
    static const uint8_t LONG[40] = {7};
    start(true);
    hear(1, 0);
    TEST_ASSERT_TRUE(uart_write(&u, LONG, 40));
    serve();
    TEST_ASSERT_TRUE(uart_start(&u, 57600));
    line.shifting = line.waiting = -1;
    TEST_ASSERT_FALSE(uart_sending(&u));
    uint8_t got[4];
    TEST_ASSERT_EQUAL_size_t(0, uart_read(&u, got, 4));
    TEST_ASSERT_EQUAL_size_t(64, uart_free(&u));
    TEST_ASSERT_EQUAL_HEX32(91 * 16 + 2, usart.brr); /* 91.125 */
    byte_time();
    TEST_ASSERT_EQUAL_INT(0, line.out_n);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(dividers_are_those_of_the_manual);
    RUN_TEST(eight_samples_where_sixteen_do_not_fit);
    RUN_TEST(rates_more_than_a_hundredth_off_are_refused);
    RUN_TEST(a_refused_rate_leaves_the_line_as_it_was);
    RUN_TEST(the_link_sends_all_in_order_and_goes_quiet);
    RUN_TEST(a_full_ring_takes_all_or_nothing);
    RUN_TEST(what_comes_is_read_and_what_does_not_fit_is_counted);
    RUN_TEST(errors_are_counted_and_bad_bytes_dropped);
    RUN_TEST(one_wire_turns_round_after_the_last_stop_bit);
    RUN_TEST(abort_ends_what_is_sent_and_forgets_what_came);
    RUN_TEST(abort_of_nothing_is_nothing);
    RUN_TEST(a_new_rate_ends_everything);
    return UNITY_END();
}
