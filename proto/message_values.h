/* message_values.h - what the numbers in enumerated fields and flags mean, described once: constants, names
 * for people and the tables of PROTOCOL.md are made from these lists.
 *
 * A reader must expect values and flags that it does not know: minor versions add some.
 */
#ifndef LIMBER_MESSAGE_VALUES_H
#define LIMBER_MESSAGE_VALUES_H

#include <stdbool.h>
#include <stdint.h>

/* Lists, each with its constant's prefix: VALUE(name, value, meaning). */

// clang-format off
#define DEVICE_STATES(VALUE)                                                                                     \
    VALUE(DEVICE, BOOT, 0, "starting")                                                                           \
    VALUE(DEVICE, SELFTEST, 1, "checking itself")                                                                \
    VALUE(DEVICE, DISARMED, 2, "servos without torque; settings may be saved")                                   \
    VALUE(DEVICE, ARMING, 3, "torque on, blending from where the servos are")                                    \
    VALUE(DEVICE, ACTIVE, 4, "following the poses")                                                              \
    VALUE(DEVICE, HOLD, 5, "poses stopped: angles are held")                                                     \
    VALUE(DEVICE, RELAX, 6, "poses stayed away: going straight slowly")                                          \
    VALUE(DEVICE, LIMP, 7, "torque off after RELAX; ARM to go on")                                               \
    VALUE(DEVICE, FAULT, 8, "torque off, latched: see the fault, then CLEAR_FAULT")                              \
    VALUE(DEVICE, ESTOP, 9, "torque off, latched: CLEAR_FAULT once the input is closed")

#define FAULTS(VALUE)                                                                                            \
    VALUE(FAULT_CODE, NONE, 0, "none")                                                                           \
    VALUE(FAULT_CODE, SOLVER, 1, "three ticks without a finite answer")                                          \
    VALUE(FAULT_CODE, DEADLINE, 2, "a tick took longer than it may")                                             \
    VALUE(FAULT_CODE, CANARY, 3, "the stack has grown over its end")                                             \
    VALUE(FAULT_CODE, WATCHDOG, 4, "a part of the main loop did not check in")                                   \
    VALUE(FAULT_CODE, SERVO, 5, "a servo reports an error or does not answer")                                   \
    VALUE(FAULT_CODE, SERVO_MAP, 6, "the servos' present positions cannot be taken as goals")                    \
    VALUE(FAULT_CODE, FLASH, 7, "flash reported an error or read back wrong")                                    \
    VALUE(FAULT_CODE, SETTINGS, 8, "settings were stored, but no copy is whole")                                 \
    VALUE(FAULT_CODE, SELF_TEST, 9, "the self-test failed")                                                      \
    VALUE(FAULT_CODE, CLOCK, 10, "not the clock the firmware was built for")                                     \
    VALUE(FAULT_CODE, PROCESSOR, 11, "the processor faulted: see BOOT_REPORT")

