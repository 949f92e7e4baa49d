/* test_params_material.c - rods asked for by what they are made of, as people write it: every key and bound, what is
 * needed, what contradicts, what goes before what, and what is told of the rod that comes out. */
#include <math.h>

#include "params_derived.h"
#include "params_fixture.h"
#include "params_material.h"

static const char STEEL_ROD[] = "[rod]\nmaterial = spring-steel\ntotal_length = 1.2\n"
                                "diameter = 0.008 0.004\nlinks = 20\n";

static rod_blank blank;

static void expect_unresolved(const char *path, long line, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
    expect_complaint(path, line, reason, "");
}

/* What was written, and the rod that follows from it, are these. */
static void expect_blank(const rod_blank *wanted, int32_t model, int links_n)
{
    resolve();
    TEST_ASSERT_TRUE(params_material_is_asked(&text));
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_material_blank(&text, &blank));
    TEST_ASSERT_EQUAL_FLOAT_ARRAY((const float *)wanted, (const float *)&blank,
                                  sizeof blank / sizeof(float));
    rod_params rod;
    rod_params_defaults(&rod);
    rod.model = model;
    rod.links_n = links_n;
    rod_blank_fill(wanted, &rod);
    TEST_ASSERT_EQUAL_INT(model, params.model);
    TEST_ASSERT_EQUAL_INT(links_n, params.links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.spring, params.spring, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.damper, params.damper, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.drag, params.drag, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.length_m, params.length_m, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.mass_kg, params.mass_kg, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.inertia, params.inertia, links_n);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(rod.coupling, params.coupling, links_n);
}

static void test_every_material_is_there_by_name(void)
{
    for (int i = 0; i < MATERIALS_N; i++) {
        const material *m = &materials[i];
        char assignment[60];
        setUp();
        snprintf(assignment, sizeof assignment, "material=%s", material_names[i]);
        set(assignment);
        set("total_length=0.5");
        set("diameter=0.004");
        const rod_blank wanted = {.youngs_modulus_pa = m->youngs_modulus_pa,
                                  .density_kg_m3 = m->density_kg_m3,
                                  .diameter_m = {0.004f, 0.004f},
                                  .damping_ratio = m->damping_ratio,
                                  .length_m = 0.5f};
        expect_blank(&wanted, ROD_MODEL_ELASTIC, 10);
        TEST_ASSERT_TRUE(rod_blank_check(&wanted, NULL) && *m->what != '\0');
    }
}

static void test_single_numbers_go_before_the_material(void)
{
    read_ini(STEEL_ROD);
    set("density=8000");
    set("bore=0.5");
    set("damping_ratio=0.1");
    set("air_drag=0.2");
    const rod_blank wanted = {.youngs_modulus_pa = 206e9f,
                              .density_kg_m3 = 8000.0f,
                              .diameter_m = {0.008f, 0.004f},
                              .bore = 0.5f,
                              .damping_ratio = 0.1f,
                              .length_m = 1.2f,
                              .drag_n_s_m2 = 0.2f};
    expect_blank(&wanted, ROD_MODEL_ELASTIC, 20);
    set("model=contour");
    expect_blank(&wanted, ROD_MODEL_CONTOUR, 20);
}

static void test_no_material_is_needed(void)
{
    read_ini("[rod]\nyoungs_modulus = 3e9\ndensity = 1200\ndiameter = 0.01\ntotal_length = 0.4\n");
    const rod_blank wanted = {.youngs_modulus_pa = 3e9f,
                              .density_kg_m3 = 1200.0f,
                              .diameter_m = {0.01f, 0.01f},
                              .damping_ratio = 0.01f,
                              .length_m = 0.4f};
    expect_blank(&wanted, ROD_MODEL_ELASTIC, 10);
}

static void test_a_preset_of_another_material(void)
{
    rod_blank wanted = rod_preset_find("fishing-rod")->blank;
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_preset(&text, "fishing-rod"));
    set("damping_ratio=0.3");
    wanted.damping_ratio = 0.3f;
    expect_blank(&wanted, ROD_MODEL_ELASTIC, 12);
    set("material=bamboo");
    wanted.youngs_modulus_pa = materials[MATERIAL_BAMBOO].youngs_modulus_pa;
    wanted.density_kg_m3 = materials[MATERIAL_BAMBOO].density_kg_m3;
    expect_blank(&wanted, ROD_MODEL_ELASTIC, 12);
    TEST_ASSERT_EQUAL_FLOAT(1.2f, params.limit_rad[0]); /* the preset's */
}

