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
static void expect_suitable(const rod_preset *preset, int32_t model, int links_n)
{
    static rod r;
    rod_preset_fill(preset, model, links_n, &params);
    TEST_ASSERT_EQUAL_INT(model, params.model);
    TEST_ASSERT_EQUAL_INT(links_n, params.links_n);
    TEST_ASSERT_EQUAL_INT(preset->hold_n, params.hold_n);
    TEST_ASSERT_EQUAL_INT(ROD_SCHEME_MIDPOINT, params.scheme);
    TEST_ASSERT_EQUAL_HEX32(bits_of(0.001f), bits_of(params.tick_s));
    TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_params_check(&params, NULL), preset->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_init(&r, &params, NULL), preset->name);
    TEST_ASSERT_TRUE_MESSAGE(rod_params_resolving_rate_hz(&params) <= 1000.0f, preset->name);
    params.links_n = ROD_MAX_LINKS; /* links that come later are like the last */
    TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_params_check(&params, NULL), preset->name);
}

static void test_presets_suit_every_number_of_links(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const rod_preset *preset = &rod_presets[i];
        TEST_ASSERT_TRUE(preset->links_n >= 1 && preset->links_n <= ROD_MAX_LINKS);
        for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
            expect_suitable(preset, ROD_MODEL_CONTOUR, links_n);
            expect_suitable(preset, ROD_MODEL_ELASTIC, links_n);
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
            rod_preset_fill(preset, ROD_MODEL_CONTOUR, links_n, &params);
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

/* --- elastic --- */

static double sum_of(const float *list)
{
    double sum = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        sum += (double)list[i];
    }
    return sum;
}

/* Cut finer, it is the same rod: as long as contour's at the number of links that suits it, and as quick. */
static void test_an_elastic_preset_is_one_rod(void)
{
    /* of the beams themselves, by numpy: test_material.c has the way */
    static const double FIRST_MODE_HZ[ROD_PRESETS_N] = {6.7607, 0.85057, 0.69202,
                                                        5.0158, 156.80,  20.502};
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const rod_preset *preset = &rod_presets[i];
        rod_preset_fill(preset, ROD_MODEL_CONTOUR, preset->links_n, &params);
        const double length_m = sum_of(params.length_m);
        for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
            rod_preset_fill(preset, ROD_MODEL_ELASTIC, links_n, &params);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 * length_m, length_m, sum_of(params.length_m));
            const double off = links_n < 3 ? 0.5 : links_n < 8 ? 0.14 : 0.02;
            TEST_ASSERT_DOUBLE_WITHIN(off * FIRST_MODE_HZ[i], FIRST_MODE_HZ[i],
                                      (double)rod_params_first_mode_hz(&params));
        }
    }
}

static void test_an_elastic_preset_is_its_blank(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        TEST_ASSERT_TRUE_MESSAGE(rod_blank_check(&rod_presets[i].blank, NULL), rod_presets[i].name);
        for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n += 9) {
            rod_params wanted;
            rod_params_defaults(&wanted);
            wanted.model = ROD_MODEL_ELASTIC;
            wanted.links_n = links_n;
            rod_blank_fill(&rod_presets[i].blank, &wanted);
            rod_preset_fill(&rod_presets[i], ROD_MODEL_ELASTIC, links_n, &params);
            TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted.length_m, params.length_m, ROD_MAX_LINKS);
            TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted.spring, params.spring, ROD_MAX_LINKS);
            TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted.damper, params.damper, ROD_MAX_LINKS);
            TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted.mass_kg, params.mass_kg, ROD_MAX_LINKS);
            TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted.drag, params.drag, ROD_MAX_LINKS);
        }
    }
}

/* What presets.c says of those whose dimensions somebody has published. */
static void test_presets_keep_to_their_sources(void)
{
    const rod_blank *foil = &rod_preset_find("foil")->blank;
    TEST_ASSERT_TRUE(foil->length_m <= 0.9f);

    const rod_blank *stick = &rod_preset_find("ribbon-stick")->blank;
    TEST_ASSERT_TRUE(stick->length_m >= 0.5f && stick->length_m <= 0.6f);
    TEST_ASSERT_TRUE(stick->diameter_m[ROD_BUTT] <= 0.01f);

    /* 7 ft, butt 0.276 in, tip 4/64 in, 0.85 oz; what is beyond the handle has the same taper */
    const rod_blank *rod = &rod_preset_find("fishing-rod")->blank;
    const double inch_m = 0.0254, butt_m = 0.276 * inch_m, tip_m = 4.0 / 64.0 * inch_m;
    const double all_m = 84.0 * inch_m, free_share = (double)rod->length_m / all_m;
    const double wall = 1.0 - (double)rod->bore * (double)rod->bore;
    const double mass_kg = (double)rod->density_kg_m3 * PI / 12.0 * wall * all_m *
                           (butt_m * butt_m + butt_m * tip_m + tip_m * tip_m);
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * 0.0241, 0.0241, mass_kg);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, tip_m, (double)rod->diameter_m[ROD_TIP]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, tip_m + (butt_m - tip_m) * free_share,
                              (double)rod->diameter_m[ROD_BUTT]);

    /* 15.5 mm at the handle, 5.3 mm after 1.68 m */
    const rod_blank *whip = &rod_preset_find("whip")->blank;
    TEST_ASSERT_EQUAL_FLOAT(15.5e-3f, whip->diameter_m[ROD_BUTT]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, 15.5e-3 - 10.2e-3 * (double)whip->length_m / 1.68,
                              (double)whip->diameter_m[ROD_TIP]);
}