#define REASONS(VALUE)                                                                                           \
    VALUE(REASON, UNSUPPORTED, 1, "this device cannot do that")                                                  \
    VALUE(REASON, VERSION, 2, "other major version of the protocol")                                             \
    VALUE(REASON, SESSION, 3, "not the session of the last HELLO")                                               \
    VALUE(REASON, STATE, 4, "not in this state")                                                                 \
    VALUE(REASON, LATCHED, 5, "a fault or e-stop is latched: CLEAR_FAULT first")                                 \
    VALUE(REASON, ESTOP_OPEN, 6, "the e-stop input says stop")                                                   \
    VALUE(REASON, NO_POSES, 7, "no good stream of poses")                                                        \
    VALUE(REASON, POSES_TOO_SLOW, 8, "poses further apart than the hold timeout allows")                         \
    VALUE(REASON, NAME, 9, "no parameter or preset of that name")                                                \
    VALUE(REASON, INDEX, 10, "beyond the last one")                                                              \
    VALUE(REASON, ENTRIES, 11, "more or other entries than the parameter has, or none")                          \
    VALUE(REASON, BOUNDS, 12, "out of bounds")                                                                   \
    VALUE(REASON, NOT_FINITE, 13, "NaN or infinity")                                                             \
    VALUE(REASON, NOT_WHOLE, 14, "a whole number is needed")                                                     \
    VALUE(REASON, READ_ONLY, 15, "cannot be set")                                                                \
    VALUE(REASON, DISARMED_ONLY, 16, "only while DISARMED")                                                      \
    VALUE(REASON, COMBINATION, 17, "each value may be, but not together")                                        \
    VALUE(REASON, LINE_RATE, 18, "does not fit the line: the text has the arithmetic")                           \
    VALUE(REASON, FLASH, 19, "flash is full or failed")                                                          \
    VALUE(REASON, BUSY, 20, "still busy with something else: try again")                                         \
    VALUE(REASON, SERVO, 21, "a servo cannot do that")                                                           \
    VALUE(REASON, SERVO_SILENT, 22, "a servo does not answer")                                                   \
    VALUE(REASON, SERVO_GARBLED, 23, "noise comes instead of a servo's answer")                                  \
    VALUE(REASON, SERVO_HARDWARE, 24, "a servo reports a hardware error: the value")                             \
    VALUE(REASON, SERVO_BEYOND, 25, "no such baud rate or PWM channel here")

#define LOG_LEVELS(VALUE)                                                                                        \
    VALUE(LEVEL, ERROR, 0, "something is broken")                                                                \
    VALUE(LEVEL, WARNING, 1, "something should be looked at")                                                    \
    VALUE(LEVEL, INFO, 2, "good to know")                                                                        \
    VALUE(LEVEL, DEBUG, 3, "for developers")

#define POSE_SOURCES(VALUE)                                                                                      \
    VALUE(SOURCE, UNKNOWN, 0, "not told")                                                                        \
    VALUE(SOURCE, RECORDED, 1, "a track from a file")                                                            \
    VALUE(SOURCE, SYNTHETIC, 2, "computed")                                                                      \
    VALUE(SOURCE, OPTICAL, 3, "an optical tracker")                                                              \
    VALUE(SOURCE, VR, 4, "a VR controller or tracker")                                                           \
    VALUE(SOURCE, INERTIAL, 5, "an inertial tracker")

#define ANGLES_FLAGS(VALUE)                                                                                      \
    VALUE(ANGLES, NOT_FINITE, 0x01, "the solver gave no finite answer: these are the last tick's")               \
    VALUE(ANGLES, LIMITED_ANGLE, 0x02, "a joint met its stop")                                                   \
    VALUE(ANGLES, LIMITED_ACCELERATION, 0x04, "a joint met its bound of acceleration")                           \
    VALUE(ANGLES, LIMITED_RATE, 0x08, "a joint met its bound of speed")                                          \
    VALUE(ANGLES, BLENDING, 0x10, "a blend is under way")                                                        \
    VALUE(ANGLES, PREDICTED, 0x20, "the base pose was predicted beyond the newest POSE")                         \
    VALUE(ANGLES, NO_POSE, 0x80, "no POSE yet in this session: pose_seq and received_ago_us mean nothing")

#define POSE_LOG_FLAGS(VALUE)                                                                                    \
    VALUE(POSE_LOG, RESTART, 0x01, "the rod was laid straight before this tick")                                 \
    VALUE(POSE_LOG, GAP, 0x02, "ticks before this one were not logged: the line was full")

