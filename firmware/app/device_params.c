/* device_params.c - see device_params.h. */
#include "device_params.h"

#include "message_values.h"
#include "servo_types.h"

static const char *const POSE_MODES[] = {"predict", "interpolate"};
static const char *const SERVO_KINDS[] = {
    [SERVOS_NONE] = "none", [SERVOS_PWM] = "pwm", [SERVOS_BUS] = "bus"};

// clang-format off
#define ONE(member, name, unit, what, kind, flags, min, max, initial)                              \
    {name, unit, what, NULL, kind, PARAM_KEPT | (flags), ENTRIES_ONE, min, max, initial,           \
     offsetof(device_params, member)}
#define CHOICE(member, name, what, choices, flags, max)                                            \
    {name, "", what, choices, PARAM_CHOICE, PARAM_KEPT | (flags), ENTRIES_ONE, 0.0f, max, 0.0f,    \
     offsetof(device_params, member)}
#define SERVO(member, name, unit, what, kind, min, max, initial)                                   \
    {name, unit, what, NULL, kind, PARAM_KEPT | PARAM_LIST | PARAM_DISARMED_ONLY, ENTRIES_SERVOS,  \
     min, max, initial,                                                                            \
     offsetof(device_params, member)}
// clang-format on

const device_field device_fields[DEVICE_FIELDS_N] = {
    CHOICE(pose_mode, "pose_mode", "between poses: predict adds no delay, interpolate is smoother",
           POSE_MODES, 0, 1.0f),
    ONE(pose_hold_ms, "pose_hold", "ms", "without a pose for so long the rod is held", PARAM_NUMBER,
        0, 20.0f, 200.0f, 50.0f),
    ONE(pose_speed_mps, "pose_speed", "m/s", "faster is no hand: such poses are rejected",
        PARAM_NUMBER, 0, 0.5f, 200.0f, 25.0f),
    ONE(pose_turn_radps, "pose_turn", "rad/s", "likewise for turning", PARAM_NUMBER, 0, 1.0f,
        1000.0f, 150.0f),
    ONE(angles_hz, "angles_rate", "Hz", "how often ANGLES are sent", PARAM_NUMBER, 0, 1.0f, 2000.0f,
        100.0f),
    ONE(nodes_hz, "nodes_rate", "Hz", "how often NODES are sent, 0: never", PARAM_NUMBER, 0, 0.0f,
        500.0f, 0.0f),
    ONE(pose_log, "pose_log", "", "1: the exact pose of every tick is sent", PARAM_WHOLE, 0, 0.0f,
        1.0f, 0.0f),
    ONE(blend_s, "blend", "s", "other parameters take over within this time", PARAM_NUMBER, 0,
        0.05f, 5.0f, 0.3f),
    CHOICE(servo_kind, "servo_kind", "what hangs on it: nothing, hobby servos, smart ones on a bus",
           SERVO_KINDS, PARAM_DISARMED_ONLY, (float)SERVOS_BUS),
    ONE(servo_baud, "servo_baud", "baud", "of the bus: what the servos are set to", PARAM_WHOLE,
        PARAM_DISARMED_ONLY, 9600.0f, 4.5e6f, 1e6f),
    ONE(pwm_hz, "pwm_rate", "Hz", "of hobby servos' pulses: 50, or up to 333 for digital ones",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 50.0f, 333.0f, 50.0f),
    ONE(pwm_center_us, "pwm_center", "us", "hobby servos: pulse in the middle of the travel",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 1000.0f, 2000.0f, 1500.0f),
    ONE(pwm_us_per_rad, "pwm_scale", "us/rad", "hobby servos: how much longer for a radian",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 100.0f, 2000.0f, 636.6f),
    ONE(servo_hz, "servo_rate", "Hz", "how often servos get new goals, 0: as often as they can",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 0.0f, 2000.0f, 0.0f),
    ONE(servo_rate_radps, "servo_speed", "rad/s", "most speed of a servo", PARAM_NUMBER,
        PARAM_DISARMED_ONLY, 0.1f, 100.0f, 12.0f),
    ONE(servo_acceleration_radps2, "servo_acceleration", "rad/s^2", "most acceleration of a servo",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 1.0f, 10000.0f, 600.0f),
    SERVO(servo_id, "servo_id", "", "on the bus, or the PWM channel; as delivered 1, 2, 3 ...",
          PARAM_WHOLE, 0.0f, 252.0f, 0.0f),
    SERVO(servo_sign, "servo_sign", "", "1, or -1 for one mounted the other way round", PARAM_WHOLE,
          -1.0f, 1.0f, 1.0f),
    SERVO(servo_offset_rad, "servo_offset", "rad", "where the joint is straight", PARAM_NUMBER,
          -3.2f, 3.2f, 0.0f),
    SERVO(servo_min_rad, "servo_min", "rad", "range of the servo, from straight", PARAM_NUMBER,
          -3.2f, 0.0f, -1.6f),
    SERVO(servo_max_rad, "servo_max", "rad", "range of the servo, from straight", PARAM_NUMBER,
          0.0f, 3.2f, 1.6f),
};
