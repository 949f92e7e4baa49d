/* pose_figures.c - how well pose_input tells where the hand is, and how calmly, on recorded tracks.
 *
 *     pose_figures TRACK...        (TUM text: t x y z qx qy qz qw)
 *
 * Each track arrives 2 ms after its capture; ticks at 1 kHz. The truth is what was accepted, joined by
 * straight lines, known only later. Error: of a tick's base against the truth at that moment (for
 * interpolate: and at the moment it stands for). Acceleration: second difference of the base over ticks,
 * which is what excites the rod. For comparison the same ticks from the bare methods: hold the newest
 * pose; the line of the last two without horizon or blend; straight lines between poses, one interval late.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pose_input.h"

enum { SAMPLES_MAX = 20000, TICKS_MAX = 80000, LATENCY_US = 2000, TICK_US = 1000 };

typedef struct {
    double t_us;
    rod_pose pose;
} moment;

static moment track[SAMPLES_MAX], accepted[SAMPLES_MAX];
static moment given[TICKS_MAX];
static int track_n, accepted_n;

static double distance(vec3 a, vec3 b)
{
    const vec3 d = vec3_sub(a, b);
    return sqrt((double)vec3_dot(d, d));
}

static rod_pose mixed(const moment *a, const moment *b, double t_us)
{
    const double s = (t_us - a->t_us) / (b->t_us - a->t_us);
    pose_motion step = pose_velocity(&a->pose, &b->pose, 1.0f);
    const vec3 turn = vec3_scale(step.turn_radps, (float)s);
    const double angle = sqrt((double)vec3_dot(turn, turn));
    const float scale = angle > 1e-9 ? (float)(sin(angle / 2) / angle) : 0.5f;
    const quat q = {turn.x * scale, turn.y * scale, turn.z * scale, (float)cos(angle / 2)};
    return (rod_pose){
        vec3_add(a->pose.position_m, vec3_scale(step.velocity_mps, (float)s)),
        pose_unit(quat_multiply(q, a->pose.orientation)),
    };
}

/* Where the hand was; false over gaps. Moments asked for only grow, but for small steps back. */
static bool truth(double t_us, int *at, rod_pose *pose)
{
    while (*at > 0 && accepted[*at].t_us > t_us) {
        --*at;
    }
    while (*at + 2 < accepted_n && accepted[*at + 1].t_us <= t_us) {
        ++*at;
    }
    const moment *a = &accepted[*at], *b = a + 1;
    if (t_us < a->t_us || t_us > b->t_us || b->t_us - a->t_us > 100e3) {
        return false;
    }
    *pose = mixed(a, b, t_us);
    return true;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_spread(const char *what, double *values, int n, double unit)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sum += values[i] * values[i];
    }
    qsort(values, (size_t)n, sizeof *values, compare);
    printf("  %s %8.3f %8.3f %8.2f", what, unit * sqrt(sum / n), unit * values[n * 99 / 100],
           unit * values[n - 1]);
}

static void report(const char *name, int ticks_n, double late_us)
{
    static double metres[TICKS_MAX], radians[TICKS_MAX], mps2[TICKS_MAX], radps2[TICKS_MAX];
    int n = 0, at = 0;
    for (int i = 2; i < ticks_n; i++) {
        rod_pose there;
        if (!truth(given[i].t_us - late_us, &at, &there)) {
            continue;
        }
        const rod_pose *now = &given[i].pose, *before = &given[i - 1].pose,
                       *first = &given[i - 2].pose;
        metres[n] = distance(now->position_m, there.position_m);
        radians[n] = (double)pose_angle(now->orientation, there.orientation);
        mps2[n] = 1e6 * distance(vec3_sub(now->position_m, before->position_m),
                                 vec3_sub(before->position_m, first->position_m));
        const pose_motion w1 = pose_velocity(before, now, 1.0f),
                          w0 = pose_velocity(first, before, 1.0f);
        radps2[n++] = 1e6 * distance(w1.turn_radps, w0.turn_radps);
    }
    printf("%-26s", name);
    print_spread("mm", metres, n, 1e3);
    print_spread("deg", radians, n, 180.0 / 3.14159265358979);
    print_spread("m/s2", mps2, n, 1.0);
    print_spread("rad/s2", radps2, n, 1.0);
    printf("\n");
}

