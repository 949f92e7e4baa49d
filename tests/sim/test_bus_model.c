/* test_bus_model.c - the model servos: what they answer, byte by byte as the e-Manual prints it, what they refuse, and
 * when they turn. */
#include "bus_fixture.h"

void setUp(void)
{
    bus_new(4, 1000000);
}

void tearDown(void)
{
    bus_free();
}

/* --- the examples of the e-Manual, DYNAMIXEL Protocol 2.0, 6 Instruction Details ---------------------- */

/* An XM430-W210 with firmware 38, as there. */
static void be_the_manuals(int id)
{
    servo(id)->table[DXL_X_MODEL] = 0x06;
    servo(id)->table[DXL_X_MODEL + 1] = 0x04;
    servo(id)->table[DXL_X_FIRMWARE] = 0x26;
}

static void put_at(int id, int units)
{
    bench->plant.positions_rad[servo(id)->place] = (float)(units - 2048) * DXL_X_RAD_PER_UNIT;
}

#define EXAMPLE(sent, answer)                                                                      \
    do {                                                                                           \
        (void)tell(sent, sizeof sent);                                                             \
        TEST_ASSERT_EQUAL_UINT(sizeof answer, bench->heard_n);                                     \
        TEST_ASSERT_EQUAL_HEX8_ARRAY(answer, bench->heard, sizeof answer);                         \
    } while (0)

static void test_ping_as_printed(void)
{
    static const uint8_t ONE[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4E};
    static const uint8_t ALL[] = {0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x03, 0x00, 0x01, 0x31, 0x42};
    static const uint8_t ANSWERS[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x55, 0x00, 0x06,
                                      0x04, 0x26, 0x65, 0x5D, 0xFF, 0xFF, 0xFD, 0x00, 0x02, 0x07,
                                      0x00, 0x55, 0x00, 0x06, 0x04, 0x26, 0x6F, 0x6D};
    uint8_t first[14];
    memcpy(first, ANSWERS, sizeof first);
    be_the_manuals(1);
    be_the_manuals(2);
    EXAMPLE(ONE, first);
    servo(3)->unplugged = servo(4)->unplugged = true;
    EXAMPLE(ALL, ANSWERS);
}

static void test_read_and_write_as_printed(void)
{
    static const uint8_t READ[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00,
                                   0x02, 0x84, 0x00, 0x04, 0x00, 0x1D, 0x15};
    static const uint8_t VALUE[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55,
                                    0x00, 0xA6, 0x00, 0x00, 0x00, 0x8C, 0xC0};
    static const uint8_t WRITE[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x09, 0x00, 0x03,
                                    0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xCA, 0x89};
    static const uint8_t DONE[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x04,
                                   0x00, 0x55, 0x00, 0xA1, 0x0C};
    put_at(1, 166);
    EXAMPLE(READ, VALUE);
    EXAMPLE(WRITE, DONE);
    TEST_ASSERT_EQUAL_UINT32(512, read_from(1, DXL_X_GOAL_POSITION, 4));
}

static void test_reboot_as_printed(void)
{
    static const uint8_t REBOOT[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x08, 0x2F, 0x4E};
    static const uint8_t DONE[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x04,
                                   0x00, 0x55, 0x00, 0xA1, 0x0C};
    EXAMPLE(REBOOT, DONE);
}

static void test_sync_read_as_printed(void)
{
    static const uint8_t READ[] = {0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x09, 0x00, 0x82,
                                   0x84, 0x00, 0x04, 0x00, 0x01, 0x02, 0xCE, 0xFA};
    static const uint8_t VALUES[] = {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00, 0xA6,
                                     0x00, 0x00, 0x00, 0x8C, 0xC0, 0xFF, 0xFF, 0xFD, 0x00, 0x02,
                                     0x08, 0x00, 0x55, 0x00, 0x1F, 0x08, 0x00, 0x00, 0xBA, 0xBE};
    put_at(1, 166);
    put_at(2, 2079);
    EXAMPLE(READ, VALUES);
}

