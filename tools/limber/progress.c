/* progress.c - see progress.h. */
#include "progress.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

static bool shown;

bool progress_wanted(void)
{
    return isatty(STDERR_FILENO) != 0;
}

void progress_show(const char *format, ...)
{
    va_list arguments;
    if (!progress_wanted()) {
        return;
    }
    fputs("\r", stderr);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputs("\033[K", stderr);
    fflush(stderr);
    shown = true;
}

void progress_clear(void)
{
    if (shown) {
        fputs("\r\033[K", stderr);
        shown = false;
    }
}
