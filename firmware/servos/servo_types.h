/* servo_types.h - what the servo back ends and whoever uses them (servos.h) talk about. */
#ifndef LIMBER_SERVO_TYPES_H
#define LIMBER_SERVO_TYPES_H

#include <stdint.h>

#include "rod_config.h"

enum { SERVO_COUNT_MAX = 2 * ROD_MAX_LINKS, SERVO_ID_MAX = 252 };

typedef enum { SERVOS_NONE, SERVOS_PWM, SERVOS_BUS, SERVOS_KINDS_N } servos_kind;

typedef struct {
    uint8_t kind; /* servos_kind */
    int servos_n;
    uint8_t id[SERVO_COUNT_MAX]; /* on the bus, 0 ... 252; or the PWM channel, from 1 */
    uint32_t bus_baud;
    float pwm_hz;         /* 50 ... 333 */
    float pwm_center_us;  /* pulse in the middle of the travel */
    float pwm_us_per_rad; /* pulses stay within 500 ... 2500 us, whatever the goal */
} servos_config;

typedef enum {
    SERVO_TROUBLE_NONE,
    SERVO_TROUBLE_SILENT, /* does not answer */
    SERVO_TROUBLE_GARBLED, /* bytes come, but no whole packet: another baud rate, or two with one id */
    SERVO_TROUBLE_STATUS,   /* refused an instruction: detail is its status error (dynamixel.h) */
    SERVO_TROUBLE_HARDWARE, /* reports a hardware error: detail is its Hardware Error Status */
    SERVO_TROUBLE_MODEL,    /* not one of the X series: detail is its model number */
    SERVO_TROUBLE_BAUD,     /* the board, or a servo, cannot make that rate */
    SERVO_TROUBLE_CHANNEL,  /* there is no such PWM channel */
    SERVO_TROUBLE_COUNT, /* none, more than there are channels, or more than the baud rate can serve in time */
    SERVO_TROUBLE_READ_BACK, /* took a value and holds another: detail is that */
    SERVO_TROUBLE_MODE,      /* does not follow goal positions: detail is its Operating Mode */
    SERVO_TROUBLE_TAKEN,     /* another servo has the new id */
    SERVO_TROUBLE_FAR,       /* many turns away from its middle */
    SERVO_TROUBLE_STUCK,     /* does not get where it is told to */
    SERVO_TROUBLES_N,
} servo_trouble_kind;

typedef struct {
    uint8_t kind;  /* servo_trouble_kind */
    int16_t servo; /* its place in config.id, -1: none in particular */
    uint8_t id;
    uint32_t detail; /* depends on the kind; 0 else */
} servo_trouble;

/* What happened and what to do, half a sentence without the servo's name; never NULL. */
const char *servo_trouble_text(uint8_t kind);

typedef enum {
    SERVO_REQUEST_PING, /* is it there, and how is it */
    SERVO_REQUEST_ID,   /* answers to new_id from now on */
    SERVO_REQUEST_BAUD, /* talks at new_baud from now on */
    SERVO_REQUEST_TEST, /* turns by turn_rad and back, within 2 s; then no torque */
} servo_request_kind;

typedef struct {
    uint8_t kind, id, new_id;
    uint32_t baud; /* to talk to it at; 0: config.bus_baud */
    uint32_t new_baud;
    float turn_rad;
} servo_request;

typedef enum {
    SERVO_REQUEST_NONE,
    SERVO_REQUEST_BUSY,
    SERVO_REQUEST_DONE,
    SERVO_REQUEST_FAILED
} servo_request_state;

/* Of one servo, as it told; of a PWM channel only id and position_rad (as last sent). */
typedef struct {
    uint8_t id, firmware, hardware_error;
    uint16_t model;
    uint32_t baud;
    float position_rad, supply_v, temperature_c;
} servo_info;

#endif
