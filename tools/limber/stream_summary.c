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

void stream_show_progress(stream *st)
{
    const uint64_t now_us = limber_now_us();
    if (!progress_wanted() || now_us - st->progress_us < PROGRESS_US) {
        return;
    }
    st->progress_us = now_us;
    char of[32] = "";
    if (!st->source->options.live) {
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

static void print_oddities(const stream *st)
{
    const live_lines *const lines = &st->source->lines;
    if (st->skipped_n > 0) {
        printf("skipped    %llu whose moment passed while the device was away\n",
               (unsigned long long)st->skipped_n);
    }
    if (!st->source->options.live) {
        return;
    }
    if (lines->unreadable > 0 || st->source->counts.zero_quaternions > 0) {
        printf("left out   %ld lines that are no pose, %ld without an orientation\n",
               lines->unreadable, st->source->counts.zero_quaternions);
    }
    const double took_s = (double)(st->end_us - st->play_us) * 1e-6;
    if (st->played_n > 20 && st->played_s > 3.0 * took_s + 0.5) {
        printf("pace       %.1f s of poses came in %.1f s; --speed 1 keeps to their times\n",
               st->played_s, took_s);
    }
}

void stream_print_summary(const stream *st)
{
    const double took_s = (double)(st->end_us - st->play_us) * 1e-6;
    progress_clear();
    printf("stream     %s: %llu poses in %.2f s, to %s on %s%s\n", st->source->name,
           (unsigned long long)st->played_n, took_s, st->device, st->options.port,
           st->interrupted ? " (interrupted)" : "");
    print_oddities(st);
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
    if (st->csv->rows_n > 0) {
        printf("angles in  %llu rows of CSV\n", (unsigned long long)st->csv->rows_n);
    }
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
    cJSON_AddNumberToObject(json, "unreadable_lines", (double)st->source->lines.unreadable);
    cJSON_AddNumberToObject(json, "duration_s", (double)(st->end_us - st->play_us) * 1e-6);
    cJSON_AddNumberToObject(json, "reconnects", st->reconnects_n);
    cJSON_AddNumberToObject(json, "angles", (double)st->angles_n);
    cJSON_AddItemToObject(json, "poses", account_json(&st->account));
    cJSON_AddItemToObject(json, "latency", pose_delays_json(st->delays));
    cJSON_AddNumberToObject(json, "exit_code", exit_code);
    texts_print_json(json);
}
