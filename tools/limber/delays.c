/* delays.c - see delays.h. */
#include "delays.h"

#include <math.h>
#include <stdlib.h>

#include "limber.h"

pose_delays *pose_delays_new(void)
{
    pose_delays *const d = calloc(1, sizeof *d);
    if (d == NULL) {
        (void)sim_give_up("out of memory");
    }
    return d;
}

void pose_delays_session(pose_delays *d, float tick_hz)
{
    d->tick_us = tick_hz >= 1.0f ? (int32_t)(1e6f / tick_hz + 0.5f) : 0;
    d->sent_n = d->first_echo_n = d->last_echo_n = 0;
    d->echoed = false;
}

void pose_delays_sent(pose_delays *d, uint16_t seq, uint64_t sent_us)
{
    d->sent_us[seq] = sent_us;
    d->last_seq = seq;
    d->sent_n++;
}

static void add(delays *d, int64_t us)
{
    us = us < 0 ? 0 : us; /* the clock's offset is not known better than that */
    const int64_t bin = us / DELAYS_BIN_US;
    d->bins[bin < DELAYS_BINS_N ? bin : DELAYS_BINS_N - 1]++;
    d->n++;
    d->max_us = us > d->max_us ? us : d->max_us;
}

void pose_delays_angles(pose_delays *d, const message_angles *angles, uint32_t device_us,
                        uint64_t came_us, const clock_sync *clock)
{
    const uint16_t behind = (uint16_t)(d->last_seq - angles->pose_seq);
    if ((angles->flags & ANGLES_NO_POSE) != 0 || behind >= d->sent_n) {
        return;
    }
    const uint64_t n = d->sent_n - behind;
    if (d->echoed && n <= d->last_echo_n) {
        return;
    }
    if (!d->echoed) {
        d->echoed = true;
        d->first_echo_n = n;
    }
    d->last_echo_n = n;
    if (angles->received_ago_us == UINT16_MAX || angles->solved_ago_us > angles->received_ago_us ||
        clock->samples_n == 0) {
        return;
    }
    const uint32_t sent_us = (uint32_t)d->sent_us[angles->pose_seq];
    const uint32_t left_us = clock_sync_to_ours(clock, device_us);
    const int64_t whole_us = (int64_t)(came_us - d->sent_us[angles->pose_seq]);
    const int64_t most_reply_us = whole_us - angles->received_ago_us;
    /* both ends on our clock: no leg can have taken less than nothing */
    int64_t line_us = (int32_t)(left_us - angles->received_ago_us - sent_us);
    line_us = line_us < 0 ? 0 : line_us > most_reply_us ? most_reply_us : line_us;
    add(&d->whole, whole_us);
    add(&d->line, line_us);
    int32_t solve_us = angles->received_ago_us - angles->solved_ago_us; /* of the last tick ... */
    solve_us = d->tick_us > 0 ? solve_us % d->tick_us : solve_us;       /* ... of the first */
    add(&d->solve, solve_us);
    add(&d->reply, whole_us - line_us - solve_us);
}

uint64_t pose_delays_unseen(const pose_delays *d)
{
    return d->echoed ? d->first_echo_n - 1 + d->sent_n - d->last_echo_n : d->sent_n;
}

double delays_quantile_ms(const delays *d, double share)
{
    const uint64_t wanted = (uint64_t)ceil(share * (double)d->n);
    uint64_t so_far = 0;
    for (int bin = 0; bin < DELAYS_BINS_N && d->n > 0; bin++) {
        so_far += d->bins[bin];
        if (so_far >= wanted) {
            const int64_t us = (int64_t)(bin + 1) * DELAYS_BIN_US;
            return (double)(us < d->max_us && bin < DELAYS_BINS_N - 1 ? us : d->max_us) * 1e-3;
        }
    }
    return 0.0;
}

/* --- spread ---------------------------------------------------------------------------------------- */

enum { USUAL_BARS_MAX = 20, PRINTED_WIDTH = 50 };

/* The least width of 5, 10, 20, 50, 100, ... us, in the finest bins, that takes no more bars than there are. */
static int bar_width(int first_bin, int last_bin)
{
    static const int STEPS[] = {1, 2, 4};
    for (int decade = 1;; decade *= 10) {
        for (int i = 0; i < 3; i++) {
            const int width = STEPS[i] * decade;
            if (last_bin / width - first_bin / width < USUAL_BARS_MAX) {
                return width;
            }
        }
    }
}

static double ms_of(int bin)
{
    return bin * DELAYS_BIN_US / 1e3;
}

/* The bin up to which a share of the delays lies. */
static int bin_of_share(const delays *d, double share)
{
    int bin = 0;
    for (uint64_t so_far = d->bins[0]; (double)so_far < share * (double)d->n;) {
        so_far += d->bins[++bin];
    }
    return bin;
}

