/* servo_ask.c - see servo_ask.h. */
#include "servo_ask.h"

#include <stdio.h>
#include <string.h>

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

/* The wire says in words what is wrong with a servo, and these are how they begin. A device with other words is
 * understood less well, not wrongly. */
servo_blame servo_ask_blame(const session *s)
{
    static const struct {
        servo_blame blame;
        const char *words;
    } BEGINNINGS[] = {{SERVO_SILENT, "does not answer"},
                      {SERVO_GARBLED, "answers with noise"},
                      {SERVO_BROKEN, "reports a hardware error"},
                      {SERVO_BEYOND, "cannot be driven at that rate"},
                      {SERVO_BEYOND, "is on a PWM channel that does not exist"}};
    const message_nack *nack = &s->answer.nack;
    if (s->request != REQUEST_REFUSED || nack->reason != REASON_SERVO) {
        return SERVO_BLAMELESS;
    }
    for (size_t i = 0; i < sizeof BEGINNINGS / sizeof BEGINNINGS[0]; i++) {
        if (strncmp(nack->text, BEGINNINGS[i].words, strlen(BEGINNINGS[i].words)) == 0) {
            return BEGINNINGS[i].blame;
        }
    }
    return SERVO_OTHERWISE;
}

void servo_ask_describe(const session *s, int id, port_why text)
{
    const message_nack *nack = &s->answer.nack;
    const servo_blame blame = servo_ask_blame(s);
    char more[100] = "";
    if (blame == SERVO_SILENT) {
        snprintf(more, sizeof more, "; limber servo scan --baud all finds those that do");
    } else if (blame == SERVO_GARBLED) {
        snprintf(more, sizeof more, "; connect one servo at a time");
    } else if (blame == SERVO_BROKEN) {
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
    if (s->lost || servo_ask_blame(s) == SERVO_BLAMELESS) {
        return session_complain(s);
    }
    servo_ask_describe(s, id, text);
    return limber_refuse("%s", text);
}

int servo_ask(session *s, const message *request, int id)
{
    return session_try(s, request) == REQUEST_DONE ? SIM_OK : servo_ask_complain(s, id);
}
