/* test_board_pins.c - each pin's function, against a table of its own; the servo supply is never on by accident. */
#include <string.h>

#include "pins.h"
#include "scripted.h"
#include "unity.h"

static rcc_registers rcc;
static gpio_registers gpio[3];
static const pins_ports PORTS = {{&gpio[0], &gpio[1], &gpio[2]}};

/* As after a reset (RM0090 8.4): the debugger's pins have a function, all others are inputs. */
void setUp(void)
{
    memset(&rcc, 0, sizeof rcc);
    memset(gpio, 0, sizeof gpio);
    gpio[0].moder = 0xA8000000;
    gpio[0].pupdr = 0x64000000;
    gpio[1].moder = 0x00000280;
    gpio[1].pupdr = 0x00000100;
    scripted_start((script){NULL, NULL});
    pins_start(&rcc, &PORTS);
}

void tearDown(void) {}

enum { IN, OUT, FUNCTION };

static void pin_is(int port, int pin, uint32_t mode, uint32_t function, uint32_t pull)
{
    const gpio_registers *g = &gpio[port];
    TEST_ASSERT_EQUAL_HEX32(mode, g->moder >> 2 * pin & 3);
    TEST_ASSERT_EQUAL_HEX32(pull, g->pupdr >> 2 * pin & 3);
    TEST_ASSERT_EQUAL_HEX32(0, g->otyper >> pin & 1); /* push-pull, the servo bus too: uart.h */
    if (mode == FUNCTION) {
        TEST_ASSERT_EQUAL_HEX32(function, (pin < 8 ? g->afrl : g->afrh) >> 4 * (pin & 7) & 0xF);
    }
}

static void functions_are_those_of_the_wiring_table(void)
{
    pin_is(0, 9, FUNCTION, 7, 0);  /* USART1_TX */
    pin_is(0, 10, FUNCTION, 7, 1); /* USART1_RX */
    pin_is(2, 6, FUNCTION, 8, 0);  /* USART6_TX: 5 V tolerant without a pull-up only */
    for (int pin = 6; pin <= 7; pin++) {
        pin_is(0, pin, FUNCTION, 2, 0); /* TIM3_CH1, 2 */
        pin_is(1, pin - 6, FUNCTION, 2, 0);
        pin_is(1, pin, FUNCTION, 2, 0); /* TIM4 */
        pin_is(1, pin + 2, FUNCTION, 2, 0);
    }
    pin_is(2, 0, IN, 0, 1); /* e-stop: pulled up, so that a cut loop reads high */
    pin_is(1, 12, OUT, 0, 0);
    pin_is(2, 12, OUT, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(0xA8000000, gpio[0].moder & 0xFC000000); /* the debugger stays on */
    TEST_ASSERT_EQUAL_HEX32(0x00000280, gpio[1].moder & 0x000003C0);
}

static void blocks_have_clocks_before_they_are_touched(void)
{
    TEST_ASSERT_EQUAL_HEX32(7, rcc.ahb1enr);
    TEST_ASSERT_EQUAL_HEX32(1 << 1 | 1 << 2, rcc.apb1enr);
    TEST_ASSERT_EQUAL_HEX32(1 << 4 | 1 << 5, rcc.apb2enr);
    TEST_ASSERT_EQUAL_INT(0, scripted_first_write(&rcc.ahb1enr));
}

static void the_supply_is_off_before_it_is_an_output(void)
{
    const int first = scripted_first_write(&gpio[1].bsrr);
    TEST_ASSERT_TRUE(first >= 0 && first < scripted_first_write(&gpio[1].moder));
    TEST_ASSERT_EQUAL_HEX32(1u << (12 + 16), scripted_writes[first].value);
    TEST_ASSERT_EQUAL_INT(first, scripted_last_write(&gpio[1].bsrr));
    pins_servo_supply(&gpio[1], true);
    TEST_ASSERT_EQUAL_HEX32(1u << 12, gpio[1].bsrr);
    pins_servo_supply(&gpio[1], false);
    TEST_ASSERT_EQUAL_HEX32(1u << 28, gpio[1].bsrr);
}

static void high_is_stop(void)
{
    gpio[2].idr = 0;
    TEST_ASSERT_FALSE(pins_estop(&gpio[2]));
    gpio[2].idr = 1;
    TEST_ASSERT_TRUE(pins_estop(&gpio[2]));
    gpio[2].idr = 0xFFFE;
    TEST_ASSERT_FALSE(pins_estop(&gpio[2]));
}

static void the_led_is_on_when_low(void)
{
    pins_led(&gpio[2], true);
    TEST_ASSERT_EQUAL_HEX32(1u << 28, gpio[2].bsrr);
    pins_led(&gpio[2], false);
    TEST_ASSERT_EQUAL_HEX32(1u << 12, gpio[2].bsrr);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(functions_are_those_of_the_wiring_table);
    RUN_TEST(blocks_have_clocks_before_they_are_touched);
    RUN_TEST(the_supply_is_off_before_it_is_an_output);
    RUN_TEST(high_is_stop);
    RUN_TEST(the_led_is_on_when_low);
    return UNITY_END();
}
