/* servo_wire_hal.h - the wire's hal, and the few words that tests of the master are written in. */
#ifndef LIMBER_SERVO_WIRE_HAL_H
#define LIMBER_SERVO_WIRE_HAL_H

#include "servo_wire.h"

static inline void hal_supply(void *context, bool on)
{
    (void)context;
    if (on && !w.supply) {
        w.powered_us = w.now_us;
        for (int i = 0; i < w.servos_n; i++) { /* RAM starts anew */
            const int32_t present = wire_get(&w.servo[i], PRESENT);
            const uint8_t hardware = w.servo[i].table[HARDWARE];
            memset(w.servo[i].table + TORQUE, 0, PRESENT - TORQUE);
            wire_set(&w.servo[i], GOAL, 9999); /* anything but where it is */
            wire_set(&w.servo[i], PRESENT, present);
            w.servo[i].table[HARDWARE] = hardware;
        }
    }
    w.supply = on;
}

static inline bool hal_bus_start(void *context, uint32_t baud)
{
    (void)context;
    w.starts++;
    w.sending = false;
    w.coming_n = 0;
    w.baud = baud;
    return baud != 0 && baud <= w.baud_max;
}

static inline bool hal_bus_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    if (w.sending || bytes_n > sizeof w.out || w.baud == 0) {
        return false;
    }
    memcpy(w.out, bytes, bytes_n);
    w.out_n = bytes_n;
    w.sending = true;
    w.sent_us = w.now_us + wire_bytes_us(bytes_n);
    w.collisions += (int32_t)(w.line_us - w.now_us) > 0 ? 1 : 0;
    if (w.echo) {
        wire_come(bytes, bytes_n, w.now_us);
    }
    return true;
}

static inline bool hal_bus_sending(void *context)
{
    (void)context;
    return w.sending || w.stuck;
}

static inline size_t hal_bus_read(void *context, uint8_t *bytes, size_t room)
{
    (void)context;
    size_t n = 0, kept = 0, there = 0;
    while (there < w.coming_n && (int32_t)(w.now_us - w.coming[there].due_us) >= 0) {
        there++;
    }
    w.unread_max = there > w.unread_max ? there : w.unread_max;
    for (size_t i = 0; i < w.coming_n; i++) {
        if (n < room && kept == 0 && (int32_t)(w.now_us - w.coming[i].due_us) >= 0) {
            bytes[n++] = w.coming[i].byte;
        } else {
            w.coming[kept++] = w.coming[i];
        }
    }
    w.coming_n = kept;
    return n;
}

static inline void hal_bus_abort(void *context)
{
    (void)context;
    uint8_t bytes[64];
    while (hal_bus_read(NULL, bytes, sizeof bytes) > 0) {
    }
    w.aborts++;
    w.sending = false;
}

static inline bool hal_pwm_start(void *context, float rate_hz)
{
    (void)context;
    w.pwm_hz = rate_hz;
    memset(w.pulse_us, 0, sizeof w.pulse_us);
    return true;
}

static inline void hal_pwm_pulse(void *context, int channel, uint32_t width_us)
{
    (void)context;
    TEST_ASSERT_TRUE(channel >= 0 && channel < HAL_PWM_CHANNELS_N);
    w.pulse_us[channel] = width_us;
}

static inline void hal_pwm_stop(void *context)
{
    (void)context;
    memset(w.pulse_us, 0, sizeof w.pulse_us);
}

static const hal WIRE_HAL = {
    .servo_supply = hal_supply,
    .bus_start = hal_bus_start,
    .bus_write = hal_bus_write,
    .bus_sending = hal_bus_sending,
    .bus_read = hal_bus_read,
    .bus_abort = hal_bus_abort,
    .pwm_start = hal_pwm_start,
    .pwm_pulse = hal_pwm_pulse,
    .pwm_stop = hal_pwm_stop,
};

static servos subject;
static float goals_rad[SERVO_COUNT_MAX];

