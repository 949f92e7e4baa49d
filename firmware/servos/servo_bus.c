/* servo_bus.c - the bus as a whole, and goals while it is on; see servo_bus.h. */
#include "servo_bus_private.h"

#include <string.h>

#include "servo_round.h"

enum { TORQUE_OFFS = 3 };

#define GAP_S 0.00025f /* servos take their time to answer, and the line to turn round */

float servo_bus_period_s(uint32_t baud, int servos_n)
{
    const int goals_n = DXL_OVERHEAD_BYTES + 4 + 5 * servos_n;
    const int question_n = DXL_OVERHEAD_BYTES + 4, answer_n = DXL_STATUS_BYTES + 1;
    return 10.0f * (float)(goals_n + question_n + answer_n) / (float)baud + GAP_S;
}

bool servo_bus_check(const servos_config *config, servo_trouble *trouble)
{
    const int n = config->servos_n;
    *trouble = (servo_trouble){.servo = -1};
    if (dxl_x_baud_code(config->bus_baud) < 0) {
        trouble->kind = SERVO_TROUBLE_BAUD;
    } else if (n < 1 || n > SERVO_BUS_SERVOS_MAX ||
               servo_bus_period_s(config->bus_baud, n) > 1e-6f * (float)SERVO_BUS_PERIOD_MAX_US) {
        trouble->kind = SERVO_TROUBLE_COUNT;
    }
    return trouble->kind == SERVO_TROUBLE_NONE;
}

void servo_bus_init(servo_bus *b, const hal *hal, const servos_config *config)
{
    *b = (servo_bus){.hal = hal, .config = config, .trouble = {.servo = -1}};
    dxl_decoder_init(&b->decoder, b->params, sizeof b->params);
}

void servo_bus_begin(servo_bus *b, servo_bus_state state, const servo_bus_step *const *script)
{
    b->state = state;
    b->script = script;
    b->step = 0;
    b->servo = 0;
    b->since_us = b->now_us;
    b->question.state = QUESTION_NONE;
}

void servo_bus_next(servo_bus *b)
{
    b->step++;
    b->since_us = b->now_us;
}

void servo_bus_fail(servo_bus *b, servo_trouble trouble)
{
    servo_bus_begin(b, SERVO_BUS_FAILED, NULL);
    b->trouble = trouble;
    b->torque_offs = TORQUE_OFFS;
}

static void say_torque_off(servo_bus *b)
{
    if (servo_bus_tell(b,
                       dxl_write(b->packet, sizeof b->packet, DXL_BROADCAST, DXL_X_TORQUE, 1, 0))) {
        b->torque_offs--;
    }
}

void servo_bus_off(servo_bus *b)
{
    servo_bus_begin(b, SERVO_BUS_OFF, NULL);
    if (b->baud == 0 && !servo_bus_start(b, b->config->bus_baud)) {
        return; /* a rate that there is not: nothing has been sent, either */
    }
    servo_bus_forget(b);
    b->torque_offs = TORQUE_OFFS;
    say_torque_off(b);
}

void servo_bus_prepare(servo_bus *b, uint32_t now_us)
{
    b->now_us = now_us;
    b->trouble = (servo_trouble){.servo = -1};
    servo_bus_begin(b, SERVO_BUS_PREPARING, SERVO_BUS_PREPARE);
    if (!servo_bus_start(b, b->config->bus_baud)) {
        servo_bus_fail(b, (servo_trouble){.kind = SERVO_TROUBLE_BAUD, .servo = -1});
    }
}

void servo_bus_ask(servo_bus *b, const servo_request *request, uint32_t powered_us, uint32_t now_us)
{
    b->now_us = now_us;
    b->trouble = (servo_trouble){.servo = -1};
    b->request = *request;
    b->request.baud = request->baud != 0 ? request->baud : b->config->bus_baud;
    servo_bus_begin(b, SERVO_BUS_REQUEST, servo_bus_request_script(request));
    b->info = (servo_info){.id = request->id, .baud = b->request.baud};
    b->since_us = powered_us; /* all begin with waiting for the servos to boot */
    if (dxl_x_baud_code(b->request.baud) < 0 || !servo_bus_start(b, b->request.baud)) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_BAUD, -1, request->id, b->request.baud});
    }
}

