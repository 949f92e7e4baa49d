/* live_lines.c - see live_lines.h. */
#include "live_lines.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "limber.h"

void live_lines_read(live_lines *l)
{
    if (l->text_n == sizeof l->text) { /* no line is that long: not poses */
        l->text_n = 0;
        l->too_long = true;
    }
    const long n = read(l->fd, l->text + l->text_n, sizeof l->text - l->text_n);
    if (n > 0) {
        l->text_n += (size_t)n;
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        l->ended = true;
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

bool live_lines_next(live_lines *l, track_sample *sample)
{
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
        if (l->unreadable++ == 0) {
            limber_note("standard input:%ld: not 'timestamp tx ty tz qx qy qz qw': '%.60s'; left "
                        "out, as all like it",
                        l->line, text);
        }
    }
    return false;
}
