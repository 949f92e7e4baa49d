/* pose_input.c - see pose_input.h. */
#include "pose_input.h"

#define BLEND_MIN_S 0.006f
#define BLEND_MAX_S 0.1f
#define VELOCITY_OVER_MIN_US 10000u

enum {
    HORIZON_MAX_US = 100000,
    SEQ_SURE_US = 10000000, /* too short for seq to wrap, at up to 6500 poses a second */
};

const char *pose_stream_text(pose_stream_state state)
{
    switch (state) {
    case POSE_STREAM_NONE:
        return "no pose received yet";
    case POSE_STREAM_GOOD:
        return "good";
    case POSE_STREAM_SILENT:
        return "no valid pose within the hold timeout";
    case POSE_STREAM_SLOW:
        return "source slower than the hold timeout allows: resample it or raise the timeout";
    }
    return "unknown state";
}

pose_input_params pose_input_defaults(void)
{
    return (pose_input_params){
        .mode = POSE_PREDICT,
        .hold_us = 50000,
        .horizon_us = 20000,
        .speed_max_mps = 20.0f,
        .turn_max_radps = 150.0f,
    };
}

bool pose_input_set(pose_input *in, const pose_input_params *p)
{
    const bool known = p->mode == POSE_PREDICT || p->mode == POSE_INTERPOLATE;
    if (!known || p->hold_us < POSE_HOLD_MIN_US || p->hold_us > POSE_HOLD_MAX_US ||
        p->horizon_us > HORIZON_MAX_US || !(p->speed_max_mps > 0.0f) ||
        !(p->speed_max_mps <= 100.0f) || !(p->turn_max_radps > 0.0f) ||
        !(p->turn_max_radps <= 1000.0f)) {
        return false;
    }
    in->params = *p;
    return true;
}

bool pose_input_init(pose_input *in, const pose_input_params *params, uint32_t now_us)
{
    pose_input fresh = {.now_us = (int64_t)now_us};
    if (!pose_input_set(&fresh, params)) {
        return false;
    }
    *in = fresh;
    clock_map_init(&in->clock);
    return true;
}

void pose_input_open(pose_input *in, uint8_t session)
{
    in->session_open = true;
    in->session = session;
    pose_sequence_reset(&in->sequence);
    in->anchored = false;
    in->refused_n = 0;
    in->pace = (pose_pace){0};
    clock_map_init(&in->clock);
}

/* The device's clock never runs backwards; a moment before the last one leaves it as it is. */
static void advance(pose_input *in, uint32_t now_us)
{
    const int32_t elapsed_us = (int32_t)(now_us - (uint32_t)in->now_us);
    in->now_us += elapsed_us > 0 ? elapsed_us : 0;
}

/* The accepted pose so many before the newest. */
static const pose_kept *pose_before(const pose_input *in, int back)
{
    return &in->accepted[(in->newest + POSE_HISTORY_N - (unsigned)back) % POSE_HISTORY_N];
}

static int least_int(int a, int b)
{
    return a < b ? a : b;
}

static float least(float a, float b)
{
    return a < b ? a : b;
}

static float most(float a, float b)
{
    return a > b ? a : b;
}

/* The source's interval as if nothing had been lost or refused since the last accepted pose. */
static void measure(pose_input *in, const pose_kept *kept, int64_t age_us)
{
    pose_pace_age(&in->pace, age_us > 0 ? (uint32_t)age_us : 0u);
    if (!in->anchored) {
        return;
    }
    const int32_t elapsed_us = pose_elapsed_us(pose_before(in, 0), kept);
    const uint16_t sent_n = (uint16_t)(kept->seq - pose_before(in, 0)->seq);
    if (elapsed_us <= 0 || in->now_us - in->accepted_us > SEQ_SURE_US) {
        return; /* the sender's clock was set, or seq may have wrapped */
    }
    pose_pace_interval(&in->pace, (uint32_t)elapsed_us / (sent_n > 0 ? sent_n : 1u),
                       in->params.hold_us);
}

static pose_rules rules_of(const pose_input *in, int32_t elapsed_us)
{
    const float interval_s = (float)pose_pace_interval_us(&in->pace) * 1e-6f;
    const float age_s = (float)pose_pace_age_us(&in->pace) * 1e-6f;
    const float horizon_s = (float)in->params.horizon_us * 1e-6f;
    const float gap_s = least((float)elapsed_us * 1e-6f, BLEND_MAX_S);
    pose_rules rules = {
        .blend_s = most(BLEND_MIN_S, most(gap_s, least(interval_s, BLEND_MAX_S))),
        .speed_max_mps = in->params.speed_max_mps,
        .turn_max_radps = in->params.turn_max_radps,
    };
    if (in->params.mode == POSE_INTERPOLATE) {
        rules.delay_s = age_s + interval_s;
        rules.stop_s = least(0.5f * interval_s, horizon_s);
    } else {
        rules.slow_s = least(age_s + interval_s, horizon_s * (2.0f / 3.0f));
        rules.stop_s = least(age_s + 1.5f * interval_s, horizon_s);
    }
    return rules;
}

/* The motion that led to a pose. To predict, over 10 ms at least: over less, the noise of a tracker and of
 * its time stamps outweighs what the hand may change meanwhile. To interpolate, from the pose before,
 * unless the two are too close together to tell. */
static pose_motion motion_to(const pose_input *in, const pose_kept *kept)
{
    uint32_t over_us = pose_pace_interval_us(&in->pace) / 2u;
    if (in->params.mode == POSE_PREDICT && over_us < VELOCITY_OVER_MIN_US) {
        over_us = VELOCITY_OVER_MIN_US;
    }
    int i = 0;
    while (i + 1 < in->accepted_n &&
           (uint32_t)pose_elapsed_us(pose_before(in, i), kept) < over_us) {
        i++;
    }
    const float elapsed_s = (float)pose_elapsed_us(pose_before(in, i), kept) * 1e-6f;
    return pose_velocity(&pose_before(in, i)->pose, &kept->pose, elapsed_s);
}

