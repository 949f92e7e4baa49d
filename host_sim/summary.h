/* summary.h - what a replay says of itself, on the terminal and in the report. */
#ifndef LIMBER_SUMMARY_H
#define LIMBER_SUMMARY_H

#include <stdio.h>

#include "replay.h"

enum { SUMMARY_WARNINGS_MAX = 8, SUMMARY_ROWS_MAX = 20, SUMMARY_TEXT_MAX = 240 };

typedef char summary_text[SUMMARY_TEXT_MAX];

typedef struct {
    int rows_n, warnings_n;
    summary_text labels[SUMMARY_ROWS_MAX], values[SUMMARY_ROWS_MAX];
    summary_text warnings[SUMMARY_WARNINGS_MAX];
} summary;

/* preset may be NULL. */
void summary_make(const replay *r, const char *preset, summary *out);
void summary_print(const replay *r, const char *preset, FILE *out);

#endif
