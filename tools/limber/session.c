/* session.c - see session.h; the opening is session_hello.c. */
#include "session.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "interrupt.h"
#include "texts.h"

enum {
    REPEAT_US = 50000,
    REPEATS_N = 3,
    ANSWER_MAX_US = 500000,
    LONG_ANSWER_MAX_US = 5000000,
    SYNC_US = 1000000,
    WAIT_MAX_US = 50000, /* so that an interrupt between two waits is not slept over */
};

static void lose(session *s)
{
    s->lost = true;
    if (s->request == REQUEST_WAITING) {
        s->request = REQUEST_UNANSWERED;
    }
}

uint16_t session_next_seq(const session *s, message_type type)
{
    return s->seq[type];
}

bool session_send(session *s, const message *m)
{
    return session_send_at(s, m, limber_now_us());
}

bool session_send_at(session *s, const message *m, uint64_t at_us)
{
    uint8_t wire[FRAME_WIRE_MAX];
    const size_t n = messages_encode(m, s->id, s->seq[m->type], (uint32_t)at_us, wire, sizeof wire);
    s->seq[m->type]++;
    if (s->lost || !port_write(&s->port, wire, n, s->why)) {
        lose(s);
        return false;
    }
    return true;
}

/* --- requests -------------------------------------------------------------------------------------- */

/* The id of a request is its first field, whatever it asks for. */
static void put_id(message *m, uint16_t id)
{
    memcpy((char *)m + messages_info(m->type)->fields[0].offset, &id, sizeof id);
}

void session_ask(session *s, const message *request)
{
    s->last_id = (uint16_t)(s->last_id == UINT16_MAX ? 1 : s->last_id + 1);
    s->asked = *request;
    s->asked_id = s->last_id;
    put_id(&s->asked, s->asked_id);
    s->asked_us = s->repeated_us = limber_now_us();
    s->asked_n = 1;
    s->request = REQUEST_WAITING;
    (void)session_send(s, &s->asked);
}

/* Flash and servos are slow: the answer comes when it is done. Repeats in between do no harm. */
static uint64_t answer_max_us(uint8_t asked)
{
    switch (asked) {
    case MESSAGE_ARM:
    case MESSAGE_PARAM_SAVE:
    case MESSAGE_SERVO_ASSIGN:
    case MESSAGE_SERVO_PING:
    case MESSAGE_SERVO_SET_BAUD:
    case MESSAGE_SERVO_TEST:
        return LONG_ANSWER_MAX_US;
    default:
        return ANSWER_MAX_US;
    }
}

static void repeat_request(session *s, uint64_t now_us)
{
    if (s->request != REQUEST_WAITING) {
        return;
    }
    if (now_us - s->asked_us >= answer_max_us(s->asked.type)) {
        s->request = REQUEST_UNANSWERED;
    } else if (s->asked_n <= REPEATS_N && now_us - s->repeated_us >= REPEAT_US) {
        s->asked_n++;
        s->repeated_us = now_us;
        (void)session_send(s, &s->asked);
    }
}

static bool is_answer(const message *m, uint16_t *id)
{
    switch (m->type) {
    case MESSAGE_ACK:
    case MESSAGE_NACK:
    case MESSAGE_PARAM_INFO:
    case MESSAGE_PARAM_VALUE:
    case MESSAGE_PRESET_INFO:
    case MESSAGE_SERVO_INFO:
    case MESSAGE_SCENE_OBJECT:
    case MESSAGE_STATS:
        memcpy(id, (const char *)m + messages_info(m->type)->fields[0].offset, sizeof *id);
        return *id != 0;
    default:
        return false;
    }
}

/* What the request was asked for, should not be answered by a bare ACK. */
static bool fits(const message *answer, uint8_t asked)
{
    switch (asked) {
    case MESSAGE_STATS_GET:
        return answer->type == MESSAGE_STATS;
    case MESSAGE_PARAM_LIST:
        return answer->type == MESSAGE_PARAM_INFO;
    case MESSAGE_PARAM_GET:
        return answer->type == MESSAGE_PARAM_VALUE;
    case MESSAGE_PRESET_LIST:
        return answer->type == MESSAGE_PRESET_INFO;
    case MESSAGE_SERVO_PING:
        return answer->type == MESSAGE_SERVO_INFO;
    case MESSAGE_SCENE_GET:
        return answer->type == MESSAGE_SCENE_OBJECT;
    default:
        return answer->type == MESSAGE_ACK;
    }
}

static void take_answer(session *s, const message *m, uint16_t id)
{
    if (s->request != REQUEST_WAITING || id != s->asked_id) {
        return; /* answers to what was repeated come twice */
    }
    if (m->type == MESSAGE_NACK || fits(m, s->asked.type)) {
        s->answer = *m;
        s->request = m->type == MESSAGE_NACK ? REQUEST_REFUSED : REQUEST_DONE;
    }
}

request_state session_try(session *s, const message *request)
{
    session_ask(s, request);
    while (s->request == REQUEST_WAITING) {
        (void)session_step(s, limber_now_us() + WAIT_MAX_US, -1);
    }
    return s->request;
}

