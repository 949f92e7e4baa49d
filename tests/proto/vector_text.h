/* vector_text.h - frames as text: what proto/vectors is written in, and what the peers' test reads.
 *
 *     name: what this is
 *     hex: 00 ... 00                 bytes on the line
 *     expect: POSE crc               one word for each stretch between zeros, in order: a message's name, or
 *                                    crc, cobs, short, long (no frame), unknown, length (no message)
 *       session 7                    header and fields of a single message: numbers, or "text" in JSON
 *       position_m 0 1 -0.25
 */
#ifndef LIMBER_VECTOR_TEXT_H
#define LIMBER_VECTOR_TEXT_H

#include <stdio.h>

#include "messages.h"

void put_hex_line(FILE *out, const uint8_t *bytes, size_t bytes_n);

/* The words of `expect`, as the decoder finds them, a space before each. */
void put_events(FILE *out, const uint8_t *bytes, size_t bytes_n);

/* A whole record of one good message. */
void put_message_record(FILE *out, const char *name, const message *m, const frame *header);

/* As many bytes as there are two digits each; stops at the end of the line. */
size_t get_hex(const char *text, uint8_t *bytes, size_t room);

/* The files of proto/vectors (vector_records.c). */
void put_good(FILE *out);
void put_damaged(FILE *out);

#endif
