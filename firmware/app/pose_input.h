/* pose_input.h - from the poses that arrive to the base pose of every tick, and whether to trust it.
 *
 *     pose_input_init(&input, &params, now_us);
 *     pose_input_open(&input, session);                      // HELLO: and only this resets seq
 *     clock_map_exchange(&input.clock, &exchange);           // TIMESYNC
 *     verdict = pose_input_receive(&input, &sample, now_us); // POSE: counted, newest wins
 *     pose_tick tick = pose_input_tick(&input, now_us);      // every tick: the base, now
 *     pose_stream stream = pose_input_stream(&input);        // every tick: for the supervisor
 *
 * A pose is judged in this order, and the first "no" is its verdict:
 *
 *   POSE_WRONG_SESSION  no session is open, or it is another one
 *   POSE_DUPLICATE      this seq has come before (the last 32 are remembered)
 *   POSE_LATE           (int16)(seq - newest seq received) <= 0; or captured no later, by the
 *                       sender's clock, than the last accepted pose
 *   POSE_NOT_FINITE     a number is not finite, or a coordinate is beyond +-500 m
 *   POSE_BAD_QUATERNION | |q| - 1 | > 0.01
 *   POSE_STALE          captured more than 50 ms before it arrived. The moment of capture is when it was
 *                       sent, by the clock map, less its age; until the map knows, arrival less age
 *   POSE_FUTURE         captured more than 5 ms after it arrived
 *   POSE_TELEPORT       further from the last accepted than speed_max_mps in that time and 20 mm
 *   POSE_TOO_FAST       turned from it by more than turn_max_radps in that time and 0.1 rad
 *
 * Times between poses are differences of the sender's clock, which neither the line nor a correction of
 * the clock map disturbs. Nobody is locked out: five poses in a row refused as TELEPORT, TOO_FAST or for
 * the second kind of LATE, each of which could follow the one before it, mean that the tracker really is
 * there now: the fifth is accepted. After 0.25 s without an accepted pose (by arrival or by capture), and
 * in a new session, the next one is accepted wherever it is. These and the very first are restarts: the
 * base jumps, pose_tick.restart is set once and the rod must start anew, straight (rod_reset).
 *
 *   received = the sum of count[]      sent = accepted + refused by cause + lost, for a sender that sent
 *   each seq once. lost counts gaps of seq; a pose that comes late after all (one of the last 32) is taken
 *   off again. A silence of more than 32767 poses makes seq ambiguous: the sender must open a new session.
 *
 * The source's interval and the age of its poses are the (lower) medians of the last eight. A source
 * whose interval is longer than the HOLD timeout is refused as POSE_STREAM_SLOW from its second interval
 * on, until its interval is under 4/5 of the timeout.
 *
 * Predicting takes velocities over the last 10 ms of poses or more: over the last two alone the error grows
 * by a fifth and the acceleration by half (06, 125 Hz). Interpolating takes them from the last two.
 *
 * Measured on the recorded tracks (tests/app/pose_figures.c; 2 ms from capture to arrival, 1 kHz ticks).
 * Error against where the hand, as known later, was at the tick: rms / 99 %, mm; for interpolate, which is
 * late by one interval, also against the moment it stands for. Then the acceleration of the base over
 * ticks, rms, m/s2. "Held": the newest pose as it is. "Line": through the last two, no blend, no horizon.
 *
 *                 predict           interpolate (its own moment)     held               line
 *   04 shake      7.8/24    774     10/26  (1.9/7.3)    614          8.1/22   5085      8.9/30    8640
 *   05 swing     16.7/78    815     20/92  (6.2/14)     421         14.6/62   8300     15.8/70   11000
 *   06 glitchy   11.9/36    619     15/44  (7.0/14)     353          9.8/30   6140     27/53     13300
 *   07 at rest   0.56/0.23   39   0.52/0.23 (0.12/0.05)  23         0.41/0.17  269    0.58/0.27    515
 *   08 arcs      0.67/2.3    92    4.7/11.5 (0.21/0.85) 115          3.6/9.8  2376     1.1/4.5    1706
 *
 * Where the motion is smooth (08) predicting takes 80 % off the error of holding; where trackers correct
 * themselves in jerks (05, 06) nothing predicts the jerk, and its worth is the calm: under a fifth of
 * the blows of holding, a tenth of those of a bare line.
 *
 * The caller owns the state (about 0.9 KB); no heap, no libm, integers (no 64-bit division) and float32 in
 * one order: the same bits on every machine. All from the main loop, none from an interrupt. uint32 times
 * are the device's clock, us, and wrap; call pose_input_tick at least every 30 min and hours of silence are
 * told from seconds. Bounded work: the dearest pose takes four arc
 * tangents, a tick two sines and cosines.
 */
