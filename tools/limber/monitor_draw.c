/* monitor_draw.c - see monitor_draw.h. From top to bottom:
 *
 *     title, state, alarm          a line each, the alarm only if there is one
 *     facts, counters              flow through as many lines as the screen can spare
 *     joints                       in columns if they are many; what does not fit is scrolled to
 *     what was said last, or the keys
 */
#include "monitor_draw.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <curses.h>

enum {
    ROOMY_ROWS = 20,      /* from so many on each group of facts begins a line of its own */
    JOINT_WIDTH_MIN = 39, /* two bars of 9 */
    BAR_WIDTH_MAX = 41,
    WITHOUT_BARS = 21, /* of a joint's width: its number, two angles, what is between */
};

/* --- text that flows ------------------------------------------------------------------------------- */

typedef struct {
    int row, end, column;
} flow;

static attr_t coloured(const monitor_view *v, int colour)
{
    return v->colour ? (attr_t)COLOR_PAIR(colour) : A_NORMAL;
}

static void put(int row, int column, attr_t look, const char *text)
{
    (void)attrset((int)look);
    (void)mvaddnstr(row, column, text, COLS - column);
    (void)attrset(A_NORMAL);
}

/* On this line if it fits, else on the next. False: there is no room left. */
static bool flow_put(flow *f, attr_t look, const char *text)
{
    const int n = (int)strlen(text);
    if (f->column > 1 && f->column + n > COLS) {
        f->row++;
        f->column = 1;
    }
    if (f->row >= f->end) {
        return false;
    }
    put(f->row, f->column, look, text);
    f->column += n + 2;
    return true;
}

static void flow_break(flow *f)
{
    if (f->column > 1) {
        f->row++;
        f->column = 1;
    }
}

/* --- top ------------------------------------------------------------------------------------------- */

static void draw_title(const monitor_state *m)
{
    monitor_text left;
    char right[40];
    const uint32_t up_s = m->heartbeat.uptime_ms / 1000;
    snprintf(left, sizeof left, " %s %s  %d links  %s", m->device.device, m->device.build,
             m->device.links_n, m->port);
    monitor_text_clean(left);
    snprintf(right, sizeof right, " up %u:%02u:%02u ", up_s / 3600, up_s / 60 % 60, up_s % 60);
    (void)attrset(A_REVERSE);
    (void)mvhline(0, 0, ' ' | A_REVERSE, COLS);
    put(0, 0, A_REVERSE, left);
    put(0, COLS - (int)strlen(right), A_REVERSE, right);
}

static int colour_of_state(uint8_t state)
{
    switch (state) {
    case DEVICE_ACTIVE:
        return COLOUR_GOOD;
    case DEVICE_FAULT:
    case DEVICE_ESTOP:
        return COLOUR_BAD;
    case DEVICE_ARMING:
    case DEVICE_HOLD:
    case DEVICE_RELAX:
    case DEVICE_LIMP:
        return COLOUR_CARE;
    default:
        return COLOUR_FAINT;
    }
}

/* Returns the row after it. */
static int draw_state(const monitor_view *v, const monitor_state *m)
{
    const bool known = m->heartbeat_known || m->angles_known;
    const char *const name =
        known ? message_value_name(&message_values_device_states, m->state) : "?";
    const attr_t look = A_BOLD | coloured(v, colour_of_state(m->state));
    put(1, 1, look, name);
    put(1, 3 + (int)strlen(name), A_NORMAL,
        known ? message_value_meaning(&message_values_device_states, m->state) : "");
    monitor_text alarm;
    if (!monitor_text_alarm(m, alarm)) {
        return 2;
    }
    put(2, 1, A_BOLD | coloured(v, COLOUR_BAD), alarm);
    return 3;
}

/* --- facts ----------------------------------------------------------------------------------------- */

static attr_t look_of(const monitor_view *v, const monitor_state *m, monitor_piece piece)
{
    const uint8_t limits = ANGLES_NOT_FINITE | ANGLES_LIMITED_ANGLE | ANGLES_LIMITED_ACCELERATION |
                           ANGLES_LIMITED_RATE;
    if (piece == MONITOR_TEXT_FLAGS) {
        return coloured(v, COLOUR_FAINT);
    }
    for (int bit = 0; bit < MONITOR_FLAGS_N && piece == MONITOR_TEXT_LIMITS; bit++) {
        if ((limits >> bit & 1) != 0 && m->flags_share[bit] > 0.0) {
            return A_BOLD | coloured(v, COLOUR_CARE);
        }
    }
    return A_NORMAL;
}

/* Groups that begin a line, so that what comes and goes in one does not move the others about. On a small
 * screen each has one line, and what does not fit is left out. */
static void draw_facts(const monitor_view *v, const monitor_state *m, flow *f)
{
    const int end = f->end;
    const bool roomy = LINES >= ROOMY_ROWS;
    for (int piece = 0; piece < (roomy ? MONITOR_TEXTS_N : MONITOR_TEXT_FLAGS); piece++) {
        monitor_text text;
        if (piece == MONITOR_TEXT_POSES || piece == MONITOR_TEXT_LIMITS ||
            piece == MONITOR_TEXT_FLAGS) {
            flow_break(f);
        }
        f->end = !roomy && f->column == 1 && f->row < end ? f->row + 1 : f->end;
        if (monitor_text_of(m, (monitor_piece)piece, text)) {
            (void)flow_put(f, look_of(v, m, (monitor_piece)piece), text);
        }
    }
    flow_break(f);
    f->end = end;
}

/* Trouble that grows, other trouble, the usual. */
static int group_of(const monitor_counter *counter)
{
    return counter->usual ? 2 : counter->growing ? 0 : 1;
}

