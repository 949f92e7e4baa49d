/* pose_track.c - see pose_track.h. */
#include "pose_track.h"

#include <math.h>
#include <stdio.h>

/* The device's parameter that makes it send POSE_LOG. */
static const char PARAMETER[] = "pose_log";

static bool is_off(const pose_track *t)
{
    return t == NULL || t->out.file == NULL;
}

int pose_track_open(pose_track *t, const char *path)
{
    *t = (pose_track){0};
    return path == NULL ? SIM_OK : output_open(&t->out, path);
}

/* --- what the device sends ------------------------------------------------------------------------- */

static int switch_log(session *s, float to)
{
    message set = {.type = MESSAGE_PARAM_SET, .param_set = {.values_n = 1, .values = {to}}};
    snprintf(set.param_set.name, sizeof set.param_set.name, "%s", PARAMETER);
    int result = session_request(s, &set);
    if (result == SIM_OK &&
        session_try(s, &(message){.type = MESSAGE_PARAM_COMMIT}) != REQUEST_DONE) {
        result = session_complain(s);
        set.param_set.values[0] = 1.0f - to; /* must not wait for somebody else's COMMIT */
        (void)session_try(s, &set);
    }
    return result;
}

int pose_track_begin(pose_track *t, session *s)
{
    message ask = {.type = MESSAGE_PARAM_GET, .param_get = {.which = PARAM_IN_FORCE}};
    if (is_off(t)) {
        return SIM_OK;
    }
    if ((s->device.features & FEATURE_POSE_LOG) == 0) {
        return limber_refuse("this device does not send the poses it used (limber info, features)");
    }
    if ((s->heartbeat.flags & HEARTBEAT_STAGED) != 0) {
        return limber_refuse(
            "parameters are staged on the device, and asking for its poses would "
            "put them in force; commit them first, or limber params set them back");
    }
    snprintf(ask.param_get.name, sizeof ask.param_get.name, "%s", PARAMETER);
    if (!(t->tick_hz > 0.0)) {
        /* a float made of a float: 999.99994 Hz are 1000, and an hour of ticks would show it */
        t->tick_hz =
            s->device.tick_hz > 0.0f ? round((double)s->device.tick_hz * 100.0) / 100.0 : 1000.0;
    }
    int result = session_request(s, &ask);
    if (result == SIM_OK && s->answer.param_value.values[0] < 0.5f) {
        result = switch_log(s, 1.0f);
        t->asked = result == SIM_OK;
    }
    return result;
}

void pose_track_end(pose_track *t, session *s)
{
    if (!is_off(t) && t->asked && s != NULL && !s->lost) {
        (void)switch_log(s, 0.0f);
        t->asked = false;
    }
}

/* --- the file -------------------------------------------------------------------------------------- */

static void begin_file(pose_track *t, const message_pose_log *pose)
{
    t->begun = true;
    t->first_tick = pose->tick;
    fprintf(t->out.file, "# poses of limber stream --poses, one a tick\n"
                         "# timestamp tx ty tz qx qy qz qw\n");
}

void pose_track_add(pose_track *t, const message_pose_log *pose)
{
    if (is_off(t)) {
        return;
    }
    if (!t->begun && (pose->flags & (POSE_LOG_RESTART | POSE_LOG_GAP)) == 0) {
        return; /* still a pose of the session before: the first one of ours lays the rod straight */
    }
    if (!t->begun) {
        begin_file(t, pose);
    } else {
        const uint32_t ticks_n = pose->tick - t->last_tick;
        if (ticks_n == 0 || ticks_n > INT32_MAX) {
            return; /* a device that started anew counts from 0 again: its track would be another one */
        }
        t->missing_n += ticks_n - 1;
        t->restarts_n += (pose->flags & POSE_LOG_RESTART) != 0;
    }
    t->last_tick = pose->tick;
    t->rows_n++;
    fprintf(t->out.file, "%.6f", (double)(pose->tick - t->first_tick) / t->tick_hz);
    for (int i = 0; i < 3; i++) {
        fprintf(t->out.file, " %.9g", (double)pose->position_m[i]);
    }
    for (int i = 0; i < 4; i++) {
        fprintf(t->out.file, " %.9g", (double)pose->quaternion_xyzw[i]);
    }
    fprintf(t->out.file, "\n");
}

int pose_track_close(pose_track *t)
{
    return is_off(t) ? SIM_OK : output_close(&t->out, t->rows_n > 0);
}
