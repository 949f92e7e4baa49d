/* message_list.h - every message, described once. Structs, packing, lengths, the layout hash, the tables of
 * PROTOCOL.md and the test programs are all made from these lists.
 *
 * MESSAGES: name, member, type, tail, direction, drop class, meaning.
 * A message's fields follow each other on the wire without gaps, in the order of its list (`of` is handed
 * through: the member the list is asked about):
 *     ONE(of, type, name, meaning)        u8 u16 i16 u32 f32, little-endian
 *     MANY(of, type, n, name, meaning)    n of them
 *     NAME(of, n, name, meaning)          n bytes of UTF-8, filled up with zeros; a string in the struct
 * then the tail, from there to the end of the payload: NONE, or as many elements as there are of
 *     ANGLES  theta i16, phi i16      NODES  x y z f32      VALUES  f32      TEXT  UTF-8, up to 96 bytes
 * A meaning that starts with the title of a list in message_values.h says that the values are that list's.
 *
 * A published message never changes: what is new gets a new type (PROTOCOL.md, "Versions").
 */
#ifndef LIMBER_MESSAGE_LIST_H
#define LIMBER_MESSAGE_LIST_H

// clang-format off
#define MESSAGES(MESSAGE)                                                                                        \
    MESSAGE(HELLO, hello, 0x01, NONE, BOTH, KEPT, "who is there; opens a session")                               \
    MESSAGE(PING, ping, 0x02, NONE, BOTH, KEPT, "asks for a PONG")                                               \
    MESSAGE(PONG, pong, 0x03, NONE, BOTH, KEPT, "answers a PING")                                                \
    MESSAGE(TIMESYNC, timesync, 0x04, NONE, TO_DEVICE, KEPT, "asks for the device's clock") \
    MESSAGE(TIMESYNC_ANSWER, timesync_answer, 0x05, NONE, FROM_DEVICE, KEPT, "answers a TIMESYNC")               \
    MESSAGE(HEARTBEAT, heartbeat, 0x06, NONE, FROM_DEVICE, KEPT, "10 Hz, sent by the control loop itself")       \
    MESSAGE(STATS_GET, stats_get, 0x07, NONE, TO_DEVICE, KEPT, "asks for STATS at once")                         \
    MESSAGE(STATS, stats, 0x08, NONE, FROM_DEVICE, TELEMETRY, "every counter; at 1 Hz and when asked for")       \
    MESSAGE(LOG, log, 0x09, TEXT, FROM_DEVICE, LOGS, "a line for people")                                        \
    MESSAGE(ROD_STATS, rod_stats, 0x0A, NONE, FROM_DEVICE, TELEMETRY, "counters of the rod; just before each STATS") \
    MESSAGE(POSE, pose, 0x10, NONE, TO_DEVICE, KEPT, "where the rod's base is")                                  \
    MESSAGE(ANGLES, angles, 0x11, ANGLES, FROM_DEVICE, ANGLES, "the joint angles of a tick")                     \
    MESSAGE(NODES, nodes, 0x12, NODES, FROM_DEVICE, NODES, "where the link ends are, for graphics")              \
    MESSAGE(POSE_LOG, pose_log, 0x13, NONE, FROM_DEVICE, TELEMETRY, "the exact base pose a tick used")           \
    MESSAGE(TOUCH, touch, 0x14, NONE, FROM_DEVICE, TELEMETRY, "how hard objects push the rod; while any does")   \
    MESSAGE(ARM, arm, 0x20, NONE, TO_DEVICE, KEPT, "give the servos torque and start following")                 \
    MESSAGE(DISARM, disarm, 0x21, NONE, TO_DEVICE, KEPT, "stop following and take the torque away")              \
    MESSAGE(ESTOP, estop, 0x22, NONE, TO_DEVICE, KEPT, "torque off within one tick, latched")                    \
    MESSAGE(CLEAR_FAULT, clear_fault, 0x23, NONE, TO_DEVICE, KEPT, "leave FAULT or ESTOP for DISARMED")          \
    MESSAGE(REBOOT, reboot, 0x24, NONE, TO_DEVICE, KEPT, "start afresh")                                         \
    MESSAGE(PARAM_LIST, param_list, 0x30, NONE, TO_DEVICE, KEPT, "asks for a PARAM_INFO")                        \
    MESSAGE(PARAM_GET, param_get, 0x31, NONE, TO_DEVICE, KEPT, "asks for a PARAM_VALUE")                         \
    MESSAGE(PARAM_SET, param_set, 0x32, VALUES, TO_DEVICE, KEPT, "stages values of one parameter")               \
    MESSAGE(PARAM_COMMIT, param_commit, 0x33, NONE, TO_DEVICE, KEPT, "checks and applies what is staged")        \
    MESSAGE(PARAM_SAVE, param_save, 0x34, NONE, TO_DEVICE, KEPT, "writes what is in force to flash")             \
    MESSAGE(PARAM_DEFAULTS, param_defaults, 0x35, NONE, TO_DEVICE, KEPT, "stages every parameter's default")     \
    MESSAGE(PRESET_LIST, preset_list, 0x36, NONE, TO_DEVICE, KEPT, "asks for a PRESET_INFO")                     \
    MESSAGE(PRESET, preset, 0x37, NONE, TO_DEVICE, KEPT, "applies a preset, through a blend")                    \
    MESSAGE(SERVO_ASSIGN, servo_assign, 0x38, NONE, TO_DEVICE, KEPT, "gives a bus servo another id")             \
    MESSAGE(SERVO_PING, servo_ping, 0x39, NONE, TO_DEVICE, KEPT, "asks one servo for a SERVO_INFO")              \
    MESSAGE(SERVO_SET_BAUD, servo_set_baud, 0x3A, NONE, TO_DEVICE, KEPT, "gives a bus servo another baud rate")  \
    MESSAGE(SERVO_TEST, servo_test, 0x3B, NONE, TO_DEVICE, KEPT, "turns one servo a little and back")            \
    MESSAGE(SCENE_PUT, scene_put, 0x3C, NONE, TO_DEVICE, KEPT, "puts an object in place, or takes it away")      \
    MESSAGE(SCENE_GET, scene_get, 0x3D, NONE, TO_DEVICE, KEPT, "asks for a SCENE_OBJECT")                        \
    MESSAGE(SHAPE, shape, 0x3E, ANGLES, TO_DEVICE, KEPT, "pulls the joints to these angles, or lets them go")    \
    MESSAGE(ACK, ack, 0x40, NONE, FROM_DEVICE, KEPT, "done")                                                     \
    MESSAGE(NACK, nack, 0x41, TEXT, FROM_DEVICE, KEPT, "not done, and why")                                      \
    MESSAGE(PARAM_INFO, param_info, 0x42, TEXT, FROM_DEVICE, KEPT, "what a parameter is")                        \
    MESSAGE(PARAM_VALUE, param_value, 0x43, VALUES, FROM_DEVICE, KEPT, "what a parameter is set to")             \
    MESSAGE(PRESET_INFO, preset_info, 0x44, TEXT, FROM_DEVICE, KEPT, "what a preset is")                         \
    MESSAGE(FAULT, fault, 0x45, TEXT, FROM_DEVICE, KEPT, "the device stopped, and why")                          \
    MESSAGE(BOOT_REPORT, boot_report, 0x46, NONE, FROM_DEVICE, KEPT, "how the device came up; follows its HELLO") \
    MESSAGE(SERVO_INFO, servo_info, 0x47, NONE, FROM_DEVICE, KEPT, "how a servo is")                             \
    MESSAGE(SCENE_OBJECT, scene_object, 0x48, NONE, FROM_DEVICE, KEPT, "an object, and how hard it pushes the rod")

