/* live.h - what limber-sim's commands share that run in real time until Ctrl-C, for somebody at the other end of a
 * line. */
#ifndef LIMBER_LIVE_H
#define LIMBER_LIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "line.h"

/* From here on Ctrl-C and kill only set a flag, and a reader that goes away is no reason to die. */
void live_catch_signals(void);
bool live_asked_to_stop(void);

/* Opens a PTY under the name `pty` or a TCP port at `tcp`, whichever is not NULL, and prints a line that ends in how
 * to reach it, behind `title`. SIM_OK, or an exit code after complaining. */
int live_open_line(line *l, const char *title, const char *pty, const char *tcp);

/* Values of options: SIM_OK, or SIM_BAD_INPUT after complaining. *to is freed by the caller in the end. */
int live_text(char **to, const char *text);

/* A baud rate that smart servos have. */
int live_servo_baud(const char *option, const char *text, uint32_t *to);

#endif
