/* device.h - the whole device: one tick from bytes to servo goals and back, behind hal.h.
 *
 *     device_init(&device, &hal, &config);
 *     every config.tick_s: device_tick(&device);
 *
 * The same code on the board, in the simulator and in the tests. Nothing here knows a register or waits for
 * anything; a tick's work is bounded. Caller-owned, no heap; all of it from the main loop.
 *
 * One tick, top to bottom in device_tick: receive -> pose -> states -> rod and servos -> report.
 * What each message does is in commands.c, what is sent unasked in telemetry.c.
 */
#ifndef LIMBER_DEVICE_H
#define LIMBER_DEVICE_H

#include "body.h"
#include "faults.h"
#include "hal.h"
#include "link.h"
#include "params.h"
#include "pose_input.h"
#include "servos.h"
#include "settings.h"
#include "supervisor.h"

/* A watcher of everything that happens to the body, tick by tick: the simulator's log. Any may be NULL.
 * changed: params and whether all of them are new; put: an object of the scene; placed: where the servos are. */
typedef struct {
    void *context;
    void (*changed)(void *context, const params_set *set, bool all_new);
    void (*put)(void *context, int index, const scene_object *object);
    void (*shaped)(void *context, const body_shape *shape);
    void (*placed)(void *context, const float *positions_rad, int servos_n);
    void (*ticked)(void *context, const body_input *input, const body *b);
} device_watcher;

typedef struct {
    float tick_s;        /* what device_tick is called with */
    float tick_max_hz;   /* the fastest that this hardware could do, for HELLO */
    uint32_t line_baud;  /* 0: the line has no rate */
    uint32_t features;   /* FEATURE_... */
    const char *name;    /* at most 16 bytes: "limber-sim" */
    const char *build;   /* at most 24 bytes: version and commit */
    int links_n;         /* of the rod in the hand, unless settings say otherwise */
    uint8_t servos_kind; /* what hangs on it: servos_kind, likewise */
    device_watcher watcher;
} device_config;

/* Settings: 9 lists of a float a joint, 5 of one a servo, names and single values. */
enum { DEVICE_ANSWERS_KEPT_N = 8, DEVICE_SETTINGS_BYTES = 76 * ROD_MAX_LINKS + 512 };

/* Parts of the tick that must have come round before the watchdog is fed. */
enum {
    CHECKED_RECEIVE = 1 << 0,
    CHECKED_STATES = 1 << 1,
    CHECKED_SERVOS = 1 << 2,
    CHECKED_STACK = 1 << 3,
    CHECKED_DEADLINE = 1 << 4,
    CHECKED_ALL = (1 << 5) - 1,
};

/* A request that takes more than a tick: its answer comes when it is done, and asking again changes nothing. */
typedef struct {
    uint16_t id; /* 0: none is under way */
    uint8_t type;
} device_request;

typedef struct {
    const hal *hal;
    device_config config;
    hal_boot boot;
    device_link link;
    params params;
    pose_input poses;
    supervisor supervisor;
    fault_log faults;
    settings settings;
    servos servos;
    body body;
    body_input input; /* of this tick */

    uint32_t blend_due_us; /* once the servos have torque */
    uint32_t now_us, tick;
    uint32_t uptime_ms, uptime_rest_us;
    bool arm, disarm, clear, estop; /* asked for in this tick */
    bool self_test_passed;
    uint8_t reboot; /* 1 + REBOOT_..., once the answer is out; 0: not asked */
    device_request saving, arming, servicing; /* SAVE; ARM; SERVO_... */
    bool unsaved;
    uint8_t checked_in; /* CHECKED_... of this tick */
    message_nack
        answers[DEVICE_ANSWERS_KEPT_N]; /* to requests that change something, for when they are
                                                    asked again; reason 0: it was an ACK */
    int answers_next;
    uint32_t commands_done, commands_refused, commands_repeated;

    pose_tick pose; /* of this tick */
    uint32_t solved_us;
    uint32_t to_angles_ticks, to_nodes_ticks, to_heartbeat_ticks, to_stats_ticks;
    uint32_t limited_ticks[SERVO_LIMITERS_N], deadline_misses, holds;
    uint32_t tick_max_us, tick_time_us, tick_worst_us,
        ticks_timed_n;   /* ever; since the last heartbeat */
    uint32_t fault_seen; /* latched causes already told */
    bool pose_log_gap;   /* a POSE_LOG has been dropped since the last one sent */
    bool touch_told;     /* the last TOUCH sent had contacts: one without them must follow */

    uint8_t settings_bytes[DEVICE_SETTINGS_BYTES];
} device;

/* Loads settings (this may erase a flash sector: 2 s), prepares everything, says HELLO and BOOT_REPORT. */
void device_init(device *d, const hal *hal, const device_config *config, const hal_boot *boot);

void device_tick(device *d);

/* The pieces of it, in files of their own. */
bool device_apply_params(device *d, const params_set *set, bool all_new,
                         params_refusal *why); /* to all parts, or to none */
bool device_put_object(
    device *d, int index, const scene_object *object, char *text,
    params_refusal *why); /* scene_commands.c, both; `text` as for tick_budget_check */
bool device_take_shape(device *d, const body_shape *shape, char *text, params_refusal *why);
void commands_take(device *d, const message *m, const frame *header); /* commands.c */
void commands_end_tick(device *d);                     /* a SAVE under way, a reboot due */
void param_commands_take(device *d, const message *m); /* param_commands.c */
void param_commands_end_tick(device *d);
void scene_commands_take(device *d, const message *m); /* scene_commands.c */
void servo_commands_take(device *d, const message *m); /* servo_commands.c */
void servo_commands_end_tick(device *d);
uint8_t servo_commands_reason(uint8_t trouble_kind); /* REASON_SERVO... */
void arming_begin(device *d, uint16_t request_id);   /* arming.c: the servos are looked for */
void arming_before_states(device *d);                /* found: the states may hear of the ARM */
void arming_after_states(device *d);                 /* what became of it */
void arming_trouble(const device *d, char *text, size_t room); /* which servo, and what is wrong */
void telemetry_send(device *d);
void telemetry_stats(device *d, uint16_t request_id);
void telemetry_hello(device *d, uint16_t request_id); /* and BOOT_REPORT */
void telemetry_log(device *d, uint8_t level, const char *text);
void telemetry_servos(device *d); /* LOG: which, and how often they are served */

#endif
