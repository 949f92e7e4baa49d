/* bus_model.c - see bus_model.h. */
#include "bus_model.h"

#include <string.h>

enum {
    REPLY_MAX_BYTES = 256,
    STATUS_READS = 1,
    STATUS_ALL = 2,
    BETWEEN_PACKETS = 8, /* bytes, beyond the places that are looked at */
    WRONG_CRC = 0,       /* in the place of an instruction: no instruction has it */
};

/* One or more servos talking: what the wire makes of it. */
typedef struct {
    uint8_t bytes[REPLY_MAX_BYTES];
    size_t n;
    int servos_n;
    double delay_s;
} reply;

/* --- instructions ---------------------------------------------------------------------------------- */

static uint8_t do_write(bus_model *m, bus_servo *s, uint16_t address, const uint8_t *bytes,
                        size_t bytes_n)
{
    const uint8_t error = bus_servo_write(s, address, bytes, bytes_n);
    m->counts.refused += error != 0;
    m->counts.goals +=
        error == 0 && address <= DXL_X_GOAL_POSITION && address + bytes_n > DXL_X_GOAL_POSITION;
    return error;
}

static uint8_t refuse(bus_model *m, uint8_t error)
{
    m->counts.refused++;
    return error;
}

/* Reads as Read and Sync Read ask for it; data[BUS_SERVO_TABLE_BYTES]. */
static uint8_t do_read(bus_model *m, bus_servo *s, const dxl_packet *p, double at_s, uint8_t *data,
                       size_t *data_n)
{
    const uint16_t n = dxl_u16(p->params + 2);
    const uint8_t error = bus_servo_read(s, dxl_u16(p->params), data, n, at_s);
    *data_n = error == 0 ? n : 0;
    return error == 0 ? 0 : refuse(m, error);
}

/* What one servo does, and what it has to say about it: its status packet's length, 0 where it keeps silent. */
static size_t obey(bus_model *m, bus_servo *s, const dxl_packet *p, double at_s, uint8_t *status)
{
    const uint8_t id = s->table[DXL_X_ID]; /* a new id counts from the next packet on */
    const uint8_t level = s->table[BUS_SERVO_STATUS_LEVEL];
    uint8_t data[BUS_SERVO_TABLE_BYTES], error = 0, least = STATUS_ALL;
    size_t data_n = 0;
    switch (p->instruction) {
    case DXL_PING:
        least = 0;
        data_n = 3;
        memcpy(data, s->table + DXL_X_MODEL, 2);
        data[2] = s->table[DXL_X_FIRMWARE];
        break;
    case DXL_READ:
    case DXL_SYNC_READ:
        least = STATUS_READS;
        error = p->params_n < 4 ? refuse(m, DXL_E_LENGTH) : do_read(m, s, p, at_s, data, &data_n);
        break;
    case DXL_WRITE:
        error = p->params_n < 2
                    ? refuse(m, DXL_E_LENGTH)
                    : do_write(m, s, dxl_u16(p->params), p->params + 2, p->params_n - 2);
        break;
    case DXL_REBOOT:
        bus_servo_reboot(s, at_s);
        break;
    default:
        error = refuse(m, p->instruction == WRONG_CRC ? DXL_E_CRC : DXL_E_INSTRUCTION);
    }
    error |= s->table[DXL_X_HARDWARE_ERROR] != 0 ? DXL_ALERT : 0;
    return level >= least ? dxl_status(status, REPLY_MAX_BYTES, id, error, data, data_n) : 0;
}

static bool hears(const bus_model *m, const bus_servo *s, double at_s)
{
    return bus_servo_hears(s, m->any_baud ? 0 : m->wire.baud, at_s);
}

