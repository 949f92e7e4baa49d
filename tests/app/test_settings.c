/* test_settings.c - settings in flash: saving, loading, running full, wear, errors of the flash. */
#include "flash_fixture.h"

void setUp(void) {}
void tearDown(void) {}

static flash_chips flash;
static settings s;

static hal fresh(void)
{
    flash_blank(&flash);
    return flash_hal(&flash);
}

static void reboot(const hal *h, uint32_t generation, settings_origin origin)
{
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, h));
    TEST_ASSERT_EQUAL_UINT32(generation, loaded(&s));
    TEST_ASSERT_EQUAL_INT(origin, s.origin);
}

static void what_was_saved_last_is_loaded(void)
{
    const hal h = fresh();
    reboot(&h, 0, SETTINGS_NONE);
    for (uint32_t generation = 1; generation < HOST_OR_BOARD(500, 30); generation++) {
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, generation));
        TEST_ASSERT_EQUAL_UINT32(generation, loaded(&s));
        reboot(&h, generation, SETTINGS_NEWEST);
    }
}

static void saving_never_erases_and_says_when_only_a_restart_helps(void)
{
    const hal h = fresh();
    reboot(&h, 0, SETTINGS_NONE);
    uint32_t generation = 0;
    settings_error error;
    do {
        error = save(&s, ++generation);
    } while (error == SETTINGS_OK);
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_FULL, error);
    TEST_ASSERT_NOT_NULL(strstr(settings_error_text(error), "restart"));
    TEST_ASSERT_TRUE(generation > 2 * FLASH_BYTES / (BLOCK_MAX + 256)); /* both sectors are full */
    TEST_ASSERT_EQUAL_INT(0, flash.erasures[0] + flash.erasures[1]);
    TEST_ASSERT_EQUAL_UINT32(generation - 1, loaded(&s));
    reboot(&h, generation - 1, SETTINGS_NEWEST);
    TEST_ASSERT_TRUE(s.erased);
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, generation));
    reboot(&h, generation, SETTINGS_NEWEST);
}

static void an_older_copy_is_kept_until_there_are_two(void)
{
    const hal h = fresh();
    boot(&s, &h);
    uint32_t generation = 0;
    while (s.active != 1) {
        save(&s, ++generation);
    }
    reboot(&h, generation, SETTINGS_NEWEST);
    TEST_ASSERT_FALSE(s.erased);
    save(&s, ++generation);
    reboot(&h, generation, SETTINGS_NEWEST);
    TEST_ASSERT_TRUE(s.erased);
    reboot(&h, generation, SETTINGS_NEWEST);
    TEST_ASSERT_FALSE(s.erased);
}

static void both_sectors_wear_alike_and_little(void)
{
    const hal h = fresh();
    enum { SAVES_N = HOST_OR_BOARD(2000, 100) };
    for (uint32_t generation = 1; generation <= SAVES_N; generation++) {
        if (generation % 3 == 1) {
            boot(&s, &h);
        }
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, generation));
    }
    TEST_ASSERT_INT_WITHIN(1, flash.erasures[0], flash.erasures[1]);
    /* a record takes half of BLOCK_MAX and half a grid step on average, so a sector holds six */
    TEST_ASSERT_TRUE(flash.erasures[0] + flash.erasures[1] <= SAVES_N / 4);
}

static void sequences_wrap(void)
{
    const hal h = fresh();
    boot(&s, &h);
    save(&s, 1);
    s.sector[0].newest.sequence = UINT32_MAX - 5u;
    save(&s, 2);
    *flash_word(&flash, 0, 0) = 0; /* the first copy, numbered 1, never was */
    for (uint32_t generation = 3; generation < 40; generation++) {
        reboot(&h, generation - 1, SETTINGS_NEWEST);
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, generation));
    }
}

/* Any word of the record, head, payload, checksum or commit: found out, and nothing is lost. */
static void a_word_that_cannot_be_written_is_found_out(void)
{
    const hal h = fresh();
    boot(&s, &h);
    save(&s, 1);
    const uint32_t start = s.sector[0].end, bytes = 16 + (block_of(2).n + 3) / 4 * 4 + 8;
    static flash_chips saved;
    saved = flash;
    int found = 0;
    for (uint32_t at = start; at < start + bytes; at += 4) {
        flash = saved;
        boot(&s, &h);
        flash.stuck = true;
        flash.stuck_at = at;
        const settings_error error = save(&s, 2);
        flash.stuck = false;
        if (error == SETTINGS_OK) { /* a word of the payload that is all ones */
            TEST_ASSERT_EQUAL_UINT32(2, loaded(&s));
            continue;
        }
        found++;
        TEST_ASSERT_EQUAL_INT(SETTINGS_E_READ_BACK, error);
        TEST_ASSERT_EQUAL_UINT32(1, loaded(&s));
        reboot(&h, 1, SETTINGS_OLDER);
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, 3)); /* behind the damaged place */
        reboot(&h, 3, SETTINGS_NEWEST);
    }
    TEST_ASSERT_TRUE(found >= 6);
}

