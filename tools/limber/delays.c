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
