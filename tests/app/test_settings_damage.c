/* test_settings_damage.c - copies that have gone bad in flash: which one is loaded, and what is said. */
#include "flash_fixture.h"

void setUp(void) {}
void tearDown(void) {}

static flash_chips flash, saved_flash;
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

static void flip(int sector, uint32_t bit)
{
    flash.bytes[sector][bit / 8] ^= (uint8_t)(1u << bit % 8);
}

/* Any single bit of the newest copy: the one before is loaded, and that is said. */
static void a_flipped_bit_in_the_newest_copy_brings_the_older_one(void)
{
    const hal h = fresh();
    boot(&s, &h);
    save(&s, 1);
    save(&s, 2);
    const uint32_t start = s.sector[0].newest.offset;
    const uint32_t bytes = 16 + (block_of(2).n + 3) / 4 * 4 + 8;
    saved_flash = flash;
    for (uint32_t bit = start * 8; bit < (start + bytes) * 8; bit += HOST_OR_BOARD(1, 97)) {
        flash = saved_flash;
        flip(0, bit);
        reboot(&h, 1, SETTINGS_OLDER);
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, 3));
        reboot(&h, 3, SETTINGS_NEWEST);
    }
}

static void damage_in_older_copies_does_not_matter(void)
{
    const hal h = fresh();
    uint32_t seed = 12u;
    for (int round = 0; round < HOST_OR_BOARD(300, 10); round++) {
        flash_blank(&flash);
        boot(&s, &h);
        uint32_t generation = 0;
        const uint32_t saves = 2 + (uint32_t)random_below(&seed, 6);
        while (generation < saves) {
            save(&s, ++generation);
        }
        for (int i = random_below(&seed, 20); i >= 0; i--) {
            const int sector = s.active == 1 ? random_below(&seed, 2) : 0;
            const uint32_t reach =
                sector == s.active ? s.sector[sector].newest.offset : s.sector[sector].end;
            if (reach > 0) {
                flip(sector, random_bits(&seed) % (reach * 8));
            }
        }
        boot(&s, &h);
        TEST_ASSERT_EQUAL_UINT32(generation, loaded(&s));
        TEST_ASSERT_EQUAL_INT(SETTINGS_NEWEST, s.origin);
    }
}

/* The newest copy is the first in its sector, the other sector full: whatever is damaged, even its head,
 * the older one does not pass for the newest. */
static void a_newest_copy_alone_in_its_sector_is_missed(void)
{
    const hal h = fresh();
    boot(&s, &h);
    uint32_t generation = 0;
    while (s.active != 1) {
        save(&s, ++generation);
    }
    saved_flash = flash;
    for (uint32_t bit = 0; bit < 8 * (16 + block_of(generation).n); bit += HOST_OR_BOARD(1, 97)) {
        flash = saved_flash;
        flip(1, bit);
        boot(&s, &h);
        TEST_ASSERT_EQUAL_UINT32(generation - 1, loaded(&s));
        TEST_ASSERT_EQUAL_INT(SETTINGS_OLDER, s.origin);
    }
}

static void when_no_copy_is_whole_that_is_told_and_saving_works(void)
{
    const hal h = fresh();
    boot(&s, &h);
    uint32_t generation = 0;
    while (save(&s, ++generation) == SETTINGS_OK) {
    }
    for (int sector = 0; sector < 2; sector++) {
        for (uint32_t at = 0; at < FLASH_BYTES; at += 4) {
            *flash_word(&flash, sector, at) ^= 0x00010000u;
        }
    }
    boot(&s, &h);
    TEST_ASSERT_EQUAL_UINT32(0, loaded(&s));
    TEST_ASSERT_EQUAL_INT(SETTINGS_DAMAGED, s.origin);
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, 1000));
    boot(&s, &h);
    TEST_ASSERT_EQUAL_UINT32(1000, loaded(&s));
}

/* Random flash, random damage: whatever loads is whole (loaded() checks), nothing is read out of bounds. */
static void noise_is_never_taken_for_settings(void)
{
    const hal h = fresh();
    uint32_t seed = 77u;
    for (int round = 0; round < HOST_OR_BOARD(2000, 20); round++) {
        flash_blank(&flash);
        boot(&s, &h);
        for (uint32_t generation = 1; generation < 12; generation++) {
            save(&s, generation);
        }
        for (int i = random_below(&seed, 4000); i >= 0; i--) {
            const uint32_t at = (uint32_t)random_below(&seed, FLASH_BYTES / 4) * 4;
            *flash_word(&flash, random_below(&seed, 2), at) = random_bits(&seed);
        }
        flash.seed = random_bits(&seed);
        boot(&s, &h);
        const uint32_t got = loaded(&s);
        TEST_ASSERT_TRUE(got < 12 && (got > 0 || s.origin == SETTINGS_DAMAGED));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_flipped_bit_in_the_newest_copy_brings_the_older_one);
    RUN_TEST(damage_in_older_copies_does_not_matter);
    RUN_TEST(a_newest_copy_alone_in_its_sector_is_missed);
    RUN_TEST(when_no_copy_is_whole_that_is_told_and_saving_works);
    RUN_TEST(noise_is_never_taken_for_settings);
    return UNITY_END();
}
