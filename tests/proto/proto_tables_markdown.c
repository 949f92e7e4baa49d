/* proto_tables_markdown.c - the tables and the example of PROTOCOL.md. */
#include <inttypes.h>
#include <string.h>

#include "crc32c.h"
#include "proto_tables.h"

static const char *const TYPES[] = {"u8", "u16", "i16", "u32", "f32", "UTF-8"};
static const size_t TYPE_BYTES[] = {1, 2, 2, 4, 4, 1};
static const char *const DROPS[] = {"first (logs)", "second (telemetry)", "third (nodes)",
                                    "fourth (angles)", "never"};

static void put_cell(FILE *out, const char *text)
{
    for (; *text != '\0'; text++) {
        fprintf(out, "%s%c", *text == '|' ? "\\" : "", *text);
    }
}

static void put_row(FILE *out, size_t offset, const char *type, int n, const char *name,
                    const char *meaning)
{
    fprintf(out, "| %zu | %s", offset, type);
    if (n > 1) {
        fprintf(out, " × %d", n);
    }
    fprintf(out, " | `%s` | ", name);
    put_cell(out, meaning);
    fprintf(out, " |\n");
}

static void put_tail_rows(FILE *out, size_t offset, const char *tail)
{
    static const char *const ROWS[][2] = {
        {"ANGLES", "i16 × 2 × N | `angles_tenth_mrad` | θ and φ of each joint, 0.1 mrad; "
                   "-32768: none; N follows from the length, 0 … 256"},
        {"NODES", "f32 × 3 × n | `nodes_m` | x y z, world; n follows from the length, 0 … 91"},
        {"VALUES", "f32 × n | `values` | n follows from the length, 0 … 256"},
        {"TEXT", "UTF-8 × n | `text` | for people; n follows from the length, 0 … 96"},
    };
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        if (strcmp(tail, ROWS[i][0]) == 0) {
            fprintf(out, "| %zu | %s |\n", offset, ROWS[i][1]);
        }
    }
}

void put_markdown_messages(FILE *out)
{
    for (int i = 0; i < MESSAGES_N; i++) {
        const message_info *const info = &messages[i];
        fprintf(out, "### 0x%02X %s\n\n%s\n\n%s; ", info->type, info->name,
                message_words_of[i].meaning, direction_words[info->direction]);
        fprintf(out, "left out when the line is full: %s. ", DROPS[info->drop]);
        fprintf(out, "Payload %u", info->fixed_bytes);
        if (info->tail.max > 0) {
            fprintf(out, " + %un, n up to %u", info->tail.element_bytes, info->tail.max);
        }
        fprintf(out, " bytes; on the line %d%s.\n\n", FRAME_WIRE_BYTES(info->fixed_bytes),
                info->tail.max > 0 ? " with n = 0" : "");
        fprintf(out, "| offset | type | field | meaning |\n|---|---|---|---|\n");
        size_t offset = 0;
        for (int k = 0; k < info->fields_n; k++) {
            const message_field *const field = &info->fields[k];
            put_row(out, offset, TYPES[field->type], field->n, field->name,
                    message_words_of[i].field_meanings[k]);
            offset += field->n * TYPE_BYTES[field->type];
        }
        put_tail_rows(out, offset, message_words_of[i].tail);
        fprintf(out, "\n");
    }
    fprintf(out, "Layout hash of this version: `0x%08" PRIX32 "`.\n", messages_layout_hash());
}

void put_markdown_values(FILE *out)
{
    for (int i = 0; i < values_lists_n; i++) {
        fprintf(out, "### %s%s\n\n| %s | name | meaning |\n|---|---|---|\n", values_lists[i]->title,
                values_lists[i]->flags ? " (bits)" : "", values_lists[i]->flags ? "bit" : "value");
        for (int k = 0; k < values_lists[i]->values_n; k++) {
            const message_value *const value = &values_lists[i]->values[k];
            fprintf(out, values_lists[i]->flags ? "| 0x%02X" : "| %d", value->value);
            fprintf(out, " | %s | ", value->name);
            put_cell(out, value->meaning);
            fprintf(out, " |\n");
        }
        fprintf(out, "\n");
    }
}

static void put_hex(FILE *out, const char *what, const uint8_t *bytes, size_t bytes_n)
{
    fprintf(out, "%-9s", what);
    for (size_t i = 0; i < bytes_n; i++) {
        fprintf(out, "%s%02X", i == 0 ? "" : i % 24 == 0 ? "\n         " : " ", bytes[i]);
    }
    fprintf(out, "\n");
}

/* A pose a metre up, turned by 90 degrees about y, captured 2.5 ms before it was sent. */
void put_markdown_example(FILE *out)
{
    const message m = {.type = MESSAGE_POSE,
                       .pose = {.position_m = {0.0f, 1.0f, -0.25f},
                                .quaternion_xyzw = {0.0f, 0.70710677f, 0.0f, 0.70710677f},
                                .age_us = 2500,
                                .quality = 255,
                                .source = SOURCE_VR}};
    uint8_t body[FRAME_BODY_MAX] = {MESSAGE_POSE, 7, 0x02, 0x01, 0x40, 0x42, 0x0F, 0x00};
    uint8_t wire[FRAME_WIRE_MAX];
    const int payload_n = messages_pack(&m, body + FRAME_HEADER_BYTES, FRAME_PAYLOAD_MAX);
    const size_t covered_n = FRAME_HEADER_BYTES + (size_t)payload_n;
    const uint32_t crc = crc32c(body, covered_n);
    const uint8_t sum[4] = {(uint8_t)crc, (uint8_t)(crc >> 8), (uint8_t)(crc >> 16),
                            (uint8_t)(crc >> 24)};
    const size_t wire_n = messages_encode(&m, 7, 0x0102, 1000000, wire, sizeof wire);
    fprintf(out, "```\n");
    put_hex(out, "header", body, FRAME_HEADER_BYTES);
    put_hex(out, "payload", body + FRAME_HEADER_BYTES, (size_t)payload_n);
    put_hex(out, "CRC-32C", sum, sizeof sum);
    put_hex(out, "line", wire, wire_n);
    fprintf(out, "```\n");
}