int session_complain(const session *s)
{
    if (s->lost) {
        return limber_refuse("lost the device: %s", s->why);
    }
    if (s->request == REQUEST_REFUSED) {
        char text[PORT_WHY_BYTES];
        texts_refusal(&s->answer.nack, text);
        return limber_refuse("%s", text);
    }
    return limber_refuse("the device does not answer %s, though it is alive; try again, or "
                         "reset it",
                         messages_name(s->asked.type));
}

int session_request(session *s, const message *request)
{
    return session_try(s, request) == REQUEST_DONE ? SIM_OK : session_complain(s);
}

/* --- what comes ------------------------------------------------------------------------------------ */

static void take_message(session *s, const message *m, const frame *f, uint64_t at_us)
{
    uint16_t id;
    switch (m->type) {
    case MESSAGE_HELLO:
        if (m->hello.request_id == s->hello_id) {
            s->device = m->hello;
            s->greeted = true;
        } else if (m->hello.request_id == 0 && s->greeted) {
            snprintf(s->why, sizeof s->why, "it restarted by itself; limber info tells why");
            lose(s);
        }
        break;
    case MESSAGE_BOOT_REPORT:
        s->boot = m->boot_report;
        s->boot_known = true;
        break;
    case MESSAGE_HEARTBEAT:
        s->heartbeat = m->heartbeat;
        s->heartbeat_known = true;
        break;
    case MESSAGE_ROD_STATS:
        s->rod_stats = m->rod_stats;
        break;
    case MESSAGE_TIMESYNC_ANSWER:
        clock_sync_add(&s->clock, m->timesync_answer.t1_us, m->timesync_answer.t2_us,
                       m->timesync_answer.t3_us, at_us);
        break;
    case MESSAGE_PING:
        (void)session_send(s, &(message){.type = MESSAGE_PONG, .pong = {m->ping.token}});
        break;
    case MESSAGE_LOG:
        if (m->log.level <= LEVEL_WARNING) {
            limber_note("the device says: %s", m->log.text);
        }
        break;
    default:
        break;
    }
    if (is_answer(m, &id)) {
        take_answer(s, m, id);
    }
    if (s->listener != NULL) {
        s->listener(s->context, m, f, at_us);
    }
}

static void take_bytes(session *s, const uint8_t *bytes, size_t bytes_n)
{
    const uint64_t now_us = limber_now_us();
    for (size_t i = 0; i < bytes_n; i++, s->bytes_n++) {
        frame f;
        message m;
        if (s->bytes_n < sizeof s->first_bytes) {
            s->first_bytes[s->bytes_n] = bytes[i];
        }
        if (frame_decoder_push(&s->decoder, bytes[i], &f)) {
            s->heard_us = now_us;
            if (messages_unpack(&f, &m) == MESSAGES_OK) {
                take_message(s, &m, &f, now_us);
            }
        }
    }
}

static void read_port(session *s)
{
    uint8_t bytes[4096];
    for (int i = 0; i < 16 && !s->lost; i++) {
        const long n = port_read(&s->port, bytes, sizeof bytes, s->why);
        if (n < 0) {
            lose(s);
        }
        if (n <= 0) {
            return;
        }
        take_bytes(s, bytes, (size_t)n);
    }
}

static void keep_in_step(session *s, uint64_t now_us)
{
    if (s->greeted && now_us - s->synced_us >= SYNC_US) {
        s->synced_us = now_us;
        const message ask = clock_sync_ask(&s->clock, limber_now_us());
        (void)session_send(s, &ask);
    }
    if (s->greeted && now_us - s->heard_us > SESSION_SILENCE_MAX_US && !s->lost) {
        snprintf(s->why, sizeof s->why,
                 "nothing came from it for %.1f s; is the cable in, has it power?",
                 (double)(now_us - s->heard_us) * 1e-6);
        lose(s);
    }
}

bool session_step(session *s, uint64_t until_us, int other_fd)
{
    bool other = false;
    const uint64_t start_us = limber_now_us();
    const bool had_interrupt = interrupt_came();
    for (uint64_t now_us = start_us; !s->lost; now_us = limber_now_us()) {
        uint64_t wait_us = until_us > now_us ? until_us - now_us : 0;
        wait_us = wait_us < WAIT_MAX_US ? wait_us : WAIT_MAX_US;
        const port_events events = port_wait(&s->port, other_fd, (int64_t)wait_us);
        if (events.port) {
            read_port(s);
        }
        other = events.other;
        now_us = limber_now_us();
        repeat_request(s, now_us);
        keep_in_step(s, now_us);
        if (events.port || other || now_us >= until_us || interrupt_came() != had_interrupt) {
            break;
        }
    }
    return other;
}

int session_wait_for_state(session *s)
{
    const uint64_t until_us = limber_now_us() + SESSION_SILENCE_MAX_US;
    while (!s->heartbeat_known && !s->lost && limber_now_us() < until_us) {
        (void)session_step(s, until_us, -1);
    }
    if (s->lost) {
        return session_complain(s);
    }
    return s->heartbeat_known
               ? SIM_OK
               : limber_refuse("the device answers but sends no HEARTBEAT: its control loop "
                               "stands still; reset it");
}

const char *session_state_name(const session *s)
{
    return s->heartbeat_known
               ? message_value_name(&message_values_device_states, s->heartbeat.state)
               : "?";
}
