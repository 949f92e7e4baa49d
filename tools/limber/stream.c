/* stream.c - see stream.h. */
#include "stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interrupt.h"
#include "stats_request.h"

enum {
    LEAD_US_MIN = 5000,
    RETRY_US = 250000,
    STATS_TRIES_N = 5,
    STATS_PAUSE_US = 20000,
    WINDOW_N = 16, /* poses on their way at most when nothing else sets the pace */
    PONG_MAX_US = 1000000,
    IDLE_US = 50000,
};

static void listen(void *context, const message *m, const frame *f, uint64_t at_us)
{
    stream *st = context;
    switch (m->type) {
    case MESSAGE_ANGLES:
        st->state = m->angles.state;
        st->angles_n++;
        pose_delays_angles(st->delays, &m->angles, f->t_us, at_us, &st->s.clock);
        angles_csv_add(st->csv, &m->angles);
        break;
    case MESSAGE_HEARTBEAT:
        st->state = m->heartbeat.state;
        break;
    case MESSAGE_PONG:
        st->pong_came = st->pong_came || m->pong.token == st->pings_n;
        break;
    case MESSAGE_FAULT:
        limber_note("the device reports fault %s: %s%s%s",
                    message_value_name(&message_values_faults, m->fault.fault),
                    message_value_meaning(&message_values_faults, m->fault.fault),
                    m->fault.text[0] == '\0' ? "" : "; ", m->fault.text);
        break;
    default:
        break;
    }
}

void stream_send(stream *st, const rod_pose *pose, uint64_t captured_us)
{
    uint64_t now_us = limber_now_us();
    /* two poses of one moment would be one too many for the device */
    if (captured_us <= st->captured_us) {
        captured_us = st->captured_us + 1;
        while (now_us < captured_us) {
            now_us = limber_now_us();
        }
    }
    st->captured_us = captured_us;
    const uint64_t age_us = now_us > captured_us ? now_us - captured_us : 0;
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    const message m = {
        .type = MESSAGE_POSE,
        .pose = {.position_m = {p.x, p.y, p.z},
                 .quaternion_xyzw = {q.x, q.y, q.z, q.w},
                 .age_us = (uint16_t)(age_us < UINT16_MAX ? age_us : UINT16_MAX),
                 .quality = UINT8_MAX,
                 .source = st->source->options.live ? SOURCE_UNKNOWN : SOURCE_RECORDED}};
    pose_delays_sent(st->delays, session_next_seq(&st->s, MESSAGE_POSE), now_us);
    (void)session_send_at(&st->s, &m, now_us);
    st->session_sent_n++;
}

/* --- sessions -------------------------------------------------------------------------------------- */

static double poses_hz(const stream *st)
{
    const bool paced = !st->source->options.live && st->options.speed > 0.0;
    return !paced || !st->options.arm /* who only computes may be slow */
               ? 0.0
               : st->options.speed / source_interval_s(st->source);
}

static int begin_session(stream *st)
{
    st->in_session = true;
    st->session_sent_n = 0;
    pose_delays_session(st->delays, st->s.device.tick_hz);
    st->s.listener = listen;
    st->s.context = st;
    snprintf(st->device, sizeof st->device, "%s %s", st->s.device.device, st->s.device.build);
    st->links_n = st->s.device.links_n;
    int result = session_wait_for_state(&st->s);
    st->state = st->s.heartbeat.state;
    if (result == SIM_OK) {
        result = stats_request(&st->s, &st->before);
    }
    return result;
}

/* Its counters went on if it has been up for as long as it must have been. */
static bool kept_its_counters(const message_stats *before, const message_stats *after,
                              uint64_t apart_us)
{
    const uint32_t up_ms = after->uptime_ms - before->uptime_ms;
    return up_ms + 1000 >= apart_us / 1000 && up_ms <= apart_us / 1000 + 60000;
}

