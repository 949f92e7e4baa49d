/* count_servos.c - what the servo bus costs on the Cortex-M4F, in instructions, exactly: QEMU with `-icount shift=0`
 * lets TIM2 count them one for one (tests/target/count_instructions.c). Prints `part N count` lines, N servos, and
 * fails if one is over its bound. Once on, the wire is changed for a hal that costs next to nothing. */
#include <stdio.h>

#include "servo_wire_hal.h"

_Static_assert(sizeof(servos) <= 2048, "RAM for all of it");

#define TIM2_CR1 (*(volatile uint32_t *)0x40000000) /* RM0090, 18.4.1 */
#define TIM2_CNT (*(volatile uint32_t *)0x40000024) /* 18.4.10 */
#define TIM2_ARR (*(volatile uint32_t *)0x4000002C) /* 18.4.12 */

void setUp(void) {}
void tearDown(void) {}

static uint8_t coming[HAL_BUS_PACKET_MAX_BYTES];
static size_t coming_n, taken_n;

static bool takes(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context, (void)bytes;
    taken_n = bytes_n;
    return true;
}

static bool sends_nothing(void *context)
{
    (void)context;
    return false;
}

/* As a ring would: a copy. */
static size_t gives(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    static size_t given_n;
    const size_t left = coming_n - given_n, n = left < room ? left : room;
    memcpy(bytes, coming + given_n, n);
    given_n += n;
    if (given_n == coming_n) {
        given_n = coming_n = 0;
    }
    return n;
}

static const hal CHEAP = {.bus_write = takes, .bus_sending = sends_nothing, .bus_read = gives};

/* Prints what it cost since start, and remembers if that is more than it may be. */
static bool dear;

static uint32_t tell(const char *part, int servos_n, uint32_t start, uint32_t most)
{
    const uint32_t taken = TIM2_CNT - start;
    printf("%s %d %lu%s\n", part, servos_n, (unsigned long)taken,
           taken > most ? "   <-- TOO MUCH" : "");
    dear = dear || taken > most;
    return taken;
}

static void comes(uint8_t error, const uint8_t *params, size_t params_n)
{
    const uint8_t id = subject.config.id[subject.bus.servo];
    coming_n = dxl_status(coming, sizeof coming, id, error, params, params_n);
}

static void count(int servos_n)
{
    const servos_config config = wire_fresh(servos_n);
    turned_on(&config);
    run_ms(10);
    subject.bus.hal = &CHEAP;
    servos_tick(&subject, w.now_us += 1000);
    comes(0, (const uint8_t[]){0}, 1);

    uint32_t start = TIM2_CNT;
    servos_goals(&subject, goals_rad);
    uint32_t both = tell("servo_goals", servos_n, start, 2000);
    start = TIM2_CNT;
    servos_tick(&subject, w.now_us += 1000); /* an answer to take, and goals to send */
    both += tell("servo_tick_send", servos_n, start, 7500);
    dear = dear || both > 9000;

    static uint8_t packet[HAL_BUS_PACKET_MAX_BYTES];
    memcpy(packet, subject.bus.packet, sizeof packet);
    start = TIM2_CNT;
    dxl_seal(packet, sizeof packet, DXL_BROADCAST, DXL_SYNC_WRITE, 4u + 5u * (size_t)servos_n);
    tell("servo_seal", servos_n, start, 7000);

    memcpy(coming, subject.bus.packet, taken_n);
    coming_n = taken_n;
    start = TIM2_CNT;
    servos_tick(&subject, w.now_us += 1000); /* the echo, and a question */
    tell("servo_tick_echo", servos_n, start, 30000);

    comes(0, (const uint8_t[]){0}, 1);
    start = TIM2_CNT;
    servos_tick(&subject, w.now_us += 1000); /* an answer, and the next question */
    tell("servo_tick_ask", servos_n, start, 1000);
}

int main(void)
{
    TIM2_ARR = UINT32_MAX;
    TIM2_CR1 = 1;
    count(8);
    count(20);
    count(100);
    return dear ? 1 : 0;
}
