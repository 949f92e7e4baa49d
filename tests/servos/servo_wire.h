/* servo_wire.h - a bus with scripted servos, for the tests of its master: what ROBOTIS describes, written a second time
 * and without dynamixel.c. A hal on a clock of its own; bytes take their time, and a packet counts when its last
 * byte has come. */
#ifndef LIMBER_SERVO_WIRE_H
#define LIMBER_SERVO_WIRE_H

#include <stdlib.h>
#include <string.h>

#include "hal.h"
#include "servos.h"
#include "test_support.h"
#include "unity.h"

enum {
    WIRE_SERVOS_N = 128,
    WIRE_TABLE_BYTES = 160,
    WIRE_LOG_N = HOST_OR_BOARD(8000, 800),
    WIRE_COMING_BYTES = 2048,
    WIRE_BOOT_US = 400000,
};

/* Control table, e-Manual XL430-W250: of EEPROM Area, of RAM Area. */
enum {
    MODEL = 0,
    ID = 7,
    BAUD = 8,
    DELAY = 9,
    MODE = 11,
    TORQUE = 64,
    HARDWARE = 70,
    WATCHDOG = 98
};
enum { GOAL = 116, PRESENT = 132, VOLTAGE = 144, TEMPERATURE = 146 };
static const uint32_t WIRE_BAUDS[] = {9600,    57600,   115200,  1000000,
                                      2000000, 3000000, 4000000, 4500000};

typedef struct {
    uint8_t table[WIRE_TABLE_BYTES];
    uint32_t heard_us; /* the last instruction */
    int deaf_n;        /* so many of the next packets it misses */
    int mute_n;        /* so many of the next answers it does not give */
    int garbled_n;     /* so many of the next answers come damaged */
    uint32_t late_us;  /* its answers come so much later */
    uint8_t error;     /* its answers carry this */
    uint8_t stuck_at;  /* writes to this address are taken and come to nothing; 0: none */
    int32_t jump;      /* goal - present when it last got torque */
    int torques, strikes, moves;
} wire_servo;

typedef struct {
    uint32_t at_us;
    uint8_t instruction, id;
    uint16_t address, bytes_n;
    uint8_t first[8]; /* parameters from the address on */
} wire_record;

typedef struct {
    uint32_t now_us, powered_us, sent_us;
    bool supply, echo, sending, stuck; /* stuck: the board never says that it is done */
    uint32_t baud, baud_max;
    int servos_n;
    wire_servo servo[WIRE_SERVOS_N];
    uint8_t out[HAL_BUS_PACKET_MAX_BYTES];
    size_t out_n;
    struct {
        uint8_t byte;
        uint32_t due_us;
    } coming[WIRE_COMING_BYTES];
    size_t coming_n;
    uint32_t line_us; /* when the last byte of an answer is over */
    wire_record log[WIRE_LOG_N];
    int log_n, aborts, starts, overruns;
    int collisions;    /* packets sent while a servo was answering */
    size_t unread_max; /* the most bytes that had come between two reads */
    uint32_t pulse_us[HAL_PWM_CHANNELS_N];
    float pwm_hz;
    int pulsing_n;
} wire;

static wire w;

static inline uint16_t wire_crc(const uint8_t *bytes, size_t n)
{
    uint32_t crc = 0;
    for (size_t i = 0; i < 8 * n; i++) {
        const uint32_t bit = (crc >> 15 & 1u) ^ ((uint32_t)bytes[i / 8] >> (7 - i % 8) & 1u);
        crc = (crc << 1 & 0xFFFFu) ^ (bit ? 0x8005u : 0u);
    }
    return (uint16_t)crc;
}

static inline uint32_t wire_bytes_us(size_t n)
{
    return (uint32_t)((double)n * 1e7 / (double)w.baud + 0.999);
}

static inline int32_t wire_get(const wire_servo *s, int at)
{
    int32_t value;
    memcpy(&value, s->table + at, sizeof value);
    return value;
}

static inline void wire_set(wire_servo *s, int at, int32_t value)
{
    memcpy(s->table + at, &value, sizeof value);
}

/* Bytes that arrive one behind the other from start_us on. */
static inline uint32_t wire_come(const uint8_t *bytes, size_t n, uint32_t start_us)
{
    for (size_t i = 0; i < n; i++) {
        if (w.coming_n == WIRE_COMING_BYTES) {
            w.overruns++;
            break;
        }
        w.coming[w.coming_n].byte = bytes[i];
        w.coming[w.coming_n++].due_us = start_us + wire_bytes_us(i + 1);
    }
    return start_us + wire_bytes_us(n);
}

static inline void wire_answer(wire_servo *s, uint8_t error, const uint8_t *params, size_t n)
{
    uint8_t bytes[64] = {0xFF, 0xFF, 0xFD, 0, s->table[ID], (uint8_t)(n + 4), 0, 0x55};
    const uint8_t alert = s->table[HARDWARE] != 0 ? 0x80 : 0;
    bytes[8] = error | s->error | alert;
    memcpy(bytes + 9, params, n); /* no test's parameters need stuffing */
    const uint16_t crc = wire_crc(bytes, 9 + n);
    bytes[9 + n] = (uint8_t)crc;
    bytes[10 + n] = (uint8_t)(crc >> 8);
    if (s->mute_n > 0) {
        s->mute_n--;
        return;
    }
    if (s->garbled_n > 0) {
        s->garbled_n--;
        bytes[9] ^= 0x10;
    }
    w.line_us = wire_come(bytes, 11 + n, w.line_us + 2u * s->table[DELAY] + 20u + s->late_us);
}

