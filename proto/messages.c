/* messages.c - see messages.h. */
#include "messages.h"

#include <string.h>

const char *messages_error_text(messages_error error)
{
    static const char *const TEXT[] = {
        "fine",
        "no message of that type is known",
        "the length does not fit the message's type",
        "the buffer is too small",
    };
    const int index = -(int)error;
    return index >= 0 && index < (int)(sizeof TEXT / sizeof TEXT[0]) ? TEXT[index]
                                                                     : "unknown error";
}

/* --- numbers and names ---------------------------------------------------------------------------- */

static size_t width_bytes(uint8_t type)
{
    switch (type) {
    case WIRE_U16:
    case WIRE_I16:
        return 2;
    case WIRE_U32:
    case WIRE_F32:
        return 4;
    default:
        return 1;
    }
}

/* Numbers go as they lie in memory: signed ones and floats by their bits, low byte first. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the wire's byte order is the machine's");

static size_t text_length(const char *text, size_t max)
{
    size_t n = 0;
    while (n < max && text[n] != '\0') {
        n++;
    }
    return n;
}

/* The string's bytes up to its zero, then zeros up to `n`. */
static void put_name(uint8_t *to, const char *name, size_t n)
{
    const size_t used_n = text_length(name, n);
    memcpy(to, name, used_n);
    memset(to + used_n, 0, n - used_n);
}

/* Into room for room_n + 1 characters, all of which are written: no bytes of an earlier message stay. */
static void get_name(char *to, const uint8_t *from, size_t n, size_t room_n)
{
    const size_t used_n = text_length((const char *)from, n);
    memcpy(to, from, used_n);
    memset(to + used_n, 0, room_n + 1 - used_n);
}

/* --- messages ------------------------------------------------------------------------------------ */

messages_error messages_unpack(const frame *f, message *out)
{
    const message_info *const info = messages_info(f->type);
    if (info == NULL) {
        return MESSAGES_E_TYPE;
    }
    const message_tail *const tail = &info->tail;
    if (f->payload_n < info->fixed_bytes) {
        return MESSAGES_E_LENGTH;
    }
    const size_t tail_bytes = f->payload_n - info->fixed_bytes;
    const size_t tail_n = tail->max == 0 ? 0 : tail_bytes / tail->element_bytes;
    if (tail_n > tail->max || tail_n * tail->element_bytes != tail_bytes) {
        return MESSAGES_E_LENGTH;
    }

    char *const base = (char *)out;
    const uint8_t *from = f->payload;
    out->type = f->type;
    for (int i = 0; i < info->fields_n; i++) {
        const message_field *const field = &info->fields[i];
        const size_t width = width_bytes(field->type);
        if (field->type == WIRE_NAME) {
            get_name(base + field->offset, from, field->n, field->n);
        } else {
            memcpy(base + field->offset, from, field->n * width);
        }
        from += field->n * width;
    }
    if (tail->type == WIRE_NAME) {
        get_name(base + tail->offset, from, tail_n, tail->max);
    } else if (tail->max > 0) {
        const uint16_t count = (uint16_t)tail_n;
        memcpy(base + tail->count_offset, &count, sizeof count);
        memcpy(base + tail->offset, from, tail_bytes);
    }
    return MESSAGES_OK;
}

static size_t tail_count(const message *m, const message_tail *tail)
{
    const char *const base = (const char *)m;
    if (tail->max == 0) {
        return 0;
    }
    if (tail->type == WIRE_NAME) {
        return text_length(base + tail->offset, tail->max);
    }
    uint16_t count;
    memcpy(&count, base + tail->count_offset, sizeof count);
    return count;
}

int messages_pack(const message *m, uint8_t *payload, size_t room)
{
    const message_info *const info = messages_info(m->type);
    if (info == NULL) {
        return MESSAGES_E_TYPE;
    }
    const message_tail *const tail = &info->tail;
    const size_t tail_n = tail_count(m, tail);
    if (tail_n > tail->max) {
        return MESSAGES_E_LENGTH;
    }
    const size_t tail_bytes = tail_n * tail->element_bytes;
    if (room < info->fixed_bytes + tail_bytes) {
        return MESSAGES_E_ROOM;
    }

    const char *const base = (const char *)m;
    uint8_t *to = payload;
    for (int i = 0; i < info->fields_n; i++) {
        const message_field *const field = &info->fields[i];
        const size_t width = width_bytes(field->type);
        if (field->type == WIRE_NAME) {
            put_name(to, base + field->offset, field->n);
        } else {
            memcpy(to, base + field->offset, field->n * width);
        }
        to += field->n * width;
    }
    memcpy(to, base + tail->offset, tail_bytes);
    return (int)(info->fixed_bytes + tail_bytes);
}

size_t messages_encode(const message *m, uint8_t session, uint16_t seq, uint32_t t_us,
                       uint8_t *wire, size_t room)
{
    uint8_t payload[FRAME_PAYLOAD_MAX];
    const int payload_n = messages_pack(m, payload, sizeof payload);
    if (payload_n < 0) {
        return 0;
    }
    const frame f = {m->type, session, seq, t_us, payload, (size_t)payload_n};
    return frame_encode(&f, wire, room);
}
