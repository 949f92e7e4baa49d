/* injection.c - see injection.h. */
#include "injection.h"

#include <stdio.h>
#include <string.h>

#include "sim.h"

static const char *const KIND_NAMES[INJECT_KINDS_N] = {"noise", "drop", "stall", "servo",
                                                       "estop", "cut",  "clock"};

int injection_add(injection *all, const char *text)
{
    injected_fault fault = {.duration_s = 1.0};
    char name[16];
    int at = 0, used = 0;
    if (sscanf(text, "%15[a-z]@%lf%n", name, &fault.start_s, &at) < 2) {
        return sim_complain(
            "--inject %.60s: must be KIND@START[+DURATION][:AMOUNT], as noise@2+1:0.001", text);
    }
    if (text[at] == '+' && sscanf(text + at, "+%lf%n", &fault.duration_s, &used) == 1) {
        at += used;
    }
    if (text[at] == ':' && sscanf(text + at, ":%lf%n", &fault.amount, &used) == 1) {
        at += used;
    }
    int kind = 0;
    while (kind < INJECT_KINDS_N && strcmp(name, KIND_NAMES[kind]) != 0) {
        kind++;
    }
    if (text[at] != '\0' || kind == INJECT_KINDS_N || all->faults_n == INJECTIONS_MAX) {
        return sim_complain(
            "--inject %.60s: kinds are noise, drop, stall, servo, estop, cut and clock; at "
            "most %d faults",
            text, INJECTIONS_MAX);
    }
    fault.kind = (inject_kind)kind;
    all->faults[all->faults_n++] = fault;
    return SIM_OK;
}

injected_fault *injection_now(injection *all, inject_kind kind, double now_s)
{
    for (int i = 0; i < all->faults_n; i++) {
        injected_fault *fault = &all->faults[i];
        if (fault->kind == kind && now_s >= fault->start_s &&
            now_s < fault->start_s + fault->duration_s) {
            return fault;
        }
    }
    return NULL;
}

/* 0 ... 1: xorshift64*, Marsaglia 2003 and Vigna 2016. */
static double next_random(injection *all)
{
    all->random = all->random == 0 ? 0x9E3779B97F4A7C15u : all->random;
    all->random ^= all->random >> 12;
    all->random ^= all->random << 25;
    all->random ^= all->random >> 27;
    return (double)(all->random * 0x2545F4914F6CDD1Du >> 11) * 0x1p-53;
}

size_t injection_spoil(injection *all, double now_s, uint8_t *bytes, size_t bytes_n)
{
    const injected_fault *noise = injection_now(all, INJECT_NOISE, now_s);
    const injected_fault *drop = injection_now(all, INJECT_DROP, now_s);
    size_t kept = 0;
    for (size_t i = 0; i < bytes_n; i++) {
        if (drop != NULL && next_random(all) < drop->amount) {
            continue;
        }
        uint8_t byte = bytes[i];
        if (noise != NULL && next_random(all) < noise->amount) {
            byte ^= (uint8_t)(1u << (int)(8.0 * next_random(all)));
        }
        bytes[kept++] = byte;
    }
    return kept;
}
