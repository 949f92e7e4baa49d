/* servo_setup.c - see servo_setup.h. */
#include "servo_setup.h"

#include "servos.h"

/* Servo 2i turns theta of joint i, servo 2i + 1 its phi. */
static void describe(const params_set *set, servo_setup *setup)
{
    const device_params *d = &set->device;
    for (int servo = 0; servo < setup->servos_n; servo++) {
        setup->map[servo] = (servo_config){
            .id = (uint16_t)d->servo_id[servo],
            .joint = (uint8_t)(servo / 2),
            .axis = (uint8_t)(servo % 2),
            .sign = d->servo_sign[servo] < 0.0f ? -1 : 1,
            .offset_rad = d->servo_offset_rad[servo],
            .min_rad = d->servo_offset_rad[servo] + d->servo_min_rad[servo],
            .max_rad = d->servo_offset_rad[servo] + d->servo_max_rad[servo],
            .rate_rad_s = d->servo_rate_radps,
            .accel_rad_s2 = d->servo_acceleration_radps2,
        };
    }
}

void servo_setup_hardware(const params_set *set, servos_config *config)
{
    const device_params *d = &set->device;
    config->kind = (uint8_t)d->servo_kind;
    config->servos_n = 2 * set->rod.links_n;
    config->bus_baud = (uint32_t)d->servo_baud;
    config->pwm_hz = d->pwm_hz;
    config->pwm_center_us = d->pwm_center_us;
    config->pwm_us_per_rad = d->pwm_us_per_rad;
    for (int servo = 0; servo < config->servos_n; servo++) {
        config->id[servo] = (uint8_t)d->servo_id[servo];
    }
}

static bool check_hardware(const servos_config *config, params_refusal *why)
{
    servo_trouble trouble;
    if (servos_check(config, &trouble)) {
        return true;
    }
    const bool pwm = config->kind == SERVOS_PWM;
    switch (trouble.kind) {
    case SERVO_TROUBLE_COUNT:
        *why = (params_refusal){REASON_COMBINATION,
                                -1,
                                0.5f * (float)config->servos_n,
                                1.0f,
                                pwm ? 0.5f * (float)HAL_PWM_CHANNELS_N : (float)ROD_MAX_LINKS,
                                "links",
                                pwm ? "two hobby servos a link, and 8 channels"
                                    : servo_trouble_text(trouble.kind)};
        break;
    case SERVO_TROUBLE_BAUD:
        *why = (params_refusal){REASON_COMBINATION,
                                -1,
                                (float)config->bus_baud,
                                9600.0f,
                                4500000.0f,
                                "servo_baud",
                                "9600, 57600, 115200, or 1, 2, 3, 4, 4.5 million"};
        break;
    default:
        *why = (params_refusal){REASON_COMBINATION,
                                trouble.servo,
                                (float)trouble.id,
                                1.0f,
                                pwm ? (float)HAL_PWM_CHANNELS_N : (float)SERVO_ID_MAX,
                                "servo_id",
                                servo_trouble_text(trouble.kind)};
        break;
    }
    return false;
}

/* The servos are served on whole ticks: at the asked rate or the next lower one that fits, and never sooner than the
 * last goals have gone. */
static bool choose_period(const params_set *set, const servos_config *config, servo_setup *setup,
                          params_refusal *why)
{
    const float least_s = servos_period_s(config), asked_hz = set->device.servo_hz;
    if (asked_hz * least_s > 1.0f) {
        const bool pwm = config->kind == SERVOS_PWM;
        *why = (params_refusal){pwm ? REASON_COMBINATION : REASON_LINE_RATE,
                                -1,
                                asked_hz,
                                0.0f,
                                1.0f / least_s,
                                "servo_rate",
                                pwm ? "more than pwm_rate"
                                    : "a set of goals is 14 + 5 bytes a servo, 10 bits each, and "
                                      "one question more: see servo_baud"};
        return false;
    }
    const float period_s = asked_hz > 0.0f ? 1.0f / asked_hz : least_s;
    const int whole = (int)(period_s / set->rod.tick_s + 0.999f);
    setup->period_ticks = whole > 1 ? whole : 1;
    setup->period_s = (float)setup->period_ticks * set->rod.tick_s;
    return true;
}

static bool check_map(const servo_setup *setup, params_refusal *why)
{
    servo_refusal refusal;
    const servo_error error =
        servo_map_check(setup->map, setup->servos_n, setup->period_s, &refusal);
    if (error == SERVO_OK) {
        return true;
    }
    *why = (params_refusal){REASON_COMBINATION,
                            refusal.servo,
                            refusal.value,
                            refusal.min,
                            refusal.max,
                            error == SERVO_E_ID       ? "servo_id"
                            : error == SERVO_E_OFFSET ? "servo_offset"
                            : error == SERVO_E_RANGE  ? "servo_min"
                                                      : "servo_rate",
                            servo_error_text(error)};
    return false;
}

bool servo_setup_make(servo_setup *setup, const params_set *set, params_refusal *why)
{
    servos_config config;
    setup->servos_n = 2 * set->rod.links_n;
    servo_setup_hardware(set, &config);
    describe(set, setup);
    return check_hardware(&config, why) && choose_period(set, &config, setup, why) &&
           check_map(setup, why);
}
