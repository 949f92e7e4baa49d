/* monitor_text.h - a monitor_state in words: the pieces of the live view, and the line of --plain. */
#ifndef LIMBER_MONITOR_TEXT_H
#define LIMBER_MONITOR_TEXT_H

#include <stdio.h>

#include "monitor_state.h"

enum { MONITOR_TEXT_BYTES = 400 };

typedef char monitor_text[MONITOR_TEXT_BYTES];

/* In the order in which they matter. */
typedef enum {
    MONITOR_TEXT_ANGLES,  /* "angles 200/s" */
    MONITOR_TEXT_TICK,    /* "tick 23 us, max 40 (4 %)": of the time between ticks */
    MONITOR_TEXT_LATENCY, /* "pose -> angles 2.1 ms, p99 4.0" */
    MONITOR_TEXT_POSES,   /* "poses 100/s, refused 0, lost 0": a second, all three */
    MONITOR_TEXT_PACE,    /* "apart 10.0 ms, jitter 0.31, max 12.4" */
    MONITOR_TEXT_LIMITS,  /* flags of ANGLES, and in how many of them: "limited rate 12 %" */
    MONITOR_TEXT_TOUCH,   /* "touches at 3 nodes, 1.24 N (-0.2, 0, 1.22)": what pushes the rod */
    MONITOR_TEXT_FLAGS,   /* of HEARTBEAT */
    MONITOR_TEXTS_N
} monitor_piece;

/* False, and an empty text, where there is nothing to say. */
bool monitor_text_of(const monitor_state *m, monitor_piece piece, monitor_text text);

/* What somebody should do something about: a lost device, a fault, an open e-stop. False: nothing. */
bool monitor_text_alarm(const monitor_state *m, monitor_text text);

/* "poses_late 12 +3": the number is how much it grew when it last did. */
void monitor_text_counter(const monitor_counter *counter, monitor_text text);

/* Everything but printable ASCII becomes '?': a device's words must not steer the terminal. */
void monitor_text_clean(char *text);

/* One line: when, the state, the pieces, the largest angle, the counters that grow. */
void monitor_text_line(const monitor_state *m, double since_s, FILE *out);

#endif