#define REQUEST_ID(of, ONE) ONE(of, u16, request_id, "chosen by the sender, not 0; the answer repeats it")

#define OBJECT(of, ONE, MANY)                                                                                    \
    ONE(of, u8, kind, "object kind; 0: the place is free, and the rest is 0 or ignored")                         \
    MANY(of, f32, 3, place_m, "of its centre in the world, of a plane any point of its surface; within 1000 m")  \
    MANY(of, f32, 4, orientation_xyzw, "object to world, of unit length; a plane's free side is +z")             \
    MANY(of, f32, 3, half_m, "box: half its edges, less the radius; capsule: z, half its length, less the radius") \
    ONE(of, f32, radius_m, "sphere, capsule; of a box what rounds its edges; 0.001 ... 1000, plane: 0")          \
    ONE(of, f32, friction, "Coulomb's coefficient between it and the rod, 0 ... 10")

#define HELLO_FIELDS(of, ONE, MANY, NAME)                                                                        \
    ONE(of, u16, request_id, "chosen by the PC; the device's answer repeats it; 0 unasked, after a start")       \
    ONE(of, u8, protocol_major, "another major is refused")                                                      \
    ONE(of, u8, protocol_minor, "the lower of the two is spoken")                                                \
    ONE(of, u32, layout_hash, "messages_layout_hash: equal where both sides know the same messages")             \
    ONE(of, u32, features, "features the sender has")                                                            \
    ONE(of, u16, links_max, "most links this build can have; 0 from the PC")                                     \
    ONE(of, u16, links_n, "links now; 0 from the PC")                                                            \
    ONE(of, f32, tick_max_hz, "fastest tick; 0 from the PC")                                                     \
    ONE(of, f32, tick_hz, "tick now; 0 from the PC")                                                             \
    ONE(of, f32, angles_hz, "rate of ANGLES now; 0 from the PC")                                                 \
    ONE(of, f32, pose_hz, "rate of POSE the PC is going to send, 0: none; 0 from the device")                    \
    ONE(of, u32, line_baud, "0 where the line has no rate (USB, TCP, PTY); 0 from the PC")                       \
    NAME(of, 16, device, "board, limber-sim, or the PC program")                                                 \
    NAME(of, 24, build, "version and commit")

