/* pose_check.c - see pose_check.h. */
#include "pose_check.h"

#include "pose_resample.h"

#define FLOAT_MAX 3.402823466e38f

enum { SEEN_N = 32 }; /* seqs remembered */

const char *pose_verdict_text(pose_verdict verdict)
{
    static const char *const text[POSE_VERDICTS_N] = {
        [POSE_ACCEPTED] = "accepted",
        [POSE_WRONG_SESSION] = "from another session",
        [POSE_DUPLICATE] = "a duplicate",
        [POSE_LATE] = "late: a newer pose was there before it",
        [POSE_NOT_FINITE] = "not finite, or further than 500 m away",
        [POSE_BAD_QUATERNION] = "quaternion not of unit length",
        [POSE_STALE] = "older than 50 ms",
        [POSE_FUTURE] = "more than 5 ms from the future",
        [POSE_TELEPORT] = "moved faster than the limit",
        [POSE_TOO_FAST] = "turned faster than the limit",
    };
    return (unsigned)verdict < POSE_VERDICTS_N ? text[verdict] : "unknown verdict";
}

void pose_sequence_reset(pose_sequence *sequence)
{
    *sequence = (pose_sequence){.lost = sequence->lost};
}

pose_verdict pose_check_sequence(pose_sequence *sequence, uint16_t seq)
{
    if (!sequence->known) {
        sequence->known = true;
        sequence->newest = seq;
        sequence->seen = 1;
        sequence->span = 1;
        return POSE_ACCEPTED;
    }
    const int ahead = (int16_t)(uint16_t)(seq - sequence->newest);
    if (ahead > 0) {
        sequence->lost += (uint32_t)ahead - 1u;
        sequence->span = sequence->span + ahead < SEEN_N ? sequence->span + ahead : SEEN_N;
        sequence->seen = ahead < SEEN_N ? (sequence->seen << ahead) | 1u : 1u;
        sequence->newest = seq;
        return POSE_ACCEPTED;
    }
    if (-ahead >= sequence->span) {
        return POSE_LATE; /* too far back to know, or from before the first: never counted as lost */
    }
    const uint32_t bit = 1u << -ahead;
    if ((sequence->seen & bit) != 0u) {
        return POSE_DUPLICATE;
    }
    sequence->seen |= bit;
    sequence->lost--;
    return POSE_LATE;
}

static bool in_range(float x, float bound)
{
    return trig_abs(x) <= bound; /* not so for NaN */
}

pose_verdict pose_check_numbers(const rod_pose *pose)
{
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    if (!in_range(p.x, POSE_COORDINATE_MAX_M) || !in_range(p.y, POSE_COORDINATE_MAX_M) ||
        !in_range(p.z, POSE_COORDINATE_MAX_M) || !in_range(q.x, FLOAT_MAX) ||
        !in_range(q.y, FLOAT_MAX) || !in_range(q.z, FLOAT_MAX) || !in_range(q.w, FLOAT_MAX)) {
        return POSE_NOT_FINITE;
    }
    const float length = trig_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return in_range(length - 1.0f, POSE_QUATERNION_ERROR_MAX) ? POSE_ACCEPTED : POSE_BAD_QUATERNION;
}

pose_verdict pose_check_step(const pose_kept *from, const pose_kept *to, float speed_max_mps,
                             float turn_max_radps)
{
    const int32_t elapsed_us = pose_elapsed_us(from, to);
    if (elapsed_us <= 0) {
        return POSE_LATE;
    }
    const float elapsed_s = (float)elapsed_us * 1e-6f;
    const vec3 moved = vec3_sub(to->pose.position_m, from->pose.position_m);
    const float reach_m = speed_max_mps * elapsed_s + POSE_SLACK_M;
    if (vec3_dot(moved, moved) > reach_m * reach_m) {
        return POSE_TELEPORT;
    }
    const float turned_rad = pose_angle(from->pose.orientation, to->pose.orientation);
    return turned_rad > turn_max_radps * elapsed_s + POSE_SLACK_RAD ? POSE_TOO_FAST : POSE_ACCEPTED;
}
