/* servo_config.c - what a servo map may hold, and what is said when it does not; see servo_map.h. */
#include "servo_map.h"

#include <stddef.h>

#define UNIT_RAD (1.0f / 2097152.0f)

const char *servo_error_text(servo_error error)
{
    switch (error) {
    case SERVO_OK:
        return "no error";
    case SERVO_E_COUNT:
        return "there must be 0 servos to two for each of the most links";
    case SERVO_E_PERIOD:
        return "the servo period is out of bounds";
    case SERVO_E_ID:
        return "two servos have the same id";
    case SERVO_E_JOINT:
        return "there is no such joint";
    case SERVO_E_AXIS:
        return "a joint has axes 0 (theta) and 1 (phi)";
    case SERVO_E_SIGN:
        return "a servo's sign is 1 or -1";
    case SERVO_E_RANGE:
        return "a servo's range must lie within +-8 rad and not be empty";
    case SERVO_E_OFFSET:
        return "a servo's offset, where the joint is straight, must lie within its range";
    case SERVO_E_RATE:
        return "a servo's rate is out of bounds";
    case SERVO_E_ACCEL:
        return "a servo's acceleration is out of bounds";
    case SERVO_E_POSITION:
        return "a servo reports a position beyond +-8 rad";
    }
    return "unknown error";
}

static bool within(float value, float min, float max)
{
    return value >= min && value <= max; /* fails for NaN */
}

typedef struct {
    servo_error error;
    float value, min, max;
} servo_check;

static servo_error first_failed(const servo_check *checks, int checks_n, int servo,
                                servo_refusal *refusal)
{
    for (int i = 0; i < checks_n; i++) {
        const servo_check *c = &checks[i];
        if (!within(c->value, c->min, c->max)) {
            if (refusal != NULL) {
                *refusal = (servo_refusal){c->error, servo, c->value, c->min, c->max};
            }
            return c->error;
        }
    }
    return SERVO_OK;
}

/* Another servo before this one with its id, or -1. */
static int same_id(const servo_config *configs, int servo)
{
    for (int i = 0; i < servo; i++) {
        if (configs[i].id == configs[servo].id) {
            return i;
        }
    }
    return -1;
}

static servo_error check_one(const servo_config *configs, int servo, float period_s,
                             servo_refusal *refusal)
{
    const servo_config *c = &configs[servo];
    /* a hair above one unit, so that rounding down leaves at least that one */
    const float rate_min = 1.001f * UNIT_RAD / period_s;
    const float accel_min = rate_min / period_s;
    const float sign_min = c->sign < 0 ? -1.0f : 1.0f;
    const servo_check checks[] = {
        {SERVO_E_JOINT, (float)c->joint, 0.0f, (float)(ROD_MAX_LINKS - 1)},
        {SERVO_E_AXIS, (float)c->axis, (float)ROD_THETA, (float)ROD_PHI},
        {SERVO_E_SIGN, (float)c->sign, sign_min, sign_min},
        {SERVO_E_RANGE, c->min_rad, -SERVO_REACH_RAD, SERVO_REACH_RAD},
        {SERVO_E_RANGE, c->max_rad, c->min_rad + 4.0f * UNIT_RAD, SERVO_REACH_RAD},
        {SERVO_E_OFFSET, c->offset_rad, c->min_rad, c->max_rad},
        {SERVO_E_RATE, c->rate_rad_s, rate_min, SERVO_RATE_MAX_RAD_S},
        {SERVO_E_ACCEL, c->accel_rad_s2, accel_min, SERVO_ACCEL_MAX_RAD_S2},
    };
    const servo_error error =
        first_failed(checks, (int)(sizeof checks / sizeof checks[0]), servo, refusal);
    if (error == SERVO_OK && same_id(configs, servo) >= 0) {
        if (refusal != NULL) {
            const float id = (float)c->id;
            *refusal = (servo_refusal){SERVO_E_ID, servo, id, id, id};
        }
        return SERVO_E_ID;
    }
    return error;
}

servo_error servo_map_check(const servo_config *configs, int servos_n, float period_s,
                            servo_refusal *refusal)
{
    const servo_check checks[] = {
        {SERVO_E_COUNT, (float)servos_n, 0.0f, (float)SERVOS_MAX},
        {SERVO_E_PERIOD, period_s, SERVO_PERIOD_MIN_S, SERVO_PERIOD_MAX_S},
    };
    servo_error error = first_failed(checks, 2, -1, refusal);
    for (int i = 0; i < servos_n && error == SERVO_OK; i++) {
        error = check_one(configs, i, period_s, refusal);
    }
    if (error == SERVO_OK && refusal != NULL) {
        *refusal = (servo_refusal){SERVO_OK, -1, 0.0f, 0.0f, 0.0f};
    }
    return error;
}
