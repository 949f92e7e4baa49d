/* servo_bus_private.h - what the files of servo_bus share.
 *
 * Only one question is open at a time. What the bus is doing is a list of steps, each of which asks one thing and takes
 * its answer; servo_bus_run goes through them.
 */
#ifndef LIMBER_SERVO_BUS_PRIVATE_H
#define LIMBER_SERVO_BUS_PRIVATE_H

#include "dynamixel_x.h"
#include "servo_bus.h"

enum {
    QUESTION_NONE,
    QUESTION_OPEN,
    QUESTION_ANSWERED,
    QUESTION_REFUSED, /* error is the status packet's */
    QUESTION_SILENT,
    QUESTION_GARBLED,
};

/* ask is called as soon as nothing is under way: it opens a question, or sends what nobody answers, or just waits. took
 * (NULL: on to the next step) gets the answer; lost (NULL: the whole undertaking has failed) is called when there is
 * none, or a refusal: question.state tells. */
struct servo_bus_step {
    void (*ask)(servo_bus *b);
    void (*took)(servo_bus *b);
    void (*lost)(servo_bus *b);
};

/* --- servo_bus_ask.c: the wire --- */

/* At this rate from now on, and nothing of before counts. False: the board cannot. */
bool servo_bus_start(servo_bus *b, uint32_t baud);
/* What came before does not count any more. */
void servo_bus_forget(servo_bus *b);

/* Sends b->packet[packet_n]; nobody answers. */
bool servo_bus_tell(servo_bus *b, size_t packet_n);
/* Writes to all: the low byte of value. */
void servo_bus_tell_all(servo_bus *b, uint16_t address, uint8_t value);

/* Sends b->packet[packet_n] to id and waits for answer_n parameters, asking up to tries times. */
void servo_bus_ask_one(servo_bus *b, uint8_t id, size_t packet_n, int answer_n, int tries);
void servo_bus_ask_ping(servo_bus *b, uint8_t id, int tries);
void servo_bus_ask_read(servo_bus *b, uint8_t id, uint16_t address, int n, int tries);
void servo_bus_ask_write(servo_bus *b, uint8_t id, uint16_t address, int n, uint32_t value);

/* Asks the servos from place `first` on, as many as one go can carry (b->question.servos_n), for n <= 4 bytes; each
 * gets them as a number, when they come. */
void servo_bus_ask_many(servo_bus *b, int first, uint16_t address, int n,
                        void (*each)(servo_bus *b, int place, uint32_t value));

/* Reads what has come, takes answers, asks again or gives up. */
void servo_bus_listen(servo_bus *b);

/* What became of a question that was lost, and who it was put to. */
servo_trouble servo_bus_loss(const servo_bus *b);

/* --- servo_bus.c: the scripts' ways on --- */

void servo_bus_begin(servo_bus *b, servo_bus_state state, const servo_bus_step *const *script);
void servo_bus_next(servo_bus *b);
/* FAILED; and all are told to let go, whatever they were doing. */
void servo_bus_fail(servo_bus *b, servo_trouble trouble);

/* --- servo_bus_prepare.c, servo_bus_torque.c, servo_bus_request.c: the scripts --- */

extern const servo_bus_step SERVO_BUS_BOOT; /* waits until SERVO_BUS_BOOT_US after since_us */
extern const servo_bus_step *const SERVO_BUS_PREPARE[];
extern const servo_bus_step *const SERVO_BUS_TORQUE[];
extern const servo_bus_step *const SERVO_BUS_ON_STEPS[];
const servo_bus_step *const *servo_bus_request_script(const servo_request *request);

static inline float servo_bus_rad(int32_t units)
{
    return (float)(units - DXL_X_CENTER_UNITS) * DXL_X_RAD_PER_UNIT;
}

#endif
