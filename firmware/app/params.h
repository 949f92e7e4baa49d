/* params.h - everything the device can be told: one table, staged changes, all or nothing.
 *
 * The rod's own fields (core/rod_params.h, each under its name) are followed by the device's. SETs go to
 * a staged copy; params_commit checks the whole of it and only then makes it the one in force, so nothing
 * half-set ever runs. A refusal names the field, the entry, the value and the bounds; what was staged
 * stays as it was before the refused SET.
 *
 * Caller-owned memory, no heap. Not for interrupts. Source: protocol.md, "Rules"; safety.md, last line.
 */
#ifndef LIMBER_PARAMS_H
#define LIMBER_PARAMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device_params.h"
#include "message_values.h"
#include "rod.h"

typedef struct {
    rod_params rod;
    device_params device;
} params_set;

/* A parameter as the wire describes it. */
typedef struct {
    const char *name, *unit, *what;
    const char *const *choices; /* of a CHOICE */
    uint8_t kind;               /* PARAM_CHOICE, PARAM_WHOLE, PARAM_NUMBER */
    uint8_t flags;              /* PARAM_LIST, PARAM_DISARMED_ONLY, PARAM_READ_ONLY, PARAM_KEPT */
    uint16_t entries_n;         /* 1, the links, or the servos, as set now */
    float min, max, initial;
} params_info;

/* Why something was refused. */
typedef struct {
    uint8_t reason; /* REASON_... */
    int entry;      /* joint or servo, from 0; -1: none in particular */
    float value, min, max;
    const char *field; /* "" where there is none */
    const char *text;
} params_refusal;

typedef struct {
    params_set in_force, staged;
    uint32_t generation; /* counts commits */
    bool is_staged;      /* something has been set since the last commit */
    bool device_staged;  /* some of it the device's own, not the rod's */
} params;

/* Defaults, in force and staged. */
void params_init(params *p);

/* How many there are, and one of them by index or by name; false where there is none. entries_n is that of a rod
 * of links_n links. */
int params_count(void);
bool params_describe(int links_n, int index, params_info *info);
int params_find(const char *name); /* -1 where there is none */

/* One value of a set; entry < entries_n. */
float params_get(const params_set *set, int index, int entry);

/* Write one value of a set unjudged; an entry there is no memory for is left out. */
void params_put(params_set *set, int index, int entry, float value);

/* Stage values_n values from entry `first` on. One value for a list at first = 0 sets all of it. */
bool params_stage(params *p, const char *name, int first, const float *values, int values_n,
                  params_refusal *why);

/* Stage all defaults, or a preset (the rod only). */
void params_stage_defaults(params *p);
bool params_stage_preset(params *p, const char *name, params_refusal *why);

/* Forget what is staged. */
void params_unstage(params *p);

/* May what is staged differ from what is in force as it does? all_allowed: fields that may change only while
 * disarmed may. The rod is not tried: who gives it the set (rod_set_params) hears that from it. */
bool params_check_changes(const params *p, bool all_allowed, params_refusal *why);

/* The rod's refusal as one of a parameter; returns false. */
bool params_refuse_rod(rod_error error, const rod_refusal *refusal, params_refusal *why);

/* The staged set, checked before, is in force from here on. */
void params_take(params *p);

/* Check the changes and the rod's bounds, and take the set if both are right; what else a rod may refuse, whoever
 * makes one of the set hears from it. */
bool params_commit(params *p, bool all_allowed, params_refusal *why);

#endif