static void test_sync_write_as_printed(void)
{
    static const uint8_t WRITE[] = {0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x11, 0x00, 0x83,
                                    0x74, 0x00, 0x04, 0x00, 0x01, 0x96, 0x00, 0x00,
                                    0x00, 0x02, 0xAA, 0x00, 0x00, 0x00, 0x82, 0x87};
    (void)tell(WRITE, sizeof WRITE);
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
    TEST_ASSERT_EQUAL_UINT32(150, read_from(1, DXL_X_GOAL_POSITION, 4));
    TEST_ASSERT_EQUAL_UINT32(170, read_from(2, DXL_X_GOAL_POSITION, 4));
    TEST_ASSERT_EQUAL_UINT32(2, bench->model.counts.goals);
}

/* --- who answers, and what ------------------------------------------------------------------------------ */

static void test_broadcast_ping_is_answered_in_the_order_of_ids(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_ID, 1, 200));
    TEST_ASSERT_EQUAL_INT(0, write_to(3, DXL_X_ID, 1, 0));
    static const uint8_t IDS[] = {0, 2, 4, 200};
    TEST_ASSERT_EQUAL_INT(4, ping(DXL_BROADCAST));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT8(IDS[i], bench->statuses[i].id);
        TEST_ASSERT_EQUAL_UINT16(BUS_SERVO_MODEL, dxl_u16(bench->statuses[i].data));
        TEST_ASSERT_EQUAL_UINT8(BUS_SERVO_FIRMWARE, bench->statuses[i].data[2]);
    }
}

static void test_a_stranger_is_silent(void)
{
    TEST_ASSERT_EQUAL_INT(0, ping(5));
    TEST_ASSERT_EQUAL_UINT(0, bench->heard_n);
}

static void test_other_instructions_and_damaged_ones_are_told_so(void)
{
    uint8_t *p = bench->packet;
    (void)tell(p, dxl_seal(p, sizeof bench->packet, 2, 0x05, 0)); /* Action */
    TEST_ASSERT_EQUAL_INT(DXL_E_INSTRUCTION, error_of_only_answer());
    const size_t n = dxl_write(p, sizeof bench->packet, 2, DXL_X_GOAL_POSITION, 4, 1000);
    p[n - 4] ^= 1;
    (void)tell(p, n);
    TEST_ASSERT_EQUAL_INT(DXL_E_CRC, error_of_only_answer());
    TEST_ASSERT_EQUAL_UINT32(0, read_from(2, DXL_X_GOAL_POSITION, 4));
}

static void test_status_return_level(void)
{
    uint8_t *p = bench->packet;
    TEST_ASSERT_EQUAL_INT(0, write_to(1, BUS_SERVO_STATUS_LEVEL, 1, 1));
    TEST_ASSERT_EQUAL_INT(0, tell(p, dxl_write(p, sizeof bench->packet, 1, 65, 1, 1)));
    TEST_ASSERT_EQUAL_UINT32(1, read_from(1, 65, 1));
    TEST_ASSERT_EQUAL_INT(
        0, tell(p, dxl_write(p, sizeof bench->packet, 1, BUS_SERVO_STATUS_LEVEL, 1, 0)));
    TEST_ASSERT_EQUAL_INT(0, tell(p, dxl_read(p, sizeof bench->packet, 1, 65, 1)));
    TEST_ASSERT_EQUAL_INT(1, ping(1));
}

static void test_sync_read_ends_at_a_missing_servo(void)
{
    static const uint8_t IDS[] = {2, 1, 9, 3};
    TEST_ASSERT_EQUAL_INT(2,
                          tell(bench->packet, sync_read(DXL_X_INPUT_VOLTAGE, 3, IDS, sizeof IDS)));
    TEST_ASSERT_EQUAL_UINT8(2, bench->statuses[0].id);
    TEST_ASSERT_EQUAL_UINT8(1, bench->statuses[1].id);
    TEST_ASSERT_EQUAL_UINT16(120, dxl_u16(bench->statuses[1].data));
    TEST_ASSERT_EQUAL_UINT8(31, bench->statuses[1].data[2]);
}

/* --- the control table ---------------------------------------------------------------------------------- */

