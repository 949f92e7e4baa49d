/* source.c - see source.h. */
#include "source.h"

#include <stdlib.h>
#include <string.h>

#include "limber.h"

int source_open(source *s, const char *path, const source_options *options)
{
    const bool is_stdin = strcmp(path, "-") == 0;
    *s = (source){.options = *options, .name = is_stdin ? "standard input" : path};
    if (options->live != NULL) {
        return live_source_open(&s->input, options->live, s->name);
    }
    const int result = track_read(is_stdin ? "/dev/stdin" : path, &options->track, &s->file);
    if (result != SIM_OK) {
        return result;
    }
    for (size_t i = 0; i < s->file.samples_n; i++) {
        mount_apply(&options->mount, &s->file.samples[i]);
    }
    memcpy(s->file.origin_m, s->file.samples[0].position_m, sizeof s->file.origin_m);
    if (options->resample_hz > 0.0) {
        if (track_ticks_count(&s->file, options->resample_hz) > 1e9) {
            return sim_complain("%s: %g Hz over its whole duration are too many poses", s->name,
                                options->resample_hz);
        }
        s->ticks = track_ticks_start(&s->file, options->resample_hz);
    }
    return SIM_OK;
}

void source_free(source *s)
{
    if (s->options.live != NULL) {
        live_source_close(&s->input);
    } else {
        track_free(&s->file);
    }
}

static source_pose pose_of(const track_sample *sample, const double origin_m[3], double first_s)
{
    source_pose pose = {.t_s = sample->t_s - first_s};
    const double *const p = sample->position_m, *const q = sample->orientation;
    pose.pose.position_m = (vec3){(float)(p[0] - origin_m[0]), (float)(p[1] - origin_m[1]),
                                  (float)(p[2] - origin_m[2])};
    pose.pose.orientation = (quat){(float)q[0], (float)q[1], (float)q[2], (float)q[3]};
    return pose;
}

bool source_next(source *s, source_pose *pose)
{
    if (s->options.resample_hz > 0.0) {
        track_tick tick;
        const double t_s = (double)s->ticks.next / s->options.resample_hz;
        if (!track_ticks_next(&s->ticks, &tick)) {
            return false;
        }
        *pose = (source_pose){.pose = tick.base, .t_s = t_s};
        return true;
    }
    if (s->next == s->file.samples_n) {
        return false;
    }
    *pose = pose_of(&s->file.samples[s->next++], s->file.origin_m, s->file.samples[0].t_s);
    return true;
}

bool source_next_live(source *s, source_pose *pose)
{
    track_sample sample;
    uint64_t captured_us;
    while (live_source_next(&s->input, &sample, &captured_us)) {
        s->counts.lines++;
        if (!track_take_sample(&sample, &s->options.track, &s->counts)) {
            continue;
        }
        mount_apply(&s->options.mount, &sample);
        if (!s->begun) {
            s->begun = true;
            s->first_s = sample.t_s;
            memcpy(s->origin_m, sample.position_m, sizeof s->origin_m);
        }
        *pose = pose_of(&sample, s->origin_m, s->first_s);
        pose->captured_us = captured_us;
        return true;
    }
    return false;
}

const double *source_origin_m(const source *s)
{
    return s->options.live == NULL ? s->file.origin_m : s->begun ? s->origin_m : NULL;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double source_interval_s(const source *s)
{
    const size_t intervals_n = s->file.samples_n - 1;
    if (s->options.resample_hz > 0.0) {
        return 1.0 / s->options.resample_hz;
    }
    double *const intervals = malloc((intervals_n + 1) * sizeof *intervals);
    if (intervals == NULL || intervals_n == 0) {
        free(intervals);
        return 0.01; /* one pose: sent at the usual rate while arming */
    }
    for (size_t i = 0; i < intervals_n; i++) {
        intervals[i] = s->file.samples[i + 1].t_s - s->file.samples[i].t_s;
    }
    qsort(intervals, intervals_n, sizeof *intervals, by_size);
    const double median = intervals[(intervals_n - 1) / 2];
    free(intervals);
    return median;
}

double source_duration_s(const source *s)
{
    return track_duration_s(&s->file);
}

double source_poses_n(const source *s)
{
    return s->options.resample_hz > 0.0 ? track_ticks_count(&s->file, s->options.resample_hz)
                                        : (double)s->file.samples_n;
}