void servo_bus_positions(const servo_bus *b, float *positions_rad)
{
    for (int i = 0; i < b->config->servos_n; i++) {
        positions_rad[i] = servo_bus_rad(b->placed_units[i]);
    }
}

/* A goal beyond the bounds, or NaN, which leaves it where it was. */
static int32_t odd_goal(float goal_rad, int32_t before_units)
{
    const float max = SERVO_BUS_GOAL_MAX_RAD * DXL_X_UNITS_PER_RAD;
    return goal_rad > 0.0f   ? DXL_X_CENTER_UNITS + servo_nearest(max)
           : goal_rad < 0.0f ? DXL_X_CENTER_UNITS - servo_nearest(max)
                             : before_units;
}

void servo_bus_goals(servo_bus *b, const float *goals_rad)
{
    const float max = SERVO_BUS_GOAL_MAX_RAD;
    for (int i = 0; i < b->config->servos_n; i++) {
        const float goal = goals_rad[i];
        const bool ordinary = __builtin_fabsf(goal) <= max; /* an instruction, no libm */
        b->goal_units[i] =
            (int16_t)(ordinary ? DXL_X_CENTER_UNITS + servo_nearest(goal * DXL_X_UNITS_PER_RAD)
                               : odd_goal(goal, b->goal_units[i]));
    }
    b->goals_new = true;
}

void servo_bus_torque(servo_bus *b, const float *goals_rad)
{
    memcpy(b->goal_units, b->placed_units, sizeof b->goal_units);
    servo_bus_goals(b, goals_rad);
    b->rewrites = 0;
    b->misses = 0;
    servo_bus_begin(b, SERVO_BUS_STARTING, SERVO_BUS_TORQUE);
    for (int i = 0; i < b->config->servos_n; i++) {
        if (b->placed_units[i] == INT16_MAX || b->placed_units[i] == INT16_MIN) {
            servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_FAR, (int16_t)i, b->config->id[i], 0});
            return; /* where it really is has not been kept */
        }
    }
}

bool servo_bus_healthy(const servo_bus *b)
{
    return b->trouble.kind == SERVO_TROUBLE_NONE;
}

/* What has become of the open question goes to the step that asked it. */
static void answer(servo_bus *b)
{
    const servo_bus_step *step = b->script[b->step];
    const uint8_t outcome = b->question.state;
    if (outcome == QUESTION_ANSWERED) {
        b->question.state = QUESTION_NONE;
        (step->took != NULL ? step->took : servo_bus_next)(b);
    } else if (step->lost != NULL) {
        step->lost(b);
        b->question.state = QUESTION_NONE;
    } else {
        servo_bus_fail(b, servo_bus_loss(b));
    }
}

/* The packet under way does not end: the board's fault, but the servos cannot be reached. */
static void stuck(servo_bus *b)
{
    const servo_trouble trouble = {.kind = SERVO_TROUBLE_SILENT, .servo = -1};
    if (b->state != SERVO_BUS_ON) {
        servo_bus_fail(b, trouble);
    } else if (b->trouble.kind == SERVO_TROUBLE_NONE) {
        b->trouble = trouble;
    }
}

void servo_bus_tick(servo_bus *b, uint32_t now_us)
{
    b->now_us = now_us;
    if (b->baud == 0) {
        return; /* nothing has ever been asked of it */
    }
    servo_bus_listen(b);
    if (b->script != NULL && b->question.state > QUESTION_OPEN) {
        answer(b);
    }
    if (b->hal->bus_sending(b->hal->context)) {
        if (b->script != NULL && now_us - b->told_us > SERVO_BUS_STUCK_US) {
            stuck(b);
        }
        return;
    }
    if (b->torque_offs > 0) {
        say_torque_off(b);
    } else if (b->script != NULL && b->question.state == QUESTION_NONE) {
        b->script[b->step]->ask(b);
    }
}