static void join(reply *all, const bus_servo *s, const uint8_t *status, size_t n)
{
    const double delay_s = s->table[DXL_X_RETURN_DELAY] * 2e-6;
    for (size_t i = 0; i < n; i++) {
        all->bytes[i] = i < all->n ? bus_wire_mix(all->bytes[i], status[i]) : status[i];
    }
    all->n = n > all->n ? n : all->n;
    all->delay_s = delay_s > all->delay_s ? delay_s : all->delay_s;
    all->servos_n++;
}

static void send_reply(bus_model *m, reply *all, double at_s)
{
    const double start_s = (m->free_s > at_s ? m->free_s : at_s) + all->delay_s + m->faults.late_s;
    m->counts.replies += (uint32_t)all->servos_n;
    m->counts.shared += all->servos_n > 1;
    if (injection_random(&m->random) < m->faults.lost) {
        return;
    }
    if (injection_random(&m->random) < m->faults.damaged) {
        const size_t which = (size_t)(injection_random(&m->random) * (double)all->n);
        all->bytes[which] ^= (uint8_t)(1u << (int)(injection_random(&m->random) * 8.0));
    }
    m->free_s = bus_wire_answer(&m->wire, all->bytes, all->n, start_s);
}

/* Whoever has this id obeys, and answers; false if nobody did. */
static bool ask(bus_model *m, uint8_t id, const dxl_packet *p, double at_s)
{
    reply all = {.n = 0};
    for (int i = 0; i < m->servos_n; i++) {
        bus_servo *s = &m->servos[i];
        uint8_t status[REPLY_MAX_BYTES];
        if (s->table[DXL_X_ID] == id && hears(m, s, at_s)) {
            const size_t n = obey(m, s, p, at_s, status);
            if (n > 0) {
                join(&all, s, status, n);
            }
        }
    }
    if (all.n > 0) {
        send_reply(m, &all, at_s);
    }
    return all.n > 0;
}

static void tell_all(bus_model *m, const dxl_packet *p, double at_s)
{
    for (int i = 0; i < m->servos_n; i++) {
        uint8_t status[REPLY_MAX_BYTES];
        if (hears(m, &m->servos[i], at_s)) {
            (void)obey(m, &m->servos[i], p, at_s, status);
        }
    }
}

static void sync_write(bus_model *m, const dxl_packet *p, double at_s)
{
    const uint16_t address = p->params_n >= 4 ? dxl_u16(p->params) : 0;
    const size_t n = p->params_n >= 4 ? dxl_u16(p->params + 2) : 0;
    for (size_t at = 4; at + 1 + n <= p->params_n; at += 1 + n) {
        for (int i = 0; i < m->servos_n; i++) {
            bus_servo *s = &m->servos[i];
            if (s->table[DXL_X_ID] == p->params[at] && hears(m, s, at_s)) {
                (void)do_write(m, s, address, p->params + at + 1, n);
            }
        }
    }
}

static void broadcast(bus_model *m, const dxl_packet *p, double at_s)
{
    switch (p->instruction) {
    case DXL_PING:
        for (int id = 0; id < DXL_BROADCAST; id++) {
            (void)ask(m, (uint8_t)id, p, at_s);
        }
        break;
    case DXL_SYNC_READ:
        for (size_t at = 4; at < p->params_n && ask(m, p->params[at], p, at_s); at++) {
        }
        break;
    case DXL_SYNC_WRITE:
        sync_write(m, p, at_s);
        break;
    case DXL_WRITE:
    case DXL_REBOOT:
        tell_all(m, p, at_s);
        break;
    default:
        break;
    }
}

static void count(bus_counts *counts, uint8_t instruction)
{
    uint32_t *const which = instruction == DXL_PING         ? &counts->pings
                            : instruction == DXL_READ       ? &counts->reads
                            : instruction == DXL_WRITE      ? &counts->writes
                            : instruction == DXL_SYNC_READ  ? &counts->sync_reads
                            : instruction == DXL_SYNC_WRITE ? &counts->sync_writes
                            : instruction == DXL_REBOOT     ? &counts->reboots
                            : instruction == WRONG_CRC      ? &counts->damaged
                                                            : &counts->unknown;
    ++*which;
}

