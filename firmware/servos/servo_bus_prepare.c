/* servo_bus_prepare.c - finding all servos, and where they are; see servo_bus.h. */
#include "servo_bus_private.h"

static uint8_t id_now(const servo_bus *b)
{
    return b->config->id[b->servo];
}

static void fail_here(servo_bus *b, servo_trouble_kind kind, uint32_t detail)
{
    servo_bus_fail(b, (servo_trouble){(uint8_t)kind, b->servo, id_now(b), detail});
}

static void ask_boot(servo_bus *b)
{
    if (b->now_us - b->since_us >= SERVO_BUS_BOOT_US) {
        servo_bus_next(b);
    }
}

static void ask_torque_off(servo_bus *b)
{
    servo_bus_tell_all(b, DXL_X_TORQUE, 0);
    servo_bus_next(b);
}

static void ask_watchdog_off(servo_bus *b)
{
    servo_bus_tell_all(b, DXL_X_BUS_WATCHDOG, 0);
    servo_bus_next(b);
}

enum { STEP_PING = 3, STEP_HARDWARE, STEP_SETUP, STEP_DELAY, STEP_POSITIONS };

static void ask_ping(servo_bus *b)
{
    servo_bus_ask_ping(b, id_now(b), SERVO_BUS_TRIES);
}

static void took_ping(servo_bus *b)
{
    const uint16_t model = dxl_u16(b->question.answer);
    if (!dxl_x_accepts(model)) {
        fail_here(b, SERVO_TROUBLE_MODEL, model);
        return;
    }
    b->step = (b->question.error & DXL_ALERT) != 0 ? STEP_HARDWARE : STEP_SETUP;
}

static void ask_hardware(servo_bus *b)
{
    servo_bus_ask_read(b, id_now(b), DXL_X_HARDWARE_ERROR, 1, SERVO_BUS_TRIES);
}

static void took_hardware(servo_bus *b)
{
    fail_here(b, SERVO_TROUBLE_HARDWARE, b->question.answer[0]);
}

/* From its id on, more than is looked at: so no other answer has this length, and a late one is not taken for it. */
static void ask_setup(servo_bus *b)
{
    const int n = DXL_X_OPERATING_MODE + 1 - DXL_X_ID;
    servo_bus_ask_read(b, id_now(b), DXL_X_ID, n, SERVO_BUS_TRIES);
}

static void next_servo(servo_bus *b)
{
    b->servo++;
    b->step = STEP_PING;
    if (b->servo == b->config->servos_n) {
        b->servo = 0;
        b->step = STEP_POSITIONS;
    }
}

static void took_setup(servo_bus *b)
{
    const uint8_t *answer = b->question.answer;
    const uint8_t delay = answer[DXL_X_RETURN_DELAY - DXL_X_ID];
    const uint8_t mode = answer[DXL_X_OPERATING_MODE - DXL_X_ID];
    if (!dxl_x_follows(mode)) {
        fail_here(b, SERVO_TROUBLE_MODE, mode);
    } else if (delay != 0) {
        b->step = STEP_DELAY;
    } else {
        next_servo(b);
    }
}

static void ask_delay(servo_bus *b)
{
    servo_bus_ask_write(b, id_now(b), DXL_X_RETURN_DELAY, 1, 0);
}

static void placed(servo_bus *b, int place, uint32_t value)
{
    /* far beyond what any joint can do, and so for whoever looks at it */
    const int32_t units = (int32_t)value;
    b->placed_units[place] = (int16_t)(units > INT16_MAX   ? INT16_MAX
                                       : units < INT16_MIN ? INT16_MIN
                                                           : units);
}

static void ask_positions(servo_bus *b)
{
    servo_bus_ask_many(b, b->servo, DXL_X_PRESENT_POSITION, 4, placed);
}

/* On to those not asked yet; after the last, PREPARED, and over again. */
static void took_positions(servo_bus *b)
{
    b->servo = (int16_t)(b->servo + b->question.servos_n);
    if (b->servo >= b->config->servos_n) {
        b->servo = 0;
        b->state = SERVO_BUS_PREPARED;
    }
}

const servo_bus_step SERVO_BUS_BOOT = {ask_boot, NULL, NULL};
static const servo_bus_step TORQUE_OFF = {ask_torque_off, NULL, NULL};
static const servo_bus_step WATCHDOG_OFF = {ask_watchdog_off, NULL, NULL};
static const servo_bus_step PING = {ask_ping, took_ping, NULL};
static const servo_bus_step HARDWARE = {ask_hardware, took_hardware, NULL};
static const servo_bus_step SETUP = {ask_setup, took_setup, NULL};
static const servo_bus_step DELAY = {ask_delay, next_servo, NULL};
static const servo_bus_step POSITIONS = {ask_positions, took_positions, NULL};

const servo_bus_step *const SERVO_BUS_PREPARE[] = {
    &SERVO_BUS_BOOT,
    &TORQUE_OFF,
    &WATCHDOG_OFF,
    [STEP_PING] = &PING,
    [STEP_HARDWARE] = &HARDWARE,
    [STEP_SETUP] = &SETUP,
    [STEP_DELAY] = &DELAY,
    [STEP_POSITIONS] = &POSITIONS,
};