/* e-Manual, 4.3 Error, and 2.2, 2.3 of the XL430-W250. */
static void test_what_writing_is_refused(void)
{
    static const struct {
        uint16_t address, n;
        uint32_t value;
        uint8_t error;
    } WRITES[] = {
        {DXL_X_MODEL, 2, 1, DXL_E_ACCESS},
        {DXL_X_PRESENT_POSITION, 4, 0, DXL_E_ACCESS},
        {14, 1, 0, DXL_E_ACCESS}, /* nothing there */
        {66, 2, 0, DXL_E_ACCESS},
        {1000, 1, 0, DXL_E_ACCESS},
        {DXL_X_GOAL_POSITION + 1, 1, 0, DXL_E_ACCESS}, /* the middle of one */
        {DXL_X_GOAL_POSITION, 2, 100, DXL_E_LENGTH},
        {DXL_X_GOAL_POSITION, 0, 0, DXL_E_LENGTH},
        {DXL_X_ID, 1, 253, DXL_E_RANGE},
        {DXL_X_BAUD, 1, 8, DXL_E_RANGE},
        {DXL_X_RETURN_DELAY, 1, 255, DXL_E_RANGE},
        {DXL_X_OPERATING_MODE, 1, 2, DXL_E_RANGE},
        {DXL_X_TORQUE, 1, 2, DXL_E_RANGE},
        {DXL_X_BUS_WATCHDOG, 1, 128, DXL_E_RANGE},
        {DXL_X_PROFILE_VELOCITY, 4, 32768, DXL_E_RANGE},
        {DXL_X_GOAL_POSITION, 4, 4096, DXL_E_LIMIT},
        {DXL_X_GOAL_POSITION, 4, (uint32_t)-1, DXL_E_LIMIT},
        {104, 4, 266, DXL_E_LIMIT}, /* Goal Velocity beyond Velocity Limit */
    };
    for (size_t i = 0; i < sizeof WRITES / sizeof WRITES[0]; i++) {
        uint8_t before[BUS_SERVO_TABLE_BYTES];
        memcpy(before, servo(1)->table, sizeof before);
        TEST_ASSERT_EQUAL_HEX8(WRITES[i].error,
                               write_to(1, WRITES[i].address, WRITES[i].n, WRITES[i].value));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(before, servo(1)->table, sizeof before);
    }
    TEST_ASSERT_EQUAL_UINT32(sizeof WRITES / sizeof WRITES[0], bench->model.counts.refused);
}

static void test_what_reading_is_refused(void)
{
    static const uint16_t READS[][2] = {{14, 1}, {DXL_X_ID, 0}, {DXL_X_ID, 1000}, {1000, 1}};
    uint8_t *p = bench->packet;
    for (int i = 0; i < 4; i++) {
        (void)tell(p, dxl_read(p, sizeof bench->packet, 1, READS[i][0], READS[i][1]));
        TEST_ASSERT_EQUAL_INT(DXL_E_ACCESS, error_of_only_answer());
        TEST_ASSERT_EQUAL_UINT(0, bench->statuses[0].data_n);
    }
}

/* Several items at once are written all, or none. */
static void test_neighbours_are_written_together(void)
{
    uint8_t *p = bench->packet;
    static const uint8_t PARAMS[] = {112, 0, 100, 0, 0,
                                     0,   0, 4,   0, 0}; /* Profile Velocity, Goal Position */
    memcpy(p + DXL_PARAMS_AT, PARAMS, sizeof PARAMS);
    (void)tell(p, dxl_seal(p, sizeof bench->packet, 1, DXL_WRITE, sizeof PARAMS));
    TEST_ASSERT_EQUAL_INT(0, error_of_only_answer());
    TEST_ASSERT_EQUAL_UINT32(100, read_from(1, DXL_X_PROFILE_VELOCITY, 4));
    TEST_ASSERT_EQUAL_UINT32(1024, read_from(1, DXL_X_GOAL_POSITION, 4));
    memcpy(p + DXL_PARAMS_AT, PARAMS, sizeof PARAMS);
    p[DXL_PARAMS_AT + 2] = 50;
    p[DXL_PARAMS_AT + 7] = 200; /* no position within a turn */
    (void)tell(p, dxl_seal(p, sizeof bench->packet, 1, DXL_WRITE, sizeof PARAMS));
    TEST_ASSERT_EQUAL_INT(DXL_E_LIMIT, error_of_only_answer());
    TEST_ASSERT_EQUAL_UINT32(100, read_from(1, DXL_X_PROFILE_VELOCITY, 4));
}

