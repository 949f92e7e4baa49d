/* bus_servo.h - one model servo of the Dynamixel X series: its control table, and what reading and writing it does.
 * How it is asked, and what its answers look like on the wire, is bus_model.h.
 *
 * An XL430-W250 as the ROBOTIS e-Manual describes it: 2.2 Control Table of EEPROM Area, 2.3 of RAM Area, 2.4 Control
 * Table Description. Not modelled: indirect addresses, the shadow id, Reg Write, profiles, the control modes other than
 * position. Where the e-Manual is silent the model is the less convenient of what a servo might do:
 *
 *   - after a boot Goal Position is 0, one end of the travel, wherever the servo is: torque before a goal shows
 *   - torque after a shutdown is refused with Result Fail until a reboot
 *   - a tripped Bus Watchdog takes only 0
 *
 * Caller-owned; time in s of whatever clock the caller keeps.
 */
#ifndef LIMBER_BUS_SERVO_H
#define LIMBER_BUS_SERVO_H

#include <stddef.h>
#include <stdint.h>

#include "dynamixel.h"
#include "dynamixel_x.h"
#include "servo_plant.h"

enum {
    BUS_SERVO_MODEL = 1060,      /* XL430-W250 */
    BUS_SERVO_FIRMWARE = 46,     /* Bus Watchdog wants 38 or newer */
    BUS_SERVO_TABLE_BYTES = 148, /* as far as it is modelled */
    BUS_SERVO_FACTORY_BAUD = 57600,
    BUS_SERVO_OVERLOAD = 0x20, /* of Hardware Error Status */
};
#define BUS_SERVO_BOOT_S 0.3

/* Beside dynamixel_x.h's. Size in bytes behind it where it is not 1. */
enum {
    BUS_SERVO_MAX_POSITION = 48, /* 4 */
    BUS_SERVO_MIN_POSITION = 52, /* 4 */
    BUS_SERVO_SHUTDOWN = 63,
    BUS_SERVO_STATUS_LEVEL = 68,
    BUS_SERVO_REALTIME_TICK = 120, /* 2, ms */
    BUS_SERVO_MOVING = 122,
};

/* Set `unplugged` and `failing` at will; bus_servo_pass sees to the rest. Treat the others as read-only. */
typedef struct {
    uint8_t table[BUS_SERVO_TABLE_BYTES];
    bool unplugged;
    uint8_t failing; /* hardware errors that are there now; they stay in the table until a reboot */
    bool powered;
    double ready_s; /* when it has booted */
    double heard_s; /* the last instruction packet, to anybody */
    servo_plant *plant;
    int place;         /* in the plant */
    uint32_t torque_n; /* times it was given torque, ever */
} bus_servo;

/* New from the factory, but for id and baud rate. Without supply; baud must be one of dxl_x_baud's. */
void bus_servo_init(bus_servo *s, servo_plant *plant, int place, uint8_t id, uint32_t baud);

/* Up to this moment: supply (of all, that is), boot, hardware errors, watchdog. */
void bus_servo_pass(bus_servo *s, double now_s);

/* Whether it hears instructions sent at this rate; 0: at any. */
bool bus_servo_hears(const bus_servo *s, uint32_t baud, double now_s);

/* An instruction packet to anybody has come: for the watchdog. */
void bus_servo_hear(bus_servo *s, double now_s);

/* Both return a status error, DXL_E_..., without the alert; 0: done. Done in whole or not at all. */
uint8_t bus_servo_read(bus_servo *s, uint16_t address, uint8_t *bytes, size_t bytes_n,
                       double now_s);
uint8_t bus_servo_write(bus_servo *s, uint16_t address, const uint8_t *bytes, size_t bytes_n);

/* RAM forgotten, torque off, and deaf for BUS_SERVO_BOOT_S. */
void bus_servo_reboot(bus_servo *s, double now_s);

#endif