#define HEARTBEAT_FLAGS(VALUE)                                                                                   \
    VALUE(HEARTBEAT, TORQUE, 0x01, "the servos have torque")                                                     \
    VALUE(HEARTBEAT, ESTOP_OPEN, 0x02, "the e-stop input says stop")                                             \
    VALUE(HEARTBEAT, STAGED, 0x04, "values are staged")                                                          \
    VALUE(HEARTBEAT, UNSAVED, 0x08, "what is in force is not what flash holds")                                  \
    VALUE(HEARTBEAT, POSES_GOOD, 0x10, "a good stream of poses: ARM can succeed")                                \
    VALUE(HEARTBEAT, CLOCK_KNOWN, 0x20, "a TIMESYNC of this session has told the PC's clock")

#define FEATURES(VALUE)                                                                                          \
    VALUE(FEATURE, NODES, 0x01, "can send NODES")                                                                \
    VALUE(FEATURE, POSE_LOG, 0x02, "can send POSE_LOG")                                                          \
    VALUE(FEATURE, SETTINGS, 0x04, "can keep settings")                                                          \
    VALUE(FEATURE, ESTOP_INPUT, 0x08, "has an e-stop input")                                                     \
    VALUE(FEATURE, SERVO_POSITIONS, 0x10, "servos tell where they are: arming blends from there")                \
    VALUE(FEATURE, SERVO_ASSIGN, 0x20, "can give servos other ids")                                              \
    VALUE(FEATURE, BOOTLOADER, 0x40, "can reboot into a bootloader")                                             \
    VALUE(FEATURE, SIMULATED, 0x80, "no rod hangs on it")

#define REBOOT_TARGETS(VALUE)                                                                                    \
    VALUE(REBOOT, FIRMWARE, 0, "the firmware")                                                                   \
    VALUE(REBOOT, BOOTLOADER, 1, "the bootloader")

#define PARAM_SETS(VALUE)                                                                                        \
    VALUE(PARAM, IN_FORCE, 0, "what the device runs on")                                                         \
    VALUE(PARAM, STAGED, 1, "what COMMIT would apply")

#define PARAM_KINDS(VALUE)                                                                                       \
    VALUE(PARAM, CHOICE, 0, "one of several: the text ends in their names, [a|b|c], from 0")                     \
    VALUE(PARAM, WHOLE, 1, "a whole number")                                                                     \
    VALUE(PARAM, NUMBER, 2, "a number")

#define PARAM_FLAGS(VALUE)                                                                                       \
    VALUE(PARAM, LIST, 0x01, "one entry a joint or servo; else one")                                             \
    VALUE(PARAM, DISARMED_ONLY, 0x02, "COMMIT takes a change only while DISARMED")                               \
    VALUE(PARAM, READ_ONLY, 0x04, "cannot be set")                                                               \
    VALUE(PARAM, KEPT, 0x08, "SAVE writes it to flash")

#define RESET_CAUSES(VALUE)                                                                                      \
    VALUE(RESET, POWER, 0, "power came")                                                                         \
    VALUE(RESET, PIN, 1, "reset pin")                                                                            \
    VALUE(RESET, SOFTWARE, 2, "REBOOT")                                                                          \
    VALUE(RESET, WATCHDOG, 3, "the watchdog was not fed")                                                        \
    VALUE(RESET, PROCESSOR, 4, "the fault handler restarted: pc, lr and cfsr tell where")

#define CLOCK_KINDS(VALUE)                                                                                       \
    VALUE(CLOCK, CRYSTAL, 0, "crystal, through the PLL")                                                         \
    VALUE(CLOCK, INTERNAL_PLL, 1, "the crystal failed: internal oscillator, through the PLL")                    \
    VALUE(CLOCK, INTERNAL, 2, "the PLL failed as well: internal oscillator")                                     \
    VALUE(CLOCK, EMULATOR, 3, "an emulated board")                                                               \
    VALUE(CLOCK, HOST, 4, "a simulator's")

#define SETTINGS_ORIGINS(VALUE)                                                                                  \
    VALUE(ORIGIN, NEVER_SAVED, 0, "defaults: nothing was ever saved")                                            \
    VALUE(ORIGIN, NEWEST, 1, "the newest record")                                                                \
    VALUE(ORIGIN, OLDER, 2, "recovered from an older copy: the newest record is damaged")                        \
    VALUE(ORIGIN, LOST, 3, "defaults: records were found, none of them whole")

