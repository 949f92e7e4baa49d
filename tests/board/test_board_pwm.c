/* test_board_pwm.c - eight pulses: rates, widths, and outputs that are low whenever they should be. */
#include <string.h>

#include "pwm.h"
#include "scripted.h"
#include "unity.h"

static tim_registers timers[2];
static pwm p;

void setUp(void)
{
    memset(timers, 0, sizeof timers);
    scripted_start((script){NULL, NULL});
    pwm_init(&p, &timers[0], &timers[1], 84000000);
}

void tearDown(void)
{
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_HEX32(0, timers[i].dier); /* no interrupt, ever */
    }
}

static void outputs_are(uint32_t mode)
{
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_HEX32(mode, timers[i].ccmr1);
        TEST_ASSERT_EQUAL_HEX32(mode, timers[i].ccmr2);
        TEST_ASSERT_EQUAL_HEX32(0x1111, timers[i].ccer);
    }
}

static void low_until_started(void)
{
    outputs_are(TIM_CCMR_LOW);
    scripted_start((script){NULL, NULL});
    pwm_pulse(&p, 0, 1500);
    TEST_ASSERT_EQUAL_INT(0, scripted_writes_n);
    TEST_ASSERT_EQUAL_HEX32(0, timers[0].cr1 & TIM_CR1_CEN);
}

static void rates_to_the_microsecond(void)
{
    static const struct {
        float rate_hz;
        uint32_t period_us;
    } ROWS[] = {{50.0f, 20000}, {60.0f, 16667}, {100.0f, 10000}, {200.0f, 5000}, {333.0f, 3003}};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(pwm_start(&p, ROWS[i].rate_hz));
        for (int t = 0; t < 2; t++) {
            TEST_ASSERT_EQUAL_UINT32(ROWS[i].period_us, timers[t].arr + 1);
            TEST_ASSERT_EQUAL_UINT32(84, timers[t].psc + 1); /* counts microseconds */
            TEST_ASSERT_EQUAL_HEX32(TIM_CR1_ARPE | TIM_CR1_CEN, timers[t].cr1);
            for (int channel = 0; channel < 4; channel++) {
                TEST_ASSERT_EQUAL_UINT32(0, timers[t].ccr[channel]); /* no pulse yet */
            }
        }
        outputs_are(TIM_CCMR_PWM_PRELOAD);
    }
}

static void rates_outside_are_refused_and_stop(void)
{
    static const float RATES_HZ[] = {49.9f, 333.5f, 0.0f, -50.0f, 1e30f};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(pwm_start(&p, 50.0f));
        TEST_ASSERT_FALSE(pwm_start(&p, RATES_HZ[i]));
        outputs_are(TIM_CCMR_LOW);
    }
    volatile float zero = 0.0f;
    TEST_ASSERT_FALSE(pwm_start(&p, zero / zero));
}

static void each_width_goes_to_its_channel_by_one_write(void)
{
    TEST_ASSERT_TRUE(pwm_start(&p, 50.0f));
    scripted_start((script){NULL, NULL});
    for (int channel = 0; channel < 8; channel++) {
        pwm_pulse(&p, channel, 1000u + (uint32_t)channel);
    }
    TEST_ASSERT_EQUAL_INT(8, scripted_writes_n); /* and so nothing is cut: CCR has a preload */
    for (int channel = 0; channel < 8; channel++) {
        TEST_ASSERT_EQUAL_UINT32(1000u + (uint32_t)channel, timers[channel / 4].ccr[channel % 4]);
    }
    pwm_pulse(&p, 3, 0);
    TEST_ASSERT_EQUAL_UINT32(0, timers[0].ccr[3]);
    pwm_pulse(&p, 3, 50000); /* never high for good */
    TEST_ASSERT_EQUAL_UINT32(19999, timers[0].ccr[3]);
    TEST_ASSERT_EQUAL_UINT32(19999, timers[0].arr);
}

static void channels_that_do_not_exist_are_nothing(void)
{
    TEST_ASSERT_TRUE(pwm_start(&p, 50.0f));
    scripted_start((script){NULL, NULL});
    pwm_pulse(&p, -1, 1500);
    pwm_pulse(&p, 8, 1500);
    TEST_ASSERT_EQUAL_INT(0, scripted_writes_n);
}

static void stop_is_low_at_once_with_the_first_writes(void)
{
    TEST_ASSERT_TRUE(pwm_start(&p, 50.0f));
    pwm_pulse(&p, 7, 1500);
    scripted_start((script){NULL, NULL});
    pwm_stop(&p);
    outputs_are(TIM_CCMR_LOW);
    TEST_ASSERT_TRUE(scripted_first_write(&timers[0].ccmr1) < scripted_first_write(&timers[0].cr1));
    pwm_pulse(&p, 7, 1500);
    outputs_are(TIM_CCMR_LOW);
    TEST_ASSERT_TRUE(pwm_start(&p, 50.0f)); /* and nothing of before comes back */
    TEST_ASSERT_EQUAL_UINT32(0, timers[1].ccr[3]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(low_until_started);
    RUN_TEST(rates_to_the_microsecond);
    RUN_TEST(rates_outside_are_refused_and_stop);
    RUN_TEST(each_width_goes_to_its_channel_by_one_write);
    RUN_TEST(channels_that_do_not_exist_are_nothing);
    RUN_TEST(stop_is_low_at_once_with_the_first_writes);
    return UNITY_END();
}
