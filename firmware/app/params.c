/* params.c - see params.h. */
#include "params.h"

#include <string.h>

static uint8_t rod_flags(const rod_field *field)
{
    if (field->offset == offsetof(rod_params, tick_s)) {
        return PARAM_READ_ONLY; /* the board's own */
    }
    const bool shapes_all = field->offset <= offsetof(rod_params, links_n);
    return (uint8_t)(PARAM_KEPT | (shapes_all ? PARAM_DISARMED_ONLY : 0) |
                     (field->kind == ROD_FIELD_PER_JOINT ? PARAM_LIST : 0));
}

static uint8_t rod_kind(const rod_field *field)
{
    return field->kind == ROD_FIELD_CHOICE     ? PARAM_CHOICE
           : field->kind == ROD_FIELD_COUNT_OF ? PARAM_WHOLE
                                               : PARAM_NUMBER;
}

int params_count(void)
{
    return ROD_FIELDS_N + DEVICE_FIELDS_N;
}

bool params_describe(int links_n, int index, params_info *info)
{
    if (index < 0 || index >= params_count()) {
        return false;
    }
    if (index < ROD_FIELDS_N) {
        const rod_field *f = &rod_fields[index];
        *info = (params_info){f->name,
                              f->unit,
                              f->what,
                              f->choices,
                              rod_kind(f),
                              rod_flags(f),
                              (uint16_t)(f->kind == ROD_FIELD_PER_JOINT ? links_n : 1),
                              f->min,
                              f->max,
                              f->initial};
    } else {
        const device_field *f = &device_fields[index - ROD_FIELDS_N];
        *info = (params_info){f->name,
                              f->unit,
                              f->what,
                              f->choices,
                              f->kind,
                              f->flags,
                              (uint16_t)(f->entries == ENTRIES_SERVOS ? 2 * links_n : 1),
                              f->min,
                              f->max,
                              f->initial};
    }
    return true;
}

int params_find(const char *name)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        if (strcmp(rod_fields[i].name, name) == 0) {
            return i;
        }
    }
    for (int i = 0; i < DEVICE_FIELDS_N; i++) {
        if (strcmp(device_fields[i].name, name) == 0) {
            return ROD_FIELDS_N + i;
        }
    }
    return -1;
}

static float *place(params_set *set, int index, int entry)
{
    const device_field *f = &device_fields[index - ROD_FIELDS_N];
    return (float *)(void *)((char *)&set->device + f->offset) + entry;
}

float params_get(const params_set *set, int index, int entry)
{
    if (index < ROD_FIELDS_N) {
        return rod_field_get(&rod_fields[index], &set->rod, entry);
    }
    const device_field *f = &device_fields[index - ROD_FIELDS_N];
    return ((const float *)(const void *)((const char *)&set->device + f->offset))[entry];
}

/* Entries there is memory for, whatever the links are now. */
static int entries_max(int index)
{
    const bool list = index < ROD_FIELDS_N
                          ? rod_fields[index].kind == ROD_FIELD_PER_JOINT
                          : device_fields[index - ROD_FIELDS_N].entries == ENTRIES_SERVOS;
    return !list ? 1 : index < ROD_FIELDS_N ? ROD_MAX_LINKS : PARAMS_SERVOS_MAX;
}

void params_put(params_set *set, int index, int entry, float value)
{
    if (entry < 0 || entry >= entries_max(index)) {
        return;
    }
    if (index < ROD_FIELDS_N) {
        rod_field_set(&rod_fields[index], &set->rod, entry, value);
    } else {
        *place(set, index, entry) = value;
    }
}

/* Defaults of one set; the servos are numbered from 1, as they hang on the bus. */
static void set_defaults(params_set *set, float tick_s)
{
    rod_params_defaults(&set->rod);
    set->rod.tick_s = tick_s;
    for (int i = ROD_FIELDS_N; i < params_count(); i++) {
        for (int entry = 0; entry < entries_max(i); entry++) {
            params_put(set, i, entry, device_fields[i - ROD_FIELDS_N].initial);
        }
    }
    for (int servo = 0; servo < PARAMS_SERVOS_MAX; servo++) {
        set->device.servo_id[servo] = (float)(servo + 1);
    }
}

void params_init(params *p)
{
    set_defaults(&p->in_force, 1e-3f);
    p->staged = p->in_force;
    p->generation = 0;
    p->is_staged = p->device_staged = false;
}

static bool refuse(params_refusal *why, params_refusal what)
{
    *why = what;
    return false;
}

/* What is wrong with this value for that field, or 0. */
static uint8_t wrong_with(const params_info *info, float value)
{
    if (!(value >= -3.0e38f && value <= 3.0e38f)) {
        return REASON_NOT_FINITE;
    }
    if (value < info->min || value > info->max) {
        return REASON_BOUNDS;
    }
    const bool whole = info->kind != PARAM_NUMBER;
    const float rounded = (float)(int32_t)value; /* in bounds, so the cast is safe */
    if (whole && (value < rounded || value > rounded)) {
        return REASON_NOT_WHOLE;
    }
    return 0;
}

static const char *text_of(uint8_t reason)
{
    return message_value_meaning(&message_values_reasons, reason);
}

