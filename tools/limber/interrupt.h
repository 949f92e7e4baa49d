/* interrupt.h - Ctrl-C, kill and a closed terminal as a question to be asked: whoever has armed the device
 * disarms it before leaving. */
#ifndef LIMBER_INTERRUPT_H
#define LIMBER_INTERRUPT_H

#include <stdbool.h>

/* From here on SIGINT, SIGTERM and SIGHUP only set a flag (those that were ignored stay ignored), and a
 * reader of the output that goes away is no reason to die. Call it after opening output files, which
 * would otherwise be left to a handler of their own. */
void interrupt_catch(void);

bool interrupt_came(void);

#endif
