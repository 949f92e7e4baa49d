/* device_params.h - what the device itself can be told, beside the rod's parameters: one struct, and the table
 * that describes it to params.h. */
#ifndef LIMBER_DEVICE_PARAMS_H
#define LIMBER_DEVICE_PARAMS_H

#include <stddef.h>
#include <stdint.h>

#include "rod_config.h"

enum { PARAMS_SERVOS_MAX = 2 * ROD_MAX_LINKS };

/* All floats, whatever they stand for, so that one table and one message carry them. */
typedef struct {
    float pose_mode;      /* 0 predict, 1 interpolate */
    float pose_hold_ms;   /* without a pose for so long: HOLD */
    float pose_speed_mps; /* faster is no hand: the pose is rejected */
    float pose_turn_radps;
    float angles_hz;  /* rate of ANGLES */
    float nodes_hz;   /* rate of NODES; 0: none */
    float pose_log;   /* 1: POSE_LOG every tick */
    float blend_s;    /* a preset or other parameters take over within this time */
    float servo_kind; /* servos_kind */
    float servo_baud; /* of the bus */
    float pwm_hz;     /* of hobby servos' pulses */
    float pwm_center_us, pwm_us_per_rad;
    float servo_hz;         /* rate of servo output, 0: as often as they can be served */
    float servo_rate_radps; /* most speed of a servo */
    float servo_acceleration_radps2;
    float servo_id[PARAMS_SERVOS_MAX];   /* on the bus, or the PWM channel */
    float servo_sign[PARAMS_SERVOS_MAX]; /* 1 or -1 */
    float servo_offset_rad[PARAMS_SERVOS_MAX];
    float servo_min_rad[PARAMS_SERVOS_MAX];
    float servo_max_rad[PARAMS_SERVOS_MAX];
} device_params;

typedef enum { ENTRIES_ONE, ENTRIES_SERVOS } entries_of;

typedef struct {
    const char *name, *unit, *what;
    const char *const *choices;
    uint8_t kind, flags;
    entries_of entries;
    float min, max, initial;
    size_t offset; /* into device_params */
} device_field;

enum { DEVICE_FIELDS_N = 21 };
extern const device_field device_fields[DEVICE_FIELDS_N];

#endif
