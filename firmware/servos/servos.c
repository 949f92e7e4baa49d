/* servos.c - the one way in, whatever the servos are; see servos.h. */
#include "servos.h"

#include <stddef.h>

#include "servo_round.h"

enum { SERVICE_US = 10000000 };

static const servo_trouble NO_TROUBLE = {.servo = -1};

const char *servo_trouble_text(uint8_t kind)
{
    static const char *const TEXTS[SERVO_TROUBLES_N] = {
        [SERVO_TROUBLE_NONE] = "no trouble",
        [SERVO_TROUBLE_SILENT] = "does not answer: check its cable, supply, id and baud rate",
        [SERVO_TROUBLE_GARBLED] = "answers with noise: check for another baud rate, two servos "
                                  "with one id, the wiring",
        [SERVO_TROUBLE_STATUS] = "refused an instruction: see its status error",
        [SERVO_TROUBLE_HARDWARE] = "reports a hardware error: let it cool, check load and supply, "
                                   "and switch it off and on",
        [SERVO_TROUBLE_MODEL] = "is not of the X series: use another servo",
        [SERVO_TROUBLE_BAUD] = "cannot be driven at that rate: choose another",
        [SERVO_TROUBLE_CHANNEL] = "is on a PWM channel that does not exist: choose another",
        [SERVO_TROUBLE_COUNT] = "there are none, or more than can be served: change their number "
                                "or the baud rate",
        [SERVO_TROUBLE_READ_BACK] = "holds another value than was written: check its limits",
        [SERVO_TROUBLE_MODE] = "does not follow positions: set its Operating Mode to 3 or 4",
        [SERVO_TROUBLE_FAR] =
            "is many turns from its middle: turn it back, or switch it off and on",
        [SERVO_TROUBLE_TAKEN] = "cannot have that id: another servo answers to it",
        [SERVO_TROUBLE_STUCK] = "does not turn as told: check load, supply and its own limits",
    };
    return kind < SERVO_TROUBLES_N && TEXTS[kind] != NULL ? TEXTS[kind] : "has an unknown trouble";
}

float servos_period_s(const servos_config *config)
{
    switch (config->kind) {
    case SERVOS_PWM:
        return 1.0f / config->pwm_hz;
    case SERVOS_BUS:
        return servo_bus_period_s(config->bus_baud, config->servos_n);
    default:
        return 0.0f;
    }
}

bool servos_check(const servos_config *config, servo_trouble *trouble)
{
    servo_trouble found = NO_TROUBLE;
    bool good = true;
    if (config->kind == SERVOS_PWM) {
        good = servo_pwm_check(config, &found);
    } else if (config->kind == SERVOS_BUS) {
        good = servo_bus_check(config, &found);
    }
    if (trouble != NULL) {
        *trouble = found;
    }
    return good;
}

static void supply(servos *s, bool on)
{
    s->hal->servo_supply(s->hal->context, on);
}

static void enter(servos *s, servos_state state, uint32_t now_us)
{
    s->state = state;
    s->since_us = now_us;
}

void servos_configure(servos *s, const hal *hal, const servos_config *config)
{
    *s = (servos){.hal = hal, .config = *config, .trouble = NO_TROUBLE};
    servo_bus_init(&s->bus, hal, &s->config);
    servo_pwm_init(&s->pwm, hal, &s->config);
    supply(s, false);
}

static void fail(servos *s, servo_trouble trouble, uint32_t now_us)
{
    servos_off(s);
    s->trouble = trouble;
    enter(s, SERVOS_FAILED, now_us);
}

void servos_prepare(servos *s, uint32_t now_us)
{
    if (s->state == SERVOS_PREPARING || s->state == SERVOS_PREPARED || s->state == SERVOS_ON) {
        return;
    }
    if (s->state == SERVOS_SERVICE) {
        servos_off(s); /* a request may be under way */
    }
    servo_trouble trouble;
    if (!servos_check(&s->config, &trouble)) {
        fail(s, trouble, now_us);
        return;
    }
    s->trouble = NO_TROUBLE;
    s->answer = SERVO_REQUEST_NONE;
    enter(s, SERVOS_PREPARING, now_us);
    supply(s, s->config.kind != SERVOS_NONE);
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_prepare(&s->bus, now_us);
    } else if (s->config.kind == SERVOS_PWM && !servo_pwm_start(&s->pwm)) {
        fail(s, (servo_trouble){.kind = SERVO_TROUBLE_BAUD, .servo = -1}, now_us);
    }
}

bool servos_positions(const servos *s, float *positions_rad)
{
    if (s->config.kind != SERVOS_BUS || s->state != SERVOS_PREPARED) {
        return false;
    }
    servo_bus_positions(&s->bus, positions_rad);
    return true;
}

void servos_torque(servos *s, const float *goals_rad, uint32_t now_us)
{
    if (s->state != SERVOS_PREPARED) {
        return;
    }
    enter(s, SERVOS_ON, now_us);
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_torque(&s->bus, goals_rad);
    } else if (s->config.kind == SERVOS_PWM) {
        servo_pwm_torque(&s->pwm, goals_rad, now_us);
    }
}

void servos_goals(servos *s, const float *goals_rad)
{
    if (s->state != SERVOS_ON) {
        return;
    }
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_goals(&s->bus, goals_rad);
    } else if (s->config.kind == SERVOS_PWM) {
        servo_pwm_goals(&s->pwm, goals_rad);
    }
}

