/* report_parts.h - pieces of the report's JSON. For report.c. */
#ifndef LIMBER_REPORT_PARTS_H
#define LIMBER_REPORT_PARTS_H

#include <cjson/cJSON.h>
#include <stddef.h>

#include "replay.h"

/* Floats that go out as base64 of their little-endian bytes: a quarter of the size of numbers in text. */
typedef struct {
    unsigned char *bytes; /* NULL: there was no memory, and the page says which array is missing */
    size_t bytes_n;
} float_list;

/* An empty list with room for so many. */
float_list float_list_for(size_t values_n);
void float_list_append(float_list *list, float value);

/* Puts the list into an object under a name, and frees it. */
void float_list_add_to(cJSON *page, const char *name, float_list *list);

/* "objects" and "contacts". */
void report_add_touch(cJSON *page, const replay *r, long frame_step);

#endif
