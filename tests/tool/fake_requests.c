/* fake_requests.c - the fake device's answers to requests. */
#include <stdio.h>
#include <string.h>

#include "fake_device.h"

static const struct {
    message_param_info info;
    int entries_n;
} PARAMS[FAKE_PARAMS_N] = {
    {{.name = "scheme",
      .kind = PARAM_CHOICE,
      .maximum = 1.0f,
      .flags = PARAM_DISARMED_ONLY,
      .text = "how a step is taken [midpoint|paper]"},
     1},
    {{.name = "links",
      .kind = PARAM_WHOLE,
      .minimum = 1.0f,
      .maximum = 64.0f,
      .initial = 3.0f,
      .flags = PARAM_DISARMED_ONLY | PARAM_KEPT,
      .text = "number of links"},
     1},
    {{.name = "spring",
      .unit = "N m",
      .kind = PARAM_NUMBER,
      .maximum = 1e6f,
      .initial = 100.0f,
      .flags = PARAM_LIST | PARAM_KEPT,
      .text = "pulls a joint straight"},
     FAKE_JOINTS_N},
    {{.name = "pose_hold",
      .unit = "ms",
      .kind = PARAM_NUMBER,
      .minimum = 20.0f,
      .maximum = 200.0f,
      .initial = 50.0f,
      .flags = PARAM_KEPT,
      .text = "without a pose for so long: HOLD"},
     1},
    {{.name = "blend",
      .unit = "s",
      .kind = PARAM_NUMBER,
      .minimum = 0.05f,
      .maximum = 5.0f,
      .initial = 0.3f,
      .flags = PARAM_KEPT,
      .text = "0.1 takes over in this time"},
     1},
    {{.name = "tick",
      .unit = "s",
      .kind = PARAM_NUMBER,
      .minimum = 1e-5f,
      .maximum = 0.1f,
      .initial = 0.001f,
      .flags = PARAM_READ_ONLY,
      .text = "the board's own"},
     1},
};
static const char *const PRESETS[][2] = {{"foil", "stiff and quick"}, {"whip", "limp and lively"}};

void fake_requests_init(fake_device *d)
{
    for (int i = 0; i < FAKE_PARAMS_N; i++) {
        for (int entry = 0; entry < FAKE_JOINTS_N; entry++) {
            d->in_force[i][entry] = PARAMS[i].info.initial;
        }
    }
    if (d->ways.hold_ms > 0.0f) {
        d->in_force[3][0] = d->ways.hold_ms;
    }
    memcpy(d->staged, d->in_force, sizeof d->staged);
}

static int find(const char *name)
{
    for (int i = 0; i < FAKE_PARAMS_N; i++) {
        if (strcmp(PARAMS[i].info.name, name) == 0) {
            return i;
        }
    }
    return -1;
}

void fake_ack(fake_device *d, const message *m)
{
    const message answer = {.type = MESSAGE_ACK, .ack = {m->arm.request_id, m->type}};
    d->stats.commands_done++;
    fake_send(d, &answer);
}

void fake_nack(fake_device *d, const message *m, message_nack why)
{
    message answer = {.type = MESSAGE_NACK, .nack = why};
    answer.nack.request_id = m->arm.request_id;
    answer.nack.answered = m->type;
    d->stats.commands_refused++;
    fake_send(d, &answer);
}

static void arm(fake_device *d, const message *m)
{
    if (d->state == DEVICE_FAULT || d->state == DEVICE_ESTOP) {
        fake_nack(d, m, (message_nack){.reason = REASON_LATCHED, .entry = -1});
    } else if (!d->any_pose || fake_now_us() - d->newest_us > 50000) {
        fake_nack(d, m, (message_nack){.reason = REASON_NO_POSES, .entry = -1});
    } else {
        d->state = d->state == DEVICE_ACTIVE ? DEVICE_ACTIVE : DEVICE_ARMING;
        d->armed_us = fake_now_us();
        fake_ack(d, m);
    }
}

static void describe(fake_device *d, const message *m)
{
    const int i = m->param_list.index;
    if (i >= FAKE_PARAMS_N) {
        fake_nack(d, m, (message_nack){.reason = REASON_INDEX, .entry = -1});
        return;
    }
    message answer = {.type = MESSAGE_PARAM_INFO, .param_info = PARAMS[i].info};
    answer.param_info.request_id = m->param_list.request_id;
    answer.param_info.index = (uint16_t)i;
    answer.param_info.params_n = FAKE_PARAMS_N;
    answer.param_info.entries_n = (uint16_t)PARAMS[i].entries_n;
    fake_send(d, &answer);
}

static void get(fake_device *d, const message *m)
{
    const int i = find(m->param_get.name);
    if (i < 0) {
        fake_nack(d, m, (message_nack){.reason = REASON_NAME, .entry = -1});
        return;
    }
    message answer = {
        .type = MESSAGE_PARAM_VALUE,
        .param_value = {.request_id = m->param_get.request_id, .which = m->param_get.which}};
    memcpy(answer.param_value.name, m->param_get.name, sizeof answer.param_value.name);
    answer.param_value.values_n = (uint16_t)PARAMS[i].entries_n;
    memcpy(answer.param_value.values,
           m->param_get.which == PARAM_STAGED ? d->staged[i] : d->in_force[i], sizeof d->staged[i]);
    fake_send(d, &answer);
}

