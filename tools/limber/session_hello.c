/* session_hello.c - opening a session: HELLO until somebody answers, versions compared, clocks compared. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "interrupt.h"
#include "session.h"
#include "texts.h"

enum {
    HELLO_REPEAT_US = 200000,
    HELLO_MAX_US = 1000000,
    SYNC_ROUNDS_N = 8,
    SYNC_ROUND_US = 50000,
};

/* The beginning of what came, if it looks like text: it often tells what is on that port. */
static void quote(const session *s, char quoted[60])
{
    char text[41];
    int n = 0, letters_n = 0;
    for (; n < 40 && (uint64_t)n < s->bytes_n; n++) {
        const unsigned char c = s->first_bytes[n];
        letters_n += isprint(c) || isspace(c);
        text[n] = (char)(isprint(c) ? c : ' ');
    }
    text[n] = '\0';
    *quoted = '\0';
    if (n > 0 && letters_n == n) {
        snprintf(quoted, 60, ", beginning with '%s'", text);
    }
}

static void explain_silence(session *s)
{
    char quoted[60];
    if (s->bytes_n == 0) {
        snprintf(s->why, sizeof s->why,
                 "%.200s: nothing answers, not one byte; is the board powered and flashed, is it "
                 "this port (limber ports)?",
                 s->name);
    } else if (s->decoder.counts.good == 0) {
        quote(s, quoted);
        snprintf(s->why, sizeof s->why,
                 "%.200s: %llu bytes came, but no limber device speaks like that%s; is it "
                 "another port (limber ports), or another baud rate (serial:PATH@115200)?",
                 s->name, (unsigned long long)s->bytes_n, quoted);
    } else {
        snprintf(s->why, sizeof s->why,
                 "%.200s: a limber device talks there but does not hear: no answer to HELLO in "
                 "1 s; look at the line from PC to board, or reset the board",
                 s->name);
    }
}

static void explain_version(session *s, int major, int minor)
{
    snprintf(s->why, sizeof s->why,
             "%.200s: the device (%.16s %.24s) speaks protocol %d.%d, this limber %s speaks %d.%d; "
             "%s",
             s->name, s->device.device, s->device.build, major, minor, SIM_VERSION, PROTOCOL_MAJOR,
             PROTOCOL_MINOR,
             major > PROTOCOL_MAJOR ? "get a newer limber" : "flash newer firmware");
}

/* A device of another major version refuses by NACK, and so does one that the poses come too slowly for. */
static void take_refusal(void *context, const message *m, const frame *f, uint64_t at_us)
{
    session *s = context;
    (void)f;
    (void)at_us;
    if (m->type != MESSAGE_NACK || m->nack.answered != MESSAGE_HELLO ||
        m->nack.request_id != s->hello_id || s->lost) {
        return;
    }
    s->lost = true;
    s->refusal = m->nack.reason;
    texts_refusal(&m->nack, s->why);
    if (m->nack.reason == REASON_VERSION) {
        const size_t used = strlen(s->why);
        snprintf(s->why + used, sizeof s->why - used,
                 "; this limber %s speaks %d.%d: use the limber that came with the firmware",
                 SIM_VERSION, PROTOCOL_MAJOR, PROTOCOL_MINOR);
    }
}

/* One HELLO and its answer. */
static bool greet(session *s, float pose_hz)
{
    message hello = {.type = MESSAGE_HELLO};
    hello.hello.request_id = s->hello_id;
    hello.hello.protocol_major = PROTOCOL_MAJOR;
    hello.hello.protocol_minor = PROTOCOL_MINOR;
    hello.hello.layout_hash = messages_layout_hash();
    hello.hello.pose_hz = pose_hz;
    snprintf(hello.hello.device, sizeof hello.hello.device, "limber");
    snprintf(hello.hello.build, sizeof hello.hello.build, "%s", SIM_VERSION);
    s->listener = take_refusal;
    s->context = s;
    const uint64_t start_us = limber_now_us();
    uint64_t said_us = 0;
    while (!s->greeted && !s->lost && !interrupt_came()) {
        const uint64_t now_us = limber_now_us();
        if (now_us - start_us >= HELLO_MAX_US) {
            explain_silence(s);
            return false;
        }
        if (said_us == 0 || now_us - said_us >= HELLO_REPEAT_US) {
            said_us = now_us;
            (void)session_send(s, &hello);
        }
        (void)session_step(s, said_us + HELLO_REPEAT_US, -1);
    }
    s->listener = NULL;
    if (!s->lost && !s->greeted) {
        snprintf(s->why, sizeof s->why, "%.200s: interrupted", s->name);
    }
    return s->greeted && !s->lost;
}

static bool check_version(session *s)
{
    const message_hello *device = &s->device;
    if (device->protocol_major != PROTOCOL_MAJOR) {
        explain_version(s, device->protocol_major, device->protocol_minor);
        return false;
    }
    if (device->protocol_minor == PROTOCOL_MINOR && device->layout_hash != messages_layout_hash()) {
        limber_note("the device's messages differ from ours though both say protocol %d.%d: one "
                    "of the two is a developer's build (%.24s, %s)",
                    PROTOCOL_MAJOR, PROTOCOL_MINOR, device->build, SIM_VERSION);
    }
    return true;
}

/* A few quick exchanges, then one that tells the device what came of them; session_step goes on. */
static void compare_clocks(session *s)
{
    for (int i = 0; i <= SYNC_ROUNDS_N && !s->lost; i++) {
        const int before_n = s->clock.samples_n, before_next = s->clock.next;
        const uint64_t now_us = limber_now_us(), until_us = now_us + SYNC_ROUND_US;
        s->synced_us = 0;
        (void)session_step(s, 0, -1); /* sends one: it is long overdue */
        while (i < SYNC_ROUNDS_N && !s->lost && s->clock.samples_n == before_n &&
               s->clock.next == before_next && limber_now_us() < until_us) {
            (void)session_step(s, until_us, -1);
        }
    }
}

bool session_open(session *s, const char *name, float pose_hz)
{
    *s = (session){.name = name};
    frame_decoder_init(&s->decoder);
    if (!port_open(&s->port, name, s->why)) {
        return false;
    }
    s->open = true;
    const uint64_t now_us = limber_now_us();
    s->id = (uint8_t)(1 + (now_us / 1000 + (uint64_t)getpid()) % 255);
    s->hello_id = s->last_id = (uint16_t)(1 + now_us % 60000);
    s->heard_us = now_us;
    bool open = greet(s, pose_hz) && check_version(s);
    if (open) {
        /* the number may have been that of the session before, which would go on: another one is new */
        s->id = (uint8_t)(s->id % 255 + 1);
        s->hello_id = ++s->last_id;
        s->greeted = false;
        memset(s->seq, 0, sizeof s->seq);
        open = greet(s, pose_hz);
    }
    if (!open) {
        port_close(&s->port);
        s->open = false;
        return false;
    }
    compare_clocks(s);
    return true;
}

int session_start(session *s, const char *name, float pose_hz)
{
    if (session_open(s, name, pose_hz)) {
        port_warn_of_latency_timer(&s->port);
        return SIM_OK;
    }
    return interrupt_came() ? LIMBER_INTERRUPTED : limber_refuse("%s", s->why);
}

void session_close(session *s)
{
    if (s->open) {
        port_close(&s->port);
        s->open = false;
    }
}
