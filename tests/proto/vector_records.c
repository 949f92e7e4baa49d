/* vector_records.c - the golden frames: each message, and everything that can happen to one on the line. */
#include "proto_support.h"
#include "vector_text.h"

/* --- good ones ----------------------------------------------------------------------------------- */

static const message EXAMPLES[] = {
    {.type = MESSAGE_HELLO,
     .hello = {.request_id = 1,
               .protocol_major = 1,
               .links_max = 64,
               .links_n = 20,
               .tick_max_hz = 2000.0f,
               .tick_hz = 1000.0f,
               .angles_hz = 500.0f,
               .line_baud = 1000000,
               .layout_hash = 0x12345678,
               .features = 0xFF,
               .device = "limber-sim",
               .build = "0.1.0 31da6a8"}},
    {.type = MESSAGE_LOG,
     .log = {.level = LEVEL_WARNING,
             .text = "Spitze \xC3\xBC"
                     "ber 90\xC2\xB0"}},
    {.type = MESSAGE_LOG, .log = {.level = LEVEL_INFO}},
    {.type = MESSAGE_POSE,
     .pose = {.position_m = {0.0f, 1.0f, -0.25f},
              .quaternion_xyzw = {0.0f, 0.70710677f, 0.0f, 0.70710677f},
              .age_us = 2500,
              .quality = 255,
              .source = SOURCE_VR}},
    {.type = MESSAGE_ANGLES,
     .angles = {.tick = 123456,
                .pose_seq = 65535,
                .received_ago_us = 830,
                .solved_ago_us = 12,
                .state = DEVICE_ACTIVE,
                .flags = ANGLES_LIMITED_RATE | ANGLES_PREDICTED,
                .angles_n = 4,
                .angles_tenth_mrad = {{0, 1},
                                      {-1, 15708},
                                      {-15708, 32767},
                                      {MESSAGES_ANGLE_INVALID, MESSAGES_ANGLE_INVALID}}}},
    {.type = MESSAGE_ESTOP, .estop = {.request_id = 2}},
    {.type = MESSAGE_PARAM_SET,
     .param_set = {.request_id = 3,
                   .first = 4,
                   .name = "spring",
                   .values_n = 3,
                   .values = {80.0f, 60.0f, 40.0f}}},
    {.type = MESSAGE_NACK,
     .nack = {.request_id = 3,
              .answered = MESSAGE_PARAM_SET,
              .reason = REASON_BOUNDS,
              .entry = 5,
              .value = -1.0f,
              .minimum = 0.0f,
              .maximum = 1e6f,
              .field = "spring",
              .text = "spring of joint 6 is -1, allowed is 0 to 1e+06 N m"}},
    {.type = MESSAGE_SCENE_PUT,
     .scene_put = {.request_id = 4,
                   .index = 2,
                   .kind = OBJECT_CAPSULE,
                   .place_m = {0.0f, -0.5f, 1.25f},
                   .orientation_xyzw = {0.0f, 0.70710677f, 0.0f, 0.70710677f},
                   .half_m = {0.0f, 0.0f, 0.5f},
                   .radius_m = 0.05f,
                   .friction = 0.3f}},
    {.type = MESSAGE_SHAPE,
     .shape = {.request_id = 5,
               .strength_nm = 2.5f,
               .blend_s = 0.5f,
               .angles_n = 2,
               .angles_tenth_mrad = {{7854, 0}, {-7854, 1}}}},
    {.type = MESSAGE_TOUCH,
     .touch = {.tick = 654321, .contacts_n = 3, .force_newton = {0.0f, -1.5f, 0.25f}}},
};

void put_good(FILE *out)
{
    uint32_t seed = 20250101;
    fputs("# Good frames. Made by tests/proto/proto_vectors.c; the format is in vector_text.h.\n\n",
          out);
    frame header = {.session = 7, .seq = 0x0102, .t_us = 1000000};
    for (size_t i = 0; i < sizeof EXAMPLES / sizeof EXAMPLES[0]; i++) {
        put_message_record(out, "example", &EXAMPLES[i], &header);
    }
    static message m;
    for (int i = 0; i < MESSAGES_N; i++) {
        header = random_frame(NULL, 0, &seed);
        fill_message(&m, &messages[i], FILL_ZEROS, &seed);
        put_message_record(out, "all zero", &m, &header);
        fill_message(&m, &messages[i], FILL_RANDOM_FINITE, &seed);
        if (messages[i].tail.count_offset != 0) {
            const uint16_t few = 3;
            memcpy((char *)&m + messages[i].tail.count_offset, &few, sizeof few);
        }
        put_message_record(out, "any numbers", &m, &header);
    }
    fill_message(&m, messages_info(MESSAGE_NODES), FILL_RANDOM_FINITE, &seed);
    m.nodes.nodes_n = MESSAGES_NODES_MAX;
    put_message_record(out, "the longest payload", &m, &header);
}

/* --- damaged ones -------------------------------------------------------------------------------- */

static uint8_t bytes[4 * FRAME_WIRE_MAX];
static size_t bytes_n;

