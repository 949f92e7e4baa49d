/* param_commands.c - parameters, presets and settings over the wire (PROTOCOL.md, types 0x30 to 0x3F). */
#include <string.h>

#include "answers.h"
#include "saved_params.h"
#include "tick_budget.h"

static void take_list(device *d, const message_param_list *list)
{
    params_info info;
    if (!params_describe(d->params.in_force.rod.links_n, list->index, &info)) {
        answers_refuse_for(d, list->request_id, MESSAGE_PARAM_LIST, REASON_INDEX, NULL);
        return;
    }
    message m = {.type = MESSAGE_PARAM_INFO,
                 .param_info = {.request_id = list->request_id,
                                .index = list->index,
                                .params_n = (uint16_t)params_count(),
                                .entries_n = info.entries_n,
                                .kind = info.kind,
                                .flags = info.flags,
                                .minimum = info.min,
                                .maximum = info.max,
                                .initial = info.initial}};
    link_text(m.param_info.name, sizeof m.param_info.name, info.name);
    link_text(m.param_info.unit, sizeof m.param_info.unit, info.unit);
    link_text(m.param_info.text, sizeof m.param_info.text, info.what);
    for (int i = 0; info.choices != NULL && i <= (int)info.max; i++) {
        link_text_add(m.param_info.text, sizeof m.param_info.text, i == 0 ? " [" : "|");
        link_text_add(m.param_info.text, sizeof m.param_info.text, info.choices[i]);
    }
    link_text_add(m.param_info.text, sizeof m.param_info.text, info.choices != NULL ? "]" : "");
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_get(device *d, const message_param_get *get)
{
    const params_set *set = get->which == PARAM_STAGED ? &d->params.staged : &d->params.in_force;
    params_info info;
    const int index = params_find(get->name);
    if (!params_describe(set->rod.links_n, index, &info)) {
        const params_refusal why = {.reason = REASON_NAME, .entry = -1, .field = get->name};
        answers_refuse(d, get->request_id, MESSAGE_PARAM_GET, &why);
        return;
    }
    message m = {.type = MESSAGE_PARAM_VALUE,
                 .param_value = {.request_id = get->request_id, .which = get->which}};
    link_text(m.param_value.name, sizeof m.param_value.name, info.name);
    m.param_value.values_n = info.entries_n;
    for (int entry = 0; entry < info.entries_n; entry++) {
        m.param_value.values[entry] = params_get(set, index, entry);
    }
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_set(device *d, const message_param_set *set)
{
    params_refusal why;
    if (params_stage(&d->params, set->name, set->first, set->values, set->values_n, &why)) {
        answers_acknowledge(d, set->request_id, MESSAGE_PARAM_SET);
    } else {
        answers_refuse(d, set->request_id, MESSAGE_PARAM_SET, &why);
    }
}

/* ANGLES, NODES and POSE_LOG as set must leave a fifth of the line free for everything else. A byte takes
 * ten bits; message sizes are PROTOCOL.md's. */
static bool fits_the_line(const device *d, params_refusal *why)
{
    const params_set *set = &d->params.staged;
    const float links_n = (float)set->rod.links_n;
    const float room = 0.08f * (float)d->config.line_baud;
    const float needed = set->device.angles_hz * (27.0f + 4.0f * links_n) +
                         set->device.nodes_hz * (23.0f + 12.0f * (links_n + 1.0f)) +
                         set->device.pose_log / d->config.tick_s * 53.0f;
    if (d->config.line_baud == 0 || needed <= room) {
        return true;
    }
    *why = (params_refusal){
        REASON_LINE_RATE,
        -1,
        needed,
        0.0f,
        room,
        "angles_rate",
        "bytes a second: angles_rate (27 + 4 N) + nodes_rate (35 + 12 N) + pose_log; "
        "80 % of baud / 10"};
    return false;
}

/* What is staged is in force from this tick on, or not at all. */
static void commit(device *d, uint16_t request_id, uint8_t type)
{
    const bool all_allowed = supervisor_duties[d->supervisor.state].change_all;
    const tick_load load = {scene_objects_n(&d->body.scene), d->body.shape_ticks > 0};
    params_refusal why;
    char text[MESSAGES_TEXT_MAX + 1];
    if (d->arming.id != 0 || d->servicing.id != 0) {
        answers_refuse_for(d, request_id, type, REASON_BUSY, "the servos are being talked to");
        return;
    }
    if (!fits_the_line(d, &why) ||
        !tick_budget_check(&d->params.staged, &load, d->boot.clock_hz, text, &why) ||
        !params_check_changes(&d->params, all_allowed, &why) ||
        !device_apply_params(d, &d->params.staged, all_allowed, &why)) {
        answers_refuse(d, request_id, type, &why);
        return;
    }
    params_take(&d->params);
    if (all_allowed) {
        telemetry_servos(d);
    }
    d->unsaved = true;
    answers_acknowledge(d, request_id, type);
}

static void take_preset(device *d, const message_preset *preset)
{
    params_refusal why;
    const rod_params staged = d->params.staged.rod;
    const bool was_staged = d->params.is_staged;
    if (!params_stage_preset(&d->params, preset->name, &why)) {
        answers_refuse(d, preset->request_id, MESSAGE_PRESET, &why);
        return;
    }
    const uint32_t generation = d->params.generation;
    commit(d, preset->request_id, MESSAGE_PRESET);
    if (d->params.generation == generation) {
        d->params.staged.rod = staged; /* refused: nothing has happened */
        d->params.is_staged = was_staged;
    }
}

static void take_preset_list(device *d, const message_preset_list *list)
{
    if (list->index >= ROD_PRESETS_N) {
        answers_refuse_for(d, list->request_id, MESSAGE_PRESET_LIST, REASON_INDEX, NULL);
        return;
    }
    message m = {.type = MESSAGE_PRESET_INFO,
                 .preset_info = {list->request_id, list->index, ROD_PRESETS_N, "", ""}};
    link_text(m.preset_info.name, sizeof m.preset_info.name, rod_presets[list->index].name);
    link_text(m.preset_info.text, sizeof m.preset_info.text, rod_presets[list->index].what);
    (void)link_send(&d->link, &m, d->now_us);
}

static void take_save(device *d, uint16_t request_id)
{
    if (!supervisor_duties[d->supervisor.state].save) {
        answers_refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_STATE, "only while DISARMED");
    } else if (d->saving.id != 0 || d->arming.id != 0 || d->servicing.id != 0) {
        answers_refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_BUSY, NULL);
    } else {
        const uint32_t bytes_n = saved_params_pack(&d->params.in_force, d->settings_bytes);
        const settings_error error =
            settings_save_begin(&d->settings, SAVED_PARAMS_VERSION, d->settings_bytes, bytes_n);
        if (error < 0) {
            answers_refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_FLASH,
                               settings_error_text(error));
        } else {
            d->saving = (device_request){request_id, MESSAGE_PARAM_SAVE};
        }
    }
}

