/* servo_bus_ask.c - one question at a time: sent, waited for, asked again; see servo_bus.h. */
#include "servo_bus_private.h"

#include <string.h>

enum {
    LATEST_ANSWER_US = 2 * 254, /* the longest Return Delay Time */
    MARGIN_US = 1000,
    LISTEN_BYTES = 64,
    ANSWERS_US =
        20000, /* so long may one question and its answers take, that the watchdogs hear something */
};

static uint32_t wire_us(uint32_t baud, uint32_t bytes_n)
{
    const uint32_t byte_ns = 1000000000u / (baud / 10u);
    return bytes_n * byte_ns / 1000u;
}

void servo_bus_forget(servo_bus *b)
{
    b->hal->bus_abort(b->hal->context);
    dxl_decoder_init(&b->decoder, b->params, sizeof b->params);
    b->decoder.bad_n = b->counts.damaged;
    b->question.state = QUESTION_NONE;
}

bool servo_bus_start(servo_bus *b, uint32_t baud)
{
    servo_bus_forget(b);
    b->baud = b->hal->bus_start(b->hal->context, baud) ? baud : 0;
    return b->baud != 0;
}

bool servo_bus_tell(servo_bus *b, size_t packet_n)
{
    b->packet_n = (uint16_t)packet_n;
    if (packet_n == 0 || !b->hal->bus_write(b->hal->context, b->packet, packet_n)) {
        return false;
    }
    b->counts.sent++;
    b->told_us = b->now_us;
    return true;
}

void servo_bus_tell_all(servo_bus *b, uint16_t address, uint8_t value)
{
    servo_bus_tell(b, dxl_write(b->packet, sizeof b->packet, DXL_BROADCAST, address, 1, value));
}

/* Sends the packet, for the first time or again. */
static void put(servo_bus *b, size_t packet_n, int answers_n)
{
    servo_bus_question *q = &b->question;
    const uint32_t answer_us = wire_us(b->baud, DXL_STATUS_BYTES + q->answer_n) + LATEST_ANSWER_US;
    q->state = QUESTION_OPEN;
    q->residue_n = 0;
    q->since_us = b->now_us;
    q->patience_us = wire_us(b->baud, (uint32_t)packet_n) + (uint32_t)answers_n * answer_us +
                     MARGIN_US + b->hal->bus_slack_us;
    q->tries--;
    servo_bus_tell(b, packet_n); /* what cannot be sent has no answer */
}

void servo_bus_ask_one(servo_bus *b, uint8_t id, size_t packet_n, int answer_n, int tries)
{
    b->question.id = id;
    b->question.servos_n = 0;
    b->question.answer_n = (uint8_t)answer_n;
    b->question.tries = (uint8_t)tries;
    put(b, packet_n, 1);
}

void servo_bus_ask_ping(servo_bus *b, uint8_t id, int tries)
{
    servo_bus_ask_one(b, id, dxl_ping(b->packet, sizeof b->packet, id), 3, tries);
}

void servo_bus_ask_read(servo_bus *b, uint8_t id, uint16_t address, int n, int tries)
{
    const size_t packet_n = dxl_read(b->packet, sizeof b->packet, id, address, (uint16_t)n);
    servo_bus_ask_one(b, id, packet_n, n, tries);
}

void servo_bus_ask_write(servo_bus *b, uint8_t id, uint16_t address, int n, uint32_t value)
{
    const size_t packet_n = dxl_write(b->packet, sizeof b->packet, id, address, (uint16_t)n, value);
    servo_bus_ask_one(b, id, packet_n, 0, SERVO_BUS_TRIES);
}

/* All that have not answered yet, in one packet. */
static void put_many(servo_bus *b)
{
    const servo_bus_question *q = &b->question;
    uint8_t *ids = b->packet + DXL_SYNC_PARAMS_AT;
    int ids_n = 0;
    dxl_sync_open(b->packet, q->address, q->answer_n);
    for (int i = 0; i < q->servos_n; i++) {
        if ((q->missing >> i & 1u) != 0) {
            ids[ids_n++] = b->config->id[q->first + i];
        }
    }
    put(b, dxl_seal(b->packet, sizeof b->packet, DXL_BROADCAST, DXL_SYNC_READ, 4u + (size_t)ids_n),
        ids_n);
}

static int at_once(const servo_bus *b, int n)
{
    const uint32_t answer_n = DXL_STATUS_BYTES + (uint32_t)n;
    const uint32_t by_time = ANSWERS_US / (wire_us(b->baud, answer_n + 1) + 1);
    return by_time == 0 ? 1 : by_time < SERVO_BUS_CHUNK_MAX ? (int)by_time : SERVO_BUS_CHUNK_MAX;
}

void servo_bus_ask_many(servo_bus *b, int first, uint16_t address, int n,
                        void (*each)(servo_bus *b, int place, uint32_t value))
{
    const int left = b->config->servos_n - first, most = at_once(b, n);
    const int servos_n = left < most ? left : most;
    servo_bus_question *q = &b->question;
    q->servos_n = (uint8_t)servos_n;
    q->first = (int16_t)first;
    q->address = address;
    q->answer_n = (uint8_t)n;
    q->tries = SERVO_BUS_TRIES;
    q->missing = (1u << servos_n) - 1u;
    q->each = each;
    put_many(b);
}

