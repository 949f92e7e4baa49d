/* bus_servo.c - see bus_servo.h. */
#include "bus_servo.h"

#include <math.h>
#include <string.h>

enum {
    RAM_AT = 64,
    WATCHDOG_TRIPPED = 0xFF,
    PWM_LIMIT = 36,
    VELOCITY_LIMIT = 44,
    GOAL_PWM = 100,
    GOAL_VELOCITY = 104,
    MODE_VELOCITY = 1,
    MODE_PWM = 16,
    MULTI_TURN_UNITS = 1048575,
};
#define WATCHDOG_UNIT_S 0.02

typedef struct {
    uint8_t address, size;
    bool writable;
    int32_t min, max, initial; /* min below 0: signed */
} item;

/* e-Manual, XL430-W250, 2.2 and 2.3. */
static const item ITEMS[] = {
    /* EEPROM */
    {DXL_X_MODEL, 2, false, 0, 0, BUS_SERVO_MODEL},
    {2, 4, false, 0, 0, 0}, /* Model Information */
    {DXL_X_FIRMWARE, 1, false, 0, 0, BUS_SERVO_FIRMWARE},
    {DXL_X_ID, 1, true, 0, 252, 1},
    {DXL_X_BAUD, 1, true, 0, 7, 1},
    {DXL_X_RETURN_DELAY, 1, true, 0, 254, 250},
    {DXL_X_DRIVE_MODE, 1, true, 0, 13, 0},
    {DXL_X_OPERATING_MODE, 1, true, 0, 16, DXL_X_MODE_POSITION},
    {12, 1, true, 0, 255, 255},              /* Secondary ID */
    {13, 1, true, 1, 2, 2},                  /* Protocol Type */
    {20, 4, true, -1044479, 1044479, 0},     /* Homing Offset */
    {24, 4, true, 0, 1023, 10},              /* Moving Threshold */
    {31, 1, true, 0, 100, 72},               /* Temperature Limit */
    {32, 2, true, 60, 140, 140},             /* Max Voltage Limit */
    {34, 2, true, 60, 140, 60},              /* Min Voltage Limit */
    {PWM_LIMIT, 2, true, 0, 885, 885},       /* PWM Limit */
    {VELOCITY_LIMIT, 4, true, 0, 1023, 265}, /* Velocity Limit */
    {BUS_SERVO_MAX_POSITION, 4, true, 0, 4095, 4095},
    {BUS_SERVO_MIN_POSITION, 4, true, 0, 4095, 0},
    {60, 1, true, 0, 3, 0}, /* Startup Configuration */
    {BUS_SERVO_SHUTDOWN, 1, true, 0, 255, 52},
    /* RAM */
    {DXL_X_TORQUE, 1, true, 0, 1, 0},
    {65, 1, true, 0, 1, 0}, /* LED */
    {BUS_SERVO_STATUS_LEVEL, 1, true, 0, 2, 2},
    {69, 1, false, 0, 0, 0}, /* Registered Instruction */
    {DXL_X_HARDWARE_ERROR, 1, false, 0, 0, 0},
    {76, 2, true, 0, 16383, 1000}, /* Velocity I Gain */
    {78, 2, true, 0, 16383, 100},  /* Velocity P Gain */
    {80, 2, true, 0, 16383, 4000}, /* Position D Gain */
    {82, 2, true, 0, 16383, 0},    /* Position I Gain */
    {84, 2, true, 0, 16383, 640},  /* Position P Gain */
    {88, 2, true, 0, 16383, 0},    /* Feedforward 2nd Gain */
    {90, 2, true, 0, 16383, 0},    /* Feedforward 1st Gain */
    {DXL_X_BUS_WATCHDOG, 1, true, 0, 127, 0},
    {GOAL_PWM, 2, true, -885, 885, 885},
    {GOAL_VELOCITY, 4, true, -1023, 1023, 0},
    {DXL_X_PROFILE_ACCELERATION, 4, true, 0, 32767, 0},
    {DXL_X_PROFILE_VELOCITY, 4, true, 0, 32767, 0},
    {DXL_X_GOAL_POSITION, 4, true, -MULTI_TURN_UNITS, MULTI_TURN_UNITS, 0},
    {BUS_SERVO_REALTIME_TICK, 2, false, 0, 0, 0},
    {BUS_SERVO_MOVING, 1, false, 0, 0, 0},
    {123, 1, false, 0, 0, 0}, /* Moving Status */
    {124, 2, false, 0, 0, 0}, /* Present PWM */
    {126, 2, false, 0, 0, 0}, /* Present Load */
    {128, 4, false, 0, 0, 0}, /* Present Velocity */
    {DXL_X_PRESENT_POSITION, 4, false, 0, 0, 0},
    {136, 4, false, 0, 0, 0}, /* Velocity Trajectory */
    {140, 4, false, 0, 0, 0}, /* Position Trajectory */
    {DXL_X_INPUT_VOLTAGE, 2, false, 0, 0, 120},
    {DXL_X_TEMPERATURE, 1, false, 0, 0, 31},
    {147, 1, false, 0, 0, 0}, /* Backup Ready */
};
enum { ITEMS_N = sizeof ITEMS / sizeof ITEMS[0] };

