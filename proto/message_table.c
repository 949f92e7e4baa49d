/* message_table.c - the table of messages.h, made from message_list.h. */
#include "messages.h"

#include <string.h>

#include "crc32c.h"

#define CODE_u8 WIRE_U8
#define CODE_u16 WIRE_U16
#define CODE_i16 WIRE_I16
#define CODE_u32 WIRE_U32
#define CODE_f32 WIRE_F32

#define AT(member) offsetof(message, member)
#define FIELD_ONE(of, type, name, meaning) {#name, AT(of.name), CODE_##type, 1},
#define FIELD_MANY(of, type, n, name, meaning) {#name, AT(of.name), CODE_##type, n},
#define FIELD_NAME(of, n, name, meaning) {#name, AT(of.name), WIRE_NAME, n},

#define FIELDS(NAME, member, type, tail, direction, drop, meaning)                                 \
    static const message_field FIELDS_##member[] = {                                               \
        NAME##_FIELDS(member, FIELD_ONE, FIELD_MANY, FIELD_NAME)};
MESSAGES(FIELDS)

#define BYTES_ONE(of, type, name, meaning) +sizeof(MESSAGE_C_##type)
#define BYTES_MANY(of, type, n, name, meaning) +(n) * sizeof(MESSAGE_C_##type)
#define BYTES_NAME(of, n, name, meaning) +(n)
#define FIXED_BYTES(NAME, member) (0 NAME##_FIELDS(member, BYTES_ONE, BYTES_MANY, BYTES_NAME))

#define ANGLES_BYTES sizeof(int16_t[2])
#define NODES_BYTES sizeof(float[3])
#define VALUES_BYTES sizeof(float)

/* Each tail: maximum, bytes of an element, where its count and its elements are, what they are made of. */
#define TAIL_NONE(of)                                                                              \
    {                                                                                              \
        0, 0, 0, 0, 0                                                                              \
    }
#define TAIL_ANGLES(of)                                                                            \
    {                                                                                              \
        MESSAGES_ANGLES_MAX, ANGLES_BYTES, AT(of.angles_n), AT(of.angles_tenth_mrad), WIRE_I16     \
    }
#define TAIL_NODES(of)                                                                             \
    {                                                                                              \
        MESSAGES_NODES_MAX, NODES_BYTES, AT(of.nodes_n), AT(of.nodes_m), WIRE_F32                  \
    }
#define TAIL_VALUES(of)                                                                            \
    {                                                                                              \
        MESSAGES_VALUES_MAX, VALUES_BYTES, AT(of.values_n), AT(of.values), WIRE_F32                \
    }
#define TAIL_TEXT(of)                                                                              \
    {                                                                                              \
        MESSAGES_TEXT_MAX, 1, 0, AT(of.text), WIRE_NAME                                            \
    }

#define INFO(NAME, member, type, tail, direction, drop, meaning)                                   \
    {#NAME,                                                                                        \
     type,                                                                                         \
     MESSAGE_##direction,                                                                          \
     MESSAGE_DROP_##drop,                                                                          \
     sizeof FIELDS_##member / sizeof FIELDS_##member[0],                                           \
     FIXED_BYTES(NAME, member),                                                                    \
     TAIL_##tail(member),                                                                          \
     FIELDS_##member},
const message_info messages[MESSAGES_N] = {MESSAGES(INFO)};

/* Whatever the tail, the longest message fits a frame. */
#define LONGEST_NONE 0
#define LONGEST_ANGLES (MESSAGES_ANGLES_MAX * ANGLES_BYTES)
#define LONGEST_NODES (MESSAGES_NODES_MAX * NODES_BYTES)
#define LONGEST_VALUES (MESSAGES_VALUES_MAX * VALUES_BYTES)
#define LONGEST_TEXT MESSAGES_TEXT_MAX
#define FITS(NAME, member, type, tail, direction, drop, meaning)                                   \
    _Static_assert(FIXED_BYTES(NAME, member) + LONGEST_##tail <= FRAME_PAYLOAD_MAX,                \
                   #NAME " does not fit a frame");
MESSAGES(FITS)
_Static_assert(sizeof(float) == 4, "f32 is IEEE 754 single precision");

const message_info *messages_info(uint8_t type)
{
    for (int i = 0; i < MESSAGES_N; i++) {
        if (messages[i].type == type) {
            return &messages[i];
        }
    }
    return NULL;
}

const char *messages_name(uint8_t type)
{
    const message_info *const info = messages_info(type);
    return info != NULL ? info->name : "?";
}

static uint32_t add_text(uint32_t crc, const char *text)
{
    return crc32c_add(crc, text, strlen(text) + 1);
}

uint32_t messages_layout_hash(void)
{
    uint32_t crc = CRC32C_START;
    for (int i = 0; i < MESSAGES_N; i++) {
        const message_info *const info = &messages[i];
        crc = add_text(crc, info->name);
        crc = crc32c_add_byte(crc, info->type);
        for (int k = 0; k < info->fields_n; k++) {
            const message_field *const field = &info->fields[k];
            crc = add_text(crc, field->name);
            crc = crc32c_add_byte(crc, field->type);
            crc = crc32c_add_byte(crc, field->n);
        }
        crc = crc32c_add_byte(crc, info->tail.type);
        crc = crc32c_add_byte(crc, (uint8_t)info->tail.element_bytes);
    }
    return crc32c_finish(crc);
}
