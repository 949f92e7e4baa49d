/* track.c - cleaning and resampling; reading the text is track_reader.c's. */
#include "track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim.h"
#include "track_reader.h"

static const double LONGEST_GAP_S = 0.25;
static const double TICK_SLACK = 1e-9; /* of a tick, for decimal times that are rounded in binary */

static void convert(track_sample *s, const track_options *options)
{
    double *p = s->position_m, *q = s->orientation;
    if (options->left_handed) {
        p[0] = -p[0];
        q[1] = -q[1];
        q[2] = -q[2];
    }
    for (int i = 0; i < 3; i++) {
        p[i] *= options->scale;
    }
    if (options->y_up) { /* turn the world by +90 degrees about x */
        const double h = sqrt(0.5);
        const double turned[4] = {h * (q[0] + q[3]), h * (q[1] - q[2]), h * (q[1] + q[2]),
                                  h * (q[3] - q[0])};
        memcpy(q, turned, sizeof turned);
        const double y = p[1];
        p[1] = -p[2];
        p[2] = y;
    }
}

/* False for the quaternion that is all zeros, as trackers send when they see nothing. */
static bool normalise(double q[4], track_counts *counts)
{
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        largest = fmax(largest, fabs(q[i]));
    }
    if (!(largest > 0.0)) {
        return false;
    }
    double sum = 0.0; /* of squares, scaled so that no finite quaternion over- or underflows */
    for (int i = 0; i < 4; i++) {
        q[i] /= largest;
        sum += q[i] * q[i];
    }
    const double norm = sqrt(sum);
    counts->not_unit += fabs(norm * largest - 1.0) > 0.01;
    for (int i = 0; i < 4; i++) {
        q[i] /= norm;
    }
    return true;
}

bool track_take_sample(track_sample *s, const track_options *options, track_counts *counts)
{
    if (!normalise(s->orientation, counts)) {
        counts->zero_quaternions++;
        return false;
    }
    convert(s, options);
    return true;
}

static double distance_m(const track_sample *a, const track_sample *b)
{
    return hypot(hypot(a->position_m[0] - b->position_m[0], a->position_m[1] - b->position_m[1]),
                 a->position_m[2] - b->position_m[2]);
}

/* Drop what the model's contract drops, in its order: zero quaternions, then all but the last of equal
 * times, then (only if asked) the impossibly fast. */
static void clean(track *t, const track_options *options)
{
    track_sample *s = t->samples;
    track_counts *counts = &t->counts;
    size_t kept = 0;
    counts->lines = (long)t->samples_n;
    for (size_t i = 0; i < t->samples_n; i++) {
        if (!track_take_sample(&s[i], options, counts)) {
            continue;
        }
        if (kept > 0 && !(s[i].t_s > s[kept - 1].t_s)) {
            counts->repeated_times++;
            kept--;
        }
        s[kept++] = s[i];
    }
    t->samples_n = kept;
    if (options->max_speed_mps > 0.0) {
        kept = kept > 0;
        for (size_t i = 1; i < t->samples_n; i++) {
            const double dt_s = s[i].t_s - s[kept - 1].t_s;
            if (distance_m(&s[i], &s[kept - 1]) > options->max_speed_mps * dt_s) {
                counts->too_fast++;
            } else {
                s[kept++] = s[i];
            }
        }
        t->samples_n = kept;
    }
}

/* Further from where the hand was heading than a hand can swerve. */
static bool is_jump(const track_sample *s, size_t i)
{
    const double dt_s = s[i].t_s - s[i - 1].t_s;
    double change_squared = 0.0; /* of velocity */
    for (int axis = 0; axis < 3; axis++) {
        const double now = (s[i].position_m[axis] - s[i - 1].position_m[axis]) / dt_s;
        const double before = i < 2 ? 0.0
                                    : (s[i - 1].position_m[axis] - s[i - 2].position_m[axis]) /
                                          (s[i - 1].t_s - s[i - 2].t_s);
        change_squared += (now - before) * (now - before);
    }
    const double change = sqrt(change_squared);
    return change * dt_s > 0.01 && change > 1000.0 * dt_s;
}

