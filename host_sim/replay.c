/* replay.c - see replay.h. */
#include "replay.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "angle_hash.h"
#include "replay_touch.h"
#include "sim.h"

static const double MOST_GB = 2.0; /* seven hours of four links at 1 kHz */

static double now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

/* What reading the clock itself adds to a measured step. */
static double clock_cost_us(void)
{
    double least = 1e9;
    for (int i = 0; i < 1000; i++) {
        const double start = now_us();
        least = fmin(least, now_us() - start);
    }
    return least;
}

static void show_progress(long done, long all)
{
    static const char FULL[] = "########################################";
    const int width = (int)(40.0 * (double)done / (double)all);
    fprintf(stderr, "\r[%-40.*s] %3d %%%s", width, FULL, (int)(100.0 * (double)done / (double)all),
            done == all ? "\r\033[K" : "");
    fflush(stderr);
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void sum_up_times(replay *r, float *step_us)
{
    const size_t n = (size_t)r->ticks_n;
    qsort(step_us, n, sizeof *step_us, by_size);
    r->step_median_us = (double)step_us[n / 2];
    r->step_p99_us = (double)step_us[(n - 1) - (n - 1) / 100];
    r->step_max_us = (double)step_us[n - 1];
}

static int run_ticks(replay *r, rod *rod, float *step_us)
{
    track_ticks ticks = track_ticks_start(r->source, r->rate_hz);
    const double clock_us = clock_cost_us();
    const bool bar = isatty(STDERR_FILENO) && r->ticks_n * r->params.links_n > 2000000;
    const long bar_step = r->ticks_n / 100 + 1;
    const int values_n = 2 * r->params.links_n;
    r->hash = ANGLE_HASH_START;
    for (long n = 0; track_ticks_next(&ticks, &r->ticks[n]); n++) {
        const track_tick *tick = &r->ticks[n];
        if (tick->restart) {
            rod_reset(rod);
            r->restarts += n > 0;
        }
        const double start_us = now_us();
        const rod_error error = rod_step(rod, &tick->base);
        step_us[n] = (float)fmax(0.0, now_us() - start_us - clock_us);
        if (error != ROD_OK) {
            return sim_give_up("tick %ld, %.6f s: %s", n, (double)n / r->rate_hz,
                               rod_error_text(error));
        }
        float *row = r->angles_rad + (size_t)n * (size_t)values_n;
        memcpy(row, rod_angles(rod), (size_t)values_n * sizeof *row);
        r->hash = angle_hash_add(r->hash, row, values_n);
        if (!replay_touch_keep(r, rod, n)) {
            return sim_give_up("out of memory for %zu contacts", r->contacts_n);
        }
        if (bar && (n % bar_step == 0 || n + 1 == r->ticks_n)) {
            show_progress(n + 1, r->ticks_n);
        }
    }
    r->restored_n = (long)rod_restored_n(rod);
    return SIM_OK;
}

static void sum_up_joints(replay *r)
{
    for (int joint = 0; joint < r->params.links_n; joint++) {
        replay_joint *j = &r->joints[joint];
        const double limit = (double)r->params.limit_rad[joint];
        long at_limit = 0;
        double squares[2] = {0.0, 0.0};
        for (long n = 0; n < r->ticks_n; n++) {
            bool reached = false;
            for (int axis = 0; axis < 2; axis++) {
                const double angle = fabs((double)replay_angles(r, n)[2 * joint + axis]);
                j->peak_rad[axis] = fmax(j->peak_rad[axis], angle);
                squares[axis] += angle * angle;
                reached = reached || angle >= limit;
            }
            at_limit += reached;
        }
        for (int axis = 0; axis < 2; axis++) {
            j->rms_rad[axis] = sqrt(squares[axis] / (double)r->ticks_n);
        }
        j->limit_share = (double)at_limit / (double)r->ticks_n;
    }
}

/* Part of a run, as lags are found from it. */
typedef struct {
    long first, end, step; /* ticks; every step-th one is looked at */
} stretch;

/* The stretch of that many ticks in which joint 1 swings most. */
static stretch liveliest(const replay *r, long length)
{
    double swing = 0.0, most = -1.0;
    long best = 0;
    for (long n = 0; n < r->ticks_n; n++) {
        const float *in = replay_angles(r, n);
        swing += (double)(in[0] * in[0] + in[1] * in[1]);
        if (n >= length) {
            const float *out = replay_angles(r, n - length);
            swing -= (double)(out[0] * out[0] + out[1] * out[1]);
        }
        if (n + 1 >= length && swing > most) {
            most = swing;
            best = n + 1 - length;
        }
    }
    return (stretch){best, best + length, (long)fmax(1.0, r->rate_hz / 50.0)};
}

/* One Fourier coefficient of an angle over a stretch. */
static void fourier(const replay *r, const stretch *s, int column, double frequency_hz,
                    double out[2])
{
    const double turn = 2.0 * M_PI * frequency_hz * (double)s->step / r->rate_hz;
    const double cosine = cos(turn), sine = sin(turn);
    double x = 1.0, y = 0.0;
    out[0] = out[1] = 0.0;
    for (long n = s->first; n < s->end; n += s->step) {
        const double angle = (double)replay_angles(r, n)[column];
        out[0] += angle * x;
        out[1] -= angle * y;
        const double turned = x * cosine - y * sine;
        y = x * sine + y * cosine;
        x = turned;
    }
}

/* Phase lags as the paper's figures show them: at the frequency at which joint 1 swings most, up to
 * 10 Hz, theta and phi together. Of a long run the liveliest 200 s. */
static void find_lags(replay *r)
{
    const long length = (long)fmin((double)r->ticks_n, 200.0 * r->rate_hz);
    const stretch s = liveliest(r, length);
    const double duration_s = (double)length / r->rate_hz;
    const double top_hz = fmin(10.0, 0.4 * r->rate_hz);
    const int bins_n = (int)(top_hz * duration_s);
    double strongest = 0.0;
    for (int k = 1; k <= bins_n; k++) {
        double power = 0.0;
        for (int axis = 0; axis < 2; axis++) {
            double f[2];
            fourier(r, &s, axis, k / duration_s, f);
            power += f[0] * f[0] + f[1] * f[1];
        }
        if (power > strongest) {
            strongest = power;
            r->lag_frequency_hz = k / duration_s;
        }
    }
    const double samples_n = (double)(length / s.step);
    if (sqrt(strongest) < 1e-6 * samples_n) { /* under 2 microradians: joint 1 does not swing */
        r->lag_frequency_hz = 0.0;
        return;
    }
    for (int joint = 0; joint < r->params.links_n; joint++) {
        double real = 0.0, imaginary = 0.0;
        for (int axis = 0; axis < 2; axis++) {
            double first[2], own[2];
            fourier(r, &s, axis, r->lag_frequency_hz, first);
            fourier(r, &s, 2 * joint + axis, r->lag_frequency_hz, own);
            real += first[0] * own[0] + first[1] * own[1];
            imaginary += first[1] * own[0] - first[0] * own[1];
        }
        r->joints[joint].lag_known = hypot(real, imaginary) > 1e-12 * samples_n * samples_n;
        const double before = joint > 0 ? r->joints[joint - 1].lag_deg : 0.0;
        const double lag = atan2(imaginary, real) * 180.0 / M_PI;
        r->joints[joint].lag_deg =
            lag + 360.0 * round((before - lag) / 360.0); /* grows along the rod */
    }
}

static int run_rod(replay *r, float *step_us)
{
    rod rod;
    int result = replay_touch_place(r);
    if (result == SIM_OK && rod_init(&rod, &r->params, NULL) != ROD_OK) {
        result = sim_give_up("the rod refuses parameters that have been checked");
    }
    if (result != SIM_OK) {
        return result;
    }
    if (r->around.objects != NULL && rod_set_scene(&rod, &r->objects) != ROD_OK) {
        return sim_give_up("the rod is too stiff for float32 in the steps it takes among objects: "
                           "--rate 500 or more");
    }
    if (r->around.shape_rad != NULL &&
        rod_set_shape(&rod, r->around.shape_rad, r->around.shape_strength_nm,
                      r->around.shape_blend_s) != ROD_OK) {
        return sim_give_up("%s: the rod refuses a shape that has been checked",
                           r->around.shape_name);
    }
    return run_ticks(r, &rod, step_us);
}

int replay_run(const track *source, const rod_params *params, double rate_hz,
               const replay_surroundings *around, replay *out)
{
    static const replay_surroundings NOTHING = {0};
    *out = (replay){.source = source,
                    .params = *params,
                    .rate_hz = rate_hz,
                    .around = around == NULL ? NOTHING : *around};
    const double ticks = track_ticks_count(source, rate_hz);
    const double values = ticks * 2.0 * params->links_n;
    const double gb =
        1e-9 * (ticks * (double)(sizeof *out->ticks + sizeof(float)) + values * sizeof(float));
    if (!(gb <= MOST_GB)) {
        return sim_complain("%s: %.0f s at %g Hz make %.3g ticks of %d joints, too many to keep "
                            "(%.3g GB, at most %g); lower --rate or cut the track",
                            source->path, track_duration_s(source), rate_hz, ticks, params->links_n,
                            gb, MOST_GB);
    }
    out->ticks_n = (long)ticks;
    out->ticks = malloc((size_t)out->ticks_n * sizeof *out->ticks);
    out->angles_rad = malloc((size_t)values * sizeof *out->angles_rad);
    float *step_us = malloc((size_t)out->ticks_n * sizeof *step_us);
    int result;
    if (out->ticks == NULL || out->angles_rad == NULL || step_us == NULL) {
        result = sim_give_up("out of memory for %ld ticks", out->ticks_n);
    } else {
        result = run_rod(out, step_us);
    }
    if (result == SIM_OK) {
        sum_up_times(out, step_us);
        sum_up_joints(out);
        find_lags(out);
    } else {
        replay_free(out);
    }
    free(step_us);
    return result;
}

void replay_free(replay *r)
{
    free(r->ticks);
    free(r->angles_rad);
    free(r->contacts);
    free(r->contacts_begin);
    *r = (replay){0};
}

const float *replay_angles(const replay *r, long tick)
{
    return r->angles_rad + (size_t)tick * 2u * (size_t)r->params.links_n;
}

void replay_nodes(const replay *r, long tick, double nodes_m[][3])
{
    const int links_n = r->params.links_n;
    rod_joint angles[ROD_MAX_LINKS];
    vec3 nodes[ROD_MAX_LINKS + 1];
    memcpy(angles, replay_angles(r, tick), (size_t)links_n * sizeof *angles);
    kinematics_nodes(&r->ticks[tick].base, (const rod_joint *)angles, r->params.length_m, links_n,
                     nodes);
    const double *origin = r->source->origin_m;
    for (int i = 0; i <= links_n; i++) {
        nodes_m[i][0] = origin[0] + (double)nodes[i].x;
        nodes_m[i][1] = origin[1] + (double)nodes[i].y;
        nodes_m[i][2] = origin[2] + (double)nodes[i].z;
    }
}