/* Which of several this id is, among those that have not answered; -1: none. */
static int among(const servo_bus *b, uint8_t id)
{
    const servo_bus_question *q = &b->question;
    for (int i = 0; i < q->servos_n; i++) {
        if ((q->missing >> i & 1u) != 0 && b->config->id[q->first + i] == id) {
            return i;
        }
    }
    return -1;
}

static void take_one(servo_bus *b, const dxl_packet *packet)
{
    servo_bus_question *q = &b->question;
    memcpy(q->answer, packet->params, q->answer_n);
    q->state = QUESTION_ANSWERED;
}

static void take_of_many(servo_bus *b, const dxl_packet *packet, int which)
{
    servo_bus_question *q = &b->question;
    uint8_t bytes[4] = {0};
    memcpy(bytes, packet->params, q->answer_n);
    q->missing &= ~(1u << which);
    q->each(b, q->first + which, dxl_u32(bytes));
    if (q->missing == 0) {
        q->state = QUESTION_ANSWERED;
    }
}

static void take_status(servo_bus *b, const dxl_packet *packet)
{
    servo_bus_question *q = &b->question;
    const int number = packet->error & ~DXL_ALERT;
    const int which = q->servos_n > 0 ? among(b, packet->id) : packet->id == q->id ? 0 : -1;
    if (q->state != QUESTION_OPEN || which < 0) {
        b->counts.stray++;
    } else if (number == DXL_E_CRC) {
        q->residue_n += (uint32_t)packet->wire_n; /* our packet was damaged on its way: ask again */
    } else if (number != 0) {
        q->id = packet->id;
        q->error = (uint8_t)number;
        q->state = QUESTION_REFUSED;
    } else if (packet->params_n != q->answer_n) {
        b->counts.stray++; /* the late answer to another question */
    } else {
        b->counts.good++;
        q->error = packet->error;
        if (q->servos_n > 0) {
            take_of_many(b, packet, which);
        } else {
            take_one(b, packet);
        }
    }
}

static void take(servo_bus *b, const dxl_packet *packet)
{
    const uint32_t wire_n = (uint32_t)packet->wire_n;
    servo_bus_question *q = &b->question;
    q->residue_n -= wire_n < q->residue_n ? wire_n : q->residue_n;
    if (packet->instruction == DXL_STATUS) {
        take_status(b, packet);
    } else {
        b->counts.echoes++;
    }
}

/* Nobody answered in time, or not all: asks again, or gives up. */
static void lose_patience(servo_bus *b)
{
    servo_bus_question *q = &b->question;
    b->counts.timeouts++;
    if (q->tries == 0) {
        q->state = q->residue_n > 0 ? QUESTION_GARBLED : QUESTION_SILENT;
    } else if (q->servos_n > 0) {
        put_many(b);
    } else {
        put(b, b->packet_n, 1);
    }
}

void servo_bus_listen(servo_bus *b)
{
    uint8_t bytes[LISTEN_BYTES];
    size_t bytes_n, all_n = 0;
    do {
        bytes_n = b->hal->bus_read(b->hal->context, bytes, sizeof bytes);
        b->question.residue_n += (uint32_t)bytes_n;
        for (size_t i = 0; i < bytes_n; i++) {
            dxl_packet packet;
            if (dxl_decode(&b->decoder, bytes[i], &packet)) {
                take(b, &packet);
            }
        }
        all_n += bytes_n;
    } while (bytes_n == sizeof bytes && all_n + sizeof bytes <= HAL_BUS_PACKET_MAX_BYTES);
    b->counts.damaged = b->decoder.bad_n;
    const servo_bus_question *q = &b->question;
    if (q->state == QUESTION_OPEN && b->now_us - q->since_us > q->patience_us) {
        lose_patience(b);
    }
}

/* Its place in config.id, or -1. */
static int place_of(const servo_bus *b, uint8_t id)
{
    for (int i = 0; i < b->config->servos_n; i++) {
        if (b->config->id[i] == id) {
            return i;
        }
    }
    return -1;
}

servo_trouble servo_bus_loss(const servo_bus *b)
{
    const servo_bus_question *q = &b->question;
    servo_trouble t = {.kind = SERVO_TROUBLE_SILENT, .servo = -1, .id = q->id};
    for (int i = 0; i < q->servos_n && q->state != QUESTION_REFUSED; i++) {
        if ((q->missing >> i & 1u) != 0) {
            t.id = b->config->id[q->first + i]; /* the first that has not answered */
            break;
        }
    }
    if (b->state != SERVO_BUS_REQUEST) {
        t.servo = (int16_t)place_of(b, t.id);
    }
    if (q->state == QUESTION_GARBLED) {
        t.kind = SERVO_TROUBLE_GARBLED;
    } else if (q->state == QUESTION_REFUSED) {
        t.kind = SERVO_TROUBLE_STATUS;
        t.detail = q->error;
    }
    return t;
}
