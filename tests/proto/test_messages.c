/* test_messages.c - every message there and back, every wrong length refused, and the layouts themselves. */
#include "messages.h"
#include "proto_support.h"
#include "unity.h"

static uint8_t payload[FRAME_PAYLOAD_MAX + 1], wire[FRAME_WIRE_MAX];
static message sent, got;

void setUp(void) {}
void tearDown(void) {}

static frame frame_of(uint8_t type, size_t payload_n)
{
    return (frame){.type = type, .payload = payload, .payload_n = payload_n};
}

static void every_message_comes_back(void)
{
    uint32_t seed = 31;
    for (int i = 0; i < MESSAGES_N; i++) {
        for (int round = 0; round < HOST_OR_BOARD(500, 20); round++) {
            const fill_kind kind = round < FILL_KINDS ? (fill_kind)round : FILL_RANDOM;
            fill_message(&sent, &messages[i], kind, &seed);
            const int n = messages_pack(&sent, payload, sizeof payload);
            TEST_ASSERT_TRUE_MESSAGE(n >= messages[i].fixed_bytes, messages[i].name);
            const frame f = frame_of(messages[i].type, (size_t)n);
            memset(&got, 0, sizeof got);
            TEST_ASSERT_EQUAL_INT(MESSAGES_OK, messages_unpack(&f, &got));
            TEST_ASSERT_TRUE_MESSAGE(memcmp(&sent, &got, sizeof sent) == 0, messages[i].name);
        }
    }
}

static void every_message_comes_back_over_the_line(void)
{
    uint32_t seed = 32;
    static frame_decoder decoder;
    frame_decoder_init(&decoder);
    for (int i = 0; i < MESSAGES_N; i++) {
        fill_message(&sent, &messages[i], FILL_RANDOM, &seed);
        const uint16_t seq = (uint16_t)(65000 + 100 * i);
        const size_t n = messages_encode(&sent, 7, seq, 0xFFFFFF00u, wire, sizeof wire);
        TEST_ASSERT_TRUE(n > 0);
        frame f;
        for (size_t k = 0; k < n; k++) {
            TEST_ASSERT_EQUAL_INT(k == n - 1, frame_decoder_push(&decoder, wire[k], &f));
        }
        TEST_ASSERT_EQUAL_UINT8(7, f.session);
        TEST_ASSERT_EQUAL_UINT16(seq, f.seq);
        TEST_ASSERT_EQUAL_HEX32(0xFFFFFF00u, f.t_us);
        memset(&got, 0, sizeof got);
        TEST_ASSERT_EQUAL_INT(MESSAGES_OK, messages_unpack(&f, &got));
        TEST_ASSERT_TRUE(memcmp(&sent, &got, sizeof sent) == 0);
    }
}

/* All lengths a frame can have, against the rule written a second time. */
static void only_its_own_lengths_are_taken(void)
{
    memset(payload, 'x', sizeof payload);
    for (int i = 0; i < MESSAGES_N; i++) {
        const size_t fixed_n = messages[i].fixed_bytes;
        const size_t element = messages[i].tail.element_bytes, most = messages[i].tail.max;
        for (size_t n = 0; n <= FRAME_PAYLOAD_MAX; n++) {
            bool fits = n == fixed_n;
            for (size_t elements = 0; elements <= most && !fits; elements++) {
                fits = n == fixed_n + elements * element;
            }
            const frame f = frame_of(messages[i].type, n);
            TEST_ASSERT_EQUAL_INT(fits ? MESSAGES_OK : MESSAGES_E_LENGTH,
                                  messages_unpack(&f, &got));
        }
    }
}

static void unknown_types_are_refused(void)
{
    int known = 0;
    for (int type = 0; type < 256; type++) {
        sent.type = (uint8_t)type;
        const frame f = frame_of((uint8_t)type, 0);
        if (messages_info((uint8_t)type) != NULL) {
            known++;
            continue;
        }
        TEST_ASSERT_EQUAL_INT(MESSAGES_E_TYPE, messages_unpack(&f, &got));
        TEST_ASSERT_EQUAL_INT(MESSAGES_E_TYPE, messages_pack(&sent, payload, sizeof payload));
        TEST_ASSERT_EQUAL_size_t(0, messages_encode(&sent, 1, 1, 1, wire, sizeof wire));
        TEST_ASSERT_EQUAL_STRING("?", messages_name((uint8_t)type));
    }
    TEST_ASSERT_EQUAL_INT(MESSAGES_N, known);
}

