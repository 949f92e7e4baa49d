/* injection.h - faults by script: what goes wrong, when, and how badly; seeded, so that a run repeats. */
#ifndef LIMBER_INJECTION_H
#define LIMBER_INJECTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    INJECT_NOISE, /* amount: share of received bytes with a flipped bit */
    INJECT_DROP,  /* amount: share of received bytes that are lost */
    INJECT_STALL, /* the line stands still */
    INJECT_ESTOP, /* the e-stop input opens */
    INJECT_CUT,   /* the power goes at the amount-th flash word written from then on */
    INJECT_CLOCK, /* the device's clock jumps ahead by amount seconds */
    /* servos, bus_model.h */
    INJECT_SERVO,  /* the servo with id amount reports overload; 0: the first one */
    INJECT_UNPLUG, /* it has neither supply nor bus */
    INJECT_LOSE,   /* amount: share of servos' answers that are lost */
    INJECT_GARBLE, /* amount: share of servos' answers with a flipped bit */
    INJECT_SLOW,   /* servos' answers come amount seconds late */
    INJECT_KINDS_N
} inject_kind;

typedef struct {
    inject_kind kind;
    double start_s, duration_s, amount;
    bool done; /* CUT and CLOCK happen once */
} injected_fault;

enum { INJECTIONS_MAX = 32 };

typedef struct {
    injected_fault faults[INJECTIONS_MAX];
    int faults_n;
    uint64_t random;
} injection;

/* "KIND@START[+DURATION][:AMOUNT]", as "noise@2+1:0.001", "stall@4+0.2", "cut@6:3", "clock@7:0.5". Returns SIM_OK,
 * or complains. */
int injection_add(injection *all, const char *text);

/* Whether this one is under way. */
bool injection_is_on(const injected_fault *fault, double now_s);

/* The fault of that kind that is under way at this moment, or NULL. */
injected_fault *injection_now(injection *all, inject_kind kind, double now_s);

/* 0 ... 1; *state is the seed and 0 as good as any. */
double injection_random(uint64_t *state);

/* Bytes as they come through a line with these faults; returns how many are left. */
size_t injection_spoil(injection *all, double now_s, uint8_t *bytes, size_t bytes_n);

#endif
