/* options.h - the little that the commands add to popt: one-line errors, help with examples. */
#ifndef LIMBER_OPTIONS_H
#define LIMBER_OPTIONS_H

#include <popt.h>

/* Rows every command's table ends with. */
enum { OPTION_HELP = 1000 };
#define OPTIONS_END                                                                                \
    {"help", 'h', POPT_ARG_NONE, NULL, OPTION_HELP, "show this help", NULL}, POPT_TABLEEND

/* Rows of a command whose rod can be drawn to a shape. */
enum { OPTION_SHAPE = OPTION_HELP + 1, OPTION_SHAPE_STRENGTH, OPTION_SHAPE_BLEND };
// clang-format off
#define OPTIONS_SHAPE                                                                              \
    {"shape", 0, POPT_ARG_STRING, NULL, OPTION_SHAPE,                                              \
     "a shape to take: a table of angles or points, arc:DEGREES or coil:TURNS", "SHAPE"},          \
    {"shape-strength", 0, POPT_ARG_STRING, NULL, OPTION_SHAPE_STRENGTH,                            \
     "how strongly, like a spring of so many N m at each joint", "NM"},                            \
    {"shape-blend", 0, POPT_ARG_STRING, NULL, OPTION_SHAPE_BLEND,                                  \
     "over how long it sets in (0.5)", "S"}
// clang-format on

/* Reads options up to the next one that carries a value in its table row: returns that value (> 0),
 * OPTION_HELP after printing the help, 0 at the end, or -1 after complaining. */
int options_next(poptContext context, const char *command, const char *examples);

/* The value of an option as a number: SIM_OK, or SIM_BAD_INPUT after complaining. */
int options_number(const char *option, const char *text, double min, double max, double *to);

/* The only positional argument, or NULL after complaining; `what` names it. */
const char *options_one_argument(poptContext context, const char *command, const char *what);

#endif
