/* progress.h - one line on a terminal that is written over and over; nothing where stderr is a file. */
#ifndef LIMBER_PROGRESS_H
#define LIMBER_PROGRESS_H

#include <stdbool.h>

/* Whether there is anybody to watch. */
bool progress_wanted(void);

void progress_show(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Makes room for a line that stays. */
void progress_clear(void);

#endif
