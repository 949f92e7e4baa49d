/* servo_pwm.c - hobby servos; see servo_pwm.h. */
#include "servo_pwm.h"

#include "servo_round.h"

enum { TURN_US = 800000 }; /* of a test, each way */

bool servo_pwm_check(const servos_config *config, servo_trouble *trouble)
{
    *trouble = (servo_trouble){.servo = -1};
    if (config->servos_n < 1 || config->servos_n > HAL_PWM_CHANNELS_N) {
        trouble->kind = SERVO_TROUBLE_COUNT;
        return false;
    }
    for (int i = 0; i < config->servos_n; i++) {
        if (config->id[i] < 1 || config->id[i] > HAL_PWM_CHANNELS_N) {
            *trouble = (servo_trouble){SERVO_TROUBLE_CHANNEL, (int16_t)i, config->id[i], 0};
            return false;
        }
    }
    if (!(config->pwm_hz >= 50.0f && config->pwm_hz <= 333.0f)) {
        trouble->kind = SERVO_TROUBLE_BAUD;
        return false;
    }
    return true;
}

void servo_pwm_init(servo_pwm *p, const hal *hal, const servos_config *config)
{
    *p = (servo_pwm){.hal = hal, .config = config};
}

bool servo_pwm_start(servo_pwm *p)
{
    p->on = false;
    p->enabled_n = 0;
    return p->hal->pwm_start(p->hal->context, p->config->pwm_hz);
}

uint32_t servo_pwm_width_us(const servos_config *config, float goal_rad)
{
    const float width_us = config->pwm_center_us + goal_rad * config->pwm_us_per_rad;
    if (!(width_us >= (float)SERVOS_PWM_MIN_US)) { /* NaN too */
        return SERVOS_PWM_MIN_US;
    }
    return width_us > (float)SERVOS_PWM_MAX_US ? SERVOS_PWM_MAX_US
                                               : (uint32_t)servo_nearest(width_us);
}

static void pulse(const servo_pwm *p, uint8_t id, float goal_rad)
{
    p->hal->pwm_pulse(p->hal->context, id - 1, servo_pwm_width_us(p->config, goal_rad));
}

void servo_pwm_goals(servo_pwm *p, const float *goals_rad)
{
    for (int i = 0; i < p->config->servos_n; i++) {
        if (servo_is_number(goals_rad[i])) { /* else it stays where it was */
            p->goals_rad[i] = goals_rad[i];
        }
        if (i < p->enabled_n) {
            pulse(p, p->config->id[i], p->goals_rad[i]);
        }
    }
}

static void enable_next(servo_pwm *p, uint32_t now_us)
{
    pulse(p, p->config->id[p->enabled_n], p->goals_rad[p->enabled_n]);
    p->enabled_n++;
    p->step_us = now_us;
}

void servo_pwm_torque(servo_pwm *p, const float *goals_rad, uint32_t now_us)
{
    p->enabled_n = 0;
    for (int i = 0; i < HAL_PWM_CHANNELS_N; i++) {
        p->goals_rad[i] = 0.0f;
    }
    servo_pwm_goals(p, goals_rad);
    p->on = true;
    enable_next(p, now_us);
}

void servo_pwm_off(servo_pwm *p)
{
    p->hal->pwm_stop(p->hal->context);
    p->on = false;
    p->enabled_n = 0;
    p->test.busy = false;
}

void servo_pwm_test_start(servo_pwm *p, uint8_t id, float turn_rad, uint32_t now_us)
{
    p->test = (servo_pwm_test){.id = id, .busy = true, .turn_rad = turn_rad, .since_us = now_us};
}

static void test_tick(servo_pwm *p, uint32_t now_us)
{
    const uint32_t after_us = now_us - p->test.since_us;
    if (after_us >= 2 * TURN_US) {
        servo_pwm_off(p);
        return;
    }
    const uint32_t way_us = after_us < TURN_US ? after_us : 2 * TURN_US - after_us;
    pulse(p, p->test.id, p->test.turn_rad * (float)way_us * (1.0f / (float)TURN_US));
}

void servo_pwm_tick(servo_pwm *p, uint32_t now_us)
{
    if (p->test.busy) {
        test_tick(p, now_us);
    } else if (p->on && p->enabled_n < p->config->servos_n &&
               now_us - p->step_us >= SERVOS_PWM_STEP_US) {
        enable_next(p, now_us);
    }
}
