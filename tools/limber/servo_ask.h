/* servo_ask.h - requests to one servo through the device, and what went wrong in words about that servo. */
#ifndef LIMBER_SERVO_ASK_H
#define LIMBER_SERVO_ASK_H

#include <stddef.h>

#include "session.h"

enum { SERVO_ID_LAST = 252 };

typedef enum {
    SERVO_BLAMELESS, /* the refusal is about something else, or there is none */
    SERVO_SILENT,
    SERVO_GARBLED,
    SERVO_BROKEN, /* reports a hardware error */
    SERVO_BEYOND, /* cannot be asked at all: no such baud rate, or PWM channel */
    SERVO_OTHERWISE,
} servo_blame;

/* SIM_OK, or LIMBER_DEVICE after complaining; id: the servo it is about. */
int servo_ask(session *s, const message *request, int id);

/* What the servo has to do with the refusal of the last request. */
servo_blame servo_ask_blame(const session *s);

/* One sentence about it; for what a servo is to blame for. */
void servo_ask_describe(const session *s, int id, port_why text);

/* As session_complain, about this servo if it is to blame; returns LIMBER_DEVICE. */
int servo_ask_complain(const session *s, int id);

/* Hardware Error Status in words: "fine", or "ERROR: overload". */
void servo_ask_error_text(uint8_t hardware_error, char *text, size_t room);

#endif
