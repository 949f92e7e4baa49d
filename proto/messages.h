/* messages.h - what device and PC say to each other: plain structs, to and from the payload of a frame.
 *
 *     message m = {.type = MESSAGE_PONG, .pong = {.token = 7}};
 *     size_t n = messages_encode(&m, session, seq, now_us, wire, sizeof wire);     // to the line
 *
 *     if (frame_decoder_push(&decoder, byte, &f) && messages_unpack(&f, &m) == MESSAGES_OK) {
 *         switch (m.type) { case MESSAGE_POSE: use(&m.pose); ... }
 *     }
 *
 * The structs' members are the fields of message_list.h, in order, under the same names; the meanings
 * and units are there and in PROTOCOL.md. No value is judged here: a float may be anything, an enumerated
 * field may hold what this build does not know, a text may not be UTF-8. Lengths are exact.
 *
 * Plain data on caller-owned memory; nothing is kept. Everything but messages_encode, for its stack,
 * may be called from an interrupt.
 */
#ifndef LIMBER_MESSAGES_H
#define LIMBER_MESSAGES_H

#include <stddef.h>
#include <stdint.h>

#include "frame.h"
#include "message_list.h"
#include "message_values.h"

enum {
    PROTOCOL_MAJOR = 1,
    PROTOCOL_MINOR = 3,
    MESSAGES_ANGLES_MAX = 256, /* joints */
    MESSAGES_NODES_MAX = 91,   /* nodes in one chunk: 4.3 chunks in a rod of 256 links */
    MESSAGES_VALUES_MAX = 256, /* entries of a parameter */
    MESSAGES_TEXT_MAX = 96,    /* bytes */
    MESSAGES_NAME_MAX = 24,    /* bytes of a parameter's or preset's name */
};

/* A joint angle in ANGLES: 0.1 mrad, or this where there is none. */
#define MESSAGES_ANGLE_INVALID INT16_MIN

typedef enum {
    MESSAGES_OK = 0,
    MESSAGES_E_TYPE = -1,   /* no message of that type is known */
    MESSAGES_E_LENGTH = -2, /* the payload's length, or the tail's count, cannot be of that type */
    MESSAGES_E_ROOM = -3,   /* the caller's buffer is too small */
} messages_error;

/* One clear sentence for each; never NULL. */
const char *messages_error_text(messages_error error);

/* --- made from message_list.h ------------------------------------------------------------------- */

#define MESSAGE_C_u8 uint8_t
#define MESSAGE_C_u16 uint16_t
#define MESSAGE_C_i16 int16_t
#define MESSAGE_C_u32 uint32_t
#define MESSAGE_C_f32 float

#define MESSAGE_MEMBER_ONE(of, type, name, meaning) MESSAGE_C_##type name;
#define MESSAGE_MEMBER_MANY(of, type, n, name, meaning) MESSAGE_C_##type name[n];
#define MESSAGE_MEMBER_NAME(of, n, name, meaning) char name[(n) + 1];

/* Tails are counted, but for texts, which end in a zero. */
#define MESSAGE_TAIL_NONE
#define MESSAGE_TAIL_ANGLES                                                                        \
    uint16_t angles_n;                                                                             \
    int16_t angles_tenth_mrad[MESSAGES_ANGLES_MAX][2]; /* theta, phi */
#define MESSAGE_TAIL_NODES                                                                         \
    uint16_t nodes_n;                                                                              \
    float nodes_m[MESSAGES_NODES_MAX][3];
#define MESSAGE_TAIL_VALUES                                                                        \
    uint16_t values_n;                                                                             \
    float values[MESSAGES_VALUES_MAX];
#define MESSAGE_TAIL_TEXT char text[MESSAGES_TEXT_MAX + 1];

/* message_hello, message_ping, ... */
#define MESSAGE_STRUCT(NAME, member, type, tail, direction, drop, meaning)                         \
    typedef struct {                                                                               \
        NAME##_FIELDS(member, MESSAGE_MEMBER_ONE, MESSAGE_MEMBER_MANY,                             \
                      MESSAGE_MEMBER_NAME) MESSAGE_TAIL_##tail                                     \
    } message_##member;
