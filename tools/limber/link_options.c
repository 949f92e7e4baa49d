/* link_options.c - see link_options.h. */
#include "link_options.h"

#include <stdio.h>
#include <stdlib.h>

int link_choose(link_options *link)
{
    const char *name = link->port != NULL ? link->port : getenv("LIMBER_PORT");
    if (name == NULL || *name == '\0') {
        return port_choose(link->chosen);
    }
    const int result = port_check_name(name);
    if (result == SIM_OK) {
        snprintf(link->chosen, sizeof link->chosen, "%s", name);
    }
    return result;
}

int link_open(link_options *link, session *s)
{
    const int result = link_choose(link);
    return result == SIM_OK ? session_start(s, link->chosen, 0.0f) : result;
}

int link_take_options(poptContext context, const char *command, const char *examples, bool *help)
{
    const int found = options_next(context, command, examples);
    *help = found == OPTION_HELP;
    return found == 0 || *help ? SIM_OK : SIM_BAD_INPUT;
}

int link_no_more_arguments(poptContext context, const char *command)
{
    const char *extra = poptGetArg(context);
    return extra == NULL
               ? SIM_OK
               : sim_complain("%s: unexpected '%s'; try limber %s --help", command, extra, command);
}

void link_close(link_options *link, session *s)
{
    if (s != NULL) {
        session_close(s);
    }
    free(link->port);
    link->port = NULL;
}

int link_number(const char *option, const char *text, double min, double max, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !(*value >= min && *value <= max)) {
        return sim_complain("%s %.40s: must be a number from %g to %g", option, text, min, max);
    }
    return SIM_OK;
}
