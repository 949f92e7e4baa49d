/* pose_check.h - whether one pose may be believed: its place in the sequence, its numbers, and the step
 * from the pose before. pose_input.h says in which order and what follows.
 *
 * Pure but for the sequence, whose state the caller owns. No heap, no libm. Main loop only.
 */
#ifndef LIMBER_POSE_CHECK_H
#define LIMBER_POSE_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include "kinematics.h"

typedef enum {
    POSE_ACCEPTED,
    POSE_WRONG_SESSION,
    POSE_DUPLICATE,
    POSE_LATE,
    POSE_NOT_FINITE,
    POSE_BAD_QUATERNION,
    POSE_STALE,
    POSE_FUTURE,
    POSE_TELEPORT,
    POSE_TOO_FAST,
    POSE_VERDICTS_N
} pose_verdict;

/* Coordinates, each; the quaternion's length; and what noise may add to a step, however short. */
#define POSE_COORDINATE_MAX_M 500.0f
#define POSE_QUATERNION_ERROR_MAX 0.01f
#define POSE_SLACK_M 0.02f
#define POSE_SLACK_RAD 0.1f

/* A pose as kept for comparison with the next. */
typedef struct {
    rod_pose pose;
    uint32_t captured_us; /* sender's clock */
    uint16_t seq;
} pose_kept;

/* Which seqs have come. All zeros: none yet, the first one will do whatever it is. */
typedef struct {
    bool known;
    uint16_t newest;
    uint32_t seen; /* bit i: newest - i has come */
    int span;      /* how many of those are known about, up to 32 */
    uint32_t lost; /* seqs passed over, less those that came late after all */
} pose_sequence;

/* Starts afresh, but for lost, which goes on. */
void pose_sequence_reset(pose_sequence *sequence);

/* POSE_ACCEPTED, POSE_DUPLICATE or POSE_LATE. Give it everything that came in the session: what is refused
 * for another reason is not lost. */
pose_verdict pose_check_sequence(pose_sequence *sequence, uint16_t seq);

/* POSE_ACCEPTED, POSE_NOT_FINITE or POSE_BAD_QUATERNION. */
pose_verdict pose_check_numbers(const rod_pose *pose);

/* Whether a hand can have come from one pose to the other: POSE_ACCEPTED, POSE_LATE (no time between
 * them), POSE_TELEPORT or POSE_TOO_FAST. Both must have passed pose_check_numbers and be of unit length. */
pose_verdict pose_check_step(const pose_kept *from, const pose_kept *to, float speed_max_mps,
                             float turn_max_radps);

/* From one pose's capture to the other's, us: right within 35 min. */
static inline int32_t pose_elapsed_us(const pose_kept *from, const pose_kept *to)
{
    return (int32_t)(to->captured_us - from->captured_us);
}

const char *pose_verdict_text(pose_verdict verdict);

#endif