#ifndef LIMBER_POSE_INPUT_H
#define LIMBER_POSE_INPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "clock_map.h"
#include "kinematics.h"
#include "pose_check.h"
#include "pose_pace.h"
#include "pose_resample.h"

enum {
    POSE_AGE_MAX_US = 50000,
    POSE_FUTURE_MAX_US = 5000,
    POSE_SILENCE_MAX_US = 250000,
    POSE_REANCHOR_N = 5,
    POSE_HOLD_MIN_US = 20000,
    POSE_HOLD_MAX_US = 200000,
    POSE_HISTORY_N = 8,
};

typedef enum {
    POSE_PREDICT,     /* the base as it should be now; no delay, corrections as poses come */
    POSE_INTERPOLATE, /* late by the usual age of a pose and one interval of the source; smoother */
} pose_mode;

typedef struct {
    pose_mode mode;
    uint32_t hold_us;     /* silence that ends trust in the stream, 20000 ... 200000 */
    uint32_t horizon_us;  /* the furthest a pose is carried on past its capture, 0 ... 100000 */
    float speed_max_mps;  /* of the base, > 0 ... 100 */
    float turn_max_radps; /* of the base, > 0 ... 1000 */
} pose_input_params;

/* Predict, 50 ms, 20 ms, 20 m/s, 150 rad/s: of 22000 recorded poses these refuse seven, all glitches. */
pose_input_params pose_input_defaults(void);

/* A POSE message. Quality and source are not judged here. */
typedef struct {
    rod_pose pose;
    uint32_t sent_us, age_us; /* sender's clock; time from capture to sent_us */
    uint16_t seq;
    uint8_t session;
} pose_sample;

typedef struct {
    rod_pose base;
    bool valid;           /* a pose has been accepted since init; otherwise base is all zeros */
    bool restart;         /* once: the base was put here, it did not move here */
    uint16_t seq;         /* of the newest accepted pose, which ANGLES echoes ... */
    uint32_t received_us; /* ... and when it arrived */
} pose_tick;

typedef enum {
    POSE_STREAM_NONE,   /* no pose in this session yet */
    POSE_STREAM_GOOD,   /* arrives within the HOLD timeout */
    POSE_STREAM_SILENT, /* none accepted for hold_us or longer */
    POSE_STREAM_SLOW,   /* the source is slower than the HOLD timeout allows: refuse to arm */
} pose_stream_state;

typedef struct {
    pose_stream_state state;
    uint32_t
        silent_us; /* since the last accepted pose arrived; stops at UINT32_MAX, as without any */
    uint32_t good_us; /* how long it has been good without a restart; else 0; stops at UINT32_MAX */
    uint32_t interval_us; /* between poses at the source, median; 0: not known yet */
    uint32_t jitter_us;   /* the mean distance from it */
} pose_stream;

/* Treat the members as private, but for clock and the counters. */
typedef struct {
    clock_map clock;
    uint32_t received, count[POSE_VERDICTS_N];
    uint32_t restarts, reanchored; /* reanchored: those restarts that ended a run of refusals */

    pose_input_params params;
    int64_t now_us; /* the device's clock, unwrapped */
    bool session_open;
    uint8_t session;
    pose_sequence sequence; /* and what is lost */

    bool anchored; /* the newest accepted belongs to this session */
    pose_kept accepted
        [POSE_HISTORY_N]; /* since the last restart; the newest is at newest, then backwards, round */
    unsigned newest;
    int accepted_n;
    int64_t accepted_us, good_us; /* when the newest came; since when the stream is good */
    pose_kept refused;
    int refused_n; /* refused in a row that agree */

    pose_pace pace;
    bool restart;
    pose_resample resample;
} pose_input;

/* False, and nothing changed, if a parameter is outside its bounds (or not a number). */
bool pose_input_init(pose_input *in, const pose_input_params *params, uint32_t now_us);
/* The same for one that runs: the base goes on from where it is; for the next pose on. */
bool pose_input_set(pose_input *in, const pose_input_params *params);

/* A new session, once for each: seq, clock map and stream start afresh, the counters go on; the base stays
 * where it is until the session's first pose, which is a restart. */
void pose_input_open(pose_input *in, uint8_t session);

pose_verdict pose_input_receive(pose_input *in, const pose_sample *sample, uint32_t received_us);
pose_tick pose_input_tick(pose_input *in, uint32_t now_us);
pose_stream pose_input_stream(const pose_input *in);

/* For people, in lower case, without a full stop (so pose_verdict_text). */
const char *pose_stream_text(pose_stream_state state);

#endif
