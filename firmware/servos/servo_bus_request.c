/* servo_bus_request.c - what a user asks of one servo; see servo_bus.h. */
#include "servo_bus_private.h"

#include "servo_round.h"

enum {
    MOVE_US = 800000, /* there, and as long back */
    MOVE_EVERY_US = 20000,
    ARRIVE_US = 500000,
    ARRIVED_UNITS = 30, /* 2.6 degrees */
};

/* Who it is about: an id that has been changed is the new one. */
static uint8_t id_now(const servo_bus *b)
{
    return b->info.id;
}

static void write_byte(servo_bus *b, uint16_t address, uint8_t value)
{
    servo_bus_ask_write(b, id_now(b), address, 1, value);
}

static void ask_ping(servo_bus *b)
{
    servo_bus_ask_ping(b, id_now(b), SERVO_BUS_TRIES);
}

static void took_ping(servo_bus *b)
{
    b->info.model = dxl_u16(b->question.answer);
    b->info.firmware = b->question.answer[2];
    if (!dxl_x_accepts(b->info.model)) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_MODEL, -1, id_now(b), b->info.model});
        return;
    }
    servo_bus_next(b);
}

static void ask_hardware(servo_bus *b)
{
    servo_bus_ask_read(b, id_now(b), DXL_X_HARDWARE_ERROR, 1, SERVO_BUS_TRIES);
}

static void took_hardware(servo_bus *b)
{
    b->info.hardware_error = b->question.answer[0];
    servo_bus_next(b);
}

/* Torque stays off while there is one: the servo would not hold it anyway. */
static void took_sound(servo_bus *b)
{
    const uint8_t errors = b->question.answer[0];
    if (errors != 0) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_HARDWARE, -1, id_now(b), errors});
        return;
    }
    servo_bus_next(b);
}

static void ask_readings(servo_bus *b)
{
    const int n = DXL_X_TEMPERATURE + 1 - DXL_X_PRESENT_POSITION;
    servo_bus_ask_read(b, id_now(b), DXL_X_PRESENT_POSITION, n, SERVO_BUS_TRIES);
}

static void took_readings(servo_bus *b)
{
    const uint8_t *answer = b->question.answer;
    b->base_units = (int32_t)dxl_u32(answer);
    b->info.position_rad = servo_bus_rad(b->base_units);
    b->info.supply_v = 0.1f * (float)dxl_u16(answer + DXL_X_INPUT_VOLTAGE - DXL_X_PRESENT_POSITION);
    b->info.temperature_c = answer[DXL_X_TEMPERATURE - DXL_X_PRESENT_POSITION];
    servo_bus_next(b);
}

static void ask_done(servo_bus *b)
{
    servo_bus_begin(b, SERVO_BUS_DONE, NULL);
}

static void ask_torque_off(servo_bus *b)
{
    write_byte(b, DXL_X_TORQUE, 0);
}

/* --- Another id --- */

static void ask_new_id(servo_bus *b)
{
    servo_bus_ask_ping(b, b->request.new_id, SERVO_BUS_TRIES);
}

static void fail_taken(servo_bus *b)
{
    servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_TAKEN, -1, b->request.new_id, 0});
}

static void lost_new_id(servo_bus *b)
{
    if (b->question.state != QUESTION_SILENT) {
        fail_taken(b);
        return;
    }
    servo_bus_next(b);
}

/* Whose id its answer to this would carry is not written anywhere: it is asked again after a while, by the new one. */
static void ask_set_id(servo_bus *b)
{
    servo_bus_tell(
        b, dxl_write(b->packet, sizeof b->packet, id_now(b), DXL_X_ID, 1, b->request.new_id));
    servo_bus_next(b);
}

static void ask_settle_id(servo_bus *b)
{
    if (b->now_us - b->since_us >= SERVO_BUS_SETTLE_US) {
        b->info.id = b->request.new_id;
        servo_bus_next(b);
    }
}

/* --- Another rate --- */

static void fail_baud(servo_bus *b)
{
    servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_BAUD, -1, id_now(b), b->request.new_baud});
}

