/* bus_wire.c - see bus_wire.h. */
#include "bus_wire.h"

#include <math.h>
#include <string.h>

static double byte_s(const bus_wire *w)
{
    return 10.0 / w->baud;
}

static bus_byte *queue_at(const bus_queue *q, size_t i)
{
    return &q->bytes[(q->first + i) % q->room];
}

static bus_byte queue_take(bus_queue *q)
{
    const bus_byte b = *queue_at(q, 0);
    q->first = (q->first + 1) % q->room;
    q->n--;
    return b;
}

static void queue_add(bus_queue *q, bus_byte b)
{
    if (q->n < q->room) {
        *queue_at(q, q->n++) = b;
    }
}

static bool has_come(const bus_queue *q, double now_s)
{
    return q->n > 0 && queue_at(q, 0)->at_s <= now_s;
}

uint8_t bus_wire_mix(uint8_t one, uint8_t other)
{
    return one & (uint8_t)(other << 1 | other >> 7);
}

/* What is bad for bytes with nobody in particular. */
static uint8_t spoilt(uint8_t byte)
{
    return bus_wire_mix(byte, 0x55);
}

/* Spoils what of this queue is on the wire between these moments; true if there was any. */
static bool spoil(bus_wire *w, bus_queue *q, double start_s, double end_s)
{
    bool any = false;
    for (size_t i = 0; i < q->n; i++) {
        bus_byte *b = queue_at(q, i);
        if (b->at_s > start_s && b->at_s - byte_s(w) < end_s) {
            b->byte = spoilt(b->byte);
            any = true;
        }
    }
    w->clashes += any;
    return any;
}

/* Onto the wire; this and what the other side has there at the time spoil each other. */
static double put(bus_wire *w, bus_queue *to, bus_queue *others, const uint8_t *bytes,
                  size_t bytes_n, double start_s)
{
    const double each_s = byte_s(w), end_s = start_s + (double)bytes_n * each_s;
    const bool clash = spoil(w, others, start_s, end_s);
    for (size_t i = 0; i < bytes_n; i++) {
        queue_add(to, (bus_byte){.at_s = start_s + (double)(i + 1) * each_s,
                                 .byte = clash ? spoilt(bytes[i]) : bytes[i],
                                 .last = i + 1 == bytes_n});
    }
    return end_s;
}

void bus_wire_init(bus_wire *w, uint32_t baud)
{
    memset(w, 0, sizeof *w);
    w->to_servos = (bus_queue){.bytes = w->to_servos_bytes, .room = BUS_WIRE_TO_SERVOS_BYTES};
    w->to_host = (bus_queue){.bytes = w->to_host_bytes, .room = BUS_WIRE_TO_HOST_BYTES};
    w->baud = baud;
}

void bus_wire_start(bus_wire *w, uint32_t baud)
{
    w->baud = baud;
    w->to_servos.n = w->to_host.n = 0;
}

bool bus_wire_send(bus_wire *w, const uint8_t *bytes, size_t bytes_n, double now_s)
{
    const size_t waiting_n = w->to_servos.n;
    if (bytes_n > w->to_servos.room - waiting_n) {
        return false;
    }
    const double last_s = waiting_n > 0 ? queue_at(&w->to_servos, waiting_n - 1)->at_s : now_s;
    (void)put(w, &w->to_servos, &w->to_host, bytes, bytes_n, last_s > now_s ? last_s : now_s);
    return true;
}

bool bus_wire_sending(const bus_wire *w, double now_s)
{
    return w->to_servos.n > 0 && queue_at(&w->to_servos, w->to_servos.n - 1)->at_s > now_s;
}

size_t bus_wire_read(bus_wire *w, uint8_t *bytes, size_t room, double now_s)
{
    size_t n = 0;
    while (n < room && has_come(&w->to_host, now_s)) {
        bytes[n++] = queue_take(&w->to_host).byte;
    }
    return n;
}

size_t bus_wire_read_whole(bus_wire *w, uint8_t *bytes, size_t room, double now_s)
{
    const bus_queue *q = &w->to_host;
    size_t whole_n = 0;
    for (size_t i = 0; i < q->n && i < room && queue_at(q, i)->at_s <= now_s; i++) {
        whole_n = queue_at(q, i)->last ? i + 1 : whole_n;
    }
    return bus_wire_read(w, bytes, whole_n, now_s);
}

double bus_wire_next_s(const bus_wire *w)
{
    const double out_s = w->to_servos.n > 0 ? queue_at(&w->to_servos, 0)->at_s : HUGE_VAL;
    const double in_s = w->to_host.n > 0 ? queue_at(&w->to_host, 0)->at_s : HUGE_VAL;
    return out_s < in_s ? out_s : in_s;
}

void bus_wire_abort(bus_wire *w, double now_s)
{
    bus_queue *out = &w->to_servos;
    while (out->n > 0 && queue_at(out, out->n - 1)->at_s - byte_s(w) >= now_s) {
        out->n--;
    }
    while (has_come(&w->to_host, now_s)) {
        (void)queue_take(&w->to_host);
    }
}

bool bus_wire_hear(bus_wire *w, double now_s, uint8_t *byte, double *at_s)
{
    if (!has_come(&w->to_servos, now_s)) {
        return false;
    }
    const bus_byte b = queue_take(&w->to_servos);
    *byte = b.byte;
    *at_s = b.at_s;
    if (w->echo) {
        queue_add(&w->to_host, b);
    }
    return true;
}

double bus_wire_answer(bus_wire *w, const uint8_t *bytes, size_t bytes_n, double start_s)
{
    return put(w, &w->to_host, &w->to_servos, bytes, bytes_n, start_s);
}