/* N servos with ids 1 ... N at 4 Mbaud, each somewhere else, as delivered but for the rate; the clock is about to
 * wrap. */
static inline servos_config wire_fresh(int servos_n)
{
    memset(&w, 0, sizeof w);
    w.now_us = UINT32_MAX - 300000u;
    w.baud_max = 4500000;
    w.servos_n = servos_n;
    servos_config config = {.kind = SERVOS_BUS, .servos_n = servos_n, .bus_baud = 4000000};
    for (int i = 0; i < servos_n; i++) {
        wire_servo *s = &w.servo[i];
        s->table[MODEL] = 1060 & 0xFF;
        s->table[MODEL + 1] = 1060 >> 8;
        s->table[6] = 45;
        s->table[ID] = (uint8_t)(i + 1);
        s->table[BAUD] = 6;
        s->table[DELAY] = 250;
        s->table[MODE] = 3;
        s->table[VOLTAGE] = 118;
        s->table[TEMPERATURE] = 36;
        wire_set(s, PRESENT, 2048 + (i % 2 ? -7 : 11) * i);
        config.id[i] = (uint8_t)(i + 1);
    }
    return config;
}

static inline void tick(void)
{
    /* the packet's end, and its answers, may lie between two ticks */
    wire_until(w.now_us + 1000u);
    servos_tick(&subject, w.now_us);
}

static inline void run_ms(int ms)
{
    for (int i = 0; i < ms; i++) {
        tick();
    }
}

/* Until it is no longer in that state; how many ms it took. */
static inline int run_while(servos_state state, int ms_max)
{
    int ms = 0;
    while (subject.state == state) {
        TEST_ASSERT_TRUE_MESSAGE(ms < ms_max, "takes too long");
        tick();
        ms++;
    }
    return ms;
}

static inline void configured(const servos_config *config)
{
    servos_configure(&subject, &WIRE_HAL, config);
}

static inline void prepared(const servos_config *config)
{
    configured(config);
    servos_prepare(&subject, w.now_us);
    run_while(SERVOS_PREPARING, 5000);
    TEST_ASSERT_EQUAL_STRING("no trouble", servo_trouble_text(subject.trouble.kind));
    TEST_ASSERT_EQUAL_INT(SERVOS_PREPARED, subject.state);
}

/* Torque where they are, and until the first goals are through. */
static inline void turned_on(const servos_config *config)
{
    prepared(config);
    TEST_ASSERT_TRUE(servos_positions(&subject, goals_rad));
    servos_torque(&subject, goals_rad, w.now_us);
    for (int ms = 0; subject.bus.state == SERVO_BUS_STARTING; ms++) {
        TEST_ASSERT_TRUE_MESSAGE(ms < 1000, "takes too long");
        tick();
    }
    TEST_ASSERT_EQUAL_INT(SERVO_BUS_ON, subject.bus.state);
}

static inline void trouble_is(servo_trouble_kind kind, int servo, int id, uint32_t detail)
{
    TEST_ASSERT_EQUAL_STRING(servo_trouble_text((uint8_t)kind),
                             servo_trouble_text(subject.trouble.kind));
    TEST_ASSERT_EQUAL_INT(servo, subject.trouble.servo);
    TEST_ASSERT_EQUAL_INT(id, subject.trouble.id);
    TEST_ASSERT_EQUAL_UINT32(detail, subject.trouble.detail);
}

/* The place in the log of the nth packet like this, or -1. */
static inline int logged(uint8_t instruction, uint16_t address, int nth)
{
    for (int i = 0; i < w.log_n; i++) {
        if (w.log[i].instruction == instruction && w.log[i].address == address && nth-- == 0) {
            return i;
        }
    }
    return -1;
}

static inline int count_logged(uint8_t instruction, uint16_t address)
{
    int n = 0;
    while (logged(instruction, address, n) >= 0) {
        n++;
    }
    return n;
}

#endif
