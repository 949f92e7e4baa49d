/* output.h - files that are whole or not there: written beside their names, and renamed together when
 * all of them are complete. */
#ifndef LIMBER_OUTPUT_H
#define LIMBER_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct {
    const char *path; /* borrowed */
    FILE *file;
    struct output_waiting *waiting; /* NULL where path is a pipe or a device */
} output;

/* Returns SIM_OK, or SIM_BAD_INPUT after complaining. An interrupted program removes its partials. */
int output_open(output *out, const char *path);

/* With keep, the file waits for outputs_finish (SIM_BAD_INPUT where the disk refuses); without, it is
 * removed. Does nothing to an output that was never opened ({0}). */
int output_close(output *out, bool keep);

/* After the last output_close: with SIM_OK puts all files in place, with anything else removes them.
 * Returns the result given, or SIM_BAD_INPUT where the disk refuses. */
int outputs_finish(int result);

#endif