static void set(fake_device *d, const message *m)
{
    const message_param_set *const s = &m->param_set;
    const int i = find(s->name);
    message_nack why = {.reason = REASON_NAME, .entry = -1};
    snprintf(why.field, sizeof why.field, "%.24s", s->name);
    if (i >= 0 && (PARAMS[i].info.flags & PARAM_READ_ONLY) != 0) {
        why.reason = REASON_READ_ONLY;
    } else if (i >= 0 && s->first + s->values_n > PARAMS[i].entries_n) {
        why.reason = REASON_ENTRIES;
    } else if (i >= 0) {
        const bool all = s->values_n == 1 && s->first == 0;
        for (int n = 0; n < (all ? PARAMS[i].entries_n : s->values_n); n++) {
            const float value = s->values[all ? 0 : n];
            if (!(value >= PARAMS[i].info.minimum && value <= PARAMS[i].info.maximum)) {
                why.reason = REASON_BOUNDS;
                why.entry = (int16_t)(PARAMS[i].entries_n > 1 ? s->first + n : -1);
                why.value = value;
                why.minimum = PARAMS[i].info.minimum;
                why.maximum = PARAMS[i].info.maximum;
                fake_nack(d, m, why);
                return;
            }
            d->staged[i][s->first + n] = value;
        }
        fake_tell("staged %s first %d n %d %g", s->name, s->first, s->values_n,
                  (double)s->values[0]);
        fake_ack(d, m);
        return;
    }
    fake_nack(d, m, why);
}

static void preset(fake_device *d, const message *m)
{
    for (int i = 0; i < 2; i++) {
        if (strcmp(PRESETS[i][0], m->preset.name) == 0) {
            fake_ack(d, m);
            return;
        }
    }
    fake_nack(d, m, (message_nack){.reason = REASON_NAME, .entry = -1, .text = "foil, whip"});
}

static void list_preset(fake_device *d, const message *m)
{
    if (m->preset_list.index >= 2) {
        fake_nack(d, m, (message_nack){.reason = REASON_INDEX, .entry = -1});
        return;
    }
    message answer = {.type = MESSAGE_PRESET_INFO,
                      .preset_info = {m->preset_list.request_id, m->preset_list.index, 2, "", ""}};
    const char *const *const one = PRESETS[m->preset_list.index];
    snprintf(answer.preset_info.name, sizeof answer.preset_info.name, "%s", one[0]);
    snprintf(answer.preset_info.text, sizeof answer.preset_info.text, "%s", one[1]);
    fake_send(d, &answer);
}

void fake_tell_stats(fake_device *d, uint16_t request_id)
{
    fake_send(d, &(message){.type = MESSAGE_ROD_STATS,
                            .rod_stats = {.request_id = request_id, .lengths_restored = 3}});
    message answer = {.type = MESSAGE_STATS, .stats = d->stats};
    answer.stats.request_id = request_id;
    answer.stats.uptime_ms = (fake_now_us() - d->start_us) / 1000;
    answer.stats.poses_accepted -= d->poses_n > 0 ? (uint32_t)d->ways.lie : 0;
    fake_send(d, &answer);
}

/* Whether to play deaf: each request as often as asked for. */
static bool ignore(fake_device *d, uint16_t id)
{
    if (d->last_request != id) {
        d->last_request = id;
        d->ignored_n = 0;
    }
    return d->ignored_n++ < d->ways.drop_requests;
}

void fake_request(fake_device *d, const message *m)
{
    if (ignore(d, m->arm.request_id)) {
        return;
    }
    fake_tell("request %s", messages_name(m->type));
    if (m->type == d->ways.nack_type) {
        fake_nack(d, m,
                  (message_nack){.reason = (uint8_t)d->ways.nack_reason,
                                 .entry = -1,
                                 .text = "because\nI say so"});
        return;
    }
    switch (m->type) {
    case MESSAGE_STATS_GET:
        fake_tell_stats(d, m->stats_get.request_id);
        break;
    case MESSAGE_ARM:
        arm(d, m);
        break;
    case MESSAGE_DISARM:
        d->state =
            d->state == DEVICE_FAULT || d->state == DEVICE_ESTOP ? d->state : DEVICE_DISARMED;
        fake_ack(d, m);
        break;
    case MESSAGE_ESTOP:
        d->state = DEVICE_ESTOP;
        fake_ack(d, m);
        break;
    case MESSAGE_CLEAR_FAULT:
        d->state = DEVICE_DISARMED;
        fake_ack(d, m);
        break;
    case MESSAGE_PARAM_LIST:
        describe(d, m);
        break;
    case MESSAGE_PARAM_GET:
        get(d, m);
        break;
    case MESSAGE_PARAM_SET:
        set(d, m);
        break;
    case MESSAGE_PARAM_COMMIT:
        memcpy(d->in_force, d->staged, sizeof d->in_force);
        fake_ack(d, m);
        break;
    case MESSAGE_PARAM_DEFAULTS:
        for (int i = 0; i < FAKE_PARAMS_N; i++) {
            for (int entry = 0; entry < FAKE_JOINTS_N; entry++) {
                d->staged[i][entry] = PARAMS[i].info.initial;
            }
        }
        fake_ack(d, m);
        break;
    case MESSAGE_PARAM_SAVE:
        fake_ack(d, m);
        break;
    case MESSAGE_PRESET:
        preset(d, m);
        break;
    case MESSAGE_PRESET_LIST:
        list_preset(d, m);
        break;
    case MESSAGE_SCENE_PUT:
        fake_scene_put(d, m);
        break;
    case MESSAGE_SCENE_GET:
        fake_scene_show(d, m);
        break;
    case MESSAGE_SHAPE:
        fake_shape(d, m);
        break;
    default:
        fake_nack(d, m, (message_nack){.reason = REASON_UNSUPPORTED, .entry = -1});
    }
}
