/* stream_summary.c - what is said of a stream, while it runs and when it is over. */
#include <stdio.h>
#include <string.h>

#include "progress.h"
#include "stream.h"
#include "texts.h"

enum { PROGRESS_US = 100000 };

static const char *state_name(const stream *st)
{
    return message_value_name(&message_values_device_states, st->state);
}

static void draw(stream *st, uint64_t now_us)
{
    monitor_state_refresh(&st->monitor, now_us);
    monitor_view_draw(st->options.view, &st->monitor);
    st->interrupted = st->interrupted || !monitor_view_keys(st->options.view);
}

void stream_show_progress(stream *st)
{
    const uint64_t now_us = limber_now_us();
    if (st->options.view != NULL && now_us - st->progress_us >= PROGRESS_US) {
        st->progress_us = now_us;
        draw(st, now_us);
    }
    if (st->options.view != NULL || !progress_wanted() || now_us - st->progress_us < PROGRESS_US) {
        return;
    }
    st->progress_us = now_us;
    char of[32] = "";
    if (st->source->options.live == NULL) {
        snprintf(of, sizeof of, " of %.1f", source_duration_s(st->source));
    }
    if (st->lead_n > 0 && st->played_n == 0) {
        progress_show("arming: %s", state_name(st));
    } else {
        progress_show("%.1f%s s, %llu poses, %s, pose -> angles %.1f ms", st->played_s, of,
                      (unsigned long long)st->played_n, state_name(st),
                      delays_quantile_ms(&st->delays->whole, 0.5));
    }
}

/* Poses a second while there were any. */
static double live_rate_hz(const stream *st)
{
    const double median_ms = live_pace_median_ms(st->source->input.pace);
    return median_ms > 0.0 ? 1e3 / median_ms : 0.0;
}

static void print_left_out(const live_counts *counts)
{
    const struct {
        long n;
        const char *what;
    } parts[] = {{counts->unreadable, "that are no pose"},
                 {counts->blind, "without an orientation"},
                 {counts->others, "of others"},
                 {counts->too_many, "beyond 2000 a second"}};
    const char *between = "left out  ";
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (parts[i].n > 0) {
            printf("%s %ld %s", between, parts[i].n, parts[i].what);
            between = ",";
        }
    }
    printf("%s", *between == ',' ? "\n" : "");
}

static void print_live(const stream *st)
{
    const live_source *const input = &st->source->input;
    const live_pace *const pace = input->pace;
    if (pace->intervals_n > 0) {
        printf(
            "source     %.1f a second: one every %.2f ms (median), 99 %% within %.2f ms of that\n",
            live_rate_hz(st), live_pace_median_ms(pace), live_pace_jitter_ms(pace));
    }
    if (pace->silences_n > 0) {
        printf("silences   %d, %.2f s in all, the longest %.2f s\n", pace->silences_n,
               (double)pace->silent_us * 1e-6, (double)pace->longest_us * 1e-6);
    }
    if (st->armings_n > 1) {
        printf("armed      %d times\n", st->armings_n);
    }
    print_left_out(&input->counts);
    const double took_s = (double)(st->end_us - st->play_us) * 1e-6;
    if (input->kind->waits && st->played_n > 20 && st->played_s > 3.0 * took_s + 0.5) {
        printf("pace       %.1f s of poses came in %.1f s; --speed 1 keeps to their times\n",
               st->played_s, took_s);
    }
}

static void print_poses(const pose_track *poses)
{
    if (poses == NULL || poses->rows_n == 0) {
        return;
    }
    printf("poses in   a track of %llu ticks", (unsigned long long)poses->rows_n);
    if (poses->missing_n > 0) {
        printf(", %llu more had no room on the line", (unsigned long long)poses->missing_n);
    }
    if (poses->restarts_n > 0) {
        printf("; the rod was laid straight %llu times on the way, a replay of it is not",
               (unsigned long long)poses->restarts_n);
    }
    printf("\n");
}