int delays_bars(const delays *d, delays_bar bars[DELAYS_BARS_MAX])
{
    int first = 0;
    if (d->n == 0) {
        return 0;
    }
    while (d->bins[first] == 0) {
        first++;
    }
    const int usual = bin_of_share(d, 0.99), longest = bin_of_share(d, 1.0);
    const int width = bar_width(first, usual), begin = first / width;
    const bool all_fit = longest / width - begin < DELAYS_BARS_MAX;
    const int end = (all_fit ? longest : usual) / width + 1; /* of those equally wide */
    for (int i = begin; i < end; i++) {
        bars[i - begin] = (delays_bar){ms_of(i * width), ms_of((i + 1) * width), 0};
    }
    const int bars_n = end - begin + !all_fit;
    delays_bar *const last = &bars[bars_n - 1];
    if (!all_fit) {
        *last = (delays_bar){ms_of(end * width), 0.0, 0};
    }
    for (int bin = first; bin <= longest; bin++) {
        (bin < end * width ? &bars[bin / width - begin] : last)->n += d->bins[bin];
    }
    if (!all_fit || longest == DELAYS_BINS_N - 1) {
        last->to_ms = (double)d->max_us * 1e-3; /* the last of the bins has all that is longer */
    }
    return bars_n;
}

void delays_print_bars(const delays *d, FILE *out)
{
    delays_bar bars[DELAYS_BARS_MAX];
    const int bars_n = delays_bars(d, bars);
    uint64_t most = 1;
    for (int i = 0; i < bars_n; i++) {
        most = bars[i].n > most ? bars[i].n : most;
    }
    for (int i = 0; i < bars_n; i++) {
        /* rounded up: one delay shows, too */
        const int length = (int)((bars[i].n * PRINTED_WIDTH + most - 1) / most);
        fprintf(out, "  %8.3f ... %8.3f %8llu%s%.*s\n", bars[i].from_ms, bars[i].to_ms,
                (unsigned long long)bars[i].n, length > 0 ? " " : "", length,
                "##################################################");
    }
}

cJSON *delays_bars_json(const delays *d)
{
    delays_bar bars[DELAYS_BARS_MAX];
    const int bars_n = delays_bars(d, bars);
    cJSON *const json = cJSON_CreateArray();
    for (int i = 0; i < bars_n; i++) {
        cJSON *const one = cJSON_CreateObject();
        cJSON_AddNumberToObject(one, "from_ms", bars[i].from_ms);
        cJSON_AddNumberToObject(one, "to_ms", bars[i].to_ms);
        cJSON_AddNumberToObject(one, "poses", (double)bars[i].n);
        cJSON_AddItemToArray(json, one);
    }
    return json;
}

/* --- all parts ------------------------------------------------------------------------------------- */

static const struct {
    const char *name, *what;
    size_t offset;
} PARTS[] = {
    {"whole", "pose -> angles", offsetof(pose_delays, whole)},
    {"line", "line to device", offsetof(pose_delays, line)},
    {"solve", "tick and solve", offsetof(pose_delays, solve)},
    {"reply", "reply", offsetof(pose_delays, reply)},
};

static const delays *part(const pose_delays *d, int i)
{
    return (const delays *)(const void *)((const char *)d + PARTS[i].offset);
}

void pose_delays_print(const pose_delays *d, FILE *out)
{
    if (d->whole.n == 0) {
        fprintf(out, "latency    unknown: no ANGLES came back with a pose of ours\n");
        return;
    }
    fprintf(out, "latency         p50      p99      max   ms, of %llu poses\n",
            (unsigned long long)d->whole.n);
    for (int i = 0; i < 4; i++) {
        const delays *const p = part(d, i);
        fprintf(out, "  %-14s %7.3f  %7.3f  %7.3f\n", PARTS[i].what, delays_quantile_ms(p, 0.50),
                delays_quantile_ms(p, 0.99), (double)p->max_us * 1e-3);
    }
}

cJSON *pose_delays_json(const pose_delays *d)
{
    cJSON *const json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "poses", (double)d->whole.n);
    for (int i = 0; i < 4 && d->whole.n > 0; i++) {
        const delays *const p = part(d, i);
        cJSON *const one = cJSON_AddObjectToObject(json, PARTS[i].name);
        cJSON_AddNumberToObject(one, "p50_ms", delays_quantile_ms(p, 0.50));
        cJSON_AddNumberToObject(one, "p99_ms", delays_quantile_ms(p, 0.99));
        cJSON_AddNumberToObject(one, "max_ms", (double)p->max_us * 1e-3);
    }
    return json;
}
