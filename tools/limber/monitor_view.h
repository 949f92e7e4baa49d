/* monitor_view.h - a monitor_state on a terminal, by ncurses: from 40x12 up, any TERM that can place its cursor,
 * colour only as an addition.
 *
 *     if (monitor_view_possible()) {
 *         interrupt_catch();                        first: ncurses leaves signals alone that somebody handles
 *         monitor_view_open(&v);
 *         while (monitor_view_keys(&v)) { ...; monitor_view_draw(&v, &m); }
 *         monitor_view_close(&v);
 *     }
 *
 * Draws what it is given and talks to no device. While it is open, what anybody writes to stderr (where that
 * is a terminal) would spoil the picture: it is caught, its newest line shown at the bottom, and the last lines
 * are written to stderr at the close. One at a time; only the main thread. A picture takes about 1 ms, and
 * only what changed goes to the terminal: ten a second are enough.
 */
#ifndef LIMBER_MONITOR_VIEW_H
#define LIMBER_MONITOR_VIEW_H

#include <stdbool.h>

#include "monitor_state.h"
#include "monitor_text.h"

enum { MONITOR_SAID_N = 8 };

typedef struct {
    struct screen *screen; /* ncurses' SCREEN */
    bool colour;
    int first_joint; /* of those shown: arrows scroll */
    int shown_n;
    int stderr_fd,
        said_fd; /* the stderr kept aside, and where its lines come out; -1: not caught */
    char line[MONITOR_TEXT_BYTES]; /* what has come of the next one */
    char said[MONITOR_SAID_N][MONITOR_TEXT_BYTES];
    int said_n; /* ever */
} monitor_view;

/* Whether stdout is a terminal that can place its cursor. */
bool monitor_view_possible(void);

/* Takes the terminal over. False if that cannot be done: nothing has changed then. */
bool monitor_view_open(monitor_view *v);

/* One picture, in the terminal's present size. m has been refreshed. */
void monitor_view_draw(monitor_view *v, const monitor_state *m);

/* Takes the keys that were pressed, without waiting. False once somebody pressed q. */
bool monitor_view_keys(monitor_view *v);

/* Leaves the terminal as it was found. */
void monitor_view_close(monitor_view *v);

#endif
