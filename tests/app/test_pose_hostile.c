/* test_pose_hostile.c - whatever comes in, what goes to the rod is a pose, and everything is counted. */
#include "pose_fixture.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static float hostile(uint32_t *seed, int kind)
{
    switch (kind) {
    case 0:
        return float_of(random_bits(seed));
    case 1:
        return (float)random_between(seed, -600.0, 600.0);
    default:
        return (float)random_between(seed, -0.02, 0.02);
    }
}

static uint32_t attack(uint32_t seed, int n, pose_mode mode)
{
    pose_input in = started(mode, seed);
    pose_input_params params = pose_input_defaults();
    uint32_t now_us = seed, hash = 2166136261u;
    uint16_t seq = (uint16_t)seed;
    rod_pose pose = pose_at(0.0f, 0.0f, 0.0f);
    for (int i = 0; i < n; i++) {
        const int kind = random_below(&seed, 60);
        if (kind < 58 && random_below(&seed, 2) == 0) { /* goes on from here, and so often passes */
            const vec3 step = {hostile(&seed, 2), hostile(&seed, 2), hostile(&seed, 2)};
            pose.position_m = vec3_add(pose.position_m, step);
            pose.orientation = quat_multiply(
                quat_about((vec3){1.0f, hostile(&seed, 1), 1.0f}, (double)hostile(&seed, 2)),
                pose.orientation);
        } else if (kind >= 58) {
            pose.position_m = (vec3){hostile(&seed, kind - 58), hostile(&seed, 1), 499.0f};
            pose.orientation = random_quat(&seed);
        }
        pose_sample sample = sample_at(now_us, seq, pose);
        if (random_below(&seed, 50) == 0) {
            sample.pose.orientation.z = hostile(&seed, 0);
        }
        seq = (uint16_t)(seq + (random_below(&seed, 30) == 0 ? random_bits(&seed) : 1u));
        sample.sent_us += random_below(&seed, 30) == 0 ? random_bits(&seed) : 0u;
        sample.age_us = random_below(&seed, 30) == 0 ? random_bits(&seed) % 60000u : 0u;
        if (random_below(&seed, 100) == 0) {
            const clock_exchange exchange = {now_us, random_bits(&seed), random_bits(&seed),
                                             now_us};
            clock_map_exchange(&in.clock, &exchange);
        }
        if (random_below(&seed, 500) == 0) {
            pose_input_open(&in, SESSION);
            params.mode = random_below(&seed, 2) == 0 ? POSE_PREDICT : POSE_INTERPOLATE;
            params.speed_max_mps = (float)random_magnitude(&seed, 1e-6, 100.0);
            params.horizon_us = random_bits(&seed) % 100001u;
            TEST_ASSERT_TRUE(pose_input_set(&in, &params));
        }
        now_us += (uint32_t)random_below(&seed, 5) == 0 ? random_bits(&seed) % 30000u
                                                        : random_bits(&seed) % 2000u;
        pose_input_receive(&in, &sample, now_us);
        now_us += random_bits(&seed) % 1500u;
        const pose_tick tick = pose_input_tick(&in, now_us);
        if (tick.valid) {
            const quat q = tick.base.orientation;
            const double length = sqrt((double)q.x * (double)q.x + (double)q.y * (double)q.y +
                                       (double)q.z * (double)q.z + (double)q.w * (double)q.w);
            TEST_ASSERT_TRUE(fabs(length - 1.0) <= 1e-5);
            TEST_ASSERT_TRUE(length_double(tick.base.position_m) <= 1000.0);
            hash = (hash ^ bits_of(tick.base.position_m.x)) * 16777619u;
            hash = (hash ^ bits_of(q.w)) * 16777619u;
        }
        const pose_stream stream = pose_input_stream(&in);
        TEST_ASSERT_TRUE(stream.good_us == 0 || stream.state == POSE_STREAM_GOOD);
    }
    TEST_ASSERT_EQUAL_UINT32(in.received, counted(&in));
    TEST_ASSERT_EQUAL_UINT32((uint32_t)n, in.received);
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)n / 20u, in.count[POSE_ACCEPTED]);
    return hash;
}

static void test_hostile_poses(void)
{
    const int n = HOST_OR_BOARD(50000, 1000);
    const uint32_t predicted = attack(77, n, POSE_PREDICT);
    attack(78, n, POSE_INTERPOLATE);
    TEST_ASSERT_EQUAL_HEX32(predicted, attack(77, n, POSE_PREDICT)); /* and the same every time */
}

/* A shaken hand with noise, made without libm: the same bits on every machine. */
static void test_the_same_bits_everywhere(void)
{
    pose_input in = started(POSE_PREDICT, 0);
    uint32_t seed = 5, hash = 2166136261u;
    uint16_t seq = 0;
    for (uint32_t t_us = 0, next_us = 0; t_us < 1000000; t_us += 1000) {
        for (; next_us <= t_us; next_us += 4000u + random_bits(&seed) % 8000u) {
            const trig_pair at = trig_sincos(12.0f * 1e-6f * (float)next_us);
            const float noise_m = (float)(random_bits(&seed) % 1000u) * 1e-6f;
            const rod_pose pose = {{0.2f * at.sin, noise_m, 0.1f * at.cos},
                                   {at.sin * 0.6f, at.sin * 0.8f, 0.0f, at.cos}};
            receive(&in, next_us, seq++, pose);
        }
        if (t_us == 500000) {
            pose_input_params params = pose_input_defaults();
            params.mode = POSE_INTERPOLATE;
            pose_input_set(&in, &params);
        }
        const rod_pose base = pose_input_tick(&in, t_us).base;
        hash = (hash ^ bits_of(base.position_m.x)) * 16777619u;
        hash = (hash ^ bits_of(base.position_m.y)) * 16777619u;
        hash = (hash ^ bits_of(base.orientation.x)) * 16777619u;
        hash = (hash ^ bits_of(base.orientation.w)) * 16777619u;
    }
    TEST_ASSERT_EQUAL_UINT32(seq, in.count[POSE_ACCEPTED]);
    TEST_ASSERT_EQUAL_HEX32(0x32DE6A2Bu, hash);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_hostile_poses);
    RUN_TEST(test_the_same_bits_everywhere);
    return UNITY_END();
}
