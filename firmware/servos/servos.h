/* servos.h - the device's servos, whatever they are: none, hobby servos on PWM, or smart ones on a bus.
 *
 *     servos_configure(&servos, &hal, &config);          // DISARMED
 *     servos_prepare(&servos, now_us);                   // supply on, find them all, read where they are
 *     servos_tick(&servos, now_us);                      // every tick, first to last
 *     while (servos.state == SERVOS_PREPARING) ...       // PREPARED, or FAILED and servos.trouble tells why
 *     servos_positions(&servos, positions_rad);          // goals start from there
 *     servos_torque(&servos, goals_rad, now_us);         // goals first, then torque
 *     servos_goals(&servos, goals_rad);                  // at most every servos_period_s
 *     servos_off(&servos);                               // within this call: supply off, torque-off on its way
 *
 * Positions and goals are in rad of the servo's shaft, 0 in the middle of its travel, counter-clockwise as
 * the maker counts. Nothing here waits: what takes time goes on in servos_tick. Caller-owned, no heap, main loop only.
 *
 *   none   goals go nowhere; always healthy; positions cannot be told
 *   pwm    HAL_PWM_CHANNELS_N channels, ids 1 ...; enabled one at a time, SERVOS_PWM_STEP_US apart, since a hobby
 *          servo does not tell where it is and its first move is its own; positions cannot be told
 *   bus    Dynamixel Protocol 2.0, X series (servo_bus.h)
 */
#ifndef LIMBER_SERVOS_H
#define LIMBER_SERVOS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal.h"
#include "rod_config.h"
#include "servo_bus.h"
#include "servo_pwm.h"
#include "servo_types.h"

typedef enum {
    SERVOS_OFF,       /* no supply, no torque */
    SERVOS_PREPARING, /* supply, no torque: being looked for */
    SERVOS_PREPARED,  /* supply, no torque: all found, positions read */
    SERVOS_FAILED, /* no supply: one was not found, or lost again before torque; trouble tells why */
    SERVOS_ON,     /* torque, or on the way to it */
    SERVOS_SERVICE, /* supply, no torque but for a test: a request is under way, or was less than 10 s ago */
} servos_state;

/* Read state and trouble; treat the others as private. */
typedef struct {
    const hal *hal;
    servos_config config;
    servos_state state;
    servo_trouble trouble; /* the last; kind SERVO_TROUBLE_NONE: none since servos_prepare */
    servo_bus bus;
    servo_pwm pwm;
    uint32_t since_us;   /* of the state; in SERVICE: of the last request's end */
    uint32_t powered_us; /* of SERVICE */
    servo_request request;
    servo_request_state answer;
    servo_info info;
} servos;

/* Shortest time between two sets of goals, s: what the bus can carry beside one question to a servo, or a
 * PWM period. 0 where there is no limit. README has a table. */
float servos_period_s(const servos_config *config);

/* Whether these can be driven at all; *trouble (may be NULL) says why not. */
bool servos_check(const servos_config *config, servo_trouble *trouble);

/* Off, and from now on those of *config. The hal must outlive *s, which must not be moved or copied afterwards. */
void servos_configure(servos *s, const hal *hal, const servos_config *config);

/* Starts preparing; servos_tick goes on with it. Nothing in PREPARING, PREPARED and ON. */
void servos_prepare(servos *s, uint32_t now_us);

/* Where they are, config.servos_n of them; false where they cannot tell. In PREPARED only. */
bool servos_positions(const servos *s, float *positions_rad);

/* PREPARED -> ON, starting with these goals. Nothing in other states. */
void servos_torque(servos *s, const float *goals_rad, uint32_t now_us);

/* New goals; the newest wins where the last have not been sent yet. In ON only. */
void servos_goals(servos *s, const float *goals_rad);

/* No torque and no supply, in every state, before it returns; the bus is told as soon as its line allows (a
 * transfer under way is aborted), and in the two ticks after once more. */
void servos_off(servos *s);

/* What is under way goes on. Bounded: one packet sent, at most HAL_BUS_PACKET_MAX_BYTES bytes read. */
void servos_tick(servos *s, uint32_t now_us);

/* In ON: false once a servo has reported an error or has not answered SERVO_BUS_MISSES_MAX times in a row; trouble
 * says which. True in all other states. */
bool servos_healthy(const servos *s);

/* In ON: true from the tick in which goals are followed; before that torque is on its way, and goals wait. */
bool servos_started(const servos *s);

/* One request to one servo, while OFF, FAILED or SERVICE: supply on, and off again 10 s after the last. False if one
 * is under way, the state does not allow it, it makes no sense (an id beyond SERVO_ID_MAX, a turn that is no
 * number), or servos of this kind know no such thing: PWM channels only PING and TEST. Turns are clamped to
 * +-SERVO_BUS_TURN_MAX_RAD. */
bool servos_request(servos *s, const servo_request *request, uint32_t now_us);

/* What became of it: SERVO_REQUEST_BUSY, DONE (then *info is filled in) or FAILED (then trouble). */
servo_request_state servos_answer(const servos *s, servo_info *info, servo_trouble *trouble);

#endif