static void accept(pose_input *in, const pose_kept *kept, int64_t arrived_us, int64_t age_us,
                   bool restart)
{
    const int64_t captured_us = arrived_us - age_us;
    measure(in, kept, age_us);
    if (restart) {
        in->restart = true;
        in->restarts++;
        in->accepted_n = 0;
        pose_resample_start(&in->resample, &kept->pose, captured_us, in->now_us);
    } else {
        const pose_motion newest = motion_to(in, kept);
        const pose_rules rules = rules_of(in, pose_elapsed_us(pose_before(in, 0), kept));
        pose_resample_add(&in->resample, &newest, captured_us, &rules);
    }
    if (restart || arrived_us - in->accepted_us >= (int64_t)in->params.hold_us) {
        in->good_us = arrived_us;
    }
    in->accepted_n = least_int(in->accepted_n + 1, POSE_HISTORY_N);
    in->newest = (in->newest + 1) % POSE_HISTORY_N;
    in->accepted[in->newest] = *kept;
    in->accepted_us = arrived_us;
    in->anchored = true;
    in->refused_n = 0;
}

static pose_verdict hand_can(const pose_input *in, const pose_kept *from, const pose_kept *to)
{
    return pose_check_step(from, to, in->params.speed_max_mps, in->params.turn_max_radps);
}

static pose_verdict judge(pose_input *in, const pose_sample *sample, uint32_t received_us)
{
    if (!in->session_open || sample->session != in->session) {
        return POSE_WRONG_SESSION;
    }
    pose_verdict verdict = pose_check_sequence(&in->sequence, sample->seq);
    verdict = verdict == POSE_ACCEPTED ? pose_check_numbers(&sample->pose) : verdict;
    if (verdict != POSE_ACCEPTED) {
        return verdict;
    }
    uint32_t sent_us = received_us; /* on the device's clock */
    clock_map_to_device(&in->clock, sample->sent_us, &sent_us);
    const int64_t age_us = (int64_t)(int32_t)(received_us - sent_us) + (int64_t)sample->age_us;
    if (age_us > POSE_AGE_MAX_US) {
        return POSE_STALE;
    }
    if (age_us < -POSE_FUTURE_MAX_US) {
        return POSE_FUTURE;
    }

    pose_kept kept = {sample->pose, sample->sent_us - sample->age_us, sample->seq};
    kept.pose.orientation = pose_unit(kept.pose.orientation);
    const quat q = kept.pose.orientation, last = pose_before(in, 0)->pose.orientation;
    if (q.x * last.x + q.y * last.y + q.z * last.z + q.w * last.w < 0.0f) {
        kept.pose.orientation = (quat){-q.x, -q.y, -q.z, -q.w};
    }
    /* bytes may be given in after the tick they arrived before */
    const int64_t arrived_us = in->now_us + (int32_t)(received_us - (uint32_t)in->now_us);
    const int32_t elapsed_us = pose_elapsed_us(pose_before(in, 0), &kept);
    bool restart = !in->anchored || arrived_us - in->accepted_us > POSE_SILENCE_MAX_US ||
                   elapsed_us > POSE_SILENCE_MAX_US;
    if (!restart) {
        verdict = hand_can(in, pose_before(in, 0), &kept);
        if (verdict != POSE_ACCEPTED) {
            const bool agrees =
                in->refused_n > 0 && hand_can(in, &in->refused, &kept) == POSE_ACCEPTED;
            in->refused_n = agrees ? in->refused_n + 1 : 1;
            in->refused = kept;
            if (in->refused_n < POSE_REANCHOR_N) {
                return verdict;
            }
            restart = true;
            in->reanchored++;
        }
    }
    accept(in, &kept, arrived_us, age_us, restart);
    return POSE_ACCEPTED;
}

pose_verdict pose_input_receive(pose_input *in, const pose_sample *sample, uint32_t received_us)
{
    advance(in, received_us);
    const pose_verdict verdict = judge(in, sample, received_us);
    in->received++;
    in->count[verdict]++;
    return verdict;
}

pose_tick pose_input_tick(pose_input *in, uint32_t now_us)
{
    advance(in, now_us);
    clock_map_tick(&in->clock, now_us);
    pose_tick tick = {0};
    if (in->resample.started) {
        tick = (pose_tick){
            .base = pose_resample_at(&in->resample, in->now_us)->pose,
            .valid = true,
            .restart = in->restart,
            .seq = pose_before(in, 0)->seq,
            .received_us = (uint32_t)in->accepted_us,
        };
    }
    in->restart = false;
    return tick;
}

static uint32_t saturated(int64_t us)
{
    return us < (int64_t)UINT32_MAX ? (uint32_t)us : UINT32_MAX;
}

pose_stream pose_input_stream(const pose_input *in)
{
    pose_stream stream = {
        .state = POSE_STREAM_NONE,
        .silent_us = UINT32_MAX,
        .interval_us = pose_pace_interval_us(&in->pace),
        .jitter_us = pose_pace_jitter_us(&in->pace),
    };
    if (!in->anchored) {
        return stream;
    }
    stream.silent_us = saturated(in->now_us - in->accepted_us);
    if (in->pace.slow) {
        stream.state = POSE_STREAM_SLOW;
    } else if (stream.silent_us >= in->params.hold_us) {
        stream.state = POSE_STREAM_SILENT;
    } else {
        stream.state = POSE_STREAM_GOOD;
        stream.good_us = saturated(in->now_us - in->good_us);
    }
    return stream;
}