/* The device is lost: ask again and again, as long as nobody says stop. SIM_OK with a new session. */
static int find_again(stream *st)
{
    const uint64_t lost_us = limber_now_us();
    const message_stats before = st->before;
    const uint64_t sent_n = st->session_sent_n, unseen_n = pose_delays_unseen(st->delays);
    const bool armed = st->arming != ARMING_OFF;
    session_close(&st->s);
    st->in_session = false;
    while (!session_open(&st->s, st->options.port, (float)poses_hz(st))) {
        if (interrupt_came()) {
            account_unknown(&st->account, sent_n);
            return SIM_OK;
        }
        for (uint64_t now_us = limber_now_us(), until_us = now_us + RETRY_US;
             now_us < until_us && !interrupt_came(); now_us = limber_now_us()) {
            (void)port_wait(&(port){.fd = -1}, -1, (int64_t)(until_us - now_us));
        }
    }
    const int result = begin_session(st);
    if (result != SIM_OK) {
        account_unknown(&st->account, sent_n);
        return result;
    }
    st->reconnects_n++;
    st->back_us = limber_now_us();
    if (kept_its_counters(&before, &st->before, limber_now_us() - lost_us)) {
        (void)account_session(&st->account, sent_n, &before, &st->before, unseen_n, true);
    } else {
        account_unknown(&st->account, sent_n);
    }
    limber_note("the device is back after %.1f s, state %s%s",
                (double)(limber_now_us() - lost_us) * 1e-6,
                message_value_name(&message_values_device_states, st->state),
                !armed || st->state == DEVICE_ACTIVE || st->state == DEVICE_HOLD ? ""
                : st->options.rearm ? "; it will be armed again"
                                    : "; it stays without torque (--rearm would arm it again)");
    if (armed && st->state != DEVICE_ACTIVE && st->state != DEVICE_HOLD) {
        st->arming = ARMING_OFF;
        if (st->options.rearm) {
            stream_begin_arming(st);
        }
    }
    return SIM_OK;
}

/* After every step: lost, stopped, dropped? False with *result where it is over. */
static bool goes_on(stream *st, int *result)
{
    stream_step_arming(st);
    stream_show_progress(st);
    if (interrupt_came()) {
        st->interrupted = true;
    } else if (st->s.lost && st->options.reconnect) {
        limber_note("lost the device: %s; trying again until it is back (Ctrl-C stops)", st->s.why);
        *result = find_again(st);
        st->interrupted = interrupt_came();
    } else if (st->s.lost) {
        *result = limber_refuse("lost the device: %s (--reconnect would try again)", st->s.why);
    } else if (st->arming == ARMING_FAILED || stream_was_dropped(st)) {
        *result = LIMBER_DEVICE;
    }
    return *result == SIM_OK && !st->interrupted;
}

/* --- play ------------------------------------------------------------------------------------------ */

/* Sends one pose over and over until the device follows: the track begins when the rod does. */
static int lead_in(stream *st, const rod_pose *first)
{
    const double interval_us = source_interval_s(st->source) * 1e6;
    const double pace = st->options.speed > 0.0 ? st->options.speed : 1.0;
    const uint64_t every_us =
        interval_us / pace > LEAD_US_MIN ? (uint64_t)(interval_us / pace) : LEAD_US_MIN;
    uint64_t due_us = limber_now_us();
    int result = SIM_OK;
    stream_begin_arming(st);
    while (st->arming != ARMING_DONE && st->arming != ARMING_OFF && goes_on(st, &result)) {
        if (limber_now_us() >= due_us) {
            stream_send(st, first, due_us);
            st->lead_n++;
            due_us += every_us;
            if (due_us < limber_now_us()) {
                due_us = limber_now_us(); /* the session was away */
            }
        }
        (void)session_step(&st->s, due_us, -1);
    }
    return result;
}

/* Where only the line sets the pace: no more than a window of poses on their way. */
static void wait_for_room(stream *st)
{
    if (st->session_sent_n % WINDOW_N != 0) {
        return;
    }
    const uint64_t until_us = limber_now_us() + PONG_MAX_US;
    st->pong_came = false;
    st->pings_n++;
    (void)session_send(&st->s, &(message){.type = MESSAGE_PING, .ping = {st->pings_n}});
    while (!st->pong_came && !st->s.lost && !interrupt_came() && limber_now_us() < until_us) {
        (void)session_step(&st->s, until_us, -1);
    }
}