/* The FIE's material rules, m.8: clamped 70 cm from its point, 200 g hung 3 cm from it, a foil's blade bends by 5.5
 * to 9.5 cm. In links of 2 cm; at the clamp there is half of one to bend. */
static void test_the_foil_would_pass_the_fie(void)
{
    const double clamp_m = 0.88 - 0.70, weight_m = 0.88 - 0.03;
    double bend_m = 0.0;
    rod_preset_fill(rod_preset_find("foil"), ROD_MODEL_ELASTIC, 44, &params);
    for (int j = 9; j < 44; j++) {
        const double at_m = 0.02 * j, arm_m = weight_m - at_m;
        const double half = at_m < clamp_m + 0.001 ? 0.5 : 1.0;
        bend_m += arm_m > 0.0 ? half * 0.2 * 9.81 * arm_m / (double)params.spring[j] * (0.88 - at_m)
                              : 0.0;
    }
    printf("foil: the FIE's weight bends it by %.1f mm\n", 1000.0 * bend_m);
    TEST_ASSERT_DOUBLE_WITHIN(0.0002, 0.0732, bend_m); /* presets.c says 7.3 cm */
}

/* Nudged by 1 mm, it swings at the frequency that rod_params_first_mode_hz gives. */
static void test_an_elastic_preset_swings_at_its_first_mode(void)
{
    enum { TICKS_N = 3000, SETTLED = 500 };
    static rod r;
    static const char *const NAMES[] = {
        "foil", "fishing-rod"}; /* the others are damped too soon, or stiff */
    for (int k = 0; k < 2; k++) {
        rod_preset_fill(rod_preset_find(NAMES[k]), ROD_MODEL_ELASTIC, 10, &params);
        params.gravity_m_s2 = 0.0f;
        memset(params.drag, 0, sizeof params.drag); /* a thin tip is much braked by air */
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&r, &params, NULL));
        double first = -1.0, last = 0.0, before = 0.0;
        int rises_n = -1;
        for (int tick = 0; tick < TICKS_N; tick++) {
            const rod_pose hand = {{tick < 10 ? 0.0f : 0.001f, 0.0f, 0.0f},
                                   {0.0f, 0.0f, 0.0f, 1.0f}};
            TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&r, &hand));
            const double now = (double)rod_angles(&r)[0][ROD_THETA];
            if (tick > SETTLED && before < 0.0 && now >= 0.0) {
                last = tick - now / (now - before);
                first = rises_n < 0 ? last : first;
                rises_n++;
            }
            before = now;
        }
        const double wanted_hz = (double)rod_params_first_mode_hz(&params);
        TEST_ASSERT_TRUE_MESSAGE(rises_n > 8, NAMES[k]);
        TEST_ASSERT_DOUBLE_WITHIN(0.005 * wanted_hz, wanted_hz, rises_n / ((last - first) * 0.001));
    }
}

/* --- in character ------------------------------------------------------------------------------ */

enum { TURN_TICKS = 239, TURNS_N = 6 }; /* 2.39 s a turn at 100 Hz */

/* The amplitude of theta of the first and the last joint in the sixth turn of a circle of 0.15 m. */
static void amplitudes_on_the_circle(const rod_preset *preset, int32_t model, double amplitude[2])
{
    static rod r;
    double re[2] = {0.0, 0.0}, im[2] = {0.0, 0.0};
    rod_preset_fill(preset, model, preset->links_n, &params);
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
        amplitudes_on_the_circle(&rod_presets[i], ROD_MODEL_CONTOUR, amplitude);
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

/* On the hand's circle the elastic rods bend in the order of their stiffness, as their namesakes do. */
static void test_elastic_presets_are_as_soft_as_they_say(void)
{
    static const char *const STIFFEST_FIRST[] = {"stiff-bar",   "ribbon-stick", "foil",
                                                 "fishing-rod", "ribbon",       "whip"};
    double before = 0.0;
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        const rod_preset *preset = rod_preset_find(STIFFEST_FIRST[i]);
        double amplitude[2];
        amplitudes_on_the_circle(preset, ROD_MODEL_ELASTIC, amplitude);
        const double tilt = amplitude[0] * preset->links_n;
        printf("%-12s joint 1 %.5f rad, last %.5f rad\n", preset->name, amplitude[0], amplitude[1]);
        TEST_ASSERT_TRUE_MESSAGE(tilt > before, preset->name);
        before = tilt;
        if (i == 0) {
            TEST_ASSERT_TRUE(amplitude[0] < 0.01);
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
    RUN_TEST(test_an_elastic_preset_is_one_rod);
    RUN_TEST(test_an_elastic_preset_is_its_blank);
    RUN_TEST(test_presets_keep_to_their_sources);
    RUN_TEST(test_the_foil_would_pass_the_fie);
    RUN_TEST(test_an_elastic_preset_swings_at_its_first_mode);
    RUN_TEST(test_soft_presets_bend_to_the_tip);
    RUN_TEST(test_elastic_presets_are_as_soft_as_they_say);
    return UNITY_END();
}
