/* test_barrage.c - bytes nobody meant, by the hundred million: no frame of noise is taken for one, and no
 * well-formed nonsense does harm.
 *
 *     test_barrage [BYTES]     of each kind, 2,000,000 by default
 */
#include "device_fixture.h"

static long bytes_n = 2000000;
static uint64_t random_state = 0x9E3779B97F4A7C15u;

static uint32_t next_random(void)
{
    random_state ^= random_state << 13; /* xorshift64, Marsaglia 2003 */
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (uint32_t)(random_state >> 32);
}

void setUp(void)
{
    bench_connected(6);
}

void tearDown(void)
{
    free(b);
}

/* Plain noise, a border in every twelfth place, so that it comes in pieces of all lengths. */
static void test_noise_is_never_a_frame(void)
{
    const uint32_t good = b->host.device.link.decoder.counts.good;
    for (long sent = 0; sent < bytes_n;) {
        while (b->to_n < LINK_READ_MAX_BYTES) {
            const uint32_t r = next_random();
            b->to_device[b->to_n++] = (r >> 8) % 12u == 0 ? 0 : (uint8_t)r;
            sent++;
        }
        tick();
    }
    TEST_ASSERT_EQUAL_UINT32(good, b->host.device.link.decoder.counts.good);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    TEST_ASSERT_FALSE(b->host.plant.powered);
    TEST_ASSERT_TRUE(
        b->host.device.link.decoder.counts.cobs + b->host.device.link.decoder.counts.crc > 1000);
}

/* Every type with random fields, of the right length more often than not, with the right checksum. ARM among
 * them: torque only where a state may have it; angles finite and within their stops whatever was set. */
static void test_nonsense_in_good_frames_does_no_harm(void)
{
    for (long sent = 0; sent < bytes_n;) {
        const message_info *info = &messages[next_random() % MESSAGES_N];
        if (info->type == MESSAGE_REBOOT) {
            continue; /* does what it says: the bench's line would be gone */
        }
        uint8_t payload[FRAME_PAYLOAD_MAX];
        size_t n = info->fixed_bytes + (next_random() % 4u == 0 ? next_random() % 20u : 0u);
        n += (size_t)info->tail.element_bytes * (next_random() % 8u);
        for (size_t i = 0; i < n; i++) {
            payload[i] = next_random() % 3u == 0 ? 0 : (uint8_t)next_random();
        }
        const frame f = {info->type,    b->session, (uint16_t)next_random(),
                         pc_clock_us(), payload,    n};
        const size_t wire_n =
            frame_encode(&f, b->to_device + b->to_n, sizeof b->to_device - b->to_n);
        TEST_ASSERT_TRUE(wire_n > 0);
        b->to_n += wire_n;
        sent += (long)wire_n;
        if (info->type == MESSAGE_HELLO) {
            say_hello(100.0f);
        }
        tick();
        const supervisor_duty *duty = &supervisor_duties[state_now()];
        TEST_ASSERT_TRUE(!servo_plant_has_torque(&b->host.plant) || duty->servo_power ||
                         b->host.device.servos.state == SERVOS_SERVICE);
        const rod_joint *angles = rod_angles(&b->host.device.body.rod);
        for (int i = 0; i < b->host.device.params.in_force.rod.links_n; i++) {
            const float limit = b->host.device.params.in_force.rod.limit_rad[i];
            TEST_ASSERT_TRUE(angles[i][0] >= -limit && angles[i][0] <= limit);
            TEST_ASSERT_TRUE(angles[i][1] >= -limit && angles[i][1] <= limit);
        }
    }
    TEST_ASSERT_TRUE(b->host.device.commands_refused > 100);
}

int main(int argc, char **argv)
{
    bytes_n = argc > 1 ? atol(argv[1]) : bytes_n;
    UNITY_BEGIN();
    RUN_TEST(test_noise_is_never_a_frame);
    RUN_TEST(test_nonsense_in_good_frames_does_no_harm);
    return UNITY_END();
}
