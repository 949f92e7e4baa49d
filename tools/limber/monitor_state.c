/* monitor_state.c - see monitor_state.h. */
#include "monitor_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "stats_request.h"

enum { WINDOW_US = 900000, STATS_APART_MIN_MS = 500 };

static const double RAD_OF_TENTH_MRAD = 1e-4, DEG_OF_RAD = 57.295779513082323;

double monitor_angle_deg(int16_t tenth_mrad)
{
    return tenth_mrad == MESSAGES_ANGLE_INVALID ? (double)NAN
                                                : tenth_mrad * RAD_OF_TENTH_MRAD * DEG_OF_RAD;
}

void monitor_state_init(monitor_state *m)
{
    *m = (monitor_state){.port = "", .state = DEVICE_BOOT};
}

void monitor_state_begin(monitor_state *m, const char *port, const message_hello *device)
{
    monitor_state_init(m);
    m->port = port;
    m->device = *device;
    m->connected = true;
}

void monitor_state_lost(monitor_state *m, const char *why)
{
    m->connected = false;
    snprintf(m->why, sizeof m->why, "%s", why);
}

/* --- ANGLES ---------------------------------------------------------------------------------------- */

/* Each ANGLES names the newest POSE and when it was received. More than one may have come since the one
 * before: then their mean interval stands for each, and the longest of them cannot be told. */
static void take_echo(monitor_state *m, const message_angles *a, uint32_t device_us)
{
    if ((a->flags & ANGLES_NO_POSE) != 0 || a->received_ago_us == UINT16_MAX) {
        m->echo_known = false;
        return;
    }
    const uint16_t poses_n = (uint16_t)(a->pose_seq - m->echo_seq);
    const uint32_t received_us = device_us - a->received_ago_us;
    if (m->echo_known && poses_n == 0) {
        return;
    }
    if (m->echo_known && poses_n <= INT16_MAX) {
        const double apart_ms = (double)(received_us - m->echo_us) * 1e-3 / poses_n;
        m->window.intervals_n += poses_n;
        m->window.sum_ms += apart_ms * poses_n;
        m->window.squares_ms2 += apart_ms * apart_ms * poses_n;
        m->window.longest_ms = fmax(m->window.longest_ms, apart_ms);
    }
    m->echo_known = true;
    m->echo_seq = a->pose_seq;
    m->echo_us = received_us;
}

static void take_angles(monitor_state *m, const message_angles *a, uint32_t device_us)
{
    m->angles = *a;
    m->angles_known = true;
    m->state = a->state;
    m->window.angles_n++;
    for (int bit = 0; bit < MONITOR_FLAGS_N; bit++) {
        m->window.flags_n[bit] += a->flags >> bit & 1u;
    }
    for (int joint = 0; joint < a->angles_n; joint++) {
        for (int i = 0; i < 2; i++) {
            /* fmax passes over the NaN of a missing angle */
            m->largest_deg =
                fmax(m->largest_deg, fabs(monitor_angle_deg(a->angles_tenth_mrad[joint][i])));
        }
    }
    take_echo(m, a, device_us);
}

/* --- STATS ----------------------------------------------------------------------------------------- */

/* What grows in a device that is well. A counter that a later version adds counts as trouble. */
static bool is_usual(const char *name)
{
    static const char *const USUAL[] = {"frames_good", "poses_accepted", "commands_done",
                                        "clock_exchanges"};
    for (size_t i = 0; i < sizeof USUAL / sizeof USUAL[0]; i++) {
        if (strcmp(name, USUAL[i]) == 0) {
            return true;
        }
    }
    return false;
}

typedef struct {
    monitor_state *state;
    int index;
    uint32_t uptime_ms, apart_ms; /* since the STATS before; 0: there was none */
} counting;