void servos_off(servos *s)
{
    supply(s, false);
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_off(&s->bus);
    } else if (s->config.kind == SERVOS_PWM) {
        servo_pwm_off(&s->pwm);
    }
    if (s->answer == SERVO_REQUEST_BUSY) {
        s->answer = SERVO_REQUEST_NONE;
    }
    s->state = SERVOS_OFF;
}

/* What the bus has come to, in the terms of this file; the others have nothing to find. */
static void follow(servos *s, uint32_t now_us)
{
    const servo_bus *bus = &s->bus;
    if (s->config.kind != SERVOS_BUS) {
        s->state = s->state == SERVOS_PREPARING ? SERVOS_PREPARED : s->state;
    } else if (s->state == SERVOS_ON) {
        s->trouble = bus->trouble;
    } else if (bus->state == SERVO_BUS_FAILED) {
        fail(s, bus->trouble, now_us);
    } else if (s->state == SERVOS_PREPARING && bus->state == SERVO_BUS_PREPARED) {
        enter(s, SERVOS_PREPARED, now_us);
    }
}

static void end_request(servos *s, servo_request_state answer, uint32_t now_us)
{
    s->answer = answer;
    s->since_us = now_us;
}

static void follow_request(servos *s, uint32_t now_us)
{
    if (s->config.kind == SERVOS_PWM) {
        if (!s->pwm.test.busy) {
            end_request(s, SERVO_REQUEST_DONE, now_us);
        }
    } else if (s->bus.state == SERVO_BUS_DONE) {
        s->info = s->bus.info;
        end_request(s, SERVO_REQUEST_DONE, now_us);
    } else if (s->bus.state == SERVO_BUS_FAILED) {
        const servo_trouble trouble = s->bus.trouble;
        if (s->request.kind == SERVO_REQUEST_TEST) {
            servos_off(s); /* it may have torque, and not hear that it should not */
        }
        s->trouble = trouble;
        end_request(s, SERVO_REQUEST_FAILED, now_us);
    }
}

void servos_tick(servos *s, uint32_t now_us)
{
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_tick(&s->bus, now_us);
    } else if (s->config.kind == SERVOS_PWM) {
        servo_pwm_tick(&s->pwm, now_us);
    }
    switch (s->state) {
    case SERVOS_PREPARING:
    case SERVOS_PREPARED:
    case SERVOS_ON:
        follow(s, now_us);
        break;
    case SERVOS_SERVICE:
        if (s->answer == SERVO_REQUEST_BUSY) {
            follow_request(s, now_us);
        } else if (now_us - s->since_us >= SERVICE_US) {
            servos_off(s);
        }
        break;
    default:
        break;
    }
}

bool servos_healthy(const servos *s)
{
    return s->state != SERVOS_ON || s->config.kind != SERVOS_BUS || servo_bus_healthy(&s->bus);
}

bool servos_started(const servos *s)
{
    return s->state == SERVOS_ON && (s->config.kind != SERVOS_BUS || s->bus.state == SERVO_BUS_ON);
}

/* Whether servos of this kind know such a request, and it makes sense. */
static bool sensible(const servos *s, const servo_request *r)
{
    switch (r->kind) {
    case SERVO_REQUEST_PING:
        break;
    case SERVO_REQUEST_TEST:
        if (!servo_is_number(r->turn_rad)) {
            return false;
        }
        break;
    default:
        if (r->kind > SERVO_REQUEST_TEST || s->config.kind != SERVOS_BUS) {
            return false;
        }
    }
    return s->config.kind != SERVOS_NONE && r->id <= SERVO_ID_MAX && r->new_id <= SERVO_ID_MAX;
}

static float limited(float turn_rad)
{
    const float max = SERVO_BUS_TURN_MAX_RAD;
    return turn_rad > max ? max : turn_rad < -max ? -max : turn_rad;
}

static void pwm_request(servos *s, uint32_t now_us)
{
    const servo_request *r = &s->request;
    s->info = (servo_info){.id = r->id};
    if (r->id < 1 || r->id > HAL_PWM_CHANNELS_N || !servo_pwm_start(&s->pwm)) {
        s->trouble = (servo_trouble){SERVO_TROUBLE_CHANNEL, -1, r->id, 0};
        end_request(s, SERVO_REQUEST_FAILED, now_us);
    } else if (r->kind == SERVO_REQUEST_TEST) {
        servo_pwm_test_start(&s->pwm, r->id, r->turn_rad, now_us);
    }
}

bool servos_request(servos *s, const servo_request *request, uint32_t now_us)
{
    const bool allowed = s->state == SERVOS_OFF || s->state == SERVOS_FAILED ||
                         (s->state == SERVOS_SERVICE && s->answer != SERVO_REQUEST_BUSY);
    if (!allowed || !sensible(s, request)) {
        return false;
    }
    if (s->state != SERVOS_SERVICE) {
        s->powered_us = now_us;
    }
    s->trouble = NO_TROUBLE;
    s->answer = SERVO_REQUEST_BUSY;
    s->request = *request;
    s->request.turn_rad = limited(request->turn_rad);
    enter(s, SERVOS_SERVICE, now_us);
    supply(s, true);
    if (s->config.kind == SERVOS_BUS) {
        servo_bus_ask(&s->bus, &s->request, s->powered_us, now_us);
    } else {
        pwm_request(s, now_us);
    }
    return true;
}

servo_request_state servos_answer(const servos *s, servo_info *info, servo_trouble *trouble)
{
    if (s->answer == SERVO_REQUEST_DONE) {
        *info = s->info;
    } else if (s->answer == SERVO_REQUEST_FAILED) {
        *trouble = s->trouble;
    }
    return s->answer;
}
