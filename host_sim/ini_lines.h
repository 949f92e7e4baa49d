/* ini_lines.h - an INI file, piece by piece, each with its place for complaints. */
#ifndef LIMBER_INI_LINES_H
#define LIMBER_INI_LINES_H

#include <stdbool.h>

typedef struct {
    char origin[160];                  /* "foil.ini:7" */
    const char *section, *key, *value; /* a [section] begins: key and value are NULL */
    bool continued;                    /* the value goes on from the line above */
} ini_piece;

/* Returns SIM_OK, or an exit code after complaining: reading ends there. */
typedef int (*ini_take)(void *context, const ini_piece *piece);

/* Hands over every piece of a file, with remarks cut off. Returns SIM_OK with the number of lines in *lines_n, or an
 * exit code after complaining with file and line. */
int ini_lines_read(const char *path, ini_take take, void *context, long *lines_n);

#endif