static void count_oddities(track *t)
{
    const track_sample *s = t->samples;
    track_counts *counts = &t->counts;
    for (size_t i = 1; i < t->samples_n; i++) {
        double dot = 0.0;
        for (int axis = 0; axis < 4; axis++) {
            dot += s[i].orientation[axis] * s[i - 1].orientation[axis];
        }
        counts->sign_flips += dot < 0.0;
        counts->gaps += s[i].t_s - s[i - 1].t_s > LONGEST_GAP_S;
        if (is_jump(s, i)) {
            if (counts->jumps == 0) {
                counts->first_jump_line = s[i].line;
            }
            counts->jumps++;
        }
    }
}

int track_read(const char *path, const track_options *options, track *out)
{
    memset(out, 0, sizeof *out);
    int result = track_reader_read(path, &out->samples, &out->samples_n);
    if (result != SIM_OK) {
        return result;
    }
    out->path = strdup(path);
    clean(out, options);
    if (out->samples_n == 0) {
        track_free(out);
        return sim_complain("%s: every quaternion is all zeros: no pose to follow", path);
    }
    for (size_t i = 0; i < out->samples_n; i++) {
        for (int axis = 0; axis < 3; axis++) {
            const double metres = out->samples[i].position_m[axis];
            if (!(fabs(metres - out->samples[0].position_m[axis]) <= 900.0)) {
                result = sim_complain(
                    "%s:%ld: %.4g m away from the first sample, at most 900 m are allowed; "
                    "if the file is not in metres, give --scale",
                    path, out->samples[i].line, fabs(metres - out->samples[0].position_m[axis]));
                track_free(out);
                return result;
            }
        }
    }
    memcpy(out->origin_m, out->samples[0].position_m, sizeof out->origin_m);
    count_oddities(out);
    return SIM_OK;
}

void track_free(track *t)
{
    free(t->path);
    free(t->samples);
    memset(t, 0, sizeof *t);
}

double track_duration_s(const track *t)
{
    return t->samples[t->samples_n - 1].t_s - t->samples[0].t_s;
}

double track_ticks_count(const track *source, double rate_hz)
{
    return floor(track_duration_s(source) * rate_hz + TICK_SLACK) + 1.0;
}

track_ticks track_ticks_start(const track *source, double rate_hz)
{
    return (track_ticks){source, rate_hz, (long)track_ticks_count(source, rate_hz), 0, 0};
}

/* The pose a share u of the way from a to b: positions linear, quaternions normalised linear the
 * shorter way round. */
static rod_pose blend(const track_sample *a, const track_sample *b, double u,
                      const double origin_m[3])
{
    double p[3], q[4], dot = 0.0, norm = 0.0;
    for (int i = 0; i < 3; i++) {
        p[i] = a->position_m[i] + u * (b->position_m[i] - a->position_m[i]) - origin_m[i];
    }
    for (int i = 0; i < 4; i++) {
        dot += a->orientation[i] * b->orientation[i];
    }
    for (int i = 0; i < 4; i++) {
        q[i] = (1.0 - u) * a->orientation[i] + (dot < 0.0 ? -u : u) * b->orientation[i];
        norm += q[i] * q[i];
    }
    norm =
        1.0 / sqrt(norm); /* at least sqrt(1/2) long, since the angle between them is at most 90 */
    return (rod_pose){
        {(float)p[0], (float)p[1], (float)p[2]},
        {(float)(q[0] * norm), (float)(q[1] * norm), (float)(q[2] * norm), (float)(q[3] * norm)}};
}

bool track_ticks_next(track_ticks *ticks, track_tick *tick)
{
    if (ticks->next >= ticks->ticks_n) {
        return false;
    }
    const track *t = ticks->source;
    const track_sample *s = t->samples;
    const double now_s = s[0].t_s + (double)ticks->next / ticks->rate_hz;
    tick->restart = ticks->next == 0;
    while (ticks->near + 1 < t->samples_n && (s[ticks->near + 1].t_s - s[0].t_s) * ticks->rate_hz <=
                                                 (double)ticks->next + TICK_SLACK) {
        tick->restart |= s[ticks->near + 1].t_s - s[ticks->near].t_s > LONGEST_GAP_S;
        ticks->near++;
    }
    ticks->next++;
    const track_sample *a = &s[ticks->near];
    const bool last = ticks->near + 1 == t->samples_n;
    const track_sample *b = last ? a : a + 1;
    const double span_s = b->t_s - a->t_s;
    const bool hold = last || span_s > LONGEST_GAP_S;
    const double u = hold ? 0.0 : fmax(0.0, now_s - a->t_s) / span_s;
    tick->base = blend(a, b, u, t->origin_m);
    return true;
}