#define PING_FIELDS(of, ONE, MANY, NAME) ONE(of, u32, token, "anything")
#define PONG_FIELDS(of, ONE, MANY, NAME) ONE(of, u32, token, "that of the PING")

#define TIMESYNC_FIELDS(of, ONE, MANY, NAME)                                                                     \
    ONE(of, u32, t1_us, "PC's clock when this was sent")                                                         \
    ONE(of, u8, last_known, "1: the four moments of the last exchange follow; 0: there was none")                \
    ONE(of, u32, last_t1_us, "PC's clock: the last TIMESYNC was sent")                                           \
    ONE(of, u32, last_t2_us, "device's clock: it had come in")                                                   \
    ONE(of, u32, last_t3_us, "device's clock: the answer was sent")                                              \
    ONE(of, u32, last_t4_us, "PC's clock: the answer had come in")

#define TIMESYNC_ANSWER_FIELDS(of, ONE, MANY, NAME)                                                              \
    ONE(of, u32, t1_us, "that of the TIMESYNC")                                                                  \
    ONE(of, u32, t2_us, "device's clock when the TIMESYNC had come in")                                          \
    ONE(of, u32, t3_us, "device's clock when this was sent")

#define HEARTBEAT_FIELDS(of, ONE, MANY, NAME)                                                                    \
    ONE(of, u8, state, "device state")                                                                           \
    ONE(of, u8, fault, "fault code latched, 0: none")                                                            \
    ONE(of, u8, flags, "heartbeat flags")                                                                        \
    ONE(of, u32, uptime_ms, "since start, wraps after 49 days")                                                  \
    ONE(of, u32, tick, "number of the last tick since start")                                                    \
    ONE(of, u32, params_generation, "counts the changes of what is in force since start")                        \
    ONE(of, u16, tick_mean_us, "time a tick took, mean since the last heartbeat")                                \
    ONE(of, u16, tick_max_us, "the same, longest")

#define STATS_GET_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)