static void packing_keeps_within_the_room(void)
{
    uint32_t seed = 33;
    for (int i = 0; i < MESSAGES_N; i++) {
        fill_message(&sent, &messages[i], FILL_ONES, &seed);
        const int n = messages_pack(&sent, payload, FRAME_PAYLOAD_MAX);
        TEST_ASSERT_TRUE_MESSAGE(n > 0, messages[i].name);
        memset(payload, 0xA5, sizeof payload);
        TEST_ASSERT_EQUAL_INT(MESSAGES_E_ROOM, messages_pack(&sent, payload, (size_t)n - 1));
        TEST_ASSERT_EACH_EQUAL_HEX8(0xA5, payload, sizeof payload);
        TEST_ASSERT_EQUAL_INT(n, messages_pack(&sent, payload, (size_t)n));
        TEST_ASSERT_EQUAL_HEX8(0xA5, payload[n]);
        if (messages[i].tail.max > 0 && messages[i].tail.type != WIRE_NAME) {
            const uint16_t too_many = (uint16_t)(messages[i].tail.max + 1);
            memcpy((char *)&sent + messages[i].tail.count_offset, &too_many, sizeof too_many);
            TEST_ASSERT_EQUAL_INT(MESSAGES_E_LENGTH, messages_pack(&sent, payload, sizeof payload));
        }
    }
}

static void bytes_are_where_the_book_says(void)
{
    sent = (message){.type = MESSAGE_POSE,
                     .pose = {.position_m = {1.0f, -2.0f, 0.5f},
                              .quaternion_xyzw = {0.0f, 0.0f, 0.0f, 1.0f},
                              .age_us = 0x1234,
                              .quality = 255,
                              .source = SOURCE_RECORDED}};
    static const uint8_t POSE[32] = {0,    0, 0x80, 0x3F, 0,    0,    0,    0xC0, 0,   0, 0,
                                     0x3F, 0, 0,    0,    0,    0,    0,    0,    0,   0, 0,
                                     0,    0, 0,    0,    0x80, 0x3F, 0x34, 0x12, 255, 1};
    TEST_ASSERT_EQUAL_INT(32, messages_pack(&sent, payload, sizeof payload));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(POSE, payload, 32);

    sent = (message){
        .type = MESSAGE_PARAM_SET,
        .param_set = {
            .request_id = 0x0102, .first = 3, .name = "spring", .values_n = 1, .values = {-1.0f}}};
    static const uint8_t SET[32] = {2,   1,   3,   0,   's',         'p',
                                    'r', 'i', 'n', 'g', [30] = 0x80, [31] = 0xBF};
    TEST_ASSERT_EQUAL_INT(32, messages_pack(&sent, payload, sizeof payload));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(SET, payload, 32);

    sent = (message){.type = MESSAGE_ANGLES,
                     .angles = {.tick = 0x01020304,
                                .angles_n = 1,
                                .angles_tenth_mrad = {{-2, MESSAGES_ANGLE_INVALID}}}};
    static const uint8_t ANGLES[16] = {4, 3, 2, 1, [12] = 0xFE, 0xFF, 0x00, 0x80};
    TEST_ASSERT_EQUAL_INT(16, messages_pack(&sent, payload, sizeof payload));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(ANGLES, payload, 16);
}

/* PROTOCOL.md and the plan of the line count on these. */
static void sizes_on_the_line(void)
{
    memset(&sent, 0, sizeof sent);
    sent.type = MESSAGE_POSE;
    TEST_ASSERT_EQUAL_size_t(47, messages_encode(&sent, 0, 0, 0, wire, sizeof wire));
    sent.type = MESSAGE_ANGLES;
    for (uint16_t links_n = 0; links_n <= 57; links_n++) {
        sent.angles.angles_n = links_n;
        TEST_ASSERT_EQUAL_size_t(27 + 4 * (size_t)links_n,
                                 messages_encode(&sent, 0, 0, 0, wire, sizeof wire));
    }
    sent.angles.angles_n = 64;
    memset(sent.angles.angles_tenth_mrad, 0x55, sizeof sent.angles.angles_tenth_mrad);
    TEST_ASSERT_TRUE(messages_encode(&sent, 1, 1, 1, wire, sizeof wire) <= 27 + 4 * 64 + 1);
}