/* The commit is not written unless all before it reads back. */
static void a_damaged_record_is_not_committed(void)
{
    const hal h = fresh();
    boot(&s, &h);
    flash.stuck = true;
    flash.stuck_at = 0;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_READ_BACK, save(&s, 1));
    const uint32_t commit_at = 16 + (block_of(1).n + 3) / 4 * 4 + 4;
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFFu, *flash_word(&flash, 0, commit_at));
}

/* The other sector, not blank, has room for a small record; but then the newest would lie among the oldest,
 * and the next boot would keep those to fall back on. */
static void a_save_never_goes_behind_older_copies_in_the_other_sector(void)
{
    static const uint8_t payload[3000] = {0};
    const hal h = fresh();
    boot(&s, &h);
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, settings_save(&s, 1, payload, 3000));
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, settings_save(&s, 2, payload, 2000));
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, settings_save(&s, 3, payload, 1900));
    TEST_ASSERT_EQUAL_INT(1, s.active);
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_FULL, settings_save(&s, 4, payload, 500));
}

static void errors_of_the_flash_leave_the_settings_of_before(void)
{
    const hal h = fresh();
    boot(&s, &h);
    save(&s, 1);
    flash.refuses = true;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_FLASH, save(&s, 2));
    TEST_ASSERT_EQUAL_UINT32(1, loaded(&s));
    flash.refuses = false;
    uint32_t generation = 2;
    while (save(&s, ++generation) == SETTINGS_OK) {
    }
    flash.refuses = true;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_FLASH, boot(&s, &h)); /* cannot erase */
    TEST_ASSERT_EQUAL_UINT32(generation - 1, loaded(&s));
    flash.refuses = false;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_FULL, save(&s, generation));
}

static void sizes_are_checked(void)
{
    static const uint8_t payload[FLASH_BYTES] = {0};
    const hal h = fresh();
    boot(&s, &h);
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SIZE, settings_save(&s, 1, payload, 0));
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SIZE, settings_save(&s, 1, payload, FLASH_BYTES - 23));
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SIZE, settings_save(&s, 1, payload, UINT32_MAX));
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, settings_save(&s, 1, payload, FLASH_BYTES - 24));
    uint8_t room[8];
    uint32_t n, version;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SIZE, settings_load(&s, room, sizeof room, &n, &version));
}

static void flash_that_changed_since_the_boot_is_not_loaded(void)
{
    const hal h = fresh();
    boot(&s, &h);
    save(&s, 1);
    flash.bytes[0][20] ^= 1;
    uint8_t room[BLOCK_MAX];
    uint32_t n, version;
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_READ_BACK, settings_load(&s, room, sizeof room, &n, &version));
}

static void a_save_goes_in_small_steps_one_at_a_time(void)
{
    const hal h = fresh();
    boot(&s, &h);
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SAVING, settings_save_step(&s));
    const block b = block_of(5);
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, settings_save_begin(&s, 5, b.bytes, b.n));
    TEST_ASSERT_EQUAL_INT(SETTINGS_E_SAVING, settings_save_begin(&s, 5, b.bytes, b.n));
    int steps = 1, words = 0;
    for (; settings_save_step(&s) == SETTINGS_BUSY; steps++) {
        TEST_ASSERT_TRUE(flash.words - words <= SETTINGS_STEP_BYTES / 4);
        words = flash.words;
        TEST_ASSERT_EQUAL_UINT32(0, loaded(&s)); /* not before its commit */
    }
    TEST_ASSERT_EQUAL_UINT32(5, loaded(&s));
    const int pieces = ((int)b.n + 16 + SETTINGS_STEP_BYTES - 1) / SETTINGS_STEP_BYTES;
    TEST_ASSERT_EQUAL_INT(2 * pieces + 2, steps); /* and checksum, and commit */
    TEST_ASSERT_TRUE(flash.written_max <= SETTINGS_STEP_BYTES);
}

static void each_error_and_origin_has_its_own_text(void)
{
    for (int i = SETTINGS_BUSY; i >= SETTINGS_E_SAVING - 1; i--) {
        for (int j = SETTINGS_BUSY; j > i; j--) {
            TEST_ASSERT_TRUE(strcmp(settings_error_text((settings_error)i),
                                    settings_error_text((settings_error)j)) != 0);
        }
    }
    for (int i = 0; i <= SETTINGS_DAMAGED + 1; i++) {
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(strcmp(settings_origin_text((settings_origin)i),
                                    settings_origin_text((settings_origin)j)) != 0);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_was_saved_last_is_loaded);
    RUN_TEST(saving_never_erases_and_says_when_only_a_restart_helps);
    RUN_TEST(an_older_copy_is_kept_until_there_are_two);
    RUN_TEST(both_sectors_wear_alike_and_little);
    RUN_TEST(sequences_wrap);
    RUN_TEST(a_word_that_cannot_be_written_is_found_out);
    RUN_TEST(a_damaged_record_is_not_committed);
    RUN_TEST(a_save_never_goes_behind_older_copies_in_the_other_sector);
    RUN_TEST(errors_of_the_flash_leave_the_settings_of_before);
    RUN_TEST(sizes_are_checked);
    RUN_TEST(flash_that_changed_since_the_boot_is_not_loaded);
    RUN_TEST(a_save_goes_in_small_steps_one_at_a_time);
    RUN_TEST(each_error_and_origin_has_its_own_text);
    return UNITY_END();
}