static const item *find(uint32_t address)
{
    for (int i = 0; i < ITEMS_N; i++) {
        if (ITEMS[i].address == address) {
            return &ITEMS[i];
        }
    }
    return NULL;
}

/* --- values ---------------------------------------------------------------------------------------- */

static void put(bus_servo *s, int address, int size, int32_t value)
{
    for (int i = 0; i < size; i++) {
        s->table[address + i] = (uint8_t)((uint32_t)value >> 8 * i);
    }
}

static int32_t value_of(const item *of, const uint8_t *bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < of->size; i++) {
        value |= (uint32_t)bytes[i] << 8 * i;
    }
    return of->min < 0 && of->size == 2 ? (int16_t)value : (int32_t)value;
}

static int32_t get_u32(const bus_servo *s, int address)
{
    return (int32_t)dxl_u32(s->table + address);
}

static int32_t position_units(const bus_servo *s)
{
    const float rad = s->plant->positions_rad[s->place];
    return DXL_X_CENTER_UNITS + (int32_t)lrintf(rad * DXL_X_UNITS_PER_RAD);
}

static bool follows_positions(const bus_servo *s)
{
    const uint8_t mode = s->table[DXL_X_OPERATING_MODE];
    return mode == DXL_X_MODE_POSITION || mode == DXL_X_MODE_EXTENDED;
}

/* --- torque and goals ------------------------------------------------------------------------------ */

static void pass_on_goal(bus_servo *s)
{
    const int32_t units = get_u32(s, DXL_X_GOAL_POSITION) - DXL_X_CENTER_UNITS;
    servo_plant_goal(s->plant, s->place, (float)units * DXL_X_RAD_PER_UNIT);
}

static void set_torque(bus_servo *s, bool on)
{
    s->torque_n += on && s->table[DXL_X_TORQUE] == 0;
    s->table[DXL_X_TORQUE] = on;
    servo_plant_torque(s->plant, s->place, on && follows_positions(s));
    if (on) {
        pass_on_goal(s);
    }
}

/* 2.4, Bus Watchdog: it stops where it is. */
static void trip_watchdog(bus_servo *s)
{
    s->table[DXL_X_BUS_WATCHDOG] = WATCHDOG_TRIPPED;
    put(s, DXL_X_GOAL_POSITION, 4, position_units(s));
    servo_plant_goal(s->plant, s->place, s->plant->positions_rad[s->place]);
}

/* --- power ----------------------------------------------------------------------------------------- */

static void forget(bus_servo *s, int from, int to)
{
    for (int i = 0; i < ITEMS_N; i++) {
        if (ITEMS[i].address >= from && ITEMS[i].address < to) {
            put(s, ITEMS[i].address, ITEMS[i].size, ITEMS[i].initial);
        }
    }
}

void bus_servo_reboot(bus_servo *s, double now_s)
{
    set_torque(s, false);
    forget(s, RAM_AT, BUS_SERVO_TABLE_BYTES);
    s->ready_s = now_s + BUS_SERVO_BOOT_S;
}

void bus_servo_init(bus_servo *s, servo_plant *plant, int place, uint8_t id, uint32_t baud)
{
    memset(s, 0, sizeof *s);
    s->plant = plant;
    s->place = place;
    forget(s, 0, BUS_SERVO_TABLE_BYTES);
    s->table[DXL_X_ID] = id;
    s->table[DXL_X_BAUD] = (uint8_t)dxl_x_baud_code(baud);
}

void bus_servo_pass(bus_servo *s, double now_s)
{
    const bool powered = s->plant->powered && !s->unplugged;
    if (powered != s->powered) {
        s->powered = powered;
        bus_servo_reboot(s, now_s);
    }
    if (!powered) {
        return;
    }
    s->table[DXL_X_HARDWARE_ERROR] |= s->failing;
    if ((s->table[DXL_X_HARDWARE_ERROR] & s->table[BUS_SERVO_SHUTDOWN]) != 0) {
        set_torque(s, false);
    }
    const uint8_t watchdog = s->table[DXL_X_BUS_WATCHDOG];
    if (s->table[DXL_X_TORQUE] != 0 && watchdog != 0 && watchdog != WATCHDOG_TRIPPED &&
        now_s - s->heard_s > watchdog * WATCHDOG_UNIT_S) {
        trip_watchdog(s);
    }
}