MESSAGES(MESSAGE_STRUCT)

/* MESSAGE_HELLO, MESSAGE_PING, ... */
#define MESSAGE_CONSTANT(NAME, member, type, tail, direction, drop, meaning) MESSAGE_##NAME = type,
typedef enum { MESSAGES(MESSAGE_CONSTANT) } message_type;

#define MESSAGE_COUNT(NAME, member, type, tail, direction, drop, meaning) +1
enum { MESSAGES_N = 0 MESSAGES(MESSAGE_COUNT) };

/* Any message: 1.1 KB. Only the member that `type` names means anything. */
#define MESSAGE_UNION(NAME, member, type, tail, direction, drop, meaning) message_##member member;
typedef struct {
    uint8_t type; /* message_type */
    union {
        MESSAGES(MESSAGE_UNION)
    };
} message;

/* --- packing ------------------------------------------------------------------------------------ */

/* The frame's payload as a message. Texts end in a zero; what a name or text has after its first zero is
 * ignored. Errors: MESSAGES_E_TYPE, MESSAGES_E_LENGTH; *out is then not to be used.
 * Cost: a look-up (at most MESSAGES_N compares) and a few instructions a field; at most 1.1 KB copied. */
messages_error messages_unpack(const frame *f, message *out);

/* The message as a payload. Returns its length in bytes, at most FRAME_PAYLOAD_MAX, or an error: all
 * three are possible, MESSAGES_E_LENGTH for a tail beyond its maximum. Cost as above. */
int messages_pack(const message *m, uint8_t *payload, size_t room);

/* messages_pack and frame_encode in one: straight to the line's bytes. Returns how many, or 0 for any
 * error; room for FRAME_WIRE_MAX is always enough. Takes 1.2 KB of stack. */
size_t messages_encode(const message *m, uint8_t session, uint16_t seq, uint32_t t_us,
                       uint8_t *wire, size_t room);

/* --- the table ---------------------------------------------------------------------------------- */

typedef enum { WIRE_U8, WIRE_U16, WIRE_I16, WIRE_U32, WIRE_F32, WIRE_NAME } wire_type;

typedef struct {
    const char *name;
    uint16_t offset; /* into message */
    uint8_t type;    /* wire_type */
    uint8_t n;       /* of a NAME: its bytes on the wire; one more in the struct */
} message_field;

typedef struct {
    uint16_t max;           /* elements; 0: no tail */
    uint16_t element_bytes; /* on the wire */
    uint16_t count_offset;  /* of its uint16_t count, into message; a text has none: 0 */
    uint16_t offset;        /* of its first element, into message */
    uint8_t type;           /* wire_type of what elements are made of; texts: WIRE_NAME */
} message_tail;

typedef enum { MESSAGE_TO_DEVICE = 1, MESSAGE_FROM_DEVICE = 2, MESSAGE_BOTH = 3 } message_direction;

/* What is left out first, in this order, when the line is full; KEPT never is. */
typedef enum {
    MESSAGE_DROP_LOGS,
    MESSAGE_DROP_TELEMETRY,
    MESSAGE_DROP_NODES,
    MESSAGE_DROP_ANGLES,
    MESSAGE_DROP_KEPT
} message_drop;

typedef struct {
    const char *name; /* "HELLO" */
    uint8_t type;
    uint8_t direction; /* message_direction */
    uint8_t drop;      /* message_drop */
    uint8_t fields_n;
    uint16_t fixed_bytes; /* all of the payload but the tail */
    message_tail tail;
    const message_field *fields;
} message_info;

extern const message_info messages[MESSAGES_N];

/* The entry of that type, or NULL. */
const message_info *messages_info(uint8_t type);

/* Its name, or "?". */
const char *messages_name(uint8_t type);

/* CRC-32C of names, types, fields and tails of all messages, in order: changes with any of them.
 * Takes about 4 KB through the checksum: ask once. */
uint32_t messages_layout_hash(void);

#endif
