/* vector_text.c - see vector_text.h. */
#include "vector_text.h"

#include <stdlib.h>
#include <string.h>

void put_hex_line(FILE *out, const uint8_t *bytes, size_t bytes_n)
{
    for (size_t i = 0; i < bytes_n; i++) {
        fprintf(out, " %02x", bytes[i]);
    }
    fputc('\n', out);
}

static const char *word_of(const frame *f)
{
    static message m;
    const messages_error error = messages_unpack(f, &m);
    return error == MESSAGES_OK       ? messages_name(f->type)
           : error == MESSAGES_E_TYPE ? "unknown"
                                      : "length";
}

static uint32_t bad_n(const frame_counts *c)
{
    return c->crc + c->cobs + c->too_short + c->too_long;
}

void put_events(FILE *out, const uint8_t *bytes, size_t bytes_n)
{
    static frame_decoder decoder;
    frame_decoder_init(&decoder);
    for (size_t i = 0; i < bytes_n; i++) {
        const frame_counts before = decoder.counts;
        frame f;
        if (frame_decoder_push(&decoder, bytes[i], &f)) {
            fprintf(out, " %s", word_of(&f));
        } else if (bad_n(&decoder.counts) > bad_n(&before)) {
            fputs(decoder.counts.crc > before.crc             ? " crc"
                  : decoder.counts.cobs > before.cobs         ? " cobs"
                  : decoder.counts.too_long > before.too_long ? " long"
                                                              : " short",
                  out);
        }
    }
}

static void put_number(FILE *out, const char *at, uint8_t type)
{
    uint8_t u8;
    uint16_t u16;
    int16_t i16;
    uint32_t u32;
    float f32;
    switch (type) {
    case WIRE_U8:
        memcpy(&u8, at, sizeof u8);
        fprintf(out, " %u", u8);
        break;
    case WIRE_U16:
        memcpy(&u16, at, sizeof u16);
        fprintf(out, " %u", u16);
        break;
    case WIRE_I16:
        memcpy(&i16, at, sizeof i16);
        fprintf(out, " %d", i16);
        break;
    case WIRE_U32:
        memcpy(&u32, at, sizeof u32);
        fprintf(out, " %lu", (unsigned long)u32);
        break;
    default:
        memcpy(&f32, at, sizeof f32);
        fprintf(out, " %.9g", (double)f32);
    }
}

static size_t number_width(uint8_t type)
{
    return type == WIRE_U16 || type == WIRE_I16 ? 2 : type == WIRE_U32 || type == WIRE_F32 ? 4 : 1;
}

static void put_text(FILE *out, const char *text)
{
    fputs(" \"", out);
    for (; *text != '\0'; text++) {
        fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    }
    fputc('"', out);
}

static void put_fields(FILE *out, const message *m)
{
    const message_info *const info = messages_info(m->type);
    const char *const base = (const char *)m;
    for (int i = 0; i < info->fields_n; i++) {
        const message_field *const field = &info->fields[i];
        fprintf(out, "  %s", field->name);
        for (size_t k = 0; k < field->n && field->type != WIRE_NAME; k++) {
            put_number(out, base + field->offset + k * number_width(field->type), field->type);
        }
        if (field->type == WIRE_NAME) {
            put_text(out, base + field->offset);
        }
        fputc('\n', out);
    }
    const message_tail *const tail = &info->tail;
    if (tail->type == WIRE_NAME) {
        fputs("  text", out);
        put_text(out, base + tail->offset);
        fputc('\n', out);
    } else if (tail->max > 0) {
        uint16_t count;
        memcpy(&count, base + tail->count_offset, sizeof count);
        fputs("  tail", out);
        for (size_t at = 0; at < count * (size_t)tail->element_bytes;
             at += number_width(tail->type)) {
            put_number(out, base + tail->offset + at, tail->type);
        }
        fputc('\n', out);
    }
}

void put_message_record(FILE *out, const char *name, const message *m, const frame *header)
{
    uint8_t wire[FRAME_WIRE_MAX];
    const size_t wire_n =
        messages_encode(m, header->session, header->seq, header->t_us, wire, sizeof wire);
    fprintf(out, "name: %s\nhex:", name);
    put_hex_line(out, wire, wire_n);
    fprintf(out, "expect: %s\n  session %u\n  seq %u\n  t_us %lu\n", messages_name(m->type),
            header->session, header->seq, (unsigned long)header->t_us);
    put_fields(out, m);
    fputc('\n', out);
}

size_t get_hex(const char *text, uint8_t *bytes, size_t room)
{
    size_t n = 0;
    char *end;
    for (; n < room && *text != '\n' && *text != '\0'; text = end) {
        const unsigned long value = strtoul(text, &end, 16);
        if (end == text) {
            break;
        }
        bytes[n++] = (uint8_t)value;
        while (*end == ' ') {
            end++; /* else strtoul would look for digits beyond the end of the line */
        }
    }
    return n;
}