static uint32_t median_interval_us(void)
{
    static double interval_us[SAMPLES_MAX];
    for (int i = 1; i < accepted_n; i++) {
        interval_us[i - 1] = accepted[i].t_us - accepted[i - 1].t_us;
    }
    qsort(interval_us, (size_t)accepted_n - 1, sizeof *interval_us, compare);
    return (uint32_t)interval_us[accepted_n / 2];
}

static int run(pose_mode mode, pose_input *in)
{
    pose_input_params params = pose_input_defaults();
    params.mode = mode;
    pose_input_init(in, &params, 0);
    pose_input_open(in, 1);
    accepted_n = 0;
    int ticks_n = 0, next = 0;
    const double end_us = track[track_n - 1].t_us + LATENCY_US;
    for (uint32_t now_us = 0; (double)now_us < end_us && ticks_n < TICKS_MAX; now_us += TICK_US) {
        for (; next < track_n && track[next].t_us + LATENCY_US <= (double)now_us; next++) {
            const uint32_t t_us = (uint32_t)track[next].t_us;
            const pose_sample sent = {track[next].pose, t_us + LATENCY_US, LATENCY_US,
                                      (uint16_t)next, 1};
            if (pose_input_receive(in, &sent, t_us + LATENCY_US) == POSE_ACCEPTED) {
                accepted[accepted_n].t_us = (double)t_us;
                accepted[accepted_n++].pose = in->accepted[0].pose;
            }
        }
        const pose_tick tick = pose_input_tick(in, now_us);
        if (tick.valid) {
            given[ticks_n].t_us = (double)now_us;
            given[ticks_n++].pose = tick.base;
        }
    }
    return ticks_n;
}

/* The bare methods over the same ticks. */
static void run_bare(const char *name, int ticks_n, double late_us, bool line)
{
    int known = 0;
    for (int i = 0; i < ticks_n; i++) {
        const double now_us = given[i].t_us;
        while (known + 1 < accepted_n && accepted[known + 1].t_us + LATENCY_US <= now_us) {
            known++;
        }
        int at = known;
        if (late_us > 0.0) {
            while (at > 0 && accepted[at].t_us > now_us - late_us) {
                at--;
            }
            if (at < known) {
                given[i].pose = mixed(&accepted[at], &accepted[at + 1], now_us - late_us);
                continue;
            }
        }
        given[i].pose =
            line && at > 0 ? mixed(&accepted[at - 1], &accepted[at], now_us) : accepted[at].pose;
    }
    report(name, ticks_n, late_us);
}

static bool read_track(const char *path)
{
    FILE *file = fopen(path, "r");
    char text[512];
    double t0 = 0.0;
    track_n = 0;
    while (file != NULL && track_n < SAMPLES_MAX && fgets(text, sizeof text, file) != NULL) {
        double t, p[3], q[4];
        if (sscanf(text, "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &p[0], &p[1], &p[2], &q[0], &q[1],
                   &q[2], &q[3]) != 8) {
            continue;
        }
        t0 = track_n == 0 ? t : t0;
        track[track_n].t_us = round((t - t0) * 1e6);
        track[track_n++].pose = (rod_pose){
            {(float)p[0], (float)p[1], (float)p[2]},
            {(float)q[0], (float)q[1], (float)q[2], (float)q[3]},
        };
    }
    if (file != NULL) {
        fclose(file);
    }
    return track_n > 2;
}

int main(int argc, char **argv)
{
    static pose_input in;
    printf("each: rms, p99, max\n");
    for (int i = 1; i < argc; i++) {
        if (!read_track(argv[i])) {
            fprintf(stderr, "%s: cannot be read as a track\n", argv[i]);
            return 1;
        }
        int ticks_n = run(POSE_PREDICT, &in);
        printf("%s: %u received", argv[i], in.received);
        for (int v = 0; v < POSE_VERDICTS_N; v++) {
            if (in.count[v] > 0) {
                printf(", %u %s", in.count[v], pose_verdict_text((pose_verdict)v));
            }
        }
        printf(", %u restarts (%u after refusals)\n", in.restarts, in.reanchored);
        report("predict", ticks_n, 0.0);
        const double late_us = LATENCY_US + (double)median_interval_us();
        run_bare("bare: newest held", ticks_n, 0.0, false);
        run_bare("bare: line of two", ticks_n, 0.0, true);
        ticks_n = run(POSE_INTERPOLATE, &in);
        report("interpolate", ticks_n, 0.0);
        report("interpolate, from its time", ticks_n, late_us);
        run_bare("bare: lines, late", ticks_n, late_us, false);
    }
    return 0;
}
