/* complain.c - see sim.h. */
#include "sim.h"

#include <stdarg.h>
#include <stdio.h>

const char *sim_program_name = "limber-sim";

static void say(const char *format, va_list arguments)
{
    char line[1024];
    vsnprintf(line, sizeof line, format, arguments);
    for (char *c = line; *c != '\0'; c++) {
        /* names and values come from outside: keep the complaint one printable line */
        if ((unsigned char)*c < ' ' || *c == 127) {
            *c = '?';
        }
    }
    fprintf(stderr, "%s: %s\n", sim_program_name, line);
}

int sim_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
    return SIM_BAD_INPUT;
}

int sim_give_up(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(format, arguments);
    va_end(arguments);
    return SIM_INTERNAL;
}
