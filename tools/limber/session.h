/* session.h - a conversation with the device: HELLO, clock, requests and their answers, and whether it lives.
 *
 * One loop drives all: session_step waits for bytes or a moment, takes the messages apart, repeats what
 * was not answered, asks for the device's clock once a second, and notices when the device falls silent.
 * Everything here runs on one thread and nothing blocks for longer than asked.
 */
#ifndef LIMBER_SESSION_H
#define LIMBER_SESSION_H

#include <stdbool.h>
#include <stdint.h>

#include "clock_sync.h"
#include "limber.h"
#include "messages.h"
#include "port.h"

/* The device's heartbeat comes every 100 ms: after half a second without any message it is lost. */
#define SESSION_SILENCE_MAX_US 500000u

typedef enum {
    REQUEST_NONE,
    REQUEST_WAITING,
    REQUEST_DONE,    /* session.answer has the ACK, or what was asked for */
    REQUEST_REFUSED, /* session.answer has the NACK */
    REQUEST_UNANSWERED /* sent four times, 50 ms apart, and waited for half a second; 5 s for flash and servos */
} request_state;

/* Every good message of the device that is not an answer; before the loop goes on. */
typedef void session_listener(void *context, const message *m, const frame *f, uint64_t at_us);

typedef struct {
    port port;
    const char *name; /* of the port, as given */
    bool open, lost;
    uint8_t refusal; /* reason of the NACK to our HELLO, 0: none came */
    port_why why;    /* of being lost */

    message_hello device;
    message_boot_report boot;
    message_heartbeat heartbeat;
    message_rod_stats rod_stats; /* all zero where the device has none */
    bool boot_known, heartbeat_known;
    clock_sync clock;

    session_listener *listener;
    void *context;

    request_state request;
    message answer;

    /* private */
    uint8_t id;
    bool greeted; /* the HELLO has been answered */
    uint16_t hello_id, last_id;
    uint16_t seq[256]; /* by type */
    frame_decoder decoder;
    uint64_t heard_us, synced_us;
    message asked;
    uint16_t asked_id;
    int asked_n;
    uint64_t asked_us, repeated_us;
    uint64_t bytes_n;
    uint8_t first_bytes[64];
} session;

/* Opens the port and says HELLO; pose_hz as in HELLO. False with s->why: nothing is open then. */
bool session_open(session *s, const char *name, float pose_hz);

/* The same, complaining. Returns SIM_OK, LIMBER_DEVICE or LIMBER_INTERRUPTED. */
int session_start(session *s, const char *name, float pose_hz);

void session_close(session *s);

/* Sends a message as it is. False if the port is gone: the session is lost then. `at` also says what the
 * header's clock is to read: what counts from there must not count from a moment later. */
bool session_send(session *s, const message *m);
bool session_send_at(session *s, const message *m, uint64_t at_us);

/* The seq that the next message of this type will carry. */
uint16_t session_next_seq(const session *s, message_type type);

/* Takes what comes until the moment until_us (of limber_now_us), but returns as soon as something has come
 * on the port, other_fd can be read (true then), the session is lost or there was an interrupt. */
bool session_step(session *s, uint64_t until_us, int other_fd);

/* Puts a request on its way, filling in its id; one at a time. Its fate is in s->request. */
void session_ask(session *s, const message *request);

/* The same, and waits. SIM_OK if it was done; LIMBER_DEVICE after complaining: refused, unanswered, lost. */
int session_request(session *s, const message *request);

/* The same without complaining about a refusal: s->request tells. */
request_state session_try(session *s, const message *request);

/* What went wrong with the request, in words; returns LIMBER_DEVICE. */
int session_complain(const session *s);

/* Waits for the first heartbeat. SIM_OK, or LIMBER_DEVICE after complaining. */
int session_wait_for_state(session *s);

const char *session_state_name(const session *s);

#endif
