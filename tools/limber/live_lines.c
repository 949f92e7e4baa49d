/* live_lines.c - TUM lines from standard input, as they come: `timestamp tx ty tz qx qy qz qw`, s and m.
 *
 * Comments and blank lines are passed over. Of the lines that are no pose the first one is complained of. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "limber.h"
#include "live_source.h"

typedef struct {
    char text[65536];
    size_t text_n;
    bool too_long;
    long line;
} live_lines;

static int open_lines(live_source *s, const char *where)
{
    (void)where;
    s->fd = STDIN_FILENO;
    s->state = calloc(1, sizeof(live_lines));
    return s->state == NULL ? sim_give_up("out of memory") : SIM_OK;
}

static void read_lines(live_source *s, bool readable)
{
    live_lines *const l = s->state;
    if (!readable) {
        return;
    }
    if (l->text_n == sizeof l->text) { /* no line is that long: not poses */
        l->text_n = 0;
        l->too_long = true;
    }
    const long n = read(s->fd, l->text + l->text_n, sizeof l->text - l->text_n);
    s->arrived_us = limber_now_us();
    if (n > 0) {
        l->text_n += (size_t)n;
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        s->ended = true;
        if (l->text_n > 0 && l->text_n < sizeof l->text && l->text[l->text_n - 1] != '\n') {
            l->text[l->text_n++] = '\n'; /* the last line may lack its end */
        }
    }
}

static bool parse(const live_lines *l, char *text, track_sample *sample)
{
    double values[8];
    char *rest = text;
    for (int i = 0; i < 8; i++) {
        char *end;
        values[i] = strtod(rest, &end);
        if (end == rest || !isfinite(values[i]) || fabs(values[i]) > 1e18) {
            return false;
        }
        rest = end;
    }
    *sample = (track_sample){values[0],
                             {values[1], values[2], values[3]},
                             {values[4], values[5], values[6], values[7]},
                             l->line};
    return rest[strspn(rest, " \t\r")] == '\0';
}

/* The next complete line that is a pose. */
static bool next_line(live_source *s, track_sample *sample)
{
    live_lines *const l = s->state;
    for (char *end; (end = memchr(l->text, '\n', l->text_n)) != NULL;) {
        char text[512];
        const size_t length = (size_t)(end - l->text);
        const size_t kept = length < sizeof text - 1 ? length : sizeof text - 1;
        memcpy(text, l->text, kept);
        text[kept] = '\0';
        l->text_n -= length + 1;
        memmove(l->text, end + 1, l->text_n);
        l->line++;
        const char *const first = text + strspn(text, " \t\r");
        if (*first == '#' || *first == '\0') {
            continue;
        }
        const bool cut = l->too_long || length != kept;
        l->too_long = false;
        if (!cut && parse(l, text, sample)) {
            return true;
        }
        if (s->counts.unreadable++ == 0) {
            limber_note("standard input:%ld: not 'timestamp tx ty tz qx qy qz qw': '%.60s'; left "
                        "out, as all like it",
                        l->line, text);
        }
    }
    return false;
}

/* Standard input is nobody's to close. */
static void close_lines(live_source *s)
{
    (void)s;
}

const live_kind live_lines_kind = {"",
                                   .waits = true,
                                   .open = open_lines,
                                   .read = read_lines,
                                   .next = next_line,
                                   .close = close_lines};
