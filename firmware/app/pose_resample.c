/* pose_resample.c - see pose_resample.h. */
#include "pose_resample.h"

/* Differences of moments beyond this are as good as this: nothing is followed that long. */
enum { SPAN_MAX_US = 1000000 };

static float seconds_between(int64_t from_us, int64_t to_us)
{
    const int64_t span_us = to_us - from_us;
    const int32_t bounded_us = span_us > SPAN_MAX_US    ? SPAN_MAX_US
                               : span_us < -SPAN_MAX_US ? -SPAN_MAX_US
                                                        : (int32_t)span_us;
    return (float)bounded_us * 1e-6f;
}

quat pose_unit(quat q)
{
    const float scale = 1.0f / trig_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (quat){q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

/* Rotation vector of a unit quaternion, the shorter way round. */
static vec3 rotation_vector(quat q)
{
    const vec3 axis = {q.x, q.y, q.z};
    const float sine_squared = vec3_dot(axis, axis);
    const float sign = q.w < 0.0f ? -1.0f : 1.0f;
    if (sine_squared < 1e-12f) { /* sin x = x to the last place */
        return vec3_scale(axis, 2.0f * sign);
    }
    const float sine = trig_sqrt(sine_squared);
    return vec3_scale(axis, 2.0f * sign * trig_atan2(sine, sign * q.w) / sine);
}

static quat rotation_by(vec3 vector_rad)
{
    const float angle_squared = vec3_dot(vector_rad, vector_rad);
    if (angle_squared < 1e-12f) {
        return (quat){0.5f * vector_rad.x, 0.5f * vector_rad.y, 0.5f * vector_rad.z, 1.0f};
    }
    const float angle_rad = trig_sqrt(angle_squared);
    const trig_pair half = trig_sincos(0.5f * angle_rad);
    const vec3 axis = vec3_scale(vector_rad, half.sin / angle_rad);
    return (quat){axis.x, axis.y, axis.z, half.cos};
}

static vec3 rotation_between(quat from, quat to)
{
    return rotation_vector(quat_multiply(to, quat_conjugate(from)));
}

float pose_angle(quat from, quat to)
{
    const vec3 turn = rotation_between(from, to);
    return trig_sqrt(vec3_dot(turn, turn));
}

pose_motion pose_velocity(const rod_pose *from, const rod_pose *to, float elapsed_s)
{
    const float per_s = 1.0f / elapsed_s;
    return (pose_motion){
        .pose = *to,
        .velocity_mps = vec3_scale(vec3_sub(to->position_m, from->position_m), per_s),
        .turn_radps = vec3_scale(rotation_between(from->orientation, to->orientation), per_s),
    };
}

/* A weight on something and its rate of change. */
typedef struct {
    float value, per_s;
} weight;

/* How far along the line, in seconds of its velocity, at a time since its newest pose. */
static weight progress(const pose_rules *rules, float since_s)
{
    if (since_s <= rules->slow_s) {
        return (weight){since_s, 1.0f};
    }
    const float room_s = rules->stop_s - rules->slow_s;
    const float past_s = since_s - rules->slow_s;
    if (past_s >= 2.0f * room_s) {
        return (weight){rules->stop_s, 0.0f};
    }
    return (weight){
        since_s - past_s * past_s / (4.0f * room_s),
        1.0f - past_s / (2.0f * room_s),
    };
}

static pose_motion line_at(const pose_resample *r, int64_t now_us)
{
    const float since_s = seconds_between(r->captured_us, now_us) - r->rules.delay_s;
    const weight along = progress(&r->rules, since_s);
    const pose_motion *line = &r->line;
    return (pose_motion){
        .pose =
            {
                vec3_add(line->pose.position_m, vec3_scale(line->velocity_mps, along.value)),
                pose_unit(quat_multiply(rotation_by(vec3_scale(line->turn_radps, along.value)),
                                        line->pose.orientation)),
            },
        .velocity_mps = vec3_scale(line->velocity_mps, along.per_s),
        .turn_radps = vec3_scale(line->turn_radps, along.per_s),
    };
}

static vec3 no_longer_than(vec3 v, float bound)
{
    const float squared = vec3_dot(v, v);
    return squared > bound * bound ? vec3_scale(v, bound / trig_sqrt(squared)) : v;
}

/* a * s + b * t */
static vec3 mix(vec3 a, float s, vec3 b, float t)
{
    return vec3_add(vec3_scale(a, s), vec3_scale(b, t));
}

void pose_resample_start(pose_resample *r, const rod_pose *pose, int64_t captured_us,
                         int64_t now_us)
{
    *r = (pose_resample){
        .started = true,
        .line.pose = *pose,
        .captured_us = captured_us,
        .base.pose = *pose,
        .given_us = now_us,
        .joined_us = now_us,
    };
}

void pose_resample_add(pose_resample *r, const pose_motion *newest, int64_t captured_us,
                       const pose_rules *rules)
{
    r->line.pose = newest->pose;
    r->line.velocity_mps = no_longer_than(newest->velocity_mps, rules->speed_max_mps);
    r->line.turn_radps = no_longer_than(newest->turn_radps, rules->turn_max_radps);
    r->captured_us = captured_us;
    /* a long correction under way, after a gap, is not cut short by the next pose */
    const float left_s = r->rules.blend_s - seconds_between(r->joined_us, r->given_us);
    r->rules = *rules;
    r->rules.blend_s = left_s > rules->blend_s ? left_s : rules->blend_s;
    r->joined_us = r->given_us;
    const pose_motion line = line_at(r, r->joined_us);
    const pose_motion *base = &r->base;
    r->gap_m = vec3_sub(base->pose.position_m, line.pose.position_m);
    r->gap_mps = no_longer_than(vec3_sub(base->velocity_mps, line.velocity_mps),
                                2.0f * rules->speed_max_mps);
    r->gap_rad = rotation_between(line.pose.orientation, base->pose.orientation);
    r->gap_radps =
        no_longer_than(vec3_sub(base->turn_radps, line.turn_radps), 2.0f * rules->turn_max_radps);
}

const pose_motion *pose_resample_at(pose_resample *r, int64_t now_us)
{
    r->base = line_at(r, now_us);
    r->given_us = now_us;
    const float blend_s = r->rules.blend_s;
    const float since_s = seconds_between(r->joined_us, now_us);
    if (since_s < blend_s) {
        /* the cubic that starts at the gap and at its rate and ends at none of either */
        const float s = since_s / blend_s;
        const float left = 1.0f - s;
        const float keep = left * left * (1.0f + 2.0f * s), drive_s = since_s * left * left;
        const float keep_per_s = -6.0f * s * left / blend_s, drive = left * (1.0f - 3.0f * s);
        pose_motion *base = &r->base;
        base->pose.position_m =
            vec3_add(base->pose.position_m, mix(r->gap_m, keep, r->gap_mps, drive_s));
        base->velocity_mps =
            vec3_add(base->velocity_mps, mix(r->gap_m, keep_per_s, r->gap_mps, drive));
        base->pose.orientation = pose_unit(quat_multiply(
            rotation_by(mix(r->gap_rad, keep, r->gap_radps, drive_s)), base->pose.orientation));
        base->turn_radps =
            vec3_add(base->turn_radps, mix(r->gap_rad, keep_per_s, r->gap_radps, drive));
    }
    return &r->base;
}
