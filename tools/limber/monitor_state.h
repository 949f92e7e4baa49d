/* monitor_state.h - what is known of a device at this moment: plain data, made of its messages alone.
 *
 *     monitor_state_init(&m);
 *     monitor_state_begin(&m, s.name, &s.device);          a session begins
 *     monitor_state_take(&m, message, f->t_us);            from the session's listener, for every message
 *     monitor_state_lost(&m, s.why);                       it is over
 *     monitor_state_refresh(&m, limber_now_us());          before it is drawn or printed
 *
 * It asks the device nothing: HEARTBEAT (10 Hz), STATS (1 Hz), ANGLES, TOUCH and FAULT come by themselves. What is
 * called "the last second" is the last whole window of about that long; a rate is 0 when nothing came in it.
 * One thread; no I/O, no heap; messages are copied. A message costs less than a microsecond.
 */
#ifndef LIMBER_MONITOR_STATE_H
#define LIMBER_MONITOR_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "delays.h"
#include "messages.h"
#include "port.h"

enum { MONITOR_COUNTERS_MAX = 64, MONITOR_FLAGS_N = 8, MONITOR_GROWING_S = 5 };

typedef struct {
    const char *name; /* of the field of STATS */
    uint32_t value;
    uint32_t growth;     /* from the STATS before to the one in which it last grew */
    uint32_t grew_at_ms; /* the device's uptime then */
    bool growing, usual; /* in the last MONITOR_GROWING_S; grows in a device that is well, too */
} monitor_counter;

/* The poses as the device receives them, from the POSE and its time that each ANGLES names. */
typedef struct {
    uint32_t intervals_n;
    double mean_ms, jitter_ms, longest_ms; /* between neighbours; jitter: standard deviation */
} monitor_intervals;

/* A window of time being filled; private. */
typedef struct {
    uint64_t start_us;
    uint32_t angles_n, flags_n[MONITOR_FLAGS_N], intervals_n, tick_max_us;
    double sum_ms, squares_ms2, longest_ms;
} monitor_window;

typedef struct {
    const char *port; /* borrowed */
    message_hello device;
    bool connected;
    char why[PORT_WHY_BYTES]; /* while not connected */

    bool heartbeat_known, angles_known, stats_known, fault_known;
    message_heartbeat heartbeat;
    message_angles angles; /* the newest */
    message_fault fault;   /* the newest of this session */
    uint8_t state;         /* newest of HEARTBEAT and ANGLES */
    message_touch touch;   /* the newest; none for two HEARTBEATs: nothing touches */
    int beats_since_touch;
    double largest_deg; /* of any angle since begin: for the scale of bars */

    /* in the last second */
    double angles_hz;
    double flags_share[MONITOR_FLAGS_N]; /* of the ANGLES: by bit of the angles flags */
    uint32_t tick_max_us;
    monitor_intervals poses;

    /* between the last two STATS */
    bool rates_known;
    double accepted_hz, refused_hz, lost_hz;
    uint32_t uptime_ms; /* of the newest STATS */
    int counters_n;
    monitor_counter counters[MONITOR_COUNTERS_MAX];

    /* Of who streams through the same session; NULL: nobody does. Set after begin, borrowed. */
    const pose_delays *delays;

    monitor_window window;
    bool echo_known;
    uint16_t echo_seq;
    uint32_t echo_us; /* the device's clock when it received that pose */
} monitor_state;

void monitor_state_init(monitor_state *m);

/* A session has begun, with this answer to HELLO: all that was known of the one before is forgotten. `port`
 * must live as long as m. */
void monitor_state_begin(monitor_state *m, const char *port, const message_hello *device);

/* Any message of the device; device_us: the t_us of its frame. Types of no interest are ignored. */
void monitor_state_take(monitor_state *m, const message *message, uint32_t device_us);

/* The session is over; what was known stays to be seen. */
void monitor_state_lost(monitor_state *m, const char *why);

/* An angle of ANGLES in degrees; NaN where there is none. */
double monitor_angle_deg(int16_t tenth_mrad);

/* Closes the window of the rates when its second is over. To be called at least once a second. */
void monitor_state_refresh(monitor_state *m, uint64_t now_us);

#endif
