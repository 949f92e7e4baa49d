/* pose_fixture.h - a pose_input, a sender on the same clock, and motions given by formulas. */
#ifndef LIMBER_POSE_FIXTURE_H
#define LIMBER_POSE_FIXTURE_H

#include "../unit/test_support.h"
#include "pose_input.h"

enum { SESSION = 7 };

static inline pose_input started(pose_mode mode, uint32_t now_us)
{
    pose_input in;
    pose_input_params params = pose_input_defaults();
    params.mode = mode;
    pose_input_init(&in, &params, now_us);
    pose_input_open(&in, SESSION);
    return in;
}

static inline rod_pose pose_at(float x, float y, float z)
{
    return (rod_pose){{x, y, z}, {0.0f, 0.0f, 0.0f, 1.0f}};
}

/* Captured and sent at t_us, on a clock that is the device's. */
static inline pose_sample sample_at(uint32_t t_us, uint16_t seq, rod_pose pose)
{
    return (pose_sample){.pose = pose, .sent_us = t_us, .seq = seq, .session = SESSION};
}

static inline pose_verdict receive(pose_input *in, uint32_t t_us, uint16_t seq, rod_pose pose)
{
    const pose_sample sample = sample_at(t_us, seq, pose);
    return pose_input_receive(in, &sample, t_us);
}

/* A legless exchange: the two clocks are the same. */
static inline void sync_clocks(pose_input *in, uint32_t now_us)
{
    const clock_exchange exchange = {now_us, now_us, now_us, now_us};
    clock_map_exchange(&in->clock, &exchange);
}

static inline uint32_t counted(const pose_input *in)
{
    uint32_t sum = 0;
    for (int i = 0; i < POSE_VERDICTS_N; i++) {
        sum += in->count[i];
    }
    return sum;
}

#endif