static void test_every_bound_of_a_blank_is_named(void)
{
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        const rod_blank_field *field = &rod_blank_fields[i];
        const float values[] = {nextafterf(field->min, -1e9f), nextafterf(field->max, 1e30f), NAN};
        for (int k = 0; k < 3; k++) {
            char ini[100], bounds[100];
            snprintf(ini, sizeof ini, "[rod]\n%s = %.9g\n", field->name, (double)values[k]);
            snprintf(bounds, sizeof bounds, "out of bounds, must be %g ... %g%s%s",
                     (double)field->min, (double)field->max, *field->unit == '\0' ? "" : " ",
                     field->unit);
            expect_ini_refused(ini, 2, bounds);
        }
    }
    expect_ini_refused("[rod]\nmaterial = wood\n", 2,
                       "material = wood: must be spring-steel, aluminium, carbon, fibreglass, "
                       "bamboo, ash or nylon");
    expect_ini_refused("[rod]\ndiameter = 0.1 0.1\n 0.1\n", 3, "diameter takes at most 2 values");
    expect_ini_refused("[rod]\nbore = 0.1 0.1\n", 2, "bore takes at most 1 value");
    expect_ini_refused("[rod]\nstiffness = 1\n", 2, "total_length, air_drag, material");
}

static void test_what_is_missing_is_told(void)
{
    set("density=1000");
    expect_unresolved("--set", 0,
                      "for a rod that follows from density add youngs_modulus, "
                      "diameter, total_length (a material gives the first two), or");
    setUp();
    read_ini("[rod]\n\nmaterial = carbon\ntotal_length = 1\n");
    expect_unresolved(file_path, 3, "for a rod that follows from material add diameter, or");
}

static void test_what_contradicts_is_told(void)
{
    static const struct {
        const char *key, *reason;
    } CASES[] = {
        {"length=0.1", "length follows from material ("},
        {"spring=5", "spring follows from material ("},
        {"mass=0.1", "mass follows from material ("},
        {"inertia=0.1", "inertia follows from material ("},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        setUp();
        read_ini(STEEL_ROD);
        set(CASES[i].key);
        expect_unresolved("--set", 0, CASES[i].reason);
        TEST_ASSERT_NOT_NULL(strstr(complaint, "file.txt:2): leave out one of them"));
    }
    static const char *const EITHER[][3] = {{"damper=0.5", "damping_ratio=0.1", "damper"},
                                            {"drag=0.5", "air_drag=0.1", "drag"}};
    for (int i = 0; i < 2; i++) {
        setUp();
        read_ini(STEEL_ROD);
        set(EITHER[i][0]); /* in place of what follows */
        resolve();
        TEST_ASSERT_EQUAL_FLOAT(0.5f, rod_field_get(rod_field_find(EITHER[i][2]), &params, 7));
        set(EITHER[i][1]);
        expect_unresolved("--set", 0, "leave out one of them");
    }
}

/* Options go before a file; a file of a rod does not quietly undo a material. */
static void test_files_lie_beneath_options(void)
{
    params_text file = {0};
    write_text(STEEL_ROD);
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_read_ini(&file, file_path));
    set("material=ash");
    set("links=7");
    params_text_beneath(&text, &file);
    resolve();
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_material_blank(&text, &blank));
    TEST_ASSERT_EQUAL_FLOAT(materials[MATERIAL_ASH].density_kg_m3, blank.density_kg_m3);
    TEST_ASSERT_EQUAL_FLOAT(1.2f, blank.length_m);
    TEST_ASSERT_EQUAL_INT(7, params.links_n);
}

