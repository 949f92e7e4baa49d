/* string.h - all that the core asks of a C library; defined in replay.c. */
#ifndef LIMBER_WASM_STRING_H
#define LIMBER_WASM_STRING_H

#include <stddef.h>

void *memset(void *to, int value, size_t n);
void *memcpy(void *restrict to, const void *restrict from, size_t n);
int strcmp(const char *a, const char *b);

#endif
