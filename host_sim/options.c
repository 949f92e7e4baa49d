/* options.c - see options.h. */
#include "options.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "sim.h"

int options_next(poptContext context, const char *command, const char *examples)
{
    const int found = poptGetNextOpt(context);
    if (found < -1) {
        (void)sim_complain("%s: %s: %s; try %s %s --help", command,
                           poptBadOption(context, POPT_BADOPTION_NOALIAS), poptStrerror(found),
                           sim_program_name, command);
        return -1;
    }
    if (found == OPTION_HELP) {
        poptPrintHelp(context, stdout, 0);
        printf("\nExamples:\n%s", examples);
    }
    return found == -1 ? 0 : found;
}

const char *options_one_argument(poptContext context, const char *command, const char *what)
{
    const char *first = poptGetArg(context);
    if (first == NULL) {
        (void)sim_complain("%s: no %s given; try %s %s --help", command, what, sim_program_name,
                           command);
        return NULL;
    }
    const char *second = poptGetArg(context);
    if (second != NULL) {
        (void)sim_complain("%s: one %s at a time, but there is also '%s'", command, what, second);
        return NULL;
    }
    return first;
}

int options_number(const char *option, const char *text, double min, double max, double *to)
{
    char *end;
    *to = strtod(text, &end);
    return end != text && *end == '\0' && *to >= min && *to <= max
               ? SIM_OK
               : sim_complain("%s %.40s: must be a number from %g to %g", option, text, min, max);
}
