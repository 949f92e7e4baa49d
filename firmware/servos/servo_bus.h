/* servo_bus.h - the master of a bus of Dynamixel X servos; servos.h is the way in.
 *
 * A state machine, polled: servo_bus_tick reads what has come, and when nothing is under way sends one packet. A
 * tick of 1 ms carries one question and its answer; nothing needs finer polling, and with longer ticks all of it
 * just takes longer.
 *
 *   prepare  The servos boot for SERVO_BUS_BOOT_US. All: torque off, Bus Watchdog 0 (one that has struck refuses
 *            goals until then). Each: Ping, accepted model, no hardware error, an Operating Mode that follows
 *            goals, Return Delay Time 0 (written if it is not). Then Sync Reads of the positions, which go on, over
 *            and over, until torque: an arm without torque sinks.
 *   torque   Goals, then Torque Enable, then Bus Watchdog, each by Sync Write to all and then read back from every
 *            servo before the next is written: nobody answers a Sync Write, and a servo that missed its goal would
 *            turn to a goal of long ago as soon as it has torque. Where one holds another value all are written to
 *            again, twice; then it is in trouble. The goals written here are the positions read last, whatever the
 *            app wants; its goals follow as soon as all is done. (Where Drive Mode says Torque On by Goal Update, the
 *            first of the three brings torque already: in place, too.)
 *   on       The newest goals in one Sync Write. Whenever nothing newer waits, and at least every SERVO_BUS_ASK_US,
 *            one servo in turn is asked for its Hardware Error Status (its answer also carries the alert bit, and
 *            that it is alive): a round takes at most that time for each. One that misses is the next to be asked
 *            again; SERVO_BUS_MISSES_MAX misses in a row, or one error that it reports, make the bus unhealthy.
 *            Should this device stop, Bus Watchdog stops every servo where it is after SERVO_BUS_WATCHDOG_US.
 *   off      Whatever is under way is cut short and torque-off goes to all, FF FF FD 00 FE 06 00 03 40 00 00 and CRC,
 *            13 bytes; and in the two ticks after, since a servo may have lost the first behind the torn packet.
 *
 * What a servo must be set to beforehand: id, baud rate, and Operating Mode 3 (where it ignores goals beyond its Min
 * and Max Position Limit, at most 0 ... 4095) or 4 or 5 (several turns); Status Return Level 2 as delivered.
 *
 * Each question is put up to SERVO_BUS_TRIES times. The wire may or may not bring back what is sent: an
 * instruction that comes in is such an echo. A late answer counts as a stray, unless the same is being asked again.
 *
 * Source: ROBOTIS e-Manual, DYNAMIXEL Protocol 2.0; XL430-W250: Bus Watchdog, Torque Enable, Drive Mode, Goal Position.
 * Cost on a Cortex-M4, 100 servos: servo_bus_goals 1,500 instructions, the tick that sends them 6,600, one that asks
 * 900; each byte that comes back 55. Caller-owned, no heap, main loop only.
 */
#ifndef LIMBER_SERVO_BUS_H
#define LIMBER_SERVO_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "dynamixel.h"
#include "hal.h"
#include "servo_types.h"

enum {
    SERVO_BUS_BOOT_US = 500000,
    SERVO_BUS_SETTLE_US = 50000, /* for a servo to store an id or rate and to go on with it */
    SERVO_BUS_TRIES = 3,
    SERVO_BUS_MISSES_MAX = 3,
    SERVO_BUS_ASK_US = 20000,
    SERVO_BUS_WATCHDOG_US = 100000,
    SERVO_BUS_PERIOD_MAX_US = 50000, /* between goals: half of what the watchdog allows */
    SERVO_BUS_STUCK_US = 200000,     /* no packet takes so long */
    SERVO_BUS_SERVOS_MAX = SERVO_COUNT_MAX < 128 ? SERVO_COUNT_MAX : 128,
    SERVO_BUS_CHUNK_MAX = 30, /* asked at once: 15 bytes from each, and the echo, fit 512 */
    SERVO_BUS_ANSWER_MAX = 16,
};

#define SERVO_BUS_TURN_MAX_RAD 0.5f
#define SERVO_BUS_GOAL_MAX_RAD 8.0f

/* What has passed on the bus since servo_bus_init; all wrap. */
typedef struct {
    uint32_t sent;     /* packets */
    uint32_t good;     /* answers to what was asked */
    uint32_t damaged;  /* packets with a wrong CRC or length */
    uint32_t timeouts; /* questions without (all of) the answers */
    uint32_t echoes;   /* instructions that came back */
    uint32_t stray;    /* answers that nobody waited for */
} servo_bus_counts;

