/* stream_session.c - beginning and end of a stream's sessions: who is there, its counters before and after. */
#include <stdio.h>

#include "interrupt.h"
#include "stats_request.h"
#include "stream.h"

enum { RETRY_US = 250000, STATS_TRIES_N = 5, STATS_PAUSE_US = 20000 };

static void hear(void *context, const message *m, const frame *f, uint64_t at_us)
{
    stream *st = context;
    monitor_state_take(&st->monitor, m, f->t_us);
    switch (m->type) {
    case MESSAGE_ANGLES:
        st->state = m->angles.state;
        st->angles_n++;
        pose_delays_angles(st->delays, &m->angles, f->t_us, at_us, &st->s.clock);
        angles_csv_add(st->csv, &m->angles);
        graphics_angles(st->graphics, &m->angles);
        break;
    case MESSAGE_NODES:
        graphics_nodes(st->graphics, &m->nodes);
        break;
    case MESSAGE_POSE_LOG:
        pose_track_add(st->options.poses, &m->pose_log);
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

static double poses_hz(const stream *st)
{
    const bool paced = st->source->options.live == NULL && st->options.speed > 0.0;
    return !paced || !st->options.arm /* who only computes may be slow */
               ? 0.0
               : st->options.speed / source_interval_s(st->source);
}

static int begin_session(stream *st)
{
    st->in_session = true;
    monitor_state_begin(&st->monitor, st->options.port, &st->s.device);
    st->monitor.delays = st->delays;
    st->session_sent_n = 0;
    pose_delays_session(st->delays, st->s.device.tick_hz);
    st->s.listener = hear;
    st->s.context = st;
    snprintf(st->device, sizeof st->device, "%s %s", st->s.device.device, st->s.device.build);
    st->links_n = st->s.device.links_n;
    int result = session_wait_for_state(&st->s);
    st->state = st->s.heartbeat.state;
    if (result == SIM_OK) {
        result = pose_track_begin(st->options.poses, &st->s);
    }
    if (result == SIM_OK) {
        result = stream_scene_begin(st->options.scene, &st->s, source_origin_m(st->source));
    }
    if (result == SIM_OK) {
        result = stats_request(&st->s, &st->before);
    }
    if (result == SIM_OK) {
        stream_begin_graphics(st);
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

int stream_find_again(stream *st)
{
    const uint64_t lost_us = limber_now_us();
    const message_stats before = st->before;
    const uint64_t sent_n = st->session_sent_n, unseen_n = pose_delays_unseen(st->delays);
    const bool armed = st->arming != ARMING_OFF;
    monitor_state_lost(&st->monitor, st->s.why);
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

/* Complains of a session that could not be opened, with the numbers that only the stream knows. */
static int refuse_opening(stream *st)
{
    if (interrupt_came()) {
        return LIMBER_INTERRUPTED;
    }
    return st->s.refusal == REASON_POSES_TOO_SLOW
               ? limber_refuse("%s: %.1f poses a second are too slow: %s", st->source->name,
                               poses_hz(st), st->s.why)
               : limber_refuse("%s", st->s.why);
}

int stream_open(stream *st)
{
    if (!session_open(&st->s, st->options.port, (float)poses_hz(st))) {
        return refuse_opening(st);
    }
    port_warn_of_latency_timer(&st->s.port);
    st->csv->tick_hz = (double)st->s.device.tick_hz > 0.0 ? (double)st->s.device.tick_hz : 1000.0;
    int result = begin_session(st);
    if (result == SIM_OK) {
        result = stream_check_pace(st);
    }
    if (result != SIM_OK) {
        session_close(&st->s);
        st->in_session = false;
    }
    return result;
}

int stream_settle(stream *st)
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
