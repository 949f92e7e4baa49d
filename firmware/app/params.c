/* params.c - see params.h. */
#include "params.h"

#include <string.h>

typedef enum { ENTRIES_ONE, ENTRIES_SERVOS } entries_of;

typedef struct {
    const char *name, *unit, *what;
    uint8_t kind, flags;
    entries_of entries;
    float min, max, initial;
    size_t offset; /* into device_params */
} device_field;

static const char *const POSE_MODES[] = {"predict", "interpolate"};

// clang-format off
#define ONE(member, name, unit, what, kind, flags, min, max, initial)                              \
    {name, unit, what, kind, PARAM_KEPT | (flags), ENTRIES_ONE, min, max, initial,                 \
     offsetof(device_params, member)}
#define SERVO(member, name, unit, what, kind, min, max, initial)                                   \
    {name, unit, what, kind, PARAM_KEPT | PARAM_LIST | PARAM_DISARMED_ONLY, ENTRIES_SERVOS, min, max, initial, \
     offsetof(device_params, member)}
// clang-format on

static const device_field DEVICE_FIELDS[] = {
    ONE(pose_mode, "pose_mode", "", "between poses: predict adds no delay, interpolate is smoother",
        PARAM_CHOICE, 0, 0.0f, 1.0f, 0.0f),
    ONE(pose_hold_ms, "pose_hold", "ms", "without a pose for so long the rod is held", PARAM_NUMBER,
        0, 20.0f, 200.0f, 50.0f),
    ONE(pose_speed_mps, "pose_speed", "m/s", "faster is no hand: such poses are rejected",
        PARAM_NUMBER, 0, 0.5f, 200.0f, 25.0f),
    ONE(pose_turn_radps, "pose_turn", "rad/s", "likewise for turning", PARAM_NUMBER, 0, 1.0f,
        1000.0f, 150.0f),
    ONE(angles_hz, "angles_rate", "Hz", "how often ANGLES are sent", PARAM_NUMBER, 0, 1.0f, 2000.0f,
        100.0f),
    ONE(nodes_hz, "nodes_rate", "Hz", "how often NODES are sent, 0: never", PARAM_NUMBER, 0, 0.0f,
        500.0f, 0.0f),
    ONE(pose_log, "pose_log", "", "1: the exact pose of every tick is sent", PARAM_WHOLE, 0, 0.0f,
        1.0f, 0.0f),
    ONE(blend_s, "blend", "s", "other parameters take over within this time", PARAM_NUMBER, 0,
        0.05f, 5.0f, 0.3f),
    ONE(servo_hz, "servo_rate", "Hz", "how often servos get new goals", PARAM_NUMBER,
        PARAM_DISARMED_ONLY, 10.0f, 2000.0f, 500.0f),
    ONE(servo_rate_radps, "servo_speed", "rad/s", "most speed of a servo", PARAM_NUMBER,
        PARAM_DISARMED_ONLY, 0.1f, 100.0f, 12.0f),
    ONE(servo_acceleration_radps2, "servo_acceleration", "rad/s^2", "most acceleration of a servo",
        PARAM_NUMBER, PARAM_DISARMED_ONLY, 1.0f, 10000.0f, 600.0f),
    SERVO(servo_id, "servo_id", "", "on the bus, or the PWM channel", PARAM_WHOLE, 0.0f, 252.0f,
          0.0f),
    SERVO(servo_sign, "servo_sign", "", "1, or -1 for one mounted the other way round", PARAM_WHOLE,
          -1.0f, 1.0f, 1.0f),
    SERVO(servo_offset_rad, "servo_offset", "rad", "where the joint is straight", PARAM_NUMBER,
          -3.2f, 3.2f, 0.0f),
    SERVO(servo_min_rad, "servo_min", "rad", "range of the servo, from straight", PARAM_NUMBER,
          -3.2f, 0.0f, -1.6f),
    SERVO(servo_max_rad, "servo_max", "rad", "range of the servo, from straight", PARAM_NUMBER,
          0.0f, 3.2f, 1.6f),
};
enum { DEVICE_FIELDS_N = sizeof DEVICE_FIELDS / sizeof DEVICE_FIELDS[0] };

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