static int play_track(stream *st)
{
    source_pose pose;
    int result = SIM_OK;
    bool more = source_next(st->source, &pose);
    if (st->options.arm && more) {
        result = lead_in(st, &pose.pose);
    }
    st->play_us = limber_now_us();
    for (; more && result == SIM_OK && !st->interrupted; more = source_next(st->source, &pose)) {
        uint64_t due_us = limber_now_us();
        if (st->options.speed > 0.0) {
            due_us = st->play_us + (uint64_t)(pose.t_s / st->options.speed * 1e6);
        }
        bool on = goes_on(st, &result);
        while (on && limber_now_us() < due_us) {
            (void)session_step(&st->s, due_us, -1);
            on = goes_on(st, &result);
        }
        if (!on) {
            break;
        }
        if (due_us + IDLE_US < st->back_us) {
            st->skipped_n++; /* its moment has passed while the device was away */
            continue;
        }
        stream_send(st, &pose.pose, due_us);
        st->played_n++;
        st->played_s = pose.t_s;
        if (!(st->options.speed > 0.0)) {
            wait_for_room(st);
        }
    }
    return result;
}

static int play_live(stream *st)
{
    live_lines *const lines = &st->source->lines;
    int result = SIM_OK;
    if (st->options.arm) {
        stream_begin_arming(st);
    }
    st->play_us = limber_now_us();
    while (!lines->ended && goes_on(st, &result)) {
        source_pose pose;
        if (session_step(&st->s, limber_now_us() + IDLE_US, lines->fd)) {
            live_lines_read(lines);
        }
        while (!st->s.lost && source_next_live(st->source, &pose)) {
            stream_send(st, &pose.pose, limber_now_us());
            st->played_n++;
            st->played_s = pose.t_s;
        }
    }
    return result;
}

/* --- all of it ------------------------------------------------------------------------------------- */

/* Poses may still be on their way into a tick: asked again before anything is called unaccounted for. */
static int settle(stream *st)
{
    message_stats after;
    const uint64_t unseen_n = pose_delays_unseen(st->delays);
    for (int i = 1;; i++) {
        const int result = stats_request(&st->s, &after);
        if (result != SIM_OK) {
            account_unknown(&st->account, st->session_sent_n);
            return result;
        }
        const bool final = i == STATS_TRIES_N;
        if (account_session(&st->account, st->session_sent_n, &st->before, &after, 0, false) == 0 ||
            final) {
            (void)account_session(&st->account, st->session_sent_n, &st->before, &after, unseen_n,
                                  true);
            return SIM_OK;
        }
        const uint64_t until_us = limber_now_us() + STATS_PAUSE_US;
        while (limber_now_us() < until_us && !st->s.lost) {
            (void)session_step(&st->s, until_us, -1);
        }
    }
}

static int finish(stream *st, int result)
{
    st->end_us = limber_now_us();
    const int disarmed = stream_disarm(st);
    result = result == SIM_OK ? disarmed : result;
    if (!st->in_session) {
        return result;
    }
    if (st->s.lost) {
        account_unknown(&st->account, st->session_sent_n);
        return result;
    }
    const int settled = settle(st);
    return result == SIM_OK ? settled : result;
}

int stream_run(stream *st, const stream_options *options, source *src, angles_csv *csv)
{
    *st = (stream){.options = *options, .source = src, .csv = csv};
    st->delays = pose_delays_new();
    if (st->delays == NULL) {
        return SIM_INTERNAL;
    }
    int result = session_start(&st->s, options->port, (float)poses_hz(st));
    if (result == SIM_OK) {
        csv->tick_hz = (double)st->s.device.tick_hz > 0.0 ? (double)st->s.device.tick_hz : 1000.0;
        result = begin_session(st);
    }
    if (result == SIM_OK) {
        result = stream_check_pace(st);
    }
    if (result != SIM_OK) {
        session_close(&st->s);
        st->in_session = false;
        return result;
    }
    result = src->options.live ? play_live(st) : play_track(st);
    result = finish(st, result);
    session_close(&st->s);
    if (result == SIM_OK && !account_balances(&st->account)) {
        result = LIMBER_UNBALANCED;
    }
    /* live lines have no other end */
    return result == SIM_OK && st->interrupted && !src->options.live ? LIMBER_INTERRUPTED : result;
}

void stream_free(stream *st)
{
    free(st->delays);
    st->delays = NULL;
}