static void draw_counters(const monitor_view *v, const monitor_state *m, flow *f)
{
    bool room = true;
    for (int group = 0; group < 3; group++) {
        const attr_t look = group == 0 ? A_BOLD | coloured(v, COLOUR_CARE) : A_NORMAL;
        for (int i = 0; i < m->counters_n && room; i++) {
            monitor_text text;
            if (m->counters[i].value != 0 && group_of(&m->counters[i]) == group) {
                monitor_text_counter(&m->counters[i], text);
                room = flow_put(f, look, text);
            }
        }
    }
    flow_break(f);
}

/* --- joints ---------------------------------------------------------------------------------------- */

/* What a full bar stands for: steps, so that bars do not keep changing their meaning. */
static double scale_deg(double largest_deg)
{
    static const double STEPS_DEG[] = {5.0, 10.0, 20.0, 45.0, 90.0};
    for (int i = 0; i < 5; i++) {
        if (largest_deg <= STEPS_DEG[i]) {
            return STEPS_DEG[i];
        }
    }
    return 180.0;
}

/* "...-====|........": from the middle, in half steps; width is odd. */
static void make_bar(char *bar, int width, double angle_deg, double full_deg)
{
    const int half = width / 2;
    memset(bar, '.', (size_t)width);
    bar[width] = '\0';
    bar[half] = '|';
    if (isnan(angle_deg)) {
        return;
    }
    const int halves = (int)(fmin(fabs(angle_deg) / full_deg, 1.0) * 2 * half + 0.5);
    for (int i = 1; i <= (halves + 1) / 2; i++) {
        bar[angle_deg < 0.0 ? half - i : half + i] = 2 * i <= halves ? '=' : '-';
    }
}

static void draw_angle(const monitor_view *v, int row, int column, int width, double angle_deg,
                       double full_deg)
{
    char bar[BAR_WIDTH_MAX + 1], number[16];
    make_bar(bar, width, angle_deg, full_deg);
    put(row, column, coloured(v, COLOUR_FAINT), bar);
    snprintf(number, sizeof number, isnan(angle_deg) ? "     --" : "%+7.1f", angle_deg);
    put(row, column + width, A_NORMAL, number);
}

static int bar_width(int columns_n)
{
    const int width = (COLS / columns_n - WITHOUT_BARS) / 2;
    const int bounded = width > BAR_WIDTH_MAX ? BAR_WIDTH_MAX : width < 3 ? 3 : width;
    return bounded % 2 == 1 ? bounded : bounded - 1;
}

/* As few columns as hold them all, as far as they fit beside each other. */
static int columns_for(int joints_n, int rows_n)
{
    int columns_n = 1;
    while (columns_n * rows_n < joints_n && COLS / (columns_n + 1) >= JOINT_WIDTH_MIN) {
        columns_n++;
    }
    return columns_n;
}

static void scroll_to(monitor_view *v, int joints_n, int room_n)
{
    const int last = joints_n > room_n ? joints_n - room_n : 0;
    v->first_joint = v->first_joint > last ? last : v->first_joint < 0 ? 0 : v->first_joint;
    v->shown_n = room_n < joints_n ? room_n : joints_n;
}

static void draw_joints(monitor_view *v, const monitor_state *m, int heading_row, int end)
{
    const int joints_n = m->angles.angles_n, rows_n = end - heading_row - 1;
    const int columns_n = columns_for(joints_n, rows_n);
    const int width = bar_width(columns_n), each = COLS / columns_n;
    const double full_deg = scale_deg(m->largest_deg);
    char heading[100];
    if (!m->angles_known || rows_n < 1) {
        return;
    }
    scroll_to(v, joints_n, columns_n * rows_n);
    int used = snprintf(heading, sizeof heading, "theta, phi: degrees, of %g", full_deg);
    if (v->shown_n < joints_n) {
        snprintf(heading + used, sizeof heading - (size_t)used, "; %d-%d of %d", v->first_joint + 1,
                 v->first_joint + v->shown_n, joints_n);
    }
    put(heading_row, 1, A_UNDERLINE, heading);
    for (int i = 0; i < v->shown_n; i++) {
        const int joint = v->first_joint + i;
        const int row = heading_row + 1 + i % rows_n, column = i / rows_n * each;
        const int16_t *const angles = m->angles.angles_tenth_mrad[joint];
        char number[16];
        snprintf(number, sizeof number, "%3d", joint + 1);
        put(row, column, A_NORMAL, number);
        draw_angle(v, row, column + 4, width, monitor_angle_deg(angles[0]), full_deg);
        draw_angle(v, row, column + 4 + width + 8, width, monitor_angle_deg(angles[1]), full_deg);
    }
}

/* --- all ------------------------------------------------------------------------------------------- */

void monitor_draw(monitor_view *v, const monitor_state *m, const char *said)
{
    erase();
    draw_title(m);
    const int top = draw_state(v, m), bottom = LINES - 1;
    const int joints_rows = 1 + (m->angles.angles_n < 4 ? m->angles.angles_n : 4);
    const int most = LINES >= ROOMY_ROWS ? top + (bottom - top) / 2 : bottom - joints_rows;
    flow f = {.row = top, .end = most, .column = 1};
    draw_facts(v, m, &f);
    draw_counters(v, m, &f);
    draw_joints(v, m, f.row < most ? f.row + (LINES >= ROOMY_ROWS) : most, bottom);
    put(bottom, 1, A_DIM,
        said != NULL                      ? said
        : v->shown_n < m->angles.angles_n ? "q quits, arrows scroll"
                                          : "q quits");
    (void)move(bottom, 0);
}
