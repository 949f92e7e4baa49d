/* bus_fixture.h - the model servo bus on a virtual clock, with the test as its controller. */
#ifndef LIMBER_BUS_FIXTURE_H
#define LIMBER_BUS_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include "bus_model.h"
#include "unity.h"

enum { HEARD_BYTES = 8192, STATUSES = 256, DATA_BYTES = 148 };

typedef struct {
    uint8_t id, error;
    uint8_t data[DATA_BYTES];
    size_t data_n;
} status;

typedef struct {
    servo_plant plant;
    bus_model model;
    double now_s, turned_s;
    uint8_t heard[HEARD_BYTES]; /* since the last tell() */
    size_t heard_n;
    status statuses[STATUSES];
    int statuses_n;
    uint8_t packet[1024];
} bus_bench;

static bus_bench *bench; /* one at a time; bus_new makes it, bus_free frees it */

/* Up to now + so much, in steps as short as the plant's ticks. */
static void pass(double seconds)
{
    const double until_s = bench->now_s + seconds;
    while (bench->now_s < until_s) {
        const double next_s = bench->turned_s + 1e-3;
        bench->now_s = next_s < until_s ? next_s : until_s;
        bus_model_run(&bench->model, bench->now_s);
        if (bench->now_s >= next_s) {
            servo_plant_tick(&bench->plant, 1e-3f);
            bench->turned_s = next_s;
        }
    }
}

/* Servos with ids 1 ..., that have power and have booted. */
static void bus_new(int servos_n, uint32_t baud)
{
    bench = calloc(1, sizeof *bench);
    TEST_ASSERT_NOT_NULL(bench);
    servo_plant_init(&bench->plant, 3, 15.0f);
    bus_model_init(&bench->model, &bench->plant, servos_n, baud);
    bench->plant.powered = true;
    pass(0.4);
}

static void bus_free(void)
{
    free(bench);
}

static bus_servo *servo(int id)
{
    for (int i = 0; i < bench->model.servos_n; i++) {
        if (bench->model.servos[i].table[DXL_X_ID] == id) {
            return &bench->model.servos[i];
        }
    }
    TEST_FAIL_MESSAGE("no such servo");
    return NULL;
}

/* Whole status packets among what was heard. */
static void take_statuses(void)
{
    uint8_t params[1024];
    dxl_decoder decoder;
    dxl_packet p;
    dxl_decoder_init(&decoder, params, sizeof params);
    bench->statuses_n = 0;
    for (size_t i = 0; i < bench->heard_n; i++) {
        if (dxl_decode(&decoder, bench->heard[i], &p) && p.instruction == DXL_STATUS) {
            TEST_ASSERT_TRUE(bench->statuses_n < STATUSES && p.params_n <= DATA_BYTES);
            status *s = &bench->statuses[bench->statuses_n++];
            *s = (status){.id = p.id, .error = p.error, .data_n = p.params_n};
            memcpy(s->data, params, p.params_n);
        }
    }
}

static void listen_for(double seconds)
{
    pass(seconds);
    bench->heard_n = bus_wire_read(&bench->model.wire, bench->heard, HEARD_BYTES, bench->now_s);
    take_statuses();
}

/* Sends a packet and hears what comes within half a second; returns how many status packets. */
static int tell(const uint8_t *packet, size_t n)
{
    TEST_ASSERT_TRUE(n > 0);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, packet, n, bench->now_s));
    listen_for(0.5);
    return bench->statuses_n;
}

/* The only answer there is: its error. */
static int error_of_only_answer(void)
{
    TEST_ASSERT_EQUAL_INT(1, bench->statuses_n);
    return bench->statuses[0].error;
}

__attribute__((unused)) static int ping(uint8_t id)
{
    return tell(bench->packet, dxl_ping(bench->packet, sizeof bench->packet, id));
}

__attribute__((unused)) static int write_to(uint8_t id, uint16_t address, uint16_t n,
                                            uint32_t value)
{
    (void)tell(bench->packet,
               dxl_write(bench->packet, sizeof bench->packet, id, address, n, value));
    return error_of_only_answer();
}

/* The value read, of 1, 2 or 4 bytes. */
__attribute__((unused)) static uint32_t read_from(uint8_t id, uint16_t address, uint16_t n)
{
    (void)tell(bench->packet, dxl_read(bench->packet, sizeof bench->packet, id, address, n));
    TEST_ASSERT_EQUAL_HEX8(0, error_of_only_answer() & ~DXL_ALERT);
    TEST_ASSERT_EQUAL_UINT(n, bench->statuses[0].data_n);
    bench->statuses[0].data[n] = bench->statuses[0].data[n + 1] = 0;
    return n == 4   ? dxl_u32(bench->statuses[0].data)
           : n == 2 ? dxl_u16(bench->statuses[0].data)
                    : bench->statuses[0].data[0];
}

/* The packet that writes 4 bytes a servo: value + i to servo i, ids 1 ... servos_n. */
__attribute__((unused)) static size_t sync_write(uint16_t address, int servos_n, int32_t value)
{
    uint8_t *at = bench->packet + DXL_SYNC_PARAMS_AT;
    dxl_sync_open(bench->packet, address, 4);
    for (int i = 0; i < servos_n; i++, at += 5) {
        at[0] = (uint8_t)(i + 1);
        dxl_put_u32(at + 1, (uint32_t)(value + i));
    }
    return dxl_seal(bench->packet, sizeof bench->packet, DXL_BROADCAST, DXL_SYNC_WRITE,
                    (size_t)(4 + 5 * servos_n));
}

__attribute__((unused)) static size_t sync_read(uint16_t address, uint16_t n, const uint8_t *ids,
                                                size_t ids_n)
{
    dxl_sync_open(bench->packet, address, n);
    memcpy(bench->packet + DXL_SYNC_PARAMS_AT, ids, ids_n);
    return dxl_seal(bench->packet, sizeof bench->packet, DXL_BROADCAST, DXL_SYNC_READ, 4 + ids_n);
}

__attribute__((unused)) static int32_t position(int id)
{
    return (int32_t)read_from((uint8_t)id, DXL_X_PRESENT_POSITION, 4);
}

#endif
