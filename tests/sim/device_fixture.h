/* device_fixture.h - the whole device in one process, on its virtual clock, with the test as its PC.
 *
 * The line is two buffers; whatever the device says is unpacked and kept: the newest of each type, and counts.
 */
#ifndef LIMBER_DEVICE_FIXTURE_H
#define LIMBER_DEVICE_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include "host_device.h"
#include "unity.h"

typedef struct {
    host_device host;
    uint8_t to_device[65536], from_device[65536];
    size_t to_n, from_n;
    frame_decoder decoder;
    message newest[256];
    frame newest_header[256];
    unsigned seen_n[256];
    uint8_t session;
    uint16_t request_id, pose_seq;
    uint32_t ahead_us; /* of the PC's clock against the device's */
} bench;

static bench *b; /* one at a time; setUp makes it, tearDown frees it */

static size_t bench_read(void *context, uint8_t *bytes, size_t room)
{
    host_device *h = context;
    size_t n = b->to_n < room ? b->to_n : room;
    memcpy(bytes, b->to_device, n);
    b->to_n -= n;
    memmove(b->to_device, b->to_device + n, b->to_n);
    return injection_spoil(&h->injection, h->elapsed_s, bytes, n);
}

static bool bench_write(void *context, const uint8_t *bytes, size_t bytes_n)
{
    (void)context;
    if (b->from_n + bytes_n > sizeof b->from_device) {
        return false;
    }
    memcpy(b->from_device + b->from_n, bytes, bytes_n);
    b->from_n += bytes_n;
    return true;
}

static size_t bench_free(void *context)
{
    (void)context;
    return sizeof b->from_device - b->from_n;
}

static void bench_start_at(float tick_s, int links_n)
{
    host_device_start(&b->host, tick_s, links_n);
    b->host.hal.line_read = bench_read;
    b->host.hal.line_write = bench_write;
    b->host.hal.line_free = bench_free;
}

static void bench_start(int links_n)
{
    bench_start_at(1e-3f, links_n);
}

static void bench_new(int links_n)
{
    b = calloc(1, sizeof *b);
    TEST_ASSERT_NOT_NULL(b);
    b->host.line = (line){.fd = -1, .listen_fd = -1, .kept_fd = -1};
    servo_plant_init(&b->host.plant, 3, 15.0f);
    (void)flash_file_open(&b->host.flash, NULL);
    (void)body_log_open(&b->host.log, NULL);
    frame_decoder_init(&b->decoder);
    b->session = 1;
    bench_start(links_n);
}

static uint32_t pc_clock_us(void)
{
    return b->host.hal.now_us(&b->host) + b->ahead_us;
}

static void say_as(const message *m, uint16_t seq)
{
    b->to_n += messages_encode(m, b->session, seq, pc_clock_us(), b->to_device + b->to_n,
                               sizeof b->to_device - b->to_n);
}

/* A request with a fresh id; m's first field is the id in all of them. */
static void ask(message m)
{
    m.arm.request_id = ++b->request_id;
    say_as(&m, b->request_id);
}

static void ask_simply(uint8_t type)
{
    ask((message){.type = type});
}

static void pose_at(float x_m)
{
    const message m = {
        .type = MESSAGE_POSE,
        .pose = {.position_m = {x_m, 0.0f, 0.0f}, .quaternion_xyzw = {0.0f, 0.0f, 0.0f, 1.0f}}};
    say_as(&m, ++b->pose_seq);
}

static void listen_to_it(void)
{
    frame f;
    for (size_t i = 0; i < b->from_n; i++) {
        if (frame_decoder_push(&b->decoder, b->from_device[i], &f)) {
            TEST_ASSERT_EQUAL_INT(MESSAGES_OK, messages_unpack(&f, &b->newest[f.type]));
            b->newest_header[f.type] = f;
            b->seen_n[f.type]++;
        }
    }
    b->from_n = 0;
}

static void tick(void)
{
    host_device_tick(&b->host);
    listen_to_it();
}

__attribute__((unused)) static void ticks(int n)
{
    for (int i = 0; i < n; i++) {
        tick();
    }
}

/* One value, or all of a list, staged. */
__attribute__((unused)) static void stage(const char *name, int first, float value)
{
    message m = {.type = MESSAGE_PARAM_SET,
                 .param_set = {.first = (uint16_t)first, .values_n = 1, .values = {value}}};
    strcpy(m.param_set.name, name);
    ask(m);
    tick();
}

/* The NACK to the last request. */
__attribute__((unused)) static const message_nack *refused_at_once(uint8_t reason)
{
    const message_nack *nack = &b->newest[MESSAGE_NACK].nack;
    TEST_ASSERT_EQUAL_UINT16(b->request_id, nack->request_id);
    TEST_ASSERT_EQUAL_UINT8(reason, nack->reason);
    return nack;
}

/* Until it is answered. */
__attribute__((unused)) static void save(void)
{
    ask_simply(MESSAGE_PARAM_SAVE);
    for (int i = 0; i < 2000 && (b->newest[MESSAGE_ACK].ack.request_id != b->request_id &&
                                 b->newest[MESSAGE_NACK].nack.request_id != b->request_id);
         i++) {
        tick();
    }
}

/* A hand that sways: one pose every period_ticks. */
__attribute__((unused)) static void sway(int n, int period_ticks, float amplitude_m)
{
    for (int i = 0; i < n; i++) {
        if (i % period_ticks == 0) {
            const trig_pair t =
                trig_sincos(3.0f * (float)b->pose_seq * (float)period_ticks * 1e-3f);
            pose_at(amplitude_m * t.sin);
        }
        tick();
    }
}

static int state_now(void)
{
    return (int)b->host.device.supervisor.state;
}

static void say_hello(float pose_hz)
{
    message m = {.type = MESSAGE_HELLO,
                 .hello = {.protocol_major = PROTOCOL_MAJOR, .pose_hz = pose_hz}};
    ask(m);
    tick();
}

/* A device that knows the tool and its clock. */
__attribute__((unused)) static void bench_connected(int links_n)
{
    bench_new(links_n);
    say_hello(100.0f);
    ticks(20);
}

/* After an ARM the servos boot, are found and blend in: ACTIVE. */
__attribute__((unused)) static void sway_until_active(void)
{
    for (int i = 0; i < 300 && state_now() != SUPERVISOR_ACTIVE; i++) {
        sway(10, 10, 0.05f);
    }
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
}

/* HELLO, poses, ARM. */
__attribute__((unused)) static void get_active(void)
{
    say_hello(100.0f);
    sway(300, 10, 0.05f);
    ask_simply(MESSAGE_ARM);
    sway_until_active();
}

#endif
