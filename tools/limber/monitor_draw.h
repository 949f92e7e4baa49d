/* monitor_draw.h - what goes where on the screen; within monitor_view. */
#ifndef LIMBER_MONITOR_DRAW_H
#define LIMBER_MONITOR_DRAW_H

#include "monitor_view.h"

enum { COLOUR_GOOD = 1, COLOUR_CARE, COLOUR_BAD, COLOUR_FAINT };

/* A whole picture into ncurses' memory; v->first_joint and shown_n are brought within bounds. `said`: the
 * last line, or NULL. */
void monitor_draw(monitor_view *v, const monitor_state *m, const char *said);

#endif