void param_commands_take(device *d, const message *m)
{
    const uint16_t request_id = m->param_list.request_id; /* every request begins with it */
    switch (m->type) {
    case MESSAGE_PARAM_LIST:
        take_list(d, &m->param_list);
        break;
    case MESSAGE_PARAM_GET:
        take_get(d, &m->param_get);
        break;
    case MESSAGE_PARAM_SET:
        take_set(d, &m->param_set);
        break;
    case MESSAGE_PARAM_COMMIT:
        commit(d, request_id, MESSAGE_PARAM_COMMIT);
        break;
    case MESSAGE_PARAM_SAVE:
        take_save(d, request_id);
        break;
    case MESSAGE_PARAM_DEFAULTS:
        params_stage_defaults(&d->params);
        d->params.staged.device.servo_kind = (float)d->config.servos_kind;
        answers_acknowledge(d, request_id, MESSAGE_PARAM_DEFAULTS);
        break;
    case MESSAGE_PRESET_LIST:
        take_preset_list(d, &m->preset_list);
        break;
    case MESSAGE_PRESET:
        take_preset(d, &m->preset);
        break;
    default:
        break;
    }
}

void param_commands_end_tick(device *d)
{
    if (d->saving.id != 0) {
        const settings_error error = settings_save_step(&d->settings);
        if (error != SETTINGS_BUSY) {
            const uint16_t request_id = d->saving.id;
            d->saving.id = 0;
            if (error == SETTINGS_E_FLASH || error == SETTINGS_E_READ_BACK) {
                faults_raise(&d->faults, FAULT_FLASH);
            }
            if (error == SETTINGS_OK) {
                d->unsaved = false;
                answers_acknowledge(d, request_id, MESSAGE_PARAM_SAVE);
            } else {
                answers_refuse_for(d, request_id, MESSAGE_PARAM_SAVE, REASON_FLASH,
                                   settings_error_text(error));
            }
        }
    }
}
