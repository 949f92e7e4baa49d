/* test_settings_cuts.c - power fails: at every word of a save, in the erase at boot, over and over. After
 * each failure there are the settings of before or of after, whole. */
#include "flash_fixture.h"

void setUp(void) {}
void tearDown(void) {}

static flash_chips flash, saved_flash;
static settings s;

static bool dirty_beyond(const flash_chips *before)
{
    return memcmp(before->bytes, flash.bytes, sizeof flash.bytes) != 0;
}

/* From many states of the flash, a save cut at each of its words, torn in several ways. */
static void a_save_cut_at_any_word_leaves_old_or_new(void)
{
    const hal h = flash_hal(&flash);
    flash_blank(&flash);
    for (uint32_t generation = 1; generation <= HOST_OR_BOARD(30, 8); generation++) {
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h));
        TEST_ASSERT_EQUAL_UINT32(generation - 1, loaded(&s));
        saved_flash = flash;
        bool finished = false;
        for (int cut = 0; !finished; cut++) {
            for (uint32_t seed = 1; seed <= HOST_OR_BOARD(6, 1); seed++) {
                flash = saved_flash;
                flash.seed = seed * 747796405u + (uint32_t)cut + 1u;
                flash.words_left = cut;
                TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h)); /* nothing left to erase */
                const settings_error error = save(&s, generation);
                finished = error == SETTINGS_OK;
                const bool touched = dirty_beyond(&saved_flash);
                flash_revive(&flash);
                boot(&s, &h);
                const uint32_t got = loaded(&s);
                if (finished || got == generation) {
                    TEST_ASSERT_EQUAL_UINT32(generation, got);
                    TEST_ASSERT_EQUAL_INT(SETTINGS_NEWEST, s.origin);
                    continue;
                }
                TEST_ASSERT_EQUAL_UINT32(generation - 1, got);
                const settings_origin whole = got > 0 ? SETTINGS_NEWEST : SETTINGS_NONE;
                const settings_origin damaged = got > 0 ? SETTINGS_OLDER : SETTINGS_DAMAGED;
                TEST_ASSERT_EQUAL_INT(touched ? damaged : whole, s.origin);
            }
        }
    }
}

/* A life of bad luck: boots and saves, each of them cut off at some word or not, for ever on the same
 * flash. */
static void ten_thousand_cuts_on_one_flash_never_lose_or_mix_anything(void)
{
    const hal h = flash_hal(&flash);
    flash_blank(&flash);
    uint32_t seed = 10000u, kept = 0;
    int cuts = 0, cut_erasures = 0, boots = 0;
    for (uint32_t generation = 1; cuts < HOST_OR_BOARD(10000, 200); generation++) {
        /* cut the boot itself, now and then several times over */
        while (random_below(&seed, 3) == 0) {
            flash.words_left = 0;
            flash.seed = random_bits(&seed);
            boot(&s, &h);
            TEST_ASSERT_EQUAL_UINT32(kept, loaded(&s));
            cut_erasures += flash.dead ? 1 : 0;
            cuts += flash.dead ? 1 : 0;
            flash_revive(&flash);
        }
        boots++;
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h));
        TEST_ASSERT_EQUAL_UINT32(kept, loaded(&s));
        TEST_ASSERT_TRUE(kept == 0 || (s.origin != SETTINGS_NONE && s.origin != SETTINGS_DAMAGED));

        /* one to three saves in this session: the first always has room after a boot */
        for (int i = random_below(&seed, 3); i >= 0; i--, generation++) {
            flash.seed = random_bits(&seed);
            flash.words_left = random_below(&seed, 2) == 0 ? random_below(&seed, 240) : -1;
            const settings_error error = save(&s, generation);
            if (!flash.dead) {
                TEST_ASSERT_TRUE(error == SETTINGS_OK || error == SETTINGS_E_FULL);
                kept = error == SETTINGS_OK ? generation : kept;
                TEST_ASSERT_EQUAL_UINT32(kept, loaded(&s));
                flash_revive(&flash);
                continue;
            }
            cuts++;
            flash_revive(&flash);
            boot(&s, &h);
            const uint32_t got = loaded(&s);
            TEST_ASSERT_TRUE(got == generation || got == kept);
            TEST_ASSERT_TRUE(got == kept || s.origin == SETTINGS_NEWEST);
            kept = got;
        }
    }
    char text[120];
    snprintf(text, sizeof text, "%d cuts, %d of them in erasing, %d whole boots, %d erasures", cuts,
             cut_erasures, boots, flash.erasures[0] + flash.erasures[1]);
    TEST_MESSAGE(text);
    TEST_ASSERT_TRUE(cut_erasures > HOST_OR_BOARD(500, 3));
}

/* The erase of a sector that is no longer needed, cut off again and again: the newest stays the newest. */
static void an_erase_cut_off_any_number_of_times_is_done_in_the_end(void)
{
    const hal h = flash_hal(&flash);
    uint32_t seed = 4u;
    for (int round = 0; round < HOST_OR_BOARD(300, 5); round++) {
        flash_blank(&flash);
        boot(&s, &h);
        uint32_t generation = 0;
        while (s.active != 1 || s.sector[1].copies_n < 2) { /* until sector 0 can go */
            TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, ++generation));
        }
        /* sometimes all words are erased as the power fails: then there is nothing left to do */
        for (int i = 0; i < 4 && (i == 0 || s.sector[0].end > 0); i++) {
            flash.words_left = 0;
            flash.seed = random_bits(&seed);
            TEST_ASSERT_EQUAL_INT(SETTINGS_E_FLASH, boot(&s, &h));
            TEST_ASSERT_EQUAL_UINT32(generation, loaded(&s));
            flash_revive(&flash);
        }
        const int expected = s.sector[0].end > 0 ? 1 : 0;
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h));
        TEST_ASSERT_EQUAL_UINT32(generation, loaded(&s));
        TEST_ASSERT_EQUAL_INT(SETTINGS_NEWEST, s.origin);
        TEST_ASSERT_EQUAL_UINT32(0, s.sector[0].end);
        TEST_ASSERT_EQUAL_INT(expected, flash.erasures[0]);
    }
}

/* The very first save, cut: nothing is there, and that is not passed over in silence. */
static void a_first_save_cut_off_is_told(void)
{
    const hal h = flash_hal(&flash);
    flash_blank(&flash);
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h));
    TEST_ASSERT_EQUAL_INT(SETTINGS_NONE, s.origin);
    flash.words_left = 5;
    save(&s, 1);
    for (int i = 0; i < 3; i++) { /* and not only once */
        flash_revive(&flash);
        TEST_ASSERT_EQUAL_INT(SETTINGS_OK, boot(&s, &h));
        TEST_ASSERT_EQUAL_INT(SETTINGS_DAMAGED, s.origin);
        TEST_ASSERT_EQUAL_UINT32(0, loaded(&s));
    }
    TEST_ASSERT_EQUAL_INT(SETTINGS_OK, save(&s, 2));
    boot(&s, &h);
    TEST_ASSERT_EQUAL_INT(SETTINGS_NEWEST, s.origin);
    TEST_ASSERT_EQUAL_UINT32(2, loaded(&s));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_save_cut_at_any_word_leaves_old_or_new);
    RUN_TEST(ten_thousand_cuts_on_one_flash_never_lose_or_mix_anything);
    RUN_TEST(an_erase_cut_off_any_number_of_times_is_done_in_the_end);
    RUN_TEST(a_first_save_cut_off_is_told);
    return UNITY_END();
}
