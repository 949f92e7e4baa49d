/* bus_wire.h - the one wire between a controller and its servos, half duplex, 8N1: bytes take time, and who talks at
 * the same time as somebody else spoils it for both.
 *
 * The upper half is the controller's end, the hal's bus_ functions in all but name; the lower half is for the servos
 * (bus_model.h). Moments in s, never back. The same calls give the same bytes. Caller-owned; host only.
 */
#ifndef LIMBER_BUS_WIRE_H
#define LIMBER_BUS_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BUS_WIRE_TO_SERVOS_BYTES = 4096, BUS_WIRE_TO_HOST_BYTES = 8192 };

typedef struct {
    double at_s; /* its stop bit is out */
    uint8_t byte;
    bool last; /* of what was put on the wire at once */
} bus_byte;

/* A ring. */
typedef struct {
    bus_byte *bytes;
    size_t room, first, n;
} bus_queue;

/* Set echo at will; treat the others as private. Must not be moved. */
typedef struct {
    bool echo; /* the controller hears itself */
    uint32_t baud;
    uint32_t clashes; /* times that two talked at once */
    bus_queue to_servos, to_host;
    bus_byte to_servos_bytes[BUS_WIRE_TO_SERVOS_BYTES], to_host_bytes[BUS_WIRE_TO_HOST_BYTES];
} bus_wire;

void bus_wire_init(bus_wire *w, uint32_t baud);

/* --- the controller's end --- */

/* At this rate from now on; nothing is under way. */
void bus_wire_start(bus_wire *w, uint32_t baud);

/* Queued behind what is being sent; false, and nothing, if there is no room. */
bool bus_wire_send(bus_wire *w, const uint8_t *bytes, size_t bytes_n, double now_s);
bool bus_wire_sending(const bus_wire *w, double now_s);
size_t bus_wire_read(bus_wire *w, uint8_t *bytes, size_t room, double now_s);

/* The same, but an answer in one piece, once it is over; room for one at least. */
size_t bus_wire_read_whole(bus_wire *w, uint8_t *bytes, size_t room, double now_s);

/* When something happens next, as far as is known; HUGE_VAL: nothing is on the wire. */
double bus_wire_next_s(const bus_wire *w);

/* The byte that is on its way is the last; what has come is forgotten. Answers go on. */
void bus_wire_abort(bus_wire *w, double now_s);

/* --- the servos' end --- */

/* The next byte that has come by now_s, and when. */
bool bus_wire_hear(bus_wire *w, double now_s, uint8_t *byte, double *at_s);

/* From start_s on; returns when it is over. */
double bus_wire_answer(bus_wire *w, const uint8_t *bytes, size_t bytes_n, double start_s);

/* What two drivers that are off by part of a bit make of their bytes: neither's. */
uint8_t bus_wire_mix(uint8_t one, uint8_t other);

#endif