/* Before the servo is told: can the board follow it there? */
static void ask_new_baud(servo_bus *b)
{
    if (dxl_x_baud_code(b->request.new_baud) < 0 || !servo_bus_start(b, b->request.new_baud)) {
        fail_baud(b);
        return;
    }
    servo_bus_start(b, b->request.baud);
    servo_bus_next(b);
}

static void ask_set_baud(servo_bus *b)
{
    const uint8_t code = (uint8_t)dxl_x_baud_code(b->request.new_baud);
    servo_bus_tell(b, dxl_write(b->packet, sizeof b->packet, id_now(b), DXL_X_BAUD, 1, code));
    servo_bus_next(b);
}

static void ask_settle_baud(servo_bus *b)
{
    if (b->now_us - b->since_us >= SERVO_BUS_SETTLE_US) {
        servo_bus_start(b, b->request.new_baud);
        b->info.baud = b->request.new_baud;
        servo_bus_next(b);
    }
}

/* --- A test --- */

static void write_goal(servo_bus *b, int32_t units)
{
    servo_bus_ask_write(b, id_now(b), DXL_X_GOAL_POSITION, 4, (uint32_t)units);
}

static void ask_watchdog_off(servo_bus *b)
{
    write_byte(b, DXL_X_BUS_WATCHDOG, 0);
}

static void ask_goal_here(servo_bus *b)
{
    write_goal(b, b->base_units);
}

static void ask_goal_held(servo_bus *b)
{
    servo_bus_ask_read(b, id_now(b), DXL_X_GOAL_POSITION, 4, SERVO_BUS_TRIES);
}

static void took_goal_held(servo_bus *b)
{
    const uint32_t held = dxl_u32(b->question.answer);
    if (held != (uint32_t)b->base_units) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_READ_BACK, -1, id_now(b), held});
        return;
    }
    servo_bus_next(b);
}

static void ask_torque_on(servo_bus *b)
{
    write_byte(b, DXL_X_TORQUE, 1);
}

static void ask_watchdog_on(servo_bus *b)
{
    write_byte(b, DXL_X_BUS_WATCHDOG, SERVO_BUS_WATCHDOG_US / DXL_X_BUS_WATCHDOG_UNIT_US);
}

static void ask_mode(servo_bus *b)
{
    servo_bus_ask_read(b, id_now(b), DXL_X_OPERATING_MODE, 1, SERVO_BUS_TRIES);
}

static void took_mode(servo_bus *b)
{
    const uint8_t mode = b->question.answer[0];
    if (!dxl_x_follows(mode)) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_MODE, -1, id_now(b), mode});
        return;
    }
    servo_bus_next(b);
}

/* A share of the turn, from where it was. */
static int32_t turned_units(const servo_bus *b, float share)
{
    return b->base_units + servo_nearest(b->request.turn_rad * DXL_X_UNITS_PER_RAD * share);
}

/* The share of its time that a move has lasted. */
static float lasted(const servo_bus *b)
{
    const uint32_t after_us = b->now_us - b->since_us;
    return after_us < MOVE_US ? (float)after_us * (1.0f / (float)MOVE_US) : 1.0f;
}

static void move_to(servo_bus *b, float share)
{
    if (b->now_us - b->moved_us >= MOVE_EVERY_US) {
        b->moved_us = b->now_us;
        write_goal(b, turned_units(b, share));
    }
}

static void ask_move_there(servo_bus *b)
{
    move_to(b, lasted(b));
}

static void ask_move_back(servo_bus *b)
{
    move_to(b, 1.0f - lasted(b));
}

static void took_move(servo_bus *b)
{
    if (b->now_us - b->since_us >= MOVE_US) {
        servo_bus_next(b);
    }
}

static void ask_position(servo_bus *b)
{
    servo_bus_ask_read(b, id_now(b), DXL_X_PRESENT_POSITION, 4, SERVO_BUS_TRIES);
}

/* A servo may lag, and takes goals that it then does not follow: only where it stands tells. */
static void wait_for(servo_bus *b, int32_t goal_units)
{
    const int32_t off_units = (int32_t)dxl_u32(b->question.answer) - goal_units;
    if (off_units <= ARRIVED_UNITS && off_units >= -ARRIVED_UNITS) {
        servo_bus_next(b);
    } else if (b->now_us - b->since_us >= ARRIVE_US) {
        servo_bus_fail(b, (servo_trouble){SERVO_TROUBLE_STUCK, -1, id_now(b), 0});
    }
}

