/* bus_model.h - the other end of the servo bus: model servos on a wire (bus_wire.h), and time.
 *
 *     bus_model_init(&bus, &plant, 16, 1000000);                  // ids 1 ... 16
 *     bus_wire_send(&bus.wire, packet, packet_n, now_s);          // takes 10 bits a byte from now on
 *     bus_model_run(&bus, now_s);                                 // up to this moment, never back
 *     n = bus_wire_read(&bus.wire, bytes, sizeof bytes, now_s);   // what has come by then
 *
 * A packet takes effect when its last byte is out; a servo answers after its Return Delay Time, and that takes 10 bits
 * a byte too. Ping (to all: in the order of ids), Read, Write, Sync Read, Sync Write and Reboot are done as the ROBOTIS
 * e-Manual says, DYNAMIXEL Protocol 2.0, 6 Instruction Details; others get an Instruction Error. Beside the wire's:
 *
 *   - a servo set to another baud rate than the wire's hears nothing, and is not heard
 *   - two servos with one id answer at once: bytes come that are neither's
 *   - Sync Read: each waits for the one listed before it; behind one that is missing all are silent
 *
 * The same calls give the same bytes. Caller-owned; host only.
 */
#ifndef LIMBER_BUS_MODEL_H
#define LIMBER_BUS_MODEL_H

#include "bus_servo.h"
#include "bus_wire.h"
#include "injection.h"

typedef struct {
    uint32_t pings, reads, writes, sync_reads, sync_writes, reboots, unknown; /* whole packets */
    uint32_t damaged; /* packets with a wrong CRC */
    uint32_t replies; /* status packets on the wire */
    uint32_t refused; /* instructions to a servo that it answered, or would have, with an error */
    uint32_t shared;  /* answers of more than one servo at once */
    uint32_t goals;   /* Goal Positions written */
} bus_counts;

/* What goes wrong with answers at the moment: shares 0 ... 1, and how much later than they should they come. */
typedef struct {
    double lost, damaged, late_s;
} bus_faults;

/* Where in a packet the wire is; n: bytes since its header began. */
typedef struct {
    uint32_t last; /* bytes, the newest lowest */
    uint8_t id;
    size_t n, end_n;
} bus_packet_end;

/* Set any_baud and faults at will, read servos and counts; treat the others as private. Must not be moved. */
typedef struct {
    bus_servo servos[SERVO_COUNT_MAX];
    int servos_n;
    bus_wire wire;
    bool any_baud; /* servos understand every rate: for a line that cannot tell it */
    bus_faults faults;
    bus_counts counts;

    double free_s; /* the last answer is over */
    uint64_t random;
    bus_packet_end end;
    dxl_decoder decoder;
    uint8_t params[DXL_LENGTH_MAX];
} bus_model;

/* servos_n servos, 0 ... SERVO_COUNT_MAX, with ids 1 ..., they and the wire set to this baud rate; they turn the
 * plant's servos from 0 on. The plant must outlive the model. */
void bus_model_init(bus_model *m, servo_plant *plant, int servos_n, uint32_t baud);

/* Everything up to this moment. The plant has ticks of its own: servo_plant_tick. */
void bus_model_run(bus_model *m, double now_s);

/* Sets what the script says about servos and their answers at this moment: INJECT_SERVO ... INJECT_SLOW. */
void bus_model_inject(bus_model *m, const injection *script, double now_s);

#endif
