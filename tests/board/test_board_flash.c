/* test_board_flash.c - writing and erasing on a model of the flash controller: slow, stuck, refusing, or absent. */
#include <string.h>

#include "flash.h"
#include "scripted.h"
#include "unity.h"

enum { WORDS = FLASH_SECTOR_BYTES / 4, FOREVER = -1 };
static const uint32_t KEY1 = 0x45670123, KEY2 = 0xCDEF89AB; /* RM0090 3.6.1 */

static flash_registers controller;
static uint32_t sectors[2][WORDS];
static flash f;

/* How it behaves. */
static struct {
    int busy_polls;      /* after each write or erase */
    uint32_t error;      /* the error to report, */
    int error_at;        /* with which operation, from 0 */
    bool absent, jammed; /* jammed: the keys do not unlock it */
    int keys_n, busy_left, operations_n;
    bool cr_while_busy;
} hardware;

static void begin(void)
{
    hardware.busy_left = hardware.busy_polls;
    if (hardware.operations_n++ == hardware.error_at) {
        controller.sr |= hardware.error;
    } else {
        controller.sr |= FLASH_SR_EOP;
    }
}

static uint32_t read(const reg *place, uint32_t held)
{
    if (hardware.absent) {
        return 0;
    }
    if (place == &controller.sr && hardware.busy_left != 0) {
        hardware.busy_left -= hardware.busy_left > 0 ? 1 : 0;
        return held | FLASH_SR_BSY;
    }
    return held;
}

static bool write_key(uint32_t value)
{
    hardware.keys_n = value == (hardware.keys_n == 0 ? KEY1 : KEY2) ? hardware.keys_n + 1 : -100;
    if (hardware.keys_n == 2 && !hardware.jammed) {
        controller.cr &= ~FLASH_CR_LOCK;
        hardware.keys_n = 0;
    }
    return true;
}

static bool write_control(uint32_t value)
{
    hardware.cr_while_busy |= hardware.busy_left != 0;
    if ((controller.cr & FLASH_CR_LOCK) != 0) {
        return true; /* locked: takes nothing */
    }
    controller.cr = value;
    if ((value & FLASH_CR_STRT) != 0) {
        TEST_ASSERT_TRUE((value & FLASH_CR_SER) != 0 && (value & FLASH_CR_PG) == 0);
        const uint32_t number = value >> 3 & 0xF;
        TEST_ASSERT_TRUE(number == 10 || number == 11);
        if (hardware.error_at != hardware.operations_n) {
            memset(sectors[number - 10], 0xFF, FLASH_SECTOR_BYTES);
        }
        begin();
        controller.cr &= ~(uint32_t)FLASH_CR_STRT;
    }
    return true;
}

static bool write_memory(reg *place, uint32_t value)
{
    if ((controller.cr & FLASH_CR_LOCK) != 0 || (controller.cr & FLASH_CR_PG) == 0) {
        controller.sr |= FLASH_SR_PGSERR;
        return true;
    }
    TEST_ASSERT_EQUAL_HEX32(2 << 8, controller.cr & 3 << 8); /* PSIZE: words */
    if (hardware.error_at != hardware.operations_n) {
        *place &= value;
    }
    begin();
    return true;
}

static bool write(reg *place, uint32_t value)
{
    if (hardware.absent) {
        return true;
    }
    if (place == &controller.keyr) {
        return write_key(value);
    }
    if (place == &controller.cr) {
        return write_control(value);
    }
    if (place == &controller.sr) {
        controller.sr &= ~value;
        return true;
    }
    return place != &controller.acr && write_memory(place, value);
}

void setUp(void)
{
    memset(&controller, 0, sizeof controller);
    memset(sectors, 0xFF, sizeof sectors);
    memset(&hardware, 0, sizeof hardware);
    hardware.error_at = -1;
    controller.cr = FLASH_CR_LOCK;
    scripted_start((script){read, write});
    flash_init(&f, &controller, sectors[0], sectors[1]);
}

void tearDown(void)
{
    TEST_ASSERT_FALSE(hardware.cr_while_busy);
    if (hardware.busy_left == 0) {
        TEST_ASSERT_TRUE((controller.cr & FLASH_CR_LOCK) != 0); /* whatever happened */
    }
}

static const uint32_t PIECE[4] = {0x11111111, 0x22222222, 0x80000001, 0xFFFFFFFE};

static bool write_piece(uint32_t offset)
{
    return flash_write(&f, 1, offset, PIECE, sizeof PIECE);
}

static void what_is_written_is_read(void)
{
    static const int BUSY[] = {0, 1, 1000};
    for (int i = 0; i < 3; i++) {
        hardware.busy_polls = BUSY[i];
        uint32_t back[4];
        const uint32_t offset = i == 2 ? FLASH_SECTOR_BYTES - 16 : 64u * (uint32_t)i;
        TEST_ASSERT_TRUE(write_piece(offset));
        TEST_ASSERT_EQUAL_HEX32(0, f.errors);
        flash_read(&f, 1, offset, back, sizeof back);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(PIECE, back, 4);
        TEST_ASSERT_EQUAL_HEX32(0, controller.sr);
    }
    TEST_ASSERT_EACH_EQUAL_HEX32(0xFFFFFFFF, sectors[0], WORDS);
}

