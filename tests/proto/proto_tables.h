/* proto_tables.h - what proto_tables is made of: the parts that PROTOCOL.md and limber.ksy get from the
 * lists, and those lists' words, which the code itself has no use for. */
#ifndef LIMBER_PROTO_TABLES_H
#define LIMBER_PROTO_TABLES_H

#include <stdio.h>

#include "messages.h"

typedef struct {
    const char *meaning, *member, *tail;
    const char *const *field_meanings;
} message_words;

/* As messages[], in the same order. */
extern const message_words message_words_of[MESSAGES_N];

/* Every list of values. */
extern const message_values *const values_lists[];
extern const int values_lists_n;

/* "to the device", ... */
extern const char *const direction_words[];

void put_markdown_messages(FILE *out);
void put_markdown_values(FILE *out);
void put_markdown_example(FILE *out);

void put_kaitai_cases(FILE *out);
void put_kaitai_types(FILE *out);
void put_kaitai_enums(FILE *out);

#endif