bool params_describe(const params_set *set, int index, params_info *info)
{
    if (index < 0 || index >= params_count()) {
        return false;
    }
    const int links_n = set->rod.links_n;
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
        const device_field *f = &DEVICE_FIELDS[index - ROD_FIELDS_N];
        *info = (params_info){f->name,
                              f->unit,
                              f->what,
                              f->kind == PARAM_CHOICE ? POSE_MODES : NULL,
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
        if (strcmp(DEVICE_FIELDS[i].name, name) == 0) {
            return ROD_FIELDS_N + i;
        }
    }
    return -1;
}

static float *place(params_set *set, int index, int entry)
{
    const device_field *f = &DEVICE_FIELDS[index - ROD_FIELDS_N];
    return (float *)(void *)((char *)&set->device + f->offset) + entry;
}

float params_get(const params_set *set, int index, int entry)
{
    if (index < ROD_FIELDS_N) {
        return rod_field_get(&rod_fields[index], &set->rod, entry);
    }
    const device_field *f = &DEVICE_FIELDS[index - ROD_FIELDS_N];
    return ((const float *)(const void *)((const char *)&set->device + f->offset))[entry];
}

/* Entries there is memory for, whatever the links are now. */
static int entries_max(int index)
{
    const bool list = index < ROD_FIELDS_N
                          ? rod_fields[index].kind == ROD_FIELD_PER_JOINT
                          : DEVICE_FIELDS[index - ROD_FIELDS_N].entries == ENTRIES_SERVOS;
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
            params_put(set, i, entry, DEVICE_FIELDS[i - ROD_FIELDS_N].initial);
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
    p->is_staged = false;
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
    if (!params_describe(&p->staged, index, &info)) {
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
    return true;
}

void params_stage_defaults(params *p)
{
    set_defaults(&p->staged, p->in_force.rod.tick_s);
    p->is_staged = true;
}

bool params_stage_preset(params *p, const char *name, params_refusal *why)
{
    const rod_preset *preset = rod_preset_find(name);
    if (preset == NULL) {
        return refuse(why, (params_refusal){REASON_NAME, -1, 0, 0, 0, name, text_of(REASON_NAME)});
    }
    const float tick_s = p->in_force.rod.tick_s;
    /* as many links as the rod in the hand has */
    rod_preset_fill(preset, p->in_force.rod.links_n, &p->staged.rod);
    p->staged.rod.tick_s = tick_s;
    p->is_staged = true;
    return true;
}

void params_unstage(params *p)
{
    p->staged = p->in_force;
    p->is_staged = false;
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

static bool check_rod(const params_set *set, params_refusal *why)
{
    rod_refusal refusal;
    rod_error error = rod_params_check(&set->rod, &refusal);
    int row_n;
    static contour
        trial; /* 4 KB that no stack of a board needs to hold; the main loop is alone here */
    if (error == ROD_OK) {
        error = contour_prepare(&trial, &set->rod, &row_n);
        refusal = (rod_refusal){error, NULL, row_n - 1, 0.0f, 0.0f, 0.0f};
    }
    if (error == ROD_OK) {
        return true;
    }
    const bool single = error > ROD_E_OVERDAMPED;
    return refuse(why, (params_refusal){single ? REASON_BOUNDS : REASON_COMBINATION, refusal.joint,
                                        refusal.value, refusal.min, refusal.max,
                                        refusal.field != NULL ? refusal.field->name : "",
                                        rod_error_text(error)});
}

bool params_check(const params *p, bool all_allowed, params_refusal *why)
{
    for (int i = 0; i < params_count() && !all_allowed; i++) {
        params_info info;
        (void)params_describe(&p->staged, i, &info);
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
    return check_rod(&p->staged, why);
}

bool params_commit(params *p, bool all_allowed, params_refusal *why)
{
    if (!params_check(p, all_allowed, why)) {
        return false;
    }
    p->in_force = p->staged;
    p->is_staged = false;
    p->generation++;
    return true;
}
