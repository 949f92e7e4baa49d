/* servo_bus_torque.c - torque without a jump, and goals from then on; see servo_bus.h. */
#include "servo_bus_private.h"

enum { REWRITES_MAX = 2 };

/* What every servo must hold, in this order, before it may move. */
typedef struct {
    uint16_t address;
    uint8_t n;
    uint8_t value; /* but for goals, which each has its own */
} setting;

enum { SETTINGS_N = 3 };
static const setting SETTINGS[SETTINGS_N] = {
    {DXL_X_GOAL_POSITION, 4, 0},
    {DXL_X_TORQUE, 1, 1},
    {DXL_X_BUS_WATCHDOG, 1, SERVO_BUS_WATCHDOG_US / DXL_X_BUS_WATCHDOG_UNIT_US},
};

enum { STEP_WRITE = 1, STEPS_PER_SETTING = 2 };

static const setting *setting_now(const servo_bus *b)
{
    return &SETTINGS[(b->step - STEP_WRITE) / STEPS_PER_SETTING];
}

static uint32_t wanted(const servo_bus *b, int place)
{
    const setting *s = setting_now(b);
    return s->address == DXL_X_GOAL_POSITION ? (uint32_t)(int32_t)b->placed_units[place] : s->value;
}

/* Until whoever was asked last, for its position, has answered or will not any more. */
static void ask_hush(servo_bus *b)
{
    if (b->now_us - b->since_us >= b->question.patience_us) {
        servo_bus_next(b);
    }
}

static void ask_write(servo_bus *b)
{
    const setting *s = setting_now(b);
    uint8_t *part = b->packet + DXL_SYNC_PARAMS_AT;
    dxl_sync_open(b->packet, s->address, s->n);
    for (int i = 0; i < b->config->servos_n; i++) {
        part[0] = b->config->id[i];
        dxl_put_u32(part + 1, wanted(b, i));
        part += 1 + s->n; /* the next overwrites what is too much of this */
    }
    const size_t params_n = (size_t)(part - b->packet) - DXL_PARAMS_AT;
    servo_bus_tell(b,
                   dxl_seal(b->packet, sizeof b->packet, DXL_BROADCAST, DXL_SYNC_WRITE, params_n));
    b->servo = 0;
    b->unlike.kind = SERVO_TROUBLE_NONE;
    servo_bus_next(b);
}

static void compare(servo_bus *b, int place, uint32_t value)
{
    if (value != wanted(b, place) && b->unlike.kind == SERVO_TROUBLE_NONE) {
        b->unlike =
            (servo_trouble){SERVO_TROUBLE_READ_BACK, (int16_t)place, b->config->id[place], value};
    }
}

static void ask_check(servo_bus *b)
{
    const setting *s = setting_now(b);
    servo_bus_ask_many(b, b->servo, s->address, s->n, compare);
}

static void took_check(servo_bus *b)
{
    b->servo = (int16_t)(b->servo + b->question.servos_n);
    if (b->servo < b->config->servos_n) {
        return;
    }
    b->servo = 0;
    if (b->unlike.kind == SERVO_TROUBLE_NONE) {
        b->rewrites = 0;
        servo_bus_next(b);
    } else if (b->rewrites < REWRITES_MAX) {
        b->rewrites++;
        b->step--;
    } else {
        servo_bus_fail(b, b->unlike);
    }
}

static void ask_go(servo_bus *b)
{
    b->asked_us = b->now_us;
    servo_bus_begin(b, SERVO_BUS_ON, SERVO_BUS_ON_STEPS);
    b->script[0]->ask(b);
}

static const servo_bus_step HUSH = {ask_hush, NULL, NULL};
static const servo_bus_step WRITE = {ask_write, NULL, NULL};
static const servo_bus_step CHECK = {ask_check, took_check, NULL};
static const servo_bus_step GO = {ask_go, NULL, NULL};
const servo_bus_step *const SERVO_BUS_TORQUE[] = {&HUSH,  &WRITE, &CHECK, &WRITE,
                                                  &CHECK, &WRITE, &CHECK, &GO};

/* --- On --- */

_Static_assert(DXL_SYNC_PARAMS_AT + 5 * SERVO_BUS_SERVOS_MAX + 2 <= HAL_BUS_PACKET_MAX_BYTES,
               "goals for all in one packet");

static void send_goals(servo_bus *b)
{
    const uint8_t *ids = b->config->id;
    const int servos_n = b->config->servos_n;
    uint8_t *part = b->packet + DXL_SYNC_PARAMS_AT;
    dxl_sync_open(b->packet, DXL_X_GOAL_POSITION, 4);
    for (int i = 0; i < servos_n; i++, part += 5) {
        part[0] = ids[i];
        dxl_put_u32(part + 1, (uint32_t)(int32_t)b->goal_units[i]);
    }
    const size_t params_n = (size_t)(part - b->packet) - DXL_PARAMS_AT;
    servo_bus_tell(b,
                   dxl_seal(b->packet, sizeof b->packet, DXL_BROADCAST, DXL_SYNC_WRITE, params_n));
    b->goals_new = false;
}

static void ask_on(servo_bus *b)
{
    if (b->goals_new && b->now_us - b->asked_us < SERVO_BUS_ASK_US) {
        send_goals(b);
        return;
    }
    b->asked_us = b->now_us;
    servo_bus_ask_read(b, b->config->id[b->servo], DXL_X_HARDWARE_ERROR, 1, 1);
}

static void next_servo(servo_bus *b)
{
    b->misses = 0;
    b->servo = (int16_t)(b->servo + 1 < b->config->servos_n ? b->servo + 1 : 0);
}

/* The first trouble is the one to be told; what comes after may follow from it. */
static void trouble_on(servo_bus *b, servo_trouble trouble)
{
    if (b->trouble.kind == SERVO_TROUBLE_NONE) {
        b->trouble = trouble;
    }
    next_servo(b);
}

static void took_on(servo_bus *b)
{
    const uint8_t errors = b->question.answer[0];
    if (errors != 0 || (b->question.error & DXL_ALERT) != 0) {
        trouble_on(
            b, (servo_trouble){SERVO_TROUBLE_HARDWARE, b->servo, b->config->id[b->servo], errors});
        return;
    }
    next_servo(b);
}

static void lost_on(servo_bus *b)
{
    b->misses++;
    if (b->question.state == QUESTION_REFUSED || b->misses >= SERVO_BUS_MISSES_MAX) {
        trouble_on(b, servo_bus_loss(b));
    }
}

static const servo_bus_step ON = {ask_on, took_on, lost_on};
const servo_bus_step *const SERVO_BUS_ON_STEPS[] = {&ON};