#define BOOT_FLAGS(VALUE)                                                                                        \
    VALUE(BOOT, ESTOP_IGNORED, 0x01, "there is no e-stop input here (emulator, host)")

#define OBJECT_KINDS(VALUE)                                                                                      \
    VALUE(OBJECT, NONE, 0, "nothing")                                                                            \
    VALUE(OBJECT, PLANE, 1, "a half-space: all below its own z = 0 is solid")                                    \
    VALUE(OBJECT, SPHERE, 2, "a ball")                                                                           \
    VALUE(OBJECT, CAPSULE, 3, "a rod with round ends")                                                           \
    VALUE(OBJECT, BOX, 4, "a box with rounded edges")

/* All of them: list, member, whether they are flags (bits that may be combined), title. */
#define MESSAGE_VALUES(LIST)                                                                                     \
    LIST(DEVICE_STATES, device_states, false, "device state")                                                    \
    LIST(FAULTS, faults, false, "fault code")                                                                    \
    LIST(REASONS, reasons, false, "reason")                                                                      \
    LIST(LOG_LEVELS, log_levels, false, "log level")                                                             \
    LIST(POSE_SOURCES, pose_sources, false, "pose source")                                                       \
    LIST(ANGLES_FLAGS, angles_flags, true, "angles flags")                                                       \
    LIST(POSE_LOG_FLAGS, pose_log_flags, true, "pose log flags")                                                 \
    LIST(HEARTBEAT_FLAGS, heartbeat_flags, true, "heartbeat flags")                                              \
    LIST(FEATURES, features, true, "features")                                                                   \
    LIST(REBOOT_TARGETS, reboot_targets, false, "reboot target")                                                 \
    LIST(PARAM_SETS, param_sets, false, "parameter set")                                                         \
    LIST(PARAM_KINDS, param_kinds, false, "parameter kind")                                                      \
    LIST(PARAM_FLAGS, param_flags, true, "parameter flags")                                                      \
    LIST(RESET_CAUSES, reset_causes, false, "reset cause")                                                       \
    LIST(CLOCK_KINDS, clock_kinds, false, "clock kind")                                                          \
    LIST(SETTINGS_ORIGINS, settings_origins, false, "settings origin")                                           \
    LIST(BOOT_FLAGS, boot_flags, true, "boot flags")                                                             \
    LIST(OBJECT_KINDS, object_kinds, false, "object kind")
// clang-format on

/* DEVICE_ACTIVE, FAULT_SOLVER, REASON_BOUNDS, ANGLES_LIMITED_RATE, ... */
#define MESSAGE_VALUE_CONSTANT(prefix, name, value, meaning) prefix##_##name = value,
#define MESSAGE_VALUE_ENUM(list, member, flags, title) enum { list(MESSAGE_VALUE_CONSTANT) };
MESSAGE_VALUES(MESSAGE_VALUE_ENUM)

typedef struct {
    uint8_t value;
    const char *name;    /* without the prefix: "ACTIVE" */
    const char *meaning; /* half a sentence for people */
} message_value;

typedef struct {
    const char *title;
    bool flags;
    int values_n;
    const message_value *values;
} message_values;

/* message_values_device_states, message_values_faults, ...: one table for each list. */
#define MESSAGE_VALUES_EXTERN(list, member, flags, title)                                          \
    extern const message_values message_values_##member;
MESSAGE_VALUES(MESSAGE_VALUES_EXTERN)

/* Name or meaning of one value (of flags: of one bit); "?" where this build knows none. Never NULL. */
const char *message_value_name(const message_values *of, uint8_t value);
const char *message_value_meaning(const message_values *of, uint8_t value);

#endif
