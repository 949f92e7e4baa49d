/* live_lines.h - TUM lines from a pipe, as they come: `timestamp tx ty tz qx qy qz qw`, s and m. */
#ifndef LIMBER_LIVE_LINES_H
#define LIMBER_LIVE_LINES_H

#include <stdbool.h>

#include "track.h"

typedef struct {
    int fd;
    char text[65536];
    size_t text_n;
    bool ended, too_long;
    long line;
    long unreadable; /* lines that are no pose; the first one is complained of */
} live_lines;

/* Reads what there is, without waiting if the file descriptor said that it can be read. */
void live_lines_read(live_lines *l);

/* The next complete line as a sample; comments and blank lines are passed over. False: none yet, or at
 * `ended` none any more. */
bool live_lines_next(live_lines *l, track_sample *sample);

#endif