static void take_packet(bus_model *m, const dxl_packet *p, double at_s)
{
    count(&m->counts, p->instruction);
    for (int i = 0; i < m->servos_n; i++) {
        bus_servo_pass(&m->servos[i], at_s);
        if (hears(m, &m->servos[i], at_s)) {
            bus_servo_hear(&m->servos[i], at_s);
        }
    }
    if (p->id == DXL_BROADCAST) {
        broadcast(m, p, at_s);
    } else {
        (void)ask(m, p->id, p, at_s);
    }
}

/* --- time ------------------------------------------------------------------------------------------ */

void bus_model_init(bus_model *m, servo_plant *plant, int servos_n, uint32_t baud)
{
    memset(m, 0, sizeof *m);
    bus_wire_init(&m->wire, baud);
    dxl_decoder_init(&m->decoder, m->params, sizeof m->params);
    m->end.n = BETWEEN_PACKETS;
    m->servos_n = servos_n;
    for (int i = 0; i < servos_n; i++) {
        bus_servo_init(&m->servos[i], plant, i, (uint8_t)(i + 1), baud);
    }
}

/* Whether this byte should be the last of a packet; then, and if the decoder has none, its CRC is wrong. */
static bool packet_ends(bus_packet_end *e, uint8_t byte)
{
    e->last = e->last << 8 | byte;
    e->n++;
    if (e->last == 0xFFFFFD00u) {
        e->n = 4;
    } else if (e->n == 5) {
        e->id = byte;
    } else if (e->n == 7) {
        e->end_n = 7u + ((uint32_t)byte << 8 | (e->last >> 8 & 0xFFu));
    }
    return e->n > 7 && e->n == e->end_n;
}

void bus_model_run(bus_model *m, double now_s)
{
    uint8_t byte;
    double at_s;
    while (bus_wire_hear(&m->wire, now_s, &byte, &at_s)) {
        dxl_packet packet = {.instruction = WRONG_CRC};
        const bool ends = packet_ends(&m->end, byte);
        if (!dxl_decode(&m->decoder, byte, &packet)) {
            packet.id = m->end.id;
        }
        if (ends) {
            take_packet(m, &packet, at_s);
        }
    }
    for (int i = 0; i < m->servos_n; i++) {
        bus_servo_pass(&m->servos[i], now_s);
    }
}

/* The servo with that id; 0: the first one. */
static bus_servo *named(bus_model *m, int id)
{
    for (int i = 0; i < m->servos_n; i++) {
        if (m->servos[i].table[DXL_X_ID] == id) {
            return &m->servos[i];
        }
    }
    return id == 0 && m->servos_n > 0 ? &m->servos[0] : NULL;
}

void bus_model_inject(bus_model *m, const injection *script, double now_s)
{
    m->faults = (bus_faults){.lost = 0.0};
    for (int i = 0; i < m->servos_n; i++) {
        m->servos[i].unplugged = false;
        m->servos[i].failing = 0;
    }
    for (int i = 0; i < script->faults_n; i++) {
        const injected_fault *fault = &script->faults[i];
        bus_servo *const s = named(m, (int)fault->amount);
        if (!injection_is_on(fault, now_s)) {
            continue;
        }
        if (fault->kind == INJECT_SERVO && s != NULL) {
            s->failing = BUS_SERVO_OVERLOAD;
        } else if (fault->kind == INJECT_UNPLUG && s != NULL) {
            s->unplugged = true;
        } else if (fault->kind == INJECT_LOSE) {
            m->faults.lost = fault->amount;
        } else if (fault->kind == INJECT_GARBLE) {
            m->faults.damaged = fault->amount;
        } else if (fault->kind == INJECT_SLOW) {
            m->faults.late_s = fault->amount;
        }
    }
}