static void add(const void *from, size_t n)
{
    memcpy(bytes + bytes_n, from, n);
    bytes_n += n;
}

static uint8_t pose[FRAME_WIRE_MAX];
static size_t pose_n;

/* Adds the example pose: bytes first ... last - 1 of it. */
static void add_pose(size_t first, size_t last)
{
    add(pose + first, last - first);
}

static void add_frame(uint8_t type, uint8_t fill, size_t payload_n)
{
    static uint8_t payload[FRAME_PAYLOAD_MAX], wire[FRAME_WIRE_MAX];
    memset(payload, fill, sizeof payload);
    const frame f = {type, 1, 0x0101, 0x01010101, payload, payload_n};
    add(wire, frame_encode(&f, wire, sizeof wire));
}

/* Everything added since the last record. */
static void put_record(FILE *out, const char *name, const char *expect)
{
    fprintf(out, "name: %s\nhex:", name);
    put_hex_line(out, bytes, bytes_n);
    fprintf(out, "expect:%s%s\n\n", expect[0] != '\0' ? " " : "", expect);
    bytes_n = 0;
}

static void put_damaged_pose(FILE *out)
{
    add_pose(0, pose_n), bytes[20] ^= 0x10;
    put_record(out, "a bit of the payload flipped", "crc");
    add_pose(0, pose_n), bytes[1] ^= 0x40;
    put_record(out, "a bit of the first code flipped", "cobs");
    add_pose(0, pose_n), bytes[44] ^= 0x01;
    put_record(out, "a bit of the checksum flipped", "crc");
    add_pose(0, 10), add_pose(11, pose_n);
    put_record(out, "a code lost that stands for a zero", "crc");
    add_pose(0, 30), add_pose(31, pose_n);
    put_record(out, "a byte lost", "crc");
    add_pose(0, 46), add_pose(45, pose_n);
    put_record(out, "the last byte doubled", "cobs");
    add_pose(0, 20), add("", 1), add_pose(20, pose_n);
    put_record(out, "a zero put in", "cobs cobs");
    add_pose(0, 5), add_pose(0, pose_n);
    put_record(out, "cut off in a block, then a whole one", "cobs POSE");
    add_pose(0, 25), add_pose(0, pose_n);
    put_record(out, "cut off between two blocks, then a whole one", "crc POSE");
    add_pose(0, pose_n - 1), add_pose(1, pose_n);
    put_record(out, "both zeros between two frames lost", "crc");
    add_pose(0, pose_n - 1), add_pose(0, pose_n);
    put_record(out, "one of these zeros lost: nothing is", "POSE POSE");
    add_pose(1, pose_n), add_pose(0, pose_n);
    put_record(out, "first zero lost: nothing is", "POSE POSE");
    add("\x7E\x0D\x0A garbage", 11), add_pose(0, pose_n);
    put_record(out, "garbage before a frame", "cobs POSE");
    add("\0\0\0\0\0", 5), add_pose(0, pose_n), add("\0\0\0\0\0", 5);
    put_record(out, "zeros before and after", "POSE");
    add("\0\0\0\0\0", 5);
    put_record(out, "zeros", "");
}

static void put_no_messages(FILE *out)
{
    add("\0\x01\0", 3);
    put_record(out, "an empty body", "short");
    add("\0\x0C\1\1\1\1\1\1\1\1\1\1\1\0", 14);
    put_record(out, "one byte less than header and checksum", "short");
    add_frame(0xEE, 0xAA, 10);
    put_record(out, "a type from the future", "unknown");
    add_frame(MESSAGE_POSE, 0xAA, 31);
    put_record(out, "a pose that is a byte short", "length");
    add_frame(MESSAGE_POSE, 0, 33);
    put_record(out, "a pose that is a byte long", "length");
    add_frame(MESSAGE_ANGLES, 0, 12 + 4 * 3 + 2);
    put_record(out, "angles without the last phi", "length");
    add_frame(MESSAGE_ANGLES, 0, 12 + 4 * 257);
    put_record(out, "angles of 257 joints", "length");
    add_frame(MESSAGE_LOG, 'x', 1 + 96), add_frame(MESSAGE_LOG, 'x', 1 + 97);
    put_record(out, "a text of 96 bytes and one of 97", "LOG length");
    add_frame(0xEE, 0xAA, 254 - FRAME_BODY_MIN);
    bytes[bytes_n - 1] = 1, add("", 1); /* valid if the body has no zero: see the record */
    put_record(out, "an empty block after a full one, as some encoders write it", "unknown");
    memset(bytes, 0xFF, 6 * 255), bytes_n = 6 * 255, add("", 1), add_pose(0, pose_n);
    put_record(out, "a body that is too long, then a whole frame", "long POSE");
}

void put_damaged(FILE *out)
{
    fputs("# Damaged frames and what is left of them. Made by tests/proto/proto_vectors.c; the "
          "format is "
          "in vector_text.h.\n\n",
          out);
    pose_n = messages_encode(&EXAMPLES[3], 7, 0x0102, 1000000, pose, sizeof pose);
    put_damaged_pose(out);
    put_no_messages(out);
}