void stream_print_summary(const stream *st)
{
    const double took_s = (double)(st->end_us - st->play_us) * 1e-6;
    progress_clear();
    printf("stream     %s: %llu poses in %.2f s, to %s on %s%s\n", st->source->name,
           (unsigned long long)st->played_n, took_s, st->device, st->options.port,
           st->interrupted ? " (interrupted)" : "");
    if (st->skipped_n > 0) {
        printf("skipped    %llu whose moment passed while the device was away\n",
               (unsigned long long)st->skipped_n);
    }
    if (st->source->options.live != NULL) {
        print_live(st);
    }
    printf("sent       %llu", (unsigned long long)st->account.sent);
    if (st->lead_n > 0) {
        printf(", %llu of them the first pose, while arming", (unsigned long long)st->lead_n);
    }
    printf("\n");
    account_print(&st->account, stdout);
    if (st->reconnects_n > 0) {
        printf("lost it    %d time%s, and found it again\n", st->reconnects_n,
               st->reconnects_n == 1 ? "" : "s");
    }
    printf("angles     %llu came back, of %d links\n", (unsigned long long)st->angles_n,
           st->links_n);
    pose_delays_print(st->delays, stdout);
    if (st->graphics != NULL) {
        printf("graphics   %llu angles, %llu nodes to %s, %llu could not be sent\n",
               (unsigned long long)st->graphics->angles_n,
               (unsigned long long)st->graphics->nodes_n, st->graphics->name,
               (unsigned long long)st->graphics->unsent_n);
    }
    if (st->csv->rows_n > 0) {
        printf("angles in  %llu rows of CSV\n", (unsigned long long)st->csv->rows_n);
    }
    print_poses(st->options.poses);
}

static cJSON *live_json(const stream *st)
{
    const live_source *const input = &st->source->input;
    const live_pace *const pace = input->pace;
    cJSON *const json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "poses", (double)pace->poses_n);
    cJSON_AddNumberToObject(json, "rate_hz", live_rate_hz(st));
    cJSON_AddNumberToObject(json, "interval_p50_ms", live_pace_median_ms(pace));
    cJSON_AddNumberToObject(json, "jitter_p99_ms", live_pace_jitter_ms(pace));
    cJSON_AddNumberToObject(json, "silences", pace->silences_n);
    cJSON_AddNumberToObject(json, "silent_s", (double)pace->silent_us * 1e-6);
    cJSON_AddNumberToObject(json, "longest_silence_s", (double)pace->longest_us * 1e-6);
    cJSON_AddNumberToObject(json, "connections", (double)input->counts.connections);
    cJSON_AddNumberToObject(json, "clock_restarts", (double)input->counts.clock_restarts);
    cJSON_AddNumberToObject(json, "unreadable", (double)input->counts.unreadable);
    cJSON_AddNumberToObject(json, "without_orientation", (double)input->counts.blind);
    cJSON_AddNumberToObject(json, "of_others", (double)input->counts.others);
    cJSON_AddNumberToObject(json, "too_many", (double)input->counts.too_many);
    return json;
}

static cJSON *graphics_json(const graphics *g)
{
    cJSON *const json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "to", g->name);
    cJSON_AddNumberToObject(json, "angles", (double)g->angles_n);
    cJSON_AddNumberToObject(json, "nodes", (double)g->nodes_n);
    cJSON_AddNumberToObject(json, "unsent", (double)g->unsent_n);
    return json;
}

void stream_print_json(const stream *st, int exit_code)
{
    cJSON *const json = cJSON_CreateObject();
    progress_clear();
    cJSON_AddStringToObject(json, "track", st->source->name);
    cJSON_AddStringToObject(json, "port", st->options.port);
    cJSON_AddStringToObject(json, "device", st->device);
    cJSON_AddNumberToObject(json, "links", st->links_n);
    cJSON_AddBoolToObject(json, "armed", st->options.arm);
    cJSON_AddBoolToObject(json, "interrupted", st->interrupted);
    cJSON_AddNumberToObject(json, "poses_of_track", (double)st->played_n);
    cJSON_AddNumberToObject(json, "poses_while_arming", (double)st->lead_n);
    cJSON_AddNumberToObject(json, "skipped", (double)st->skipped_n);
    cJSON_AddNumberToObject(json, "unreadable_lines", (double)st->source->input.counts.unreadable);
    cJSON_AddNumberToObject(json, "duration_s", (double)(st->end_us - st->play_us) * 1e-6);
    cJSON_AddNumberToObject(json, "reconnects", st->reconnects_n);
    cJSON_AddNumberToObject(json, "armings", st->armings_n);
    cJSON_AddStringToObject(json, "state_at_end",
                            message_value_name(&message_values_device_states, st->end_state));
    cJSON_AddNumberToObject(json, "angles", (double)st->angles_n);
    if (st->options.poses != NULL) {
        cJSON_AddNumberToObject(json, "ticks_in_track", (double)st->options.poses->rows_n);
        cJSON_AddNumberToObject(json, "ticks_missing", (double)st->options.poses->missing_n);
    }
    if (st->source->options.live != NULL) {
        cJSON_AddItemToObject(json, "source", live_json(st));
    }
    if (st->graphics != NULL) {
        cJSON_AddItemToObject(json, "graphics", graphics_json(st->graphics));
    }
    cJSON_AddItemToObject(json, "poses", account_json(&st->account));
    cJSON_AddItemToObject(json, "latency", pose_delays_json(st->delays));
    cJSON_AddNumberToObject(json, "exit_code", exit_code);
    texts_print_json(json);
}
