/* stream.c - see stream.h. */
#include "stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interrupt.h"

enum {
    LEAD_US_MIN = 5000,
    WINDOW_N = 16, /* poses on their way at most when nothing else sets the pace */
    PONG_MAX_US = 1000000,
    IDLE_US = 50000,
    LIVE_IDLE_US = 20000,
};

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
                 .source = st->source->options.live != NULL ? SOURCE_UNKNOWN : SOURCE_RECORDED}};
    pose_delays_sent(st->delays, session_next_seq(&st->s, MESSAGE_POSE), now_us);
    (void)session_send_at(&st->s, &m, now_us);
    st->session_sent_n++;
}

/* --- play ------------------------------------------------------------------------------------------ */

/* After every step: lost, stopped, dropped? False with *result where it is over. */
static bool goes_on(stream *st, int *result)
{
    stream_step_arming(st);
    stream_scene_step(st->options.scene, &st->s, source_origin_m(st->source));
    stream_show_progress(st);
    if (interrupt_came()) {
        st->interrupted = true;
    } else if (st->s.lost && st->options.reconnect) {
        limber_note("lost the device: %s; trying again until it is back (Ctrl-C stops)", st->s.why);
        *result = stream_find_again(st);
        st->interrupted = interrupt_came();
        if (st->source->options.live != NULL) {
            st->skipped_n += (uint64_t)live_source_skip(&st->source->input);
        }
    } else if (st->s.lost) {
        *result = limber_refuse("lost the device: %s (--reconnect would try again)", st->s.why);
    } else if (st->arming == ARMING_FAILED || stream_was_dropped(st)) {
        *result = LIMBER_DEVICE;
    }
    return *result == SIM_OK && !st->interrupted;
}

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
    live_source *const input = &st->source->input;
    int result = SIM_OK;
    if (st->options.arm) {
        stream_begin_arming(st);
    }
    st->play_us = limber_now_us();
    while (!input->ended && goes_on(st, &result)) {
        source_pose pose;
        live_source_read(input, session_step(&st->s, limber_now_us() + LIVE_IDLE_US, input->fd));
        while (!st->s.lost && source_next_live(st->source, &pose)) {
            stream_send(st, &pose.pose, pose.captured_us);
            st->played_n++;
            st->played_s = pose.t_s;
        }
        if (live_source_is_silent(input)) {
            st->arming_us = limber_now_us(); /* arming has the time it needs once poses come */
        }
    }
    return result;
}

/* --- all of it ------------------------------------------------------------------------------------- */

static int finish(stream *st, int result)
{
    st->end_us = limber_now_us();
    st->end_state = st->state;
    const int disarmed = stream_disarm(st);
    pose_track_end(st->options.poses, st->in_session ? &st->s : NULL);
    stream_end_graphics(st);
    result = result == SIM_OK ? disarmed : result;
    if (!st->in_session) {
        return result;
    }
    if (st->s.lost) {
        account_unknown(&st->account, st->session_sent_n);
        return result;
    }
    const int settled = stream_settle(st);
    return result == SIM_OK ? settled : result;
}

int stream_run(stream *st, const stream_options *options, source *src, angles_csv *csv,
               graphics *drawn)
{
    *st = (stream){.options = *options, .source = src, .csv = csv, .graphics = drawn};
    st->delays = pose_delays_new();
    if (st->delays == NULL) {
        return SIM_INTERNAL;
    }
    int result = stream_open(st);
    if (result != SIM_OK) {
        return result;
    }
    result = src->options.live != NULL ? play_live(st) : play_track(st);
    result = finish(st, result);
    session_close(&st->s);
    if (result == SIM_OK && !account_balances(&st->account)) {
        result = LIMBER_UNBALANCED;
    }
    /* live sources have no other end */
    return result == SIM_OK && st->interrupted && src->options.live == NULL ? LIMBER_INTERRUPTED
                                                                            : result;
}

void stream_free(stream *st)
{
    free(st->delays);
    st->delays = NULL;
}