#define STATS_FIELDS(of, ONE, MANY, NAME)                                                                        \
    ONE(of, u16, request_id, "that of the STATS_GET; 0 unasked")                                                 \
    ONE(of, u32, uptime_ms, "since start; all counters below count from there and wrap")                         \
    ONE(of, u32, frames_good, "frames whole and with the right checksum")                                        \
    ONE(of, u32, frames_crc, "frames with a wrong checksum")                                                     \
    ONE(of, u32, frames_cobs, "frames cut off")                                                                  \
    ONE(of, u32, frames_too_short, "less than a header and a checksum between two zeros")                        \
    ONE(of, u32, frames_too_long, "more than the longest frame between two zeros")                               \
    ONE(of, u32, messages_unknown, "good frames of a type this build does not know or take")                     \
    ONE(of, u32, messages_length, "good frames whose length does not fit their type")                            \
    ONE(of, u32, poses_accepted, "poses used or replaced by a newer one before the tick")                        \
    ONE(of, u32, poses_duplicate, "seq seen before")                                                             \
    ONE(of, u32, poses_late, "seq before the newest one's, or captured no later than it")                        \
    ONE(of, u32, poses_lost, "seqs passed over, less those that came late after all")                            \
    ONE(of, u32, poses_wrong_session, "session is not that of the last HELLO")                                   \
    ONE(of, u32, poses_stale, "captured over 50 ms ago")                                                         \
    ONE(of, u32, poses_future, "captured over 5 ms from now")                                                    \
    ONE(of, u32, poses_not_finite, "NaN, infinity, or a coordinate beyond 500 m")                                \
    ONE(of, u32, poses_bad_quaternion, "length of the quaternion is off 1 by over 0.01")                         \
    ONE(of, u32, poses_teleport, "jumped")                                                                       \
    ONE(of, u32, poses_too_fast, "moved faster than a hand can")                                                 \
    ONE(of, u32, commands_done, "requests answered by ACK or by what they asked for")                            \
    ONE(of, u32, commands_refused, "requests answered by NACK")                                                  \
    ONE(of, u32, commands_repeated, "requests seen before, answered again without being done again")             \
    ONE(of, u32, deadline_misses, "ticks that took longer than a tick")                                          \
    ONE(of, u32, solver_not_finite, "ticks without a finite answer")                                             \
    ONE(of, u32, limited_angle, "ticks in which a joint met its stop")                                           \
    ONE(of, u32, limited_acceleration, "ticks in which a joint met its bound of acceleration")                   \
    ONE(of, u32, limited_rate, "ticks in which a joint met its bound of speed")                                  \
    ONE(of, u32, holds, "times HOLD was entered")                                                                \
    ONE(of, u32, servo_errors, "errors servos reported")                                                         \
    ONE(of, u32, line_overruns, "bytes lost on receipt for want of room")                                        \
    ONE(of, u32, line_framing, "bytes the UART received without a stop bit")                                     \
    ONE(of, u32, dropped_logs, "LOG not sent: the line was full")                                                \
    ONE(of, u32, dropped_telemetry, "STATS, POSE_LOG not sent: the line was full")                               \
    ONE(of, u32, dropped_nodes, "NODES not sent: the line was full")                                             \
    ONE(of, u32, dropped_angles, "ANGLES not sent: the line was full")                                           \
    ONE(of, u32, answers_lost, "answers that found the queue full: the PC asks again")                           \
    ONE(of, u32, clock_exchanges, "TIMESYNC exchanges used")                                                     \
    ONE(of, u32, clock_left_out, "TIMESYNC exchanges too slow or impossible")                                    \
    ONE(of, u32, clock_jumps, "times one of the clocks was found to have jumped")                                \
    ONE(of, u32, tick_max_us, "longest tick since start")

#define ROD_STATS_FIELDS(of, ONE, MANY, NAME)                                                                    \
    ONE(of, u16, request_id, "that of the STATS_GET; 0 unasked")                                                 \
    ONE(of, u32, lengths_restored, "elastic: ticks so violent that lengths were made good from the base outwards")

#define LOG_FIELDS(of, ONE, MANY, NAME) ONE(of, u8, level, "log level")

#define POSE_FIELDS(of, ONE, MANY, NAME)                                                                         \
    MANY(of, f32, 3, position_m, "x y z of the base, world, right-handed")                                       \
    MANY(of, f32, 4, quaternion_xyzw, "base to world, of unit length; the straight rod runs along the base's +z") \
    ONE(of, u16, age_us, "how long before the header's t_us the pose was captured; 65535: that or longer")       \
    ONE(of, u8, quality, "tracker's opinion, 0 worst ... 254 best, 255: it has none")                            \
    ONE(of, u8, source, "pose source")

#define ANGLES_FIELDS(of, ONE, MANY, NAME)                                                                       \
    ONE(of, u32, tick, "number of the tick since start")                                                         \
    ONE(of, u16, pose_seq, "seq of the newest POSE that went into it")                                           \
    ONE(of, u16, received_ago_us, "from receipt of that POSE to the header's t_us; 65535: that or longer")       \
    ONE(of, u16, solved_ago_us, "from the end of the solving to the header's t_us; 65535: that or longer")       \
    ONE(of, u8, state, "device state")                                                                           \
    ONE(of, u8, flags, "angles flags: which limit acted on any joint")

#define NODES_FIELDS(of, ONE, MANY, NAME)                                                                        \
    ONE(of, u32, tick, "number of the tick since start")                                                         \
    ONE(of, u16, first_node, "which node the tail starts with; 0 is the base")                                   \
    ONE(of, u16, rod_nodes_n, "nodes of the whole rod: links + 1")

