/* dynamixel_x.h - the Dynamixel X series: what of its control table is used, and its units.
 *
 * Source: ROBOTIS e-Manual, pages XL430-W250 and XM430-W210, sections Control Table of EEPROM Area, Control Table of
 * RAM Area and those of Control Table Description that are named after each item. The tables of all models that
 * dxl_x_accepts lets in agree in these.
 */
#ifndef LIMBER_DYNAMIXEL_X_H
#define LIMBER_DYNAMIXEL_X_H

#include <stdbool.h>
#include <stdint.h>

/* Address, with the size in bytes behind it where it is not 1. EEPROM (below 64) can be written while Torque Enable
 * is 0 only. */
enum {
    DXL_X_MODEL = 0, /* 2 */
    DXL_X_FIRMWARE = 6,
    DXL_X_ID = 7,
    DXL_X_BAUD = 8,         /* a code, dxl_x_baud_code */
    DXL_X_RETURN_DELAY = 9, /* 2 us */
    DXL_X_DRIVE_MODE = 10,
    DXL_X_OPERATING_MODE = 11,
    DXL_X_TORQUE = 64,
    DXL_X_HARDWARE_ERROR = 70,
    DXL_X_BUS_WATCHDOG =
        98, /* 20 ms; 0 none; reads 255 once it has stopped the servo: goals are refused until 0 */
    DXL_X_PROFILE_ACCELERATION = 108, /* 4 */
    DXL_X_PROFILE_VELOCITY = 112,     /* 4 */
    DXL_X_GOAL_POSITION = 116,        /* 4 */
    DXL_X_PRESENT_POSITION = 132,     /* 4, signed */
    DXL_X_INPUT_VOLTAGE = 144,        /* 2, 0.1 V */
    DXL_X_TEMPERATURE = 146,          /* degree Celsius */
};

enum { DXL_X_BUS_WATCHDOG_UNIT_US = 20000 };

/* Operating Modes that follow Goal Position. */
enum { DXL_X_MODE_POSITION = 3, DXL_X_MODE_EXTENDED = 4, DXL_X_MODE_CURRENT_BASED = 5 };

static inline bool dxl_x_follows(uint8_t mode)
{
    return mode >= DXL_X_MODE_POSITION && mode <= DXL_X_MODE_CURRENT_BASED;
}

/* Positions: 4096 units a turn, counter-clockwise, 2048 in the middle. */
enum { DXL_X_CENTER_UNITS = 2048, DXL_X_TURN_UNITS = 4096 };
#define DXL_X_UNITS_PER_RAD 651.898647f /* 4096 / (2 pi) */
#define DXL_X_RAD_PER_UNIT 1.53398079e-3f

enum { DXL_X_BAUD_CODES_N = 8 };

/* The rate of a Baud Rate code, 0 ... DXL_X_BAUD_CODES_N - 1; 0 for others. */
uint32_t dxl_x_baud(int code);
/* The other way; -1: no such rate. */
int dxl_x_baud_code(uint32_t baud);

/* Whether this model has the table above: the X series, whose numbers lie in 1000 ... 1999 (XH430-W350 is 1000,
 * XC335-T332 1700), and MX-28, MX-64 and MX-106 with protocol 2.0 (30, 311, 321). Not XL-320 (350), whose table is
 * another, nor the P and PRO series (from 2000). */
bool dxl_x_accepts(uint16_t model);

#endif