static void took_there(servo_bus *b)
{
    wait_for(b, turned_units(b, 1.0f));
}

static void took_back(servo_bus *b)
{
    wait_for(b, b->base_units);
}

static const servo_bus_step PING = {ask_ping, took_ping, NULL};
static const servo_bus_step HARDWARE = {ask_hardware, took_hardware, NULL};
static const servo_bus_step SOUND = {ask_hardware, took_sound, NULL};
static const servo_bus_step READINGS = {ask_readings, took_readings, NULL};
static const servo_bus_step DONE = {ask_done, NULL, NULL};
static const servo_bus_step TORQUE_OFF = {ask_torque_off, NULL, NULL};
static const servo_bus_step NEW_ID_FREE = {ask_new_id, fail_taken, lost_new_id};
static const servo_bus_step SET_ID = {ask_set_id, NULL, NULL};
static const servo_bus_step SETTLE_ID = {ask_settle_id, NULL, NULL};
static const servo_bus_step NEW_BAUD = {ask_new_baud, NULL, NULL};
static const servo_bus_step SET_BAUD = {ask_set_baud, NULL, NULL};
static const servo_bus_step SETTLE_BAUD = {ask_settle_baud, NULL, NULL};
static const servo_bus_step WATCHDOG_OFF = {ask_watchdog_off, NULL, NULL};
static const servo_bus_step GOAL_HERE = {ask_goal_here, NULL, NULL};
static const servo_bus_step GOAL_HELD = {ask_goal_held, took_goal_held, NULL};
static const servo_bus_step TORQUE_ON = {ask_torque_on, NULL, NULL};
static const servo_bus_step WATCHDOG_ON = {ask_watchdog_on, NULL, NULL};
static const servo_bus_step MODE = {ask_mode, took_mode, NULL};
static const servo_bus_step MOVE_THERE = {ask_move_there, took_move, NULL};
static const servo_bus_step THERE = {ask_position, took_there, NULL};
static const servo_bus_step MOVE_BACK = {ask_move_back, took_move, NULL};
static const servo_bus_step BACK = {ask_position, took_back, NULL};

static const servo_bus_step *const PING_SCRIPT[] = {&SERVO_BUS_BOOT, &PING, &HARDWARE, &READINGS,
                                                    &DONE};
static const servo_bus_step *const ID_SCRIPT[] = {&SERVO_BUS_BOOT, &NEW_ID_FREE, &PING, &TORQUE_OFF,
                                                  &SET_ID,         &SETTLE_ID,   &PING, &HARDWARE,
                                                  &READINGS,       &DONE};
static const servo_bus_step *const BAUD_SCRIPT[] = {
    &SERVO_BUS_BOOT, &NEW_BAUD, &PING,     &TORQUE_OFF, &SET_BAUD,
    &SETTLE_BAUD,    &PING,     &HARDWARE, &READINGS,   &DONE};
static const servo_bus_step *const TEST_SCRIPT[] = {
    &SERVO_BUS_BOOT, &PING,      &SOUND,     &MODE,        &TORQUE_OFF, &WATCHDOG_OFF, &READINGS,
    &GOAL_HERE,      &GOAL_HELD, &TORQUE_ON, &WATCHDOG_ON, &MOVE_THERE, &SOUND,        &THERE,
    &MOVE_BACK,      &SOUND,     &BACK,      &TORQUE_OFF,  &READINGS,   &DONE};

const servo_bus_step *const *servo_bus_request_script(const servo_request *request)
{
    switch (request->kind) {
    case SERVO_REQUEST_ID:
        return request->new_id == request->id ? PING_SCRIPT : ID_SCRIPT;
    case SERVO_REQUEST_BAUD:
        return BAUD_SCRIPT;
    case SERVO_REQUEST_TEST:
        return TEST_SCRIPT;
    default:
        return PING_SCRIPT;
    }
}
