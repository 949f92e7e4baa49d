/* monitor_text.c - see monitor_text.h. */
#include "monitor_text.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "texts.h"

void monitor_text_clean(char *text)
{
    for (char *c = text; *c != '\0'; c++) {
        if (*c < ' ' || *c > '~') {
            *c = '?';
        }
    }
}

static void append(monitor_text text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void append(monitor_text text, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, MONITOR_TEXT_BYTES - used, format, arguments);
    va_end(arguments);
}

/* LIMITED_RATE as "limited rate". */
static void append_name(monitor_text text, const char *name)
{
    for (const char *c = name; *c != '\0'; c++) {
        append(text, "%c", *c == '_' ? ' ' : tolower((unsigned char)*c));
    }
}

/* Whole numbers from 10 on. */
static void append_rate(monitor_text text, double hz)
{
    append(text, "%.*f", hz > 0.0 && hz < 9.95 ? 1 : 0, hz);
}

static void tell_tick(const monitor_state *m, monitor_text text)
{
    const uint32_t max_us = m->tick_max_us > 0 ? m->tick_max_us : m->heartbeat.tick_max_us;
    append(text, "tick %u us, max %u", m->heartbeat.tick_mean_us, max_us);
    if (m->device.tick_hz > 0.0f) {
        append(text, " (%.0f %%)", ceil(max_us * 1e-4 * (double)m->device.tick_hz));
    }
}

static void tell_poses(const monitor_state *m, monitor_text text)
{
    append(text, "poses ");
    append_rate(text, m->accepted_hz);
    append(text, "/s, refused ");
    append_rate(text, m->refused_hz);
    append(text, ", lost ");
    append_rate(text, m->lost_hz);
}

static void tell_limits(const monitor_state *m, monitor_text text)
{
    const message_values *const flags = &message_values_angles_flags;
    for (int i = 0; i < flags->values_n; i++) {
        for (int bit = 0; bit < MONITOR_FLAGS_N; bit++) {
            if (flags->values[i].value == 1u << bit && 1u << bit != ANGLES_NO_POSE &&
                m->flags_share[bit] > 0.0) {
                append(text, "%s", *text == '\0' ? "" : ", ");
                append_name(text, flags->values[i].name);
                append(text, " %.0f %%", ceil(100.0 * m->flags_share[bit]));
            }
        }
    }
    append(text, "%s", *text == '\0' && m->angles_known ? "no limit acts" : "");
}

static void tell_latency(const pose_delays *delays, monitor_text text)
{
    append(text, "pose -> angles %.1f ms, p99 %.1f", delays_quantile_ms(&delays->whole, 0.5),
           delays_quantile_ms(&delays->whole, 0.99));
}

static void tell_touch(const message_touch *touch, monitor_text text)
{
    const double x = (double)touch->force_newton[0], y = (double)touch->force_newton[1],
                 z = (double)touch->force_newton[2];
    append(text, "touches at %d node%s, %.3g N (%.3g, %.3g, %.3g)", touch->contacts_n,
           touch->contacts_n == 1 ? "" : "s", sqrt(x * x + y * y + z * z), x, y, z);
}

bool monitor_text_of(const monitor_state *m, monitor_piece piece, monitor_text text)
{
    *text = '\0';
    switch (piece) {
    case MONITOR_TEXT_ANGLES:
        append(text, "angles ");
        append_rate(text, m->angles_hz);
        append(text, "/s");
        break;
    case MONITOR_TEXT_TICK:
        if (m->heartbeat_known) {
            tell_tick(m, text);
        }
        break;
    case MONITOR_TEXT_POSES:
        if (m->rates_known) {
            tell_poses(m, text);
        }
        break;
    case MONITOR_TEXT_PACE:
        if (m->poses.intervals_n > 0) {
            append(text, "apart %.1f ms, jitter %.2f, max %.1f", m->poses.mean_ms,
                   m->poses.jitter_ms, m->poses.longest_ms);
        }
        break;
    case MONITOR_TEXT_LATENCY:
        if (m->delays != NULL && m->delays->whole.n > 0) {
            tell_latency(m->delays, text);
        }
        break;
    case MONITOR_TEXT_LIMITS:
        tell_limits(m, text);
        break;
    case MONITOR_TEXT_TOUCH:
        if (m->touch.contacts_n > 0) {
            tell_touch(&m->touch, text);
        }
        break;
    case MONITOR_TEXT_FLAGS:
        if (m->heartbeat_known) {
            texts_flags(&message_values_heartbeat_flags, m->heartbeat.flags, text,
                        MONITOR_TEXT_BYTES);
        }
        break;
    default:
        break;
    }
    return *text != '\0';
}

bool monitor_text_alarm(const monitor_state *m, monitor_text text)
{
    *text = '\0';
    if (!m->connected) {
        append(text, "LOST: %s", m->why);
    } else if (m->heartbeat.fault != FAULT_CODE_NONE) {
        append(text, "%s: %s", message_value_name(&message_values_faults, m->heartbeat.fault),
               message_value_meaning(&message_values_faults, m->heartbeat.fault));
        if (m->fault_known && m->fault.fault == m->heartbeat.fault && m->fault.text[0] != '\0') {
            append(text, " (%s)", m->fault.text);
        }
    } else if ((m->heartbeat.flags & HEARTBEAT_ESTOP_OPEN) != 0) {
        append(text, "%s",
               message_value_meaning(&message_values_heartbeat_flags, HEARTBEAT_ESTOP_OPEN));
    }
    monitor_text_clean(text);
    return *text != '\0';
}

void monitor_text_counter(const monitor_counter *counter, monitor_text text)
{
    *text = '\0';
    append(text, "%s %u", counter->name, counter->value);
    if (counter->growing) {
        append(text, " +%u", counter->growth);
    }
}

/* "largest +12.3 deg theta2" */
static void append_largest(const monitor_state *m, monitor_text text)
{
    double largest_deg = 0.0;
    int joint = 0, part = 0;
    for (int i = 0; i < 2 * m->angles.angles_n; i++) {
        const double angle_deg = monitor_angle_deg(m->angles.angles_tenth_mrad[i / 2][i % 2]);
        if (fabs(angle_deg) > fabs(largest_deg)) {
            largest_deg = angle_deg;
            joint = i / 2;
            part = i % 2;
        }
    }
    append(text, "  largest %s%d %+.1f deg", part == 0 ? "theta" : "phi", joint + 1, largest_deg);
}

void monitor_text_line(const monitor_state *m, double since_s, FILE *out)
{
    monitor_text text;
    fprintf(out, "%8.1f s  %-8s", since_s,
            m->connected ? message_value_name(&message_values_device_states, m->state) : "LOST");
    if (monitor_text_alarm(m, text)) {
        fprintf(out, "  %s", text);
    }
    for (int piece = 0; piece < MONITOR_TEXTS_N && m->connected; piece++) {
        if (piece != MONITOR_TEXT_FLAGS && monitor_text_of(m, (monitor_piece)piece, text)) {
            fprintf(out, "  %s", text);
        }
    }
    if (m->connected && m->angles_known) {
        *text = '\0';
        append_largest(m, text);
        fputs(text, out);
    }
    for (int i = 0; i < m->counters_n && m->connected; i++) {
        if (m->counters[i].growing && !m->counters[i].usual) {
            monitor_text_counter(&m->counters[i], text);
            fprintf(out, "  %s", text);
        }
    }
    fputc('\n', out);
    fflush(out);
}
