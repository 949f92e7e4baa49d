/* account.c - see account.h. */
#include "account.h"

#include <stddef.h>
#include <string.h>

static const char PREFIX[] = "poses_";

/* What the device counts poses under, by place: the message's own table, so that a cause which a later
 * version adds is counted without anybody telling this file. */
static const message_field *field_of(int i)
{
    const message_info *const info = messages_info(MESSAGE_STATS);
    return i < info->fields_n ? &info->fields[i] : NULL;
}

static bool is_cause(const message_field *field)
{
    const char *const name = field->name;
    return strncmp(name, PREFIX, sizeof PREFIX - 1) == 0 && strcmp(name, "poses_accepted") != 0 &&
           strcmp(name, "poses_lost") != 0 && strcmp(name, "poses_duplicate") != 0;
}

/* Both are the members of a message. */
static uint32_t counter(const message_stats *stats, const message_field *field)
{
    uint32_t value;
    memcpy(&value, (const char *)stats + field->offset - offsetof(message, stats), sizeof value);
    return value;
}

int64_t account_session(account *a, uint64_t sent_n, const message_stats *before,
                        const message_stats *after, uint64_t unseen_n, bool final)
{
    const uint32_t accepted = after->poses_accepted - before->poses_accepted;
    /* the device takes a late pose off its lost ones: as a signed difference that may be negative */
    const int32_t gaps = (int32_t)(after->poses_lost - before->poses_lost);
    uint64_t rejected[ACCOUNT_FIELDS_MAX] = {0}, rejected_n = 0;
    for (int i = 0; i < ACCOUNT_FIELDS_MAX && field_of(i) != NULL; i++) {
        if (is_cause(field_of(i))) {
            rejected[i] = counter(after, field_of(i)) - counter(before, field_of(i));
            rejected_n += rejected[i];
        }
    }
    int64_t left = (int64_t)sent_n - (int64_t)accepted - (int64_t)rejected_n - gaps;
    const int64_t unseen = left > 0 && (uint64_t)left <= unseen_n ? left : 0;
    left -= unseen;
    if (final) {
        a->sent += sent_n;
        a->accepted += accepted;
        a->lost += (uint64_t)(gaps + unseen);
        a->doubled += after->poses_duplicate - before->poses_duplicate;
        a->unaccounted += left;
        for (int i = 0; i < ACCOUNT_FIELDS_MAX; i++) {
            a->rejected[i] += rejected[i];
        }
    }
    return left;
}

void account_unknown(account *a, uint64_t sent_n)
{
    a->sent += sent_n;
    a->unaccounted += (int64_t)sent_n;
    a->unknown = a->unknown || sent_n > 0;
}

bool account_balances(const account *a)
{
    return a->unaccounted == 0 && !a->unknown;
}

uint64_t account_rejected(const account *a)
{
    uint64_t n = 0;
    for (int i = 0; i < ACCOUNT_FIELDS_MAX; i++) {
        n += a->rejected[i];
    }
    return n;
}

void account_print(const account *a, FILE *out)
{
    const char *separator = ": ";
    fprintf(out, "accepted   %llu\nrejected   %llu", (unsigned long long)a->accepted,
            (unsigned long long)account_rejected(a));
    for (int i = 0; i < ACCOUNT_FIELDS_MAX; i++) {
        if (a->rejected[i] > 0) {
            fprintf(out, "%s%llu ", separator, (unsigned long long)a->rejected[i]);
            for (const char *c = field_of(i)->name + sizeof PREFIX - 1; *c != '\0'; c++) {
                fputc(*c == '_' ? ' ' : *c, out);
            }
            separator = ", ";
        }
    }
    fprintf(out, "\nlost       %llu on the line\n", (unsigned long long)a->lost);
    if (a->doubled > 0) {
        fprintf(out, "doubled    %llu came twice, used once\n", (unsigned long long)a->doubled);
    }
    if (account_balances(a)) {
        fprintf(out, "balance    every pose is accounted for\n");
    } else {
        fprintf(out, "balance    %lld poses are unaccounted for%s\n", (long long)a->unaccounted,
                a->unknown ? ": the device was lost, or restarted, and its counters with it" : "");
    }
}

cJSON *account_json(const account *a)
{
    cJSON *const json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "sent", (double)a->sent);
    cJSON_AddNumberToObject(json, "accepted", (double)a->accepted);
    cJSON *const rejected = cJSON_AddObjectToObject(json, "rejected");
    for (int i = 0; i < ACCOUNT_FIELDS_MAX && field_of(i) != NULL; i++) {
        if (is_cause(field_of(i))) {
            cJSON_AddNumberToObject(rejected, field_of(i)->name + sizeof PREFIX - 1,
                                    (double)a->rejected[i]);
        }
    }
    cJSON_AddNumberToObject(json, "lost", (double)a->lost);
    cJSON_AddNumberToObject(json, "duplicates", (double)a->doubled);
    cJSON_AddNumberToObject(json, "unaccounted", (double)a->unaccounted);
    cJSON_AddBoolToObject(json, "balances", account_balances(a));
    return json;
}