bool bus_servo_hears(const bus_servo *s, uint32_t baud, double now_s)
{
    return s->powered && now_s >= s->ready_s &&
           (baud == 0 || baud == dxl_x_baud(s->table[DXL_X_BAUD]));
}

void bus_servo_hear(bus_servo *s, double now_s)
{
    s->heard_s = now_s;
}

/* --- reading and writing --------------------------------------------------------------------------- */

static void refresh(bus_servo *s, double now_s)
{
    const int32_t position = position_units(s);
    const int32_t way =
        s->table[DXL_X_TORQUE] != 0 ? get_u32(s, DXL_X_GOAL_POSITION) - position : 0;
    put(s, BUS_SERVO_REALTIME_TICK, 2, (int32_t)fmod(now_s * 1e3, 32768.0));
    put(s, BUS_SERVO_MOVING, 1, way < -1 || way > 1);
    put(s, DXL_X_PRESENT_POSITION, 4, position);
}

uint8_t bus_servo_read(bus_servo *s, uint16_t address, uint8_t *bytes, size_t bytes_n, double now_s)
{
    if (find(address) == NULL || bytes_n == 0 || address + bytes_n > BUS_SERVO_TABLE_BYTES) {
        return DXL_E_ACCESS;
    }
    refresh(s, now_s);
    memcpy(bytes, s->table + address, bytes_n);
    return 0;
}

/* Limits that depend on other items: 2.4, at Goal PWM, Goal Velocity and Goal Position. */
static bool beyond_limit(const bus_servo *s, const item *to, int32_t value)
{
    const int32_t pwm = dxl_u16(s->table + PWM_LIMIT), velocity = get_u32(s, VELOCITY_LIMIT);
    switch (to->address) {
    case GOAL_PWM:
        return value < -pwm || value > pwm;
    case GOAL_VELOCITY:
        return value < -velocity || value > velocity;
    case DXL_X_GOAL_POSITION:
        return s->table[DXL_X_OPERATING_MODE] == DXL_X_MODE_POSITION &&
               (value < get_u32(s, BUS_SERVO_MIN_POSITION) ||
                value > get_u32(s, BUS_SERVO_MAX_POSITION));
    default:
        return false;
    }
}

static bool tripped_watchdog_refuses(const bus_servo *s, const item *to, int32_t value)
{
    return s->table[DXL_X_BUS_WATCHDOG] == WATCHDOG_TRIPPED &&
           (to->address == GOAL_PWM || to->address == GOAL_VELOCITY ||
            to->address == DXL_X_GOAL_POSITION ||
            (to->address == DXL_X_BUS_WATCHDOG && value != 0));
}

static bool is_mode(int32_t value)
{
    return value == MODE_VELOCITY || value == DXL_X_MODE_POSITION || value == DXL_X_MODE_EXTENDED ||
           value == MODE_PWM;
}

static uint8_t check(const bus_servo *s, const item *to, int32_t value)
{
    const bool shut_down = (s->table[DXL_X_HARDWARE_ERROR] & s->table[BUS_SERVO_SHUTDOWN]) != 0;
    if (value < to->min || value > to->max || tripped_watchdog_refuses(s, to, value) ||
        (to->address == DXL_X_OPERATING_MODE && !is_mode(value))) {
        return DXL_E_RANGE;
    }
    if (beyond_limit(s, to, value)) {
        return DXL_E_LIMIT;
    }
    return to->address == DXL_X_TORQUE && value != 0 && shut_down ? DXL_E_RESULT : 0;
}

uint8_t bus_servo_write(bus_servo *s, uint16_t address, const uint8_t *bytes, size_t bytes_n)
{
    for (size_t at = 0; at < bytes_n || at == 0;) {
        const item *to = find((uint32_t)(address + at));
        if (to == NULL || !to->writable || (to->address < RAM_AT && s->table[DXL_X_TORQUE] != 0)) {
            return DXL_E_ACCESS;
        }
        if (bytes_n - at < to->size) {
            return DXL_E_LENGTH;
        }
        const uint8_t error = check(s, to, value_of(to, bytes + at));
        if (error != 0) {
            return error;
        }
        at += to->size;
    }
    const uint8_t torque = s->table[DXL_X_TORQUE];
    memcpy(s->table + address, bytes, bytes_n);
    if (address <= DXL_X_TORQUE && address + bytes_n > DXL_X_TORQUE) {
        const bool on = s->table[DXL_X_TORQUE] != 0;
        s->table[DXL_X_TORQUE] = torque;
        set_torque(s, on);
    }
    if (address <= DXL_X_GOAL_POSITION && address + bytes_n > DXL_X_GOAL_POSITION) {
        pass_on_goal(s);
    }
    return 0;
}
