/* servo_ask.c - see servo_ask.h. */
#include "servo_ask.h"

#include <stdio.h>
#include <string.h>

#include "interrupt.h"

enum { WAIT_MAX_US = 50000 }; /* so that an interrupt between two waits is not slept over */

void servo_ask_error_text(uint8_t hardware_error, char *text, size_t room)
{
    /* ROBOTIS e-Manual, X series, Hardware Error Status(70) */
    static const struct {
        uint8_t bit;
        const char *name;
    } BITS[] = {{0x01, "input voltage"},
                {0x04, "overheating"},
                {0x08, "encoder"},
                {0x10, "electrical shock"},
                {0x20, "overload"}};
    snprintf(text, room, "%s", hardware_error == 0 ? "fine" : "ERROR:");
    for (size_t i = 0; i < sizeof BITS / sizeof BITS[0]; i++) {
        if ((hardware_error & BITS[i].bit) != 0) {
            const size_t used = strlen(text);
            snprintf(text + used, room - used, " %s", BITS[i].name);
        }
    }
}

bool servo_ask_is_about_servo(const session *s)
{
    const uint8_t reason = s->answer.nack.reason;
    return s->request == REQUEST_REFUSED && reason >= REASON_SERVO && reason <= REASON_SERVO_BEYOND;
}

void servo_ask_describe(const session *s, int id, port_why text)
{
    const message_nack *nack = &s->answer.nack;
    char more[100] = "";
    if (nack->reason == REASON_SERVO_SILENT) {
        snprintf(more, sizeof more, "; limber servo scan --baud all finds those that do");
    } else if (nack->reason == REASON_SERVO_GARBLED) {
        snprintf(more, sizeof more, "; connect one servo at a time");
    } else if (nack->reason == REASON_SERVO_HARDWARE) {
        servo_ask_error_text((uint8_t)nack->value, more + 2, sizeof more - 2);
        memcpy(more, "; ", 2);
    } else if (nack->value > 0.0f) {
        snprintf(more, sizeof more, " (%.0f)", (double)nack->value);
    }
    snprintf(text, PORT_WHY_BYTES, "servo %d %s%s", id, nack->text, more);
}

int servo_ask_complain(const session *s, int id)
{
    port_why text;
    if (s->lost || !servo_ask_is_about_servo(s)) {
        return session_complain(s);
    }
    servo_ask_describe(s, id, text);
    return limber_refuse("%s", text);
}

request_state servo_ask_try(session *s, const message *request)
{
    session_ask(s, request);
    while (s->request == REQUEST_WAITING && !interrupt_came()) {
        (void)session_step(s, limber_now_us() + WAIT_MAX_US, -1);
    }
    return s->request;
}

int servo_ask_stop(session *s)
{
    const message disarm = {.type = MESSAGE_DISARM};
    const int result = session_request(s, &disarm);
    return result == SIM_OK ? LIMBER_INTERRUPTED : result;
}

int servo_ask(session *s, const message *request, int id)
{
    const request_state state = servo_ask_try(s, request);
    if (state == REQUEST_DONE) {
        return SIM_OK;
    }
    if (state != REQUEST_WAITING) {
        return servo_ask_complain(s, id);
    }
    const int result = servo_ask_stop(s);
    if (result == LIMBER_INTERRUPTED) {
        limber_note("interrupted: servo %d was stopped, and the servos' supply is off", id);
    }
    return result;
}
