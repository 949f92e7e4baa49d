/* servo_ask.h - requests to one servo through the device, and what went wrong in words about that servo. */
#ifndef LIMBER_SERVO_ASK_H
#define LIMBER_SERVO_ASK_H

#include <stdbool.h>
#include <stddef.h>

#include "session.h"

enum { SERVO_ID_LAST = 252 };

/* SIM_OK, or LIMBER_DEVICE after complaining; id: the servo it is about. LIMBER_INTERRUPTED after servo_ask_stop and
 * saying so, if an interrupt came while it waited (interrupt.h; only where interrupts are caught). */
int servo_ask(session *s, const message *request, int id);

/* As session_try; but an interrupt ends the wait: REQUEST_WAITING then, and it is time for servo_ask_stop. */
request_state servo_ask_try(session *s, const message *request);

/* DISARM, which ends what a servo is doing and takes all servos' supply, whatever was asked before.
 * LIMBER_INTERRUPTED, or LIMBER_DEVICE after complaining that it could not be done. */
int servo_ask_stop(session *s);

/* Whether the last request was refused because of the servo, and not of the device. */
bool servo_ask_is_about_servo(const session *s);

/* One sentence about it; for what a servo is to blame for. */
void servo_ask_describe(const session *s, int id, port_why text);

/* As session_complain, about this servo if it is to blame; returns LIMBER_DEVICE. */
int servo_ask_complain(const session *s, int id);

/* Hardware Error Status in words: "fine", or "ERROR: overload". */
void servo_ask_error_text(uint8_t hardware_error, char *text, size_t room);

#endif
