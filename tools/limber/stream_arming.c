/* stream_arming.c - the way from DISARMED to following the poses and back. */
#include <stdio.h>

#include "stream.h"
#include "texts.h"

/* The device's parameter that says how long it waits for the next pose, ms. */
static const char HOLD_PARAMETER[] = "pose_hold";

enum {
    GOOD_MAX_US = 1000000, /* then ARM is tried anyway: its refusal tells more than waiting */
    ASK_AGAIN_US = 100000,
    ASK_MAX_US = 4000000,
    BLEND_MAX_US = 10000000,
};

int stream_check_pace(stream *st)
{
    message ask = {.type = MESSAGE_PARAM_GET, .param_get = {.which = PARAM_IN_FORCE}};
    if (!st->options.arm || st->source->options.live != NULL || !(st->options.speed > 0.0)) {
        return SIM_OK;
    }
    snprintf(ask.param_get.name, sizeof ask.param_get.name, "%s", HOLD_PARAMETER);
    if (session_try(&st->s, &ask) != REQUEST_DONE || st->s.answer.param_value.values_n != 1) {
        return st->s.lost ? session_complain(&st->s) : SIM_OK; /* it will refuse ARM by itself */
    }
    const double hold_ms = (double)st->s.answer.param_value.values[0];
    const double interval_ms = source_interval_s(st->source) / st->options.speed * 1e3;
    if (interval_ms <= hold_ms) {
        return SIM_OK;
    }
    return limber_refuse("%s: a pose every %.1f ms (%.1f a second) is too slow: the device holds "
                         "still after %g ms without one and would stop and go; --resample 100 "
                         "fills in poses",
                         st->source->name, interval_ms, 1e3 / interval_ms, hold_ms);
}

void stream_begin_arming(stream *st)
{
    st->arming = ARMING_WAIT;
    st->arming_us = limber_now_us();
    st->asked_us = 0;
}

static void ask(stream *st)
{
    st->arming = ARMING_ASKED;
    st->asked_us = limber_now_us();
    st->maybe_armed = true;
    session_ask(&st->s, &(message){.type = MESSAGE_ARM});
}

/* An answer to ARM: torque, another try, or the end. */
static void take_answer(stream *st, uint64_t now_us)
{
    const uint8_t reason = st->s.answer.nack.reason;
    if (st->s.request == REQUEST_DONE) {
        st->arming = ARMING_BLEND;
        st->s.heartbeat_known = false; /* the state from here on */
    } else if (st->s.request == REQUEST_REFUSED && reason == REASON_STATE &&
               (st->state == DEVICE_ARMING || st->state == DEVICE_ACTIVE)) {
        st->arming = ARMING_BLEND; /* somebody has armed it before us */
    } else if (st->s.request == REQUEST_REFUSED && now_us - st->arming_us < ASK_MAX_US &&
               (reason == REASON_NO_POSES || reason == REASON_BUSY)) {
        st->arming = ARMING_WAIT;
    } else {
        (void)session_complain(&st->s);
        st->maybe_armed = st->s.request != REQUEST_REFUSED;
        st->arming = ARMING_FAILED;
    }
}

void stream_step_arming(stream *st)
{
    const uint64_t now_us = limber_now_us();
    if (st->s.lost) {
        return;
    }
    switch (st->arming) {
    case ARMING_WAIT:
        if (st->s.request != REQUEST_WAITING && st->session_sent_n > 0 &&
            now_us - st->asked_us >= ASK_AGAIN_US &&
            ((st->s.heartbeat_known && (st->s.heartbeat.flags & HEARTBEAT_POSES_GOOD) != 0) ||
             now_us - st->arming_us >= GOOD_MAX_US)) {
            ask(st);
        }
        break;
    case ARMING_ASKED:
        if (st->s.request != REQUEST_WAITING) {
            take_answer(st, now_us);
        }
        break;
    case ARMING_BLEND:
        if (!st->s.heartbeat_known) {
            break;
        }
        if (st->s.heartbeat.state == DEVICE_ACTIVE) {
            st->arming = ARMING_DONE;
            if (st->armings_n++ > 0) {
                limber_note("the device is ACTIVE again");
            }
        } else if (now_us - st->asked_us > BLEND_MAX_US) {
            (void)limber_refuse("the device is still %s 10 s after ARM; limber info",
                                session_state_name(&st->s));
            st->arming = ARMING_FAILED;
        }
        break;
    default:
        break;
    }
}

bool stream_was_dropped(stream *st)
{
    const bool watched =
        (st->arming == ARMING_BLEND || st->arming == ARMING_DONE) && st->s.heartbeat_known;
    if (!watched || st->state == DEVICE_ARMING || st->state == DEVICE_ACTIVE ||
        st->state == DEVICE_HOLD) {
        return false;
    }
    const bool waited = st->state == DEVICE_RELAX || st->state == DEVICE_LIMP;
    if (waited && st->source->options.live != NULL) {
        limber_note(
            "the device waited for too long and is in %s; it is armed again when poses come",
            message_value_name(&message_values_device_states, st->state));
        stream_begin_arming(st);
        return false;
    }
    const char *const advice =
        st->state == DEVICE_FAULT || st->state == DEVICE_ESTOP ? "limber info tells why, limber "
                                                                 "clear leaves it"
        : waited ? "no poses came for too long; --resample 100 fills the gaps of a track"
                 : "somebody else has disarmed it";
    (void)limber_refuse("the device stopped following after %.1f s: it is in %s (%s); %s",
                        st->played_s, message_value_name(&message_values_device_states, st->state),
                        message_value_meaning(&message_values_device_states, st->state), advice);
    return true;
}

int stream_disarm(stream *st)
{
    if (!st->maybe_armed) {
        return SIM_OK;
    }
    if (st->s.lost || !st->in_session) {
        limber_note("it could not be told to disarm; without poses it holds, relaxes and goes limp "
                    "by itself");
        return SIM_OK;
    }
    st->arming = ARMING_OFF;
    const int result = session_request(&st->s, &(message){.type = MESSAGE_DISARM});
    st->maybe_armed = result != SIM_OK;
    return result;
}