static void test_eeprom_is_locked_while_there_is_torque(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT(DXL_E_ACCESS, write_to(1, DXL_X_ID, 1, 9));
    TEST_ASSERT_EQUAL_INT(DXL_E_ACCESS, write_to(1, DXL_X_RETURN_DELAY, 1, 0));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 0));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_RETURN_DELAY, 1, 0));
}

static void test_a_new_id_counts_from_the_next_packet_on(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_ID, 1, 77));
    TEST_ASSERT_EQUAL_UINT8(1, bench->statuses[0].id);
    TEST_ASSERT_EQUAL_INT(0, ping(1));
    TEST_ASSERT_EQUAL_INT(1, ping(77));
}

static void test_extended_mode_turns_further(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_OPERATING_MODE, 1, DXL_X_MODE_EXTENDED));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 6000));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT32(6000, position(1));
}

/* --- torque and goals ----------------------------------------------------------------------------------- */

static void test_goals_are_followed_with_torque_only_and_no_faster_than_it_can(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 3000));
    TEST_ASSERT_EQUAL_INT32(2048, position(1));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 2048));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT32(2048, position(1));

    const size_t n = sync_write(DXL_X_GOAL_POSITION, 1, 4000);
    TEST_ASSERT_TRUE(bus_wire_send(&bench->model.wire, bench->packet, n, bench->now_s));
    const float *at_rad = &bench->plant.positions_rad[0];
    pass(0.003);
    TEST_ASSERT_TRUE(*at_rad < 1e-6f); /* it is 3 ms late */
    float last_rad = *at_rad;
    for (int ms = 0; ms < 100; ms++) {
        pass(1e-3);
        TEST_ASSERT_TRUE(*at_rad - last_rad <= 15.0f * 1e-3f * 1.001f);
        last_rad = *at_rad;
    }
    TEST_ASSERT_TRUE(last_rad > 1.4f);
    pass(0.2);
    TEST_ASSERT_EQUAL_INT32(4000, position(1));
}

/* Whoever gives torque without a goal sees the servo go to the end of its travel. */
static void test_torque_before_a_goal_shows(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT32(0, position(1));
    TEST_ASSERT_EQUAL_UINT32(1, servo(1)->torque_n);
}

static void test_no_movement_in_other_modes(void)
{
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_OPERATING_MODE, 1, 1));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_TORQUE, 1, 1));
    TEST_ASSERT_EQUAL_INT(0, write_to(1, DXL_X_GOAL_POSITION, 4, 100));
    TEST_ASSERT_EQUAL_INT32(2048, position(1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ping_as_printed);
    RUN_TEST(test_read_and_write_as_printed);
    RUN_TEST(test_reboot_as_printed);
    RUN_TEST(test_sync_read_as_printed);
    RUN_TEST(test_sync_write_as_printed);
    RUN_TEST(test_broadcast_ping_is_answered_in_the_order_of_ids);
    RUN_TEST(test_a_stranger_is_silent);
    RUN_TEST(test_other_instructions_and_damaged_ones_are_told_so);
    RUN_TEST(test_status_return_level);
    RUN_TEST(test_sync_read_ends_at_a_missing_servo);
    RUN_TEST(test_what_writing_is_refused);
    RUN_TEST(test_what_reading_is_refused);
    RUN_TEST(test_neighbours_are_written_together);
    RUN_TEST(test_eeprom_is_locked_while_there_is_torque);
    RUN_TEST(test_a_new_id_counts_from_the_next_packet_on);
    RUN_TEST(test_extended_mode_turns_further);
    RUN_TEST(test_goals_are_followed_with_torque_only_and_no_faster_than_it_can);
    RUN_TEST(test_torque_before_a_goal_shows);
    RUN_TEST(test_no_movement_in_other_modes);
    return UNITY_END();
}