#define POSE_LOG_FIELDS(of, ONE, MANY, NAME)                                                                     \
    ONE(of, u32, tick, "number of the tick since start")                                                         \
    MANY(of, f32, 3, position_m, "as given to the rod, every bit")                                               \
    MANY(of, f32, 4, quaternion_xyzw, "as given to the rod, every bit")                                          \
    ONE(of, u32, params_generation, "as in HEARTBEAT")                                                           \
    ONE(of, u8, state, "device state")                                                                           \
    ONE(of, u8, flags, "pose log flags")

#define TOUCH_FIELDS(of, ONE, MANY, NAME)                                                                        \
    ONE(of, u32, tick, "number of the tick since start")                                                         \
    ONE(of, u16, contacts_n, "places where the rod touches: nodes, one that touches two objects counts twice")   \
    MANY(of, f32, 3, force_newton, "sum of what pushes the rod, in the world")

#define ARM_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define DISARM_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define ESTOP_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define CLEAR_FAULT_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define REBOOT_FIELDS(of, ONE, MANY, NAME)                                                                       \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, into, "reboot target")

#define PARAM_LIST_FIELDS(of, ONE, MANY, NAME)                                                                   \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u16, index, "from 0; beyond the last one: NACK")
#define PARAM_GET_FIELDS(of, ONE, MANY, NAME)                                                                    \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, which, "parameter set")                                                                          \
    NAME(of, 24, name, "of the parameter")
#define PARAM_SET_FIELDS(of, ONE, MANY, NAME)                                                                    \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u16, first, "entry that the first value is for, from 0; 0 where there is one entry")                 \
    NAME(of, 24, name, "of the parameter")
#define PARAM_COMMIT_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define PARAM_SAVE_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define PARAM_DEFAULTS_FIELDS(of, ONE, MANY, NAME) REQUEST_ID(of, ONE)
#define PRESET_LIST_FIELDS(of, ONE, MANY, NAME)                                                                  \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u16, index, "from 0; beyond the last one: NACK")
#define PRESET_FIELDS(of, ONE, MANY, NAME)                                                                       \
    REQUEST_ID(of, ONE)                                                                                          \
    NAME(of, 24, name, "of the preset")
#define SERVO_ASSIGN_FIELDS(of, ONE, MANY, NAME)                                                                 \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, old_id, "answers to this now; it must be the only one that does")                                \
    ONE(of, u8, new_id, "shall answer to this from now on")                                                      \
    ONE(of, u32, baud, "to talk to it at; 0: that of the servo_baud parameter")
#define SERVO_PING_FIELDS(of, ONE, MANY, NAME)                                                                   \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, id, "of the servo, or a PWM channel from 1")                                                     \
    ONE(of, u32, baud, "to talk to it at; 0: that of the servo_baud parameter")
#define SERVO_SET_BAUD_FIELDS(of, ONE, MANY, NAME)                                                               \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, id, "of the servo")                                                                              \
    ONE(of, u32, baud, "to talk to it at; 0: that of the servo_baud parameter")                                  \
    ONE(of, u32, new_baud, "shall talk at this from now on")
#define SERVO_TEST_FIELDS(of, ONE, MANY, NAME)                                                                   \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, id, "of the servo, or a PWM channel from 1")                                                     \
    ONE(of, u32, baud, "to talk to it at; 0: that of the servo_baud parameter")                                  \
    ONE(of, f32, turn_rad, "by so much, and back; at most 0.5 either way")
#define SCENE_PUT_FIELDS(of, ONE, MANY, NAME)                                                                    \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, index, "its place, from 0; 255 with kind 0: all of them")                                        \
    OBJECT(of, ONE, MANY)
#define SCENE_GET_FIELDS(of, ONE, MANY, NAME)                                                                    \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, u8, index, "from 0; beyond the last place: NACK")
#define SHAPE_FIELDS(of, ONE, MANY, NAME)                                                                        \
    REQUEST_ID(of, ONE)                                                                                          \
    ONE(of, f32, strength_nm, "like a spring of so many N m at each joint, 0 ... 1e6; 0: lets it go")            \
    ONE(of, f32, blend_s, "comes and goes within this time, 0 ... 60 s")

#define ACK_FIELDS(of, ONE, MANY, NAME)                                                                          \
    ONE(of, u16, request_id, "that of the request")                                                              \
    ONE(of, u8, answered, "type of the request")
#define NACK_FIELDS(of, ONE, MANY, NAME)                                                                         \
    ONE(of, u16, request_id, "that of the request")                                                              \
    ONE(of, u8, answered, "type of the request")                                                                 \
    ONE(of, u8, reason, "reason")                                                                                \
    ONE(of, i16, entry, "joint or other entry of the field, from 0; -1: none in particular")                     \
    ONE(of, f32, value, "what was given; this and the bounds are 0 where there is nothing to say")               \
    ONE(of, f32, minimum, "least allowed there")                                                                 \
    ONE(of, f32, maximum, "most allowed there")                                                                  \
    NAME(of, 24, field, "parameter or field at fault, empty: none in particular")