static void test_what_the_rod_cannot_take_is_told(void)
{
    read_ini(STEEL_ROD);
    set("diameter=0.3");
    expect_unresolved("rod", 0, "spring of joint 1 comes out as ");
    TEST_ASSERT_NOT_NULL(strstr(complaint, "N m, must be 0 ... 1e+06: ask for fewer links, or"));
    setUp();
    read_ini(STEEL_ROD);
    set("diameter=0.0002");
    set("total_length=0.2");
    set("links=64");
    expect_unresolved("rod", 0, "mass of joint 1 comes out as ");
    setUp();
    read_ini(STEEL_ROD);
    set("damping_ratio=1");
    set("diameter=0.0001,0.2");
    set("youngs_modulus=1e7");
    expect_unresolved("rod", 0, "less damping_ratio");
}

/* --- what is told of a rod --- */

static void uniform_steel(const char *links)
{
    read_ini(STEEL_ROD);
    set("diameter=0.006");
    set(links);
    resolve();
}

/* Of the beam -0.03, -0.17 and -0.36 % at N = 50 (model.md); droop q L^4 / 8 EI (1 + 1 / N^2). */
static void test_modes_and_droop_are_beam_theorys(void)
{
    static const double ROOT[PARAMS_MODES_N] = {1.87510407, 4.69409113, 7.85475744};
    static const double BELOW[PARAMS_MODES_N] = {0.000338, 0.001714, 0.003609};
    double hz[PARAMS_MODES_N];
    uniform_steel("links=50");
    params_modes_hz(&params, hz);
    const double radius_m = 0.25 * 0.006; /* of gyration */
    const double speed = sqrt(206e9 / 7850.0) * radius_m / (1.2 * 1.2);
    for (int mode = 0; mode < PARAMS_MODES_N; mode++) {
        const double theory_hz = ROOT[mode] * ROOT[mode] * speed / (2.0 * 3.14159265358979);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0 - BELOW[mode], hz[mode] / theory_hz);
    }
    const double droop_m = 9.81 * pow(1.2, 4) / (8.0 * 206e9 / 7850.0 * radius_m * radius_m);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.0 + 1.0 / 2500.0, params_droop_m(&params) / droop_m);
    for (int links_n = 1; links_n <= 2; links_n++) {
        uniform_steel(links_n == 1 ? "links=1" : "links=2");
        params_modes_hz(&params, hz);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * hz[0], (double)rod_params_first_mode_hz(&params), hz[0]);
        TEST_ASSERT_TRUE(links_n == 1 ? !(hz[1] > 0.0) : hz[1] > hz[0] && !(hz[2] > 0.0));
    }
}

static void expect_warning(const char *words)
{
    resolve();
    forget_complaints();
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_material_blank(&text, &blank));
    params_derived_warn(&blank, &params);
    TEST_ASSERT_EQUAL_INT_MESSAGE(*words != '\0', complaints_n, complaint);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(complaint, words), complaint);
}

static void test_warnings(void)
{
    static const struct {
        const char *set[4], *words;
    } CASES[] = {
        {{"diameter=0.006", "links=10", "damping_ratio=0.1"}, ""},
        {{"total_length=0.2", "links=10", "bore=0"},
         "the first natural frequency, 188 Hz, wants 1179 "},
        {{"total_length=0.35", "links=10", "bore=0"}, "the second natural frequency, 2"},
        {{"diameter=0.0001,0.05", "links=64", "youngs_modulus=1e6", "damping_ratio=0"},
         "node 1 weighs "},
        {{"model=contour", "links=6", "diameter=0.006"}, ""},
        {{"model=contour", "links=50", "diameter=0.006"}, "ask for fewer links"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        setUp();
        read_ini(STEEL_ROD);
        for (int k = 0; k < 4 && CASES[i].set[k] != NULL; k++) {
            set(CASES[i].set[k]);
        }
        expect_warning(CASES[i].words);
    }
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_every_material_is_there_by_name);
    RUN_TEST(test_single_numbers_go_before_the_material);
    RUN_TEST(test_no_material_is_needed);
    RUN_TEST(test_a_preset_of_another_material);
    RUN_TEST(test_every_bound_of_a_blank_is_named);
    RUN_TEST(test_what_is_missing_is_told);
    RUN_TEST(test_what_contradicts_is_told);
    RUN_TEST(test_files_lie_beneath_options);
    RUN_TEST(test_what_the_rod_cannot_take_is_told);
    RUN_TEST(test_modes_and_droop_are_beam_theorys);
    RUN_TEST(test_warnings);
    fixture_end();
    return UNITY_END();
}
