/* options.h - the little that the commands add to popt: one-line errors, help with examples. */
#ifndef LIMBER_OPTIONS_H
#define LIMBER_OPTIONS_H

#include <popt.h>

/* Rows every command's table ends with. */
enum { OPTION_HELP = 1000 };
#define OPTIONS_END                                                                                \
    {"help", 'h', POPT_ARG_NONE, NULL, OPTION_HELP, "show this help", NULL}, POPT_TABLEEND

/* Reads options up to the next one that carries a value in its table row: returns that value (> 0),
 * OPTION_HELP after printing the help, 0 at the end, or -1 after complaining. */
int options_next(poptContext context, const char *command, const char *examples);

/* The only positional argument, or NULL after complaining; `what` names it. */
const char *options_one_argument(poptContext context, const char *command, const char *what);

#endif