/* The counters always come in the same order. */
static void take_counter(void *context, const char *name, uint32_t value)
{
    counting *const c = context;
    monitor_state *const m = c->state;
    if (strcmp(name, "uptime_ms") == 0 || strcmp(name, "tick_max_us") == 0 ||
        c->index == MONITOR_COUNTERS_MAX) {
        return; /* the first two count nothing */
    }
    monitor_counter *const counter = &m->counters[c->index++];
    /* poses_lost shrinks when a pose comes late after all */
    const int32_t change = c->apart_ms > 0 ? (int32_t)(value - counter->value) : 0;
    const uint32_t growth = change > 0 ? (uint32_t)change : 0;
    counter->name = name;
    counter->usual = is_usual(name);
    counter->value = value;
    if (growth > 0) {
        counter->growth = growth;
        counter->grew_at_ms = c->uptime_ms;
    }
    counter->growing =
        counter->growth > 0 && c->uptime_ms - counter->grew_at_ms < MONITOR_GROWING_S * 1000u;
    const double growth_hz = c->apart_ms > 0 ? growth * 1e3 / c->apart_ms : 0.0;
    if (strcmp(name, "poses_accepted") == 0) {
        m->accepted_hz = growth_hz;
    } else if (strcmp(name, "poses_lost") == 0) {
        m->lost_hz = growth_hz;
    } else if (strncmp(name, "poses_", 6) == 0) {
        m->refused_hz += growth_hz;
    }
}

static void take_stats(monitor_state *m, const message_stats *stats)
{
    counting c = {.state = m, .uptime_ms = stats->uptime_ms};
    if (m->stats_known) {
        c.apart_ms = stats->uptime_ms - m->uptime_ms;
        if (c.apart_ms < STATS_APART_MIN_MS) {
            return; /* one that was asked for: too close for a rate */
        }
    }
    m->refused_hz = 0.0;
    m->rates_known = c.apart_ms > 0;
    stats_each(stats, take_counter, &c);
    m->counters_n = c.index;
    m->uptime_ms = stats->uptime_ms;
    m->stats_known = true;
}

/* --- all ------------------------------------------------------------------------------------------- */

void monitor_state_take(monitor_state *m, const message *message, uint32_t device_us)
{
    switch (message->type) {
    case MESSAGE_HEARTBEAT:
        m->heartbeat = message->heartbeat;
        m->heartbeat_known = true;
        m->state = m->heartbeat.state;
        if (++m->beats_since_touch > 2) {
            m->touch = (message_touch){0}; /* the one that said so was lost */
        }
        if (m->heartbeat.tick_max_us > m->window.tick_max_us) {
            m->window.tick_max_us = m->heartbeat.tick_max_us;
        }
        break;
    case MESSAGE_ANGLES:
        take_angles(m, &message->angles, device_us);
        break;
    case MESSAGE_STATS:
        take_stats(m, &message->stats);
        break;
    case MESSAGE_TOUCH:
        m->touch = message->touch;
        m->beats_since_touch = 0;
        break;
    case MESSAGE_FAULT:
        m->fault = message->fault;
        m->fault_known = true;
        break;
    default:
        break;
    }
}

static monitor_intervals intervals_of(const monitor_window *w)
{
    if (w->intervals_n == 0) {
        return (monitor_intervals){0};
    }
    const double mean_ms = w->sum_ms / w->intervals_n;
    const double variance_ms2 = w->squares_ms2 / w->intervals_n - mean_ms * mean_ms;
    return (monitor_intervals){w->intervals_n, mean_ms, sqrt(fmax(variance_ms2, 0.0)),
                               w->longest_ms};
}

void monitor_state_refresh(monitor_state *m, uint64_t now_us)
{
    monitor_window *const w = &m->window;
    if (w->start_us == 0) {
        w->start_us = now_us;
    }
    if (now_us - w->start_us < WINDOW_US) {
        return;
    }
    m->angles_hz = w->angles_n * 1e6 / (double)(now_us - w->start_us);
    for (int bit = 0; bit < MONITOR_FLAGS_N; bit++) {
        m->flags_share[bit] = w->angles_n > 0 ? (double)w->flags_n[bit] / w->angles_n : 0.0;
    }
    m->tick_max_us = w->tick_max_us;
    m->poses = intervals_of(w);
    *w = (monitor_window){.start_us = now_us};
}