static void an_erase_clears_one_sector_and_the_data_cache(void)
{
    hardware.busy_polls = 100000;
    memset(sectors, 0, sizeof sectors);
    TEST_ASSERT_TRUE(flash_erase(&f, 0));
    TEST_ASSERT_EACH_EQUAL_HEX32(0xFFFFFFFF, sectors[0], WORDS);
    TEST_ASSERT_EACH_EQUAL_HEX32(0, sectors[1], WORDS);
    /* reset only while it is off (RM0090 3.9.1), and on again after */
    bool reset = false;
    for (int i = scripted_last_write(&controller.cr); i < scripted_writes_n; i++) {
        if (scripted_writes[i].place == &controller.acr &&
            (scripted_writes[i].value & FLASH_ACR_DCRST) != 0) {
            TEST_ASSERT_EQUAL_HEX32(0, scripted_writes[i].value & FLASH_ACR_DCEN);
            reset = true;
        }
    }
    TEST_ASSERT_TRUE(reset);
    TEST_ASSERT_EQUAL_HEX32(FLASH_ACR_DCEN, controller.acr & (FLASH_ACR_DCEN | FLASH_ACR_DCRST));
}

static const uint32_t ERRORS[] = {FLASH_SR_OPERR, FLASH_SR_WRPERR, FLASH_SR_PGAERR, FLASH_SR_PGPERR,
                                  FLASH_SR_PGSERR};

static void each_error_is_told_cleared_and_ends_the_write(void)
{
    for (int i = 0; i < 5; i++) {
        for (int word = 0; word < 4; word++) {
            setUp();
            hardware.error = ERRORS[i];
            hardware.error_at = word;
            TEST_ASSERT_FALSE(write_piece(0));
            TEST_ASSERT_EQUAL_HEX32(ERRORS[i], f.errors);
            TEST_ASSERT_EQUAL_INT(word + 1, hardware.operations_n);
            TEST_ASSERT_EQUAL_HEX32(0, controller.sr & ERRORS[i]);
            TEST_ASSERT_TRUE(write_piece(64)); /* the next one has nothing to do with it */
        }
        setUp();
        hardware.error = ERRORS[i];
        hardware.error_at = 0;
        TEST_ASSERT_FALSE(flash_erase(&f, 1));
        TEST_ASSERT_EQUAL_HEX32(ERRORS[i], f.errors);
        TEST_ASSERT_TRUE(flash_erase(&f, 1));
    }
}

static void errors_that_others_left_are_not_this_write_s(void)
{
    controller.sr = FLASH_SR_PGSERR | FLASH_SR_WRPERR;
    TEST_ASSERT_TRUE(write_piece(0));
}

static void busy_for_ever_ends(void)
{
    hardware.busy_polls = FOREVER;
    TEST_ASSERT_FALSE(write_piece(0));
    TEST_ASSERT_EQUAL_HEX32(FLASH_SR_BSY, f.errors);
    TEST_ASSERT_EQUAL_INT(1, hardware.operations_n);
    TEST_ASSERT_FALSE(write_piece(64)); /* not even begun */
    TEST_ASSERT_EQUAL_INT(1, hardware.operations_n);
    setUp();
    hardware.busy_polls = FOREVER;
    TEST_ASSERT_FALSE(flash_erase(&f, 1));
    TEST_ASSERT_EQUAL_HEX32(FLASH_SR_BSY, f.errors);
}

static void a_lock_that_stays_is_seen(void)
{
    hardware.jammed = true;
    controller.sr = FLASH_SR_PGSERR; /* of before */
    TEST_ASSERT_FALSE(write_piece(0));
    TEST_ASSERT_EQUAL_HEX32(0, f.errors);
    TEST_ASSERT_FALSE(flash_erase(&f, 1));
    TEST_ASSERT_EQUAL_INT(0, hardware.operations_n);
    TEST_ASSERT_EACH_EQUAL_HEX32(0xFFFFFFFF, sectors[1], WORDS);
}

static void no_controller_reads_blank_and_refuses(void)
{
    hardware.absent = true;
    controller.cr = 0; /* what such a place reads */
    memset(sectors, 0, sizeof sectors);
    flash_init(&f, &controller, sectors[0], sectors[1]);
    uint32_t back[4] = {0};
    flash_read(&f, 0, 0, back, sizeof back);
    TEST_ASSERT_EACH_EQUAL_HEX32(0xFFFFFFFF, back, 4);
    TEST_ASSERT_FALSE(write_piece(0));
    TEST_ASSERT_FALSE(flash_erase(&f, 0));
    controller.cr = FLASH_CR_LOCK; /* for tearDown */
}

static void outside_of_the_sectors_is_refused(void)
{
    TEST_ASSERT_FALSE(flash_write(&f, 2, 0, PIECE, 4));
    TEST_ASSERT_FALSE(flash_write(&f, -1, 0, PIECE, 4));
    TEST_ASSERT_FALSE(flash_write(&f, 0, FLASH_SECTOR_BYTES, PIECE, 4));
    TEST_ASSERT_FALSE(flash_write(&f, 0, FLASH_SECTOR_BYTES - 12, PIECE, 16));
    TEST_ASSERT_FALSE(flash_write(&f, 0, UINT32_MAX - 3, PIECE, 16));
    TEST_ASSERT_FALSE(flash_write(&f, 0, 2, PIECE, 4));
    TEST_ASSERT_FALSE(flash_write(&f, 0, 0, PIECE, 3));
    TEST_ASSERT_FALSE(flash_erase(&f, 2));
    TEST_ASSERT_EQUAL_INT(0, hardware.operations_n);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_is_written_is_read);
    RUN_TEST(an_erase_clears_one_sector_and_the_data_cache);
    RUN_TEST(each_error_is_told_cleared_and_ends_the_write);
    RUN_TEST(errors_that_others_left_are_not_this_write_s);
    RUN_TEST(busy_for_ever_ends);
    RUN_TEST(a_lock_that_stays_is_seen);
    RUN_TEST(no_controller_reads_blank_and_refuses);
    RUN_TEST(outside_of_the_sectors_is_refused);
    return UNITY_END();
}
