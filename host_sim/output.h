/* output.h - files that are whole or not there: written beside their name, renamed when complete. */
#ifndef LIMBER_OUTPUT_H
#define LIMBER_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct {
    const char *path; /* borrowed */
    char *partial;    /* the file being written; NULL where path is a pipe or a device */
    FILE *file;
} output;

/* Returns SIM_OK, or SIM_BAD_INPUT after complaining. An interrupted program removes its partials. */
int output_open(output *out, const char *path);

/* With keep, puts the file in place (SIM_BAD_INPUT where the disk refuses); without, removes it. Does
 * nothing to an output that was never opened ({0}). */
int output_close(output *out, bool keep);

#endif