static void texts_end_at_their_zero(void)
{
    const size_t fixed_n = messages_info(MESSAGE_LOG)->fixed_bytes;
    memset(&got, 0xEE, sizeof got);
    memcpy(payload, "\2ab\0cd", fixed_n + 5);
    const frame with_zero = frame_of(MESSAGE_LOG, fixed_n + 5);
    TEST_ASSERT_EQUAL_INT(MESSAGES_OK, messages_unpack(&with_zero, &got));
    TEST_ASSERT_EQUAL_STRING("ab", got.log.text);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, got.log.text + 2, sizeof got.log.text - 2);
    memset(payload, 'z', sizeof payload);
    const frame full = frame_of(MESSAGE_LOG, fixed_n + MESSAGES_TEXT_MAX);
    TEST_ASSERT_EQUAL_INT(MESSAGES_OK, messages_unpack(&full, &got));
    TEST_ASSERT_EQUAL_size_t(MESSAGES_TEXT_MAX, strlen(got.log.text));
}

/* Both by hand, on purpose: whoever changes a layout after a release must come past here. */
static void layout_is_the_published_one(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x4700C65D, messages_layout_hash());
    TEST_ASSERT_EQUAL_INT(44, MESSAGES_N);
}

static void table_makes_sense(void)
{
    for (int i = 0; i < MESSAGES_N; i++) {
        const message_info *const info = &messages[i];
        TEST_ASSERT_EQUAL_PTR(info, messages_info(info->type));
        TEST_ASSERT_EQUAL_STRING(info->name, messages_name(info->type));
        TEST_ASSERT_TRUE(info->direction >= MESSAGE_TO_DEVICE && info->direction <= MESSAGE_BOTH);
        TEST_ASSERT_TRUE(i == 0 || info->type > messages[i - 1].type);
        size_t bytes_n = 0;
        for (int k = 0; k < info->fields_n; k++) {
            const message_field *const field = &info->fields[k];
            bytes_n += field->n * number_bytes(field->type);
            for (int other = 0; other < k; other++) {
                TEST_ASSERT_TRUE(strcmp(field->name, info->fields[other].name) != 0);
            }
        }
        TEST_ASSERT_EQUAL_size_t(info->fixed_bytes, bytes_n);
    }
}

#define ADD_TABLE(list, member, flags, title) &message_values_##member,

static void values_have_names(void)
{
    static const message_values *const TABLES[] = {MESSAGE_VALUES(ADD_TABLE)};
    for (size_t k = 0; k < sizeof TABLES / sizeof TABLES[0]; k++) {
        const message_values *const of = TABLES[k];
        for (int i = 0; i < of->values_n; i++) {
            const message_value *const value = &of->values[i];
            TEST_ASSERT_EQUAL_STRING(value->name, message_value_name(of, value->value));
            TEST_ASSERT_EQUAL_STRING(value->meaning, message_value_meaning(of, value->value));
            TEST_ASSERT_TRUE(i == 0 || value->value > of->values[i - 1].value);
            TEST_ASSERT_TRUE(!of->flags || (value->value & (value->value - 1)) == 0);
        }
        TEST_ASSERT_EQUAL_STRING("?", message_value_name(of, 250));
        TEST_ASSERT_EQUAL_STRING("?", message_value_meaning(of, 250));
    }
    TEST_ASSERT_EQUAL_STRING("ACTIVE",
                             message_value_name(&message_values_device_states, DEVICE_ACTIVE));
    for (int error = -4; error <= 1; error++) {
        TEST_ASSERT_TRUE(strlen(messages_error_text((messages_error)error)) > 3);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_message_comes_back);
    RUN_TEST(every_message_comes_back_over_the_line);
    RUN_TEST(only_its_own_lengths_are_taken);
    RUN_TEST(unknown_types_are_refused);
    RUN_TEST(packing_keeps_within_the_room);
    RUN_TEST(bytes_are_where_the_book_says);
    RUN_TEST(sizes_on_the_line);
    RUN_TEST(texts_end_at_their_zero);
    RUN_TEST(layout_is_the_published_one);
    RUN_TEST(table_makes_sense);
    RUN_TEST(values_have_names);
    return UNITY_END();
}