#define PARAM_INFO_FIELDS(of, ONE, MANY, NAME)                                                                   \
    ONE(of, u16, request_id, "that of the PARAM_LIST")                                                           \
    ONE(of, u16, index, "that of the PARAM_LIST")                                                                \
    ONE(of, u16, params_n, "how many parameters there are")                                                      \
    ONE(of, u16, entries_n, "values it has now: 1, or one a joint or servo")                                     \
    ONE(of, u8, kind, "parameter kind")                                                                          \
    ONE(of, u8, flags, "parameter flags")                                                                        \
    ONE(of, f32, minimum, "least allowed")                                                                       \
    ONE(of, f32, maximum, "most allowed")                                                                        \
    ONE(of, f32, initial, "default, of every entry")                                                             \
    NAME(of, 24, name, "for people and requests")                                                                \
    NAME(of, 12, unit, "empty: none")
#define PARAM_VALUE_FIELDS(of, ONE, MANY, NAME)                                                                  \
    ONE(of, u16, request_id, "that of the PARAM_GET")                                                            \
    ONE(of, u8, which, "parameter set")                                                                          \
    NAME(of, 24, name, "of the parameter")
#define PRESET_INFO_FIELDS(of, ONE, MANY, NAME)                                                                  \
    ONE(of, u16, request_id, "that of the PRESET_LIST")                                                          \
    ONE(of, u16, index, "that of the PRESET_LIST")                                                               \
    ONE(of, u16, presets_n, "how many presets there are")                                                        \
    NAME(of, 24, name, "for people and requests")
#define FAULT_FIELDS(of, ONE, MANY, NAME)                                                                        \
    ONE(of, u8, fault, "fault code")                                                                             \
    ONE(of, u8, state, "device state it happened in")                                                            \
    ONE(of, u32, tick, "number of the tick since start")                                                         \
    ONE(of, u32, detail, "a number that tells more: servo, microseconds, address; depends on the fault")
#define BOOT_REPORT_FIELDS(of, ONE, MANY, NAME)                                                                  \
    ONE(of, u8, cause, "reset cause")                                                                            \
    ONE(of, u8, fault, "fault code that led to the reset, 0: none")                                              \
    ONE(of, u8, settings, "settings origin")                                                                     \
    ONE(of, u8, clock, "clock kind")                                                                             \
    ONE(of, u8, flags, "boot flags")                                                                             \
    ONE(of, u32, clock_hz, "of the core")                                                                        \
    ONE(of, u32, settings_sequence, "number of the settings record in use, 0: none")                             \
    ONE(of, u32, pc, "where the processor was when it faulted; this and the next two are 0 else")                \
    ONE(of, u32, lr, "where it had been called from")                                                            \
    ONE(of, u32, cfsr, "Cortex-M's configurable fault status")
#define SERVO_INFO_FIELDS(of, ONE, MANY, NAME)                                                                   \
    ONE(of, u16, request_id, "that of the SERVO_PING")                                                           \
    ONE(of, u8, id, "of the servo")                                                                              \
    ONE(of, u8, firmware, "its version")                                                                         \
    ONE(of, u16, model, "its maker's number; 0 for a PWM channel")                                               \
    ONE(of, u32, baud, "it talks at")                                                                            \
    ONE(of, u8, hardware_error, "as it reports it: see its manual")                                              \
    ONE(of, f32, position_rad, "of its shaft, 0 in the middle of its travel")                                    \
    ONE(of, f32, supply_v, "volts it sees")                                                                      \
    ONE(of, f32, temperature_c, "degrees Celsius inside")
#define SCENE_OBJECT_FIELDS(of, ONE, MANY, NAME)                                                                 \
    ONE(of, u16, request_id, "that of the SCENE_GET")                                                            \
    ONE(of, u8, index, "that of the SCENE_GET")                                                                  \
    ONE(of, u8, objects_max, "how many places there are")                                                        \
    OBJECT(of, ONE, MANY)                                                                                        \
    ONE(of, u16, contacts_n, "nodes that touch it")                                                              \
    MANY(of, f32, 3, force_newton, "sum of what it pushes the rod with, in the world")
// clang-format on

#endif
