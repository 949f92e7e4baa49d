/* injection.c - see injection.h. */
#include "injection.h"

#include <stdio.h>
#include <string.h>

#include "sim.h"

static const char *const KIND_NAMES[INJECT_KINDS_N] = {
    [INJECT_NOISE] = "noise",   [INJECT_DROP] = "drop",     [INJECT_STALL] = "stall",
    [INJECT_ESTOP] = "estop",   [INJECT_CUT] = "cut",       [INJECT_CLOCK] = "clock",
    [INJECT_SERVO] = "servo",   [INJECT_UNPLUG] = "unplug", [INJECT_LOSE] = "lose",
    [INJECT_GARBLE] = "garble", [INJECT_SLOW] = "slow"};

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
            "--inject %.60s: kinds are noise, drop, stall, estop, cut, clock, servo, unplug, lose, "
            "garble and slow; at most %d faults",
            text, INJECTIONS_MAX);
    }
    fault.kind = (inject_kind)kind;
    all->faults[all->faults_n++] = fault;
    return SIM_OK;
}

bool injection_is_on(const injected_fault *fault, double now_s)
{
    return now_s >= fault->start_s && now_s < fault->start_s + fault->duration_s;
}

injected_fault *injection_now(injection *all, inject_kind kind, double now_s)
{
    for (int i = 0; i < all->faults_n; i++) {
        injected_fault *fault = &all->faults[i];
        if (fault->kind == kind && injection_is_on(fault, now_s)) {
            return fault;
        }
    }
    return NULL;
}

/* xorshift64*, Marsaglia 2003 and Vigna 2016. */
double injection_random(uint64_t *state)
{
    uint64_t x = *state == 0 ? 0x9E3779B97F4A7C15u : *state;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    *state = x;
    return (double)(x * 0x2545F4914F6CDD1Du >> 11) * 0x1p-53;
}

size_t injection_spoil(injection *all, double now_s, uint8_t *bytes, size_t bytes_n)
{
    const injected_fault *noise = injection_now(all, INJECT_NOISE, now_s);
    const injected_fault *drop = injection_now(all, INJECT_DROP, now_s);
    size_t kept = 0;
    for (size_t i = 0; i < bytes_n; i++) {
        if (drop != NULL && injection_random(&all->random) < drop->amount) {
            continue;
        }
        uint8_t byte = bytes[i];
        if (noise != NULL && injection_random(&all->random) < noise->amount) {
            byte ^= (uint8_t)(1u << (int)(8.0 * injection_random(&all->random)));
        }
        bytes[kept++] = byte;
    }
    return kept;
}
