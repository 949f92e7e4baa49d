/* link_options.h - what most commands take: --port, --json, and a session for those who talk to the device. */
#ifndef LIMBER_LINK_OPTIONS_H
#define LIMBER_LINK_OPTIONS_H

#include <stdbool.h>

#include "options.h"
#include "port.h"
#include "session.h"

typedef struct {
    char *port; /* as given, or NULL; freed by link_close */
    int json;
    char chosen[PORT_PATH_BYTES];
} link_options;

#define LINK_PORT_OPTION(link)                                                                     \
    {                                                                                              \
        "port", 'p', POPT_ARG_STRING, &(link)->port, 0,                                            \
            "serial:/dev/ttyUSB0[@BAUD], pty:PATH or tcp:HOST:PORT", "PORT"                        \
    }
#define LINK_JSON_OPTION(link)                                                                     \
    {                                                                                              \
        "json", 'j', POPT_ARG_NONE, &(link)->json, 0, "print JSON", NULL                           \
    }

/* The port to use, from --port, $LIMBER_PORT or the only one there is. SIM_OK with link->chosen. */
int link_choose(link_options *link);

/* link_choose and session_start. */
int link_open(link_options *link, session *s);

/* Reads options that need no code of their own. SIM_OK with *help where only the help was asked for. */
int link_take_options(poptContext context, const char *command, const char *examples, bool *help);

/* Complains about arguments left over; SIM_OK if there are none. */
int link_no_more_arguments(poptContext context, const char *command);

void link_close(link_options *link, session *s);

/* A number from min to max, or a complaint. */
int link_number(const char *option, const char *text, double min, double max, double *value);

#endif