static inline uint8_t wire_write(wire_servo *s, int at, const uint8_t *bytes, size_t n)
{
    const bool rom = at < TORQUE && s->table[TORQUE] != 0;
    const bool struck = at == GOAL && s->table[WATCHDOG] == 0xFF;
    const int32_t goal = n == 4 ? (int32_t)(bytes[0] | bytes[1] << 8 | bytes[2] << 16 |
                                            (int32_t)((uint32_t)bytes[3] << 24))
                                : 0;
    if (rom) {
        return 0x07;
    }
    if (struck || (at == GOAL && s->table[MODE] == 3 && (goal < 0 || goal > 4095))) {
        return 0x04;
    }
    const bool had_torque = s->table[TORQUE] != 0;
    if (s->stuck_at == 0 || at != s->stuck_at) {
        memcpy(s->table + at, bytes, n);
    }
    if (!had_torque && s->table[TORQUE] != 0) {
        s->jump = wire_get(s, GOAL) - wire_get(s, PRESENT);
        s->torques++;
    }
    if (s->table[TORQUE] != 0 && wire_get(s, GOAL) != wire_get(s, PRESENT)) {
        wire_set(s, PRESENT, wire_get(s, GOAL)); /* as fast as can be */
        s->moves++;
    }
    return 0;
}

/* What one servo does about an instruction: p[n] are its parameters. */
static inline void wire_obey(wire_servo *s, const uint8_t *packet, const uint8_t *p, size_t n)
{
    const uint8_t id = packet[4], instruction = packet[7];
    const bool mine = id == s->table[ID];
    const int at = n >= 2 ? p[0] | p[1] << 8 : 0, each = n >= 4 ? p[2] | p[3] << 8 : 0;
    if (instruction == 0x01 && mine) {
        const uint8_t about[3] = {s->table[0], s->table[1], s->table[6]};
        wire_answer(s, 0, about, 3);
    } else if (instruction == 0x02 && mine) {
        wire_answer(s, 0, s->table + at, (size_t)each);
    } else if (instruction == 0x03 && (mine || id == 0xFE)) {
        const uint8_t error = wire_write(s, at, p + 2, n - 2);
        if (mine) {
            wire_answer(s, error, p, 0);
        }
    } else if (instruction == 0x83) {
        for (size_t i = 4; i < n; i += 1 + (size_t)each) {
            if (p[i] == s->table[ID]) {
                wire_write(s, at, p + i + 1, (size_t)each);
            }
        }
    }
}

static inline bool wire_listens(wire_servo *s)
{
    const uint32_t pause_us = w.sent_us - s->heard_us;
    if (!w.supply || w.sent_us - w.powered_us < WIRE_BOOT_US ||
        WIRE_BAUDS[s->table[BAUD]] != w.baud) {
        return false;
    }
    if (s->deaf_n > 0) {
        s->deaf_n--;
        return false;
    }
    const uint8_t limit = s->table[WATCHDOG];
    if (s->table[TORQUE] != 0 && limit > 0 && limit < 128 && pause_us > 20000u * limit) {
        s->table[WATCHDOG] = 0xFF;
        s->strikes++;
    }
    s->heard_us = w.sent_us;
    return true;
}

static inline void wire_sync_read(const uint8_t *p, size_t n)
{
    for (size_t i = 4; i < n; i++) {
        for (int k = 0; k < w.servos_n; k++) {
            if (w.servo[k].table[ID] == p[i] && wire_listens(&w.servo[k])) {
                wire_answer(&w.servo[k], 0, w.servo[k].table + p[0], p[2]);
            }
        }
    }
}

static inline void wire_record_packet(size_t params_n)
{
    TEST_ASSERT_TRUE_MESSAGE(w.log_n < WIRE_LOG_N, "the log is full");
    wire_record *r = &w.log[w.log_n++];
    const uint8_t *p = w.out + 8;
    *r = (wire_record){.at_us = w.sent_us, .instruction = w.out[7], .id = w.out[4]};
    r->address = (uint16_t)(params_n >= 2 ? p[0] | p[1] << 8 : 0);
    r->bytes_n = (uint16_t)w.out_n;
    const size_t first_n = params_n < 10 ? (params_n > 2 ? params_n - 2 : 0) : 8;
    memcpy(r->first, p + 2, first_n);
}

/* The packet is on the wire to its end. */
static inline void wire_deliver(void)
{
    const size_t params_n = w.out_n - 10;
    TEST_ASSERT_EQUAL_HEX16(wire_crc(w.out, w.out_n - 2),
                            w.out[w.out_n - 2] | w.out[w.out_n - 1] << 8);
    wire_record_packet(params_n);
    w.line_us = w.sent_us;
    if (w.out[7] == 0x82) {
        wire_sync_read(w.out + 8, params_n);
        return;
    }
    for (int i = 0; i < w.servos_n; i++) {
        if (wire_listens(&w.servo[i])) {
            wire_obey(&w.servo[i], w.out, w.out + 8, params_n);
        }
    }
}

static inline void wire_until(uint32_t now_us)
{
    w.now_us = now_us;
    if (w.sending && (int32_t)(now_us - w.sent_us) >= 0) {
        w.sending = false;
        wire_deliver();
    }
}

#endif