bool params_stage(params *p, const char *name, int first, const float *values, int values_n,
                  params_refusal *why)
{
    params_info info;
    const int index = params_find(name);
    *why = (params_refusal){.entry = -1, .field = name};
    if (!params_describe(p->staged.rod.links_n, index, &info)) {
        return refuse(why, (params_refusal){REASON_NAME, -1, 0, 0, 0, name, text_of(REASON_NAME)});
    }
    if (info.flags & PARAM_READ_ONLY) {
        return refuse(why, (params_refusal){REASON_READ_ONLY, -1, 0, 0, 0, info.name,
                                            text_of(REASON_READ_ONLY)});
    }
    if (values_n < 1 || first < 0 || first + values_n > entries_max(index)) {
        return refuse(why,
                      (params_refusal){REASON_ENTRIES, -1, (float)(first + values_n), 1.0f,
                                       (float)info.entries_n, info.name, text_of(REASON_ENTRIES)});
    }
    for (int i = 0; i < values_n; i++) {
        const uint8_t reason = wrong_with(&info, values[i]);
        if (reason != 0) {
            return refuse(why, (params_refusal){reason, first + i, values[i], info.min, info.max,
                                                info.name, text_of(reason)});
        }
    }
    const bool all = values_n == 1 && first == 0;
    const int written_n = all ? entries_max(index) : values_n;
    for (int i = 0; i < written_n; i++) {
        params_put(&p->staged, index, first + i, values[all ? 0 : i]);
    }
    p->is_staged = true;
    p->device_staged = p->device_staged || index >= ROD_FIELDS_N;
    return true;
}

void params_stage_defaults(params *p)
{
    set_defaults(&p->staged, p->in_force.rod.tick_s);
    p->is_staged = p->device_staged = true;
}

bool params_stage_preset(params *p, const char *name, params_refusal *why)
{
    const rod_preset *preset = rod_preset_find(name);
    if (preset == NULL) {
        return refuse(why, (params_refusal){REASON_NAME, -1, 0, 0, 0, name, text_of(REASON_NAME)});
    }
    const float tick_s = p->in_force.rod.tick_s;
    /* the model and as many links as the rod in the hand has */
    rod_preset_fill(preset, p->in_force.rod.model, p->in_force.rod.links_n, &p->staged.rod);
    p->staged.rod.tick_s = tick_s;
    p->is_staged = true;
    return true;
}

void params_unstage(params *p)
{
    p->staged = p->in_force;
    p->is_staged = p->device_staged = false;
}

/* The first entry in which two sets differ, or -1. */
static int difference(const params *p, int index, int entries_n)
{
    for (int entry = 0; entry < entries_n; entry++) {
        const float now = params_get(&p->in_force, index, entry);
        const float then = params_get(&p->staged, index, entry);
        if (now < then || now > then) {
            return entry;
        }
    }
    return -1;
}

bool params_refuse_rod(rod_error error, const rod_refusal *refusal, params_refusal *why)
{
    /* a field out of its own bounds, or fields that do not go together */
    const bool single = refusal->field != NULL && error != ROD_E_OVERDAMPED;
    return refuse(why, (params_refusal){single ? REASON_BOUNDS : REASON_COMBINATION, refusal->joint,
                                        refusal->value, refusal->min, refusal->max,
                                        refusal->field != NULL ? refusal->field->name : "",
                                        rod_error_text(error)});
}

static bool check_rod(const params_set *set, params_refusal *why)
{
    rod_refusal refusal;
    const rod_error error = rod_params_check(&set->rod, &refusal);
    return error == ROD_OK || params_refuse_rod(error, &refusal, why);
}

bool params_check_changes(const params *p, bool all_allowed, params_refusal *why)
{
    const int changed_n = p->device_staged ? params_count() : ROD_FIELDS_N;
    for (int i = 0; i < changed_n && !all_allowed; i++) {
        params_info info;
        (void)params_describe(p->staged.rod.links_n, i, &info);
        const int entry = info.flags & PARAM_DISARMED_ONLY ? difference(p, i, info.entries_n) : -1;
        if (entry >= 0) {
            return refuse(why,
                          (params_refusal){REASON_DISARMED_ONLY, info.entries_n > 1 ? entry : -1,
                                           params_get(&p->staged, i, entry), info.min, info.max,
                                           info.name, text_of(REASON_DISARMED_ONLY)});
        }
    }
    for (int servo = 0; servo < 2 * p->staged.rod.links_n; servo++) {
        const float sign = p->staged.device.servo_sign[servo];
        if (sign > -1.0f && sign < 1.0f) {
            return refuse(why, (params_refusal){REASON_BOUNDS, servo, sign, -1.0f, 1.0f,
                                                "servo_sign", "must be 1 or -1"});
        }
    }
    return true;
}

void params_take(params *p)
{
    p->in_force = p->staged;
    p->is_staged = p->device_staged = false;
    p->generation++;
}

bool params_commit(params *p, bool all_allowed, params_refusal *why)
{
    if (!params_check_changes(p, all_allowed, why) || !check_rod(&p->staged, why)) {
        return false;
    }
    params_take(p);
    return true;
}