typedef enum {
    SERVO_BUS_OFF,
    SERVO_BUS_PREPARING,
    SERVO_BUS_PREPARED,
    SERVO_BUS_STARTING, /* torque is on its way */
    SERVO_BUS_ON,
    SERVO_BUS_REQUEST, /* under way */
    SERVO_BUS_DONE,    /* the request is */
    SERVO_BUS_FAILED,  /* preparing, torque or the request: trouble tells why */
} servo_bus_state;

typedef struct servo_bus servo_bus;
typedef struct servo_bus_step servo_bus_step; /* servo_bus_private.h */

/* One question, and what has become of it. Private. */
typedef struct {
    uint8_t state, tries, answer_n, error;
    uint8_t id;         /* who is asked, or who refused */
    uint8_t servos_n;   /* how many are asked at once; 0: one by its id */
    int16_t first;      /* the first of them: its place in config.id */
    uint16_t address;   /* what they are asked for */
    uint32_t missing;   /* a bit for each that has not answered */
    uint32_t residue_n; /* bytes that came and belong to no whole packet */
    uint32_t since_us, patience_us;
    void (*each)(servo_bus *b, int place, uint32_t value); /* takes the answer of one of several */
    uint8_t answer[SERVO_BUS_ANSWER_MAX];                  /* of one */
} servo_bus_question;

/* Read state, trouble, info and counts; treat the others as private. *hal and *config must outlive it. */
struct servo_bus {
    const hal *hal;
    const servos_config *config;
    servo_bus_state state;
    servo_trouble trouble; /* in FAILED; in ON: not NONE means unhealthy */
    servo_info info;       /* in DONE */
    servo_bus_counts counts;
    uint32_t now_us, since_us;           /* since: of what the step waits for */
    uint32_t baud;                       /* as started; 0: not yet */
    const servo_bus_step *const *script; /* what is being done; NULL: nothing */
    uint8_t step;                        /* its place there */
    uint8_t misses, rewrites, torque_offs;
    bool goals_new;
    int16_t servo;        /* the one whose turn it is */
    servo_trouble unlike; /* READ_BACK: the first servo that holds another value than it should */
    uint32_t told_us, asked_us, moved_us;
    servo_request request;
    int32_t base_units; /* where a test starts */
    /* positions as read last, with which torque begins; the ends of the range stand for all beyond */
    int16_t placed_units[SERVO_BUS_SERVOS_MAX];
    int16_t goal_units[SERVO_BUS_SERVOS_MAX];
    servo_bus_question question;
    dxl_decoder decoder;
    uint8_t params[SERVO_BUS_ANSWER_MAX];
    uint16_t packet_n;
    uint8_t packet[HAL_BUS_PACKET_MAX_BYTES];
};

/* Shortest time between goals, s: their packet, one question with its answer, and a gap. */
float servo_bus_period_s(uint32_t baud, int servos_n);

/* Whether the configuration can be driven; *trouble says why not. */
bool servo_bus_check(const servos_config *config, servo_trouble *trouble);

void servo_bus_init(servo_bus *b, const hal *hal, const servos_config *config);

/* The supply has just come on. OFF, DONE or FAILED -> PREPARING -> PREPARED or FAILED. */
void servo_bus_prepare(servo_bus *b, uint32_t now_us);

/* In PREPARED, config.servos_n of them. */
void servo_bus_positions(const servo_bus *b, float *positions_rad);

/* PREPARED -> STARTING -> ON, or FAILED. */
void servo_bus_torque(servo_bus *b, const float *goals_rad);

/* In STARTING and ON; beyond +-SERVO_BUS_GOAL_MAX_RAD they are clamped; one that is NaN stays as it was. Sent by
 * servo_bus_tick. */
void servo_bus_goals(servo_bus *b, const float *goals_rad);

/* -> OFF from everywhere. */
void servo_bus_off(servo_bus *b);

/* -> REQUEST -> DONE or FAILED. The supply has been on since powered_us. */
void servo_bus_ask(servo_bus *b, const servo_request *request, uint32_t powered_us,
                   uint32_t now_us);

void servo_bus_tick(servo_bus *b, uint32_t now_us);

/* In ON: whether trouble is SERVO_TROUBLE_NONE; true else. */
bool servo_bus_healthy(const servo_bus *b);

#endif
