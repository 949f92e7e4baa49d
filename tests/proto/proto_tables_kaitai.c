/* proto_tables_kaitai.c - the types of limber.ksy. */
#include <string.h>

#include "proto_tables.h"

static const char *const KAITAI_TYPES[] = {"u1", "u2", "s2", "u4", "f4", "strz"};

/* The list that a field's values come from, or NULL. */
static const message_values *values_of(const char *meaning)
{
    for (int i = 0; i < values_lists_n; i++) {
        if (strncmp(meaning, values_lists[i]->title, strlen(values_lists[i]->title)) == 0) {
            return values_lists[i];
        }
    }
    return NULL;
}

static void put_lower(FILE *out, const char *text, const char *end)
{
    for (; *text != '\0'; text++) {
        const bool upper = *text >= 'A' && *text <= 'Z';
        fputc(upper ? *text - 'A' + 'a' : *text == ' ' ? '_' : *text, out);
    }
    fputs(end, out);
}

static void put_tail(FILE *out, const char *tail)
{
    if (strcmp(tail, "ANGLES") == 0) {
        fprintf(out, "      - {id: angles_tenth_mrad, type: angle_pair, repeat: eos}\n");
    } else if (strcmp(tail, "NODES") == 0) {
        fprintf(out, "      - {id: nodes_m, type: vector, repeat: eos}\n");
    } else if (strcmp(tail, "VALUES") == 0) {
        fprintf(out, "      - {id: values, type: f4, repeat: eos}\n");
    } else if (strcmp(tail, "TEXT") == 0) {
        fprintf(out, "      - {id: text, type: str, size-eos: true, terminator: 0}\n");
    }
}

static void put_field(FILE *out, const message_field *field, const char *meaning)
{
    fprintf(out, "      - id: %s\n        type: %s\n", field->name, KAITAI_TYPES[field->type]);
    if (field->type == WIRE_NAME) {
        fprintf(out, "        size: %d\n", field->n);
    } else if (field->n > 1) {
        fprintf(out, "        repeat: expr\n        repeat-expr: %d\n", field->n);
    }
    const message_values *const values = values_of(meaning);
    if (values != NULL && !values->flags && field->type == WIRE_U8) {
        fputs("        enum: ", out);
        put_lower(out, values->title, "\n");
    }
    fprintf(out, "        doc: \"%s\"\n", meaning);
}

void put_kaitai_types(FILE *out)
{
    for (int i = 0; i < MESSAGES_N; i++) {
        fprintf(out, "  %s:\n    doc: \"%s; %s\"\n    seq:\n", message_words_of[i].member,
                message_words_of[i].meaning, direction_words[messages[i].direction]);
        for (int k = 0; k < messages[i].fields_n; k++) {
            put_field(out, &messages[i].fields[k], message_words_of[i].field_meanings[k]);
        }
        put_tail(out, message_words_of[i].tail);
    }
}

void put_kaitai_cases(FILE *out)
{
    for (int i = 0; i < MESSAGES_N; i++) {
        fprintf(out, "        'message_type::%s': %s\n", message_words_of[i].member,
                message_words_of[i].member);
    }
}

void put_kaitai_enums(FILE *out)
{
    fprintf(out, "  message_type:\n");
    for (int i = 0; i < MESSAGES_N; i++) {
        fprintf(out, "    0x%02x: %s\n", messages[i].type, message_words_of[i].member);
    }
    for (int i = 0; i < values_lists_n; i++) {
        fputs("  ", out);
        put_lower(out, values_lists[i]->title, ":\n");
        for (int k = 0; k < values_lists[i]->values_n; k++) {
            const message_value *const value = &values_lists[i]->values[k];
            fprintf(out, "    %d:\n      id: ", value->value);
            put_lower(out, value->name, "\n");
            fprintf(out, "      doc: \"%s\"\n", value->meaning);
        }
    }
}
