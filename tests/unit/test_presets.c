/* test_presets.c - the ready-made rods: valid at every size, as tapered as stated, and in character. */
#include "rod.h"
#include "test_support.h"
#include "unity.h"

#include <stdbool.h>
#include <stdio.h>

static rod_params params;

void setUp(void) {}
void tearDown(void) {}

static void test_presets_are_found_by_name(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        TEST_ASSERT_EQUAL_PTR(&rod_presets[i], rod_preset_find(rod_presets[i].name));
        TEST_ASSERT_TRUE(rod_presets[i].name[0] != '\0' && rod_presets[i].what[0] != '\0');
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_TRUE(strcmp(rod_presets[i].name, rod_presets[k].name) != 0);
        }
    }
    TEST_ASSERT_NULL(rod_preset_find("spaghetti"));
    TEST_ASSERT_NULL(rod_preset_find(""));
    TEST_ASSERT_NOT_NULL(rod_preset_find("foil")); /* rod.h's example */
}

/* Valid, factorable, and resolved: the 1 ms tick is what a preset is made for. */
static void test_presets_suit_every_number_of_links(void)
{
    static rod r;
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const rod_preset *preset = &rod_presets[i];
        TEST_ASSERT_TRUE(preset->links_n >= 1 && preset->links_n <= ROD_MAX_LINKS);
        for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
            rod_preset_fill(preset, links_n, &params);
            TEST_ASSERT_EQUAL_INT(links_n, params.links_n);
            TEST_ASSERT_EQUAL_INT(preset->hold_n, params.hold_n);
            TEST_ASSERT_EQUAL_INT(ROD_SCHEME_MIDPOINT, params.scheme);
            TEST_ASSERT_EQUAL_HEX32(bits_of(0.001f), bits_of(params.tick_s));
            TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_params_check(&params, NULL), preset->name);
            TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_init(&r, &params, NULL), preset->name);
            TEST_ASSERT_TRUE_MESSAGE(rod_params_resolving_rate_hz(&params) <= 1000.0f,
                                     preset->name);
        }
    }
}

/* First at the first joint, last at the last, in a straight line between: to a few roundings. */
static void expect_taper(rod_taper taper, int links_n, int from, const float *list)
{
    for (int i = from; i < ROD_MAX_LINKS; i++) {
        const float share = links_n > 1 ? (float)i / (float)(links_n - 1) : 0.0f;
        const float wanted =
            i < links_n ? taper.first + share * (taper.last - taper.first) : taper.last;
        TEST_ASSERT_FLOAT_WITHIN(4e-7f * (taper.first + taper.last), wanted, list[i]);
    }
}

static void test_presets_taper_evenly(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const rod_preset *preset = &rod_presets[i];
        for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
            rod_preset_fill(preset, links_n, &params);
            expect_taper(preset->length_m, links_n, 0, params.length_m);
            expect_taper(preset->inertia, links_n, 0, params.inertia);
            expect_taper(preset->drag, links_n, 0, params.drag);
            expect_taper(preset->coupling, links_n, 1, params.coupling);
            expect_taper(preset->smoothing, links_n, 0, params.smoothing);
            expect_taper(preset->spring, links_n, 0, params.spring);
            expect_taper(preset->damper, links_n, 0, params.damper);
            expect_taper(preset->limit_rad, links_n, 0, params.limit_rad);
            TEST_ASSERT_EQUAL_HEX32(bits_of(preset->hand_coupling), bits_of(params.coupling[0]));
        }
    }
}

static void test_some_preset_smooths(void)
{
    int smoothing_n = 0;
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        smoothing_n += rod_presets[i].smoothing.first > 0.0f;
    }
    TEST_ASSERT_TRUE(smoothing_n >= 1);
}

/* --- in character ------------------------------------------------------------------------------ */

enum { TURN_TICKS = 239, TURNS_N = 6 }; /* 2.39 s a turn at 100 Hz */

/* The amplitude of theta of the first and the last joint in the sixth turn of a circle of 0.15 m. */
static void amplitudes_on_the_circle(const rod_preset *preset, double amplitude[2])
{
    static rod r;
    double re[2] = {0.0, 0.0}, im[2] = {0.0, 0.0};
    rod_preset_fill(preset, preset->links_n, &params);
    params.tick_s = 0.01f;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, &params, NULL));
    for (int tick = 0; tick < TURNS_N * TURN_TICKS; tick++) {
        const double angle = 2.0 * PI * tick / TURN_TICKS;
        const rod_pose hand = {{(float)(0.15 * cos(angle)), (float)(0.15 * sin(angle)), 0.0f},
                               {0.0f, 0.0f, 0.0f, 1.0f}};
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &hand));
        for (int i = 0; i < 2 && tick >= (TURNS_N - 1) * TURN_TICKS; i++) {
            const double theta = (double)rod_angles(&r)[i * (params.links_n - 1)][ROD_THETA];
            re[i] += theta * cos(angle) * 2.0 / TURN_TICKS;
            im[i] += theta * sin(angle) * 2.0 / TURN_TICKS;
        }
    }
    amplitude[0] = hypot(re[0], im[0]);
    amplitude[1] = hypot(re[1], im[1]);
}

/* In a soft rod the bend reaches the tip; in a stiff one there is hardly any. */
static void test_soft_presets_bend_to_the_tip(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const char *name = rod_presets[i].name;
        const bool soft = strcmp(name, "whip") == 0 || strcmp(name, "ribbon") == 0;
        double amplitude[2];
        amplitudes_on_the_circle(&rod_presets[i], amplitude);
        printf("%-12s joint 1 %.4f rad, last %.4f rad, %.2f of it\n", name, amplitude[0],
               amplitude[1], amplitude[1] / amplitude[0]);
        if (soft) {
            TEST_ASSERT_TRUE_MESSAGE(amplitude[0] > 0.005, name);
            TEST_ASSERT_TRUE_MESSAGE(amplitude[1] >= 0.3 * amplitude[0], name);
        }
        if (strcmp(name, "stiff-bar") == 0) {
            TEST_ASSERT_TRUE_MESSAGE(amplitude[0] < 0.01, name);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_presets_are_found_by_name);
    RUN_TEST(test_presets_suit_every_number_of_links);
    RUN_TEST(test_presets_taper_evenly);
    RUN_TEST(test_some_preset_smooths);
    RUN_TEST(test_soft_presets_bend_to_the_tip);
    return UNITY_END();
}
