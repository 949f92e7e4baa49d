/* test_params_text.c - rod parameters as people write them: every key, every bound, every refusal. What
 * files may look like, and the way back to one: test_params_ini.c. */
#include <math.h>

#include "params_fixture.h"

static bool is_number(const rod_field *field)
{
    return field->kind != ROD_FIELD_CHOICE && strcmp(field->name, "tick") != 0;
}

/* Well inside the bounds and different for each joint. */
static float value_for(const rod_field *field, int joint)
{
    return is_per_joint(field)
               ? field->min + (field->max - field->min) * 0.001f * (float)(joint + 1)
               : field->max;
}

static void check_key(const rod_field *field, bool as_list, bool in_ini, const char *separator)
{
    const int written_n = as_list ? 4 : 1;
    char assignment[200], ini[300];
    int used = snprintf(assignment, sizeof assignment, "%s=", field->name);
    for (int joint = 0; joint < written_n; joint++) {
        used += snprintf(assignment + used, sizeof assignment - (size_t)used, "%s%.9g",
                         joint > 0 ? separator : "", (double)value_for(field, joint));
    }
    setUp();
    if (rod_field_is_read(field, ROD_MODEL_CONTOUR)) {
        set("inertia=1000"); /* so that every drag and damper will do */
    } else {
        set("model=elastic");
    }
    if (in_ini) {
        snprintf(ini, sizeof ini, "[rod]\n%s\n", assignment);
        read_ini(ini);
    } else {
        set(assignment);
    }
    resolve();
    const int entries_n = is_per_joint(field) ? params.links_n : 1;
    for (int joint = 0; joint < entries_n; joint++) {
        const float expected = value_for(field, as_list ? joint : 0);
        TEST_ASSERT_FALSE(fabsf(expected - rod_field_get(field, &params, joint)) > 0.0f);
    }
}

static void test_every_key_takes_a_number_or_a_list(void)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        for (int in_ini = 0; is_number(field) && in_ini < 2; in_ini++) {
            check_key(field, false, in_ini, "");
            for (int s = 0; is_per_joint(field) && s < 4; s++) {
                static const char *const SEPARATORS[] = {",", " ", " ,\t", ", "};
                check_key(field, true, in_ini, SEPARATORS[s]);
            }
        }
    }
}

static void test_models_and_schemes_by_name(void)
{
    set("model=contour");
    set("scheme=paper");
    resolve();
    TEST_ASSERT_EQUAL_INT(ROD_SCHEME_PAPER, params.scheme);
    set("scheme=midpoint");
    resolve();
    TEST_ASSERT_EQUAL_INT(ROD_SCHEME_MIDPOINT, params.scheme);
    setUp();
    set("model=elastic");
    resolve();
    TEST_ASSERT_EQUAL_INT(ROD_MODEL_ELASTIC, params.model);
}

static void test_keys_that_the_model_does_not_read(void)
{
    static const char *const CASES[][3] = {
        {"elastic", "hold=2", "--set hold: the elastic model does not read it"},
        {"elastic", "coupling=5", "--set coupling: the elastic model does not read it"},
        {"contour", "mass=0.1", "--set mass: the contour model does not read it"},
        {"contour", "gravity=0", "--set gravity: the contour model does not read it"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        setUp();
        set(CASES[i][1]);
        TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_model(&text, CASES[i][0]));
        TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(complaint, CASES[i][2]), complaint);
    }
    setUp(); /* a file is for either model: limber params list --ini writes all keys */
    read_ini("[rod]\nmodel = elastic\nhold = 2\ncoupling = 5\nmass = 0.1\n");
    resolve();
    TEST_ASSERT_EQUAL_INT(ROD_MODEL_ELASTIC, params.model);
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_model(&text, "rubber"));
    expect_complaint("--model", 0, "model = rubber: must be contour or elastic", "");
}

static void expect_set_refused(const char *assignment, const char *reason)
{
    setUp();
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, params_text_set(&text, assignment), assignment);
    expect_complaint("--set", 0, reason, assignment);
}

static void test_every_bound_is_named(void)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        if (!is_number(field)) {
            continue;
        }
        char bounds[80];
        snprintf(bounds, sizeof bounds, "out of bounds, must be %g ... %g%s%s", (double)field->min,
                 (double)field->max, *field->unit == '\0' ? "" : " ", field->unit);
        const float allowed[] = {field->min, field->max};
        const float refused[] = {nextafterf(field->min, -1e9f),
                                 nextafterf(field->max, 1e9f),
                                 -1e9f,
                                 1e30f,
                                 INFINITY,
                                 NAN};
        char assignment[80], ini[100];
        for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
            snprintf(assignment, sizeof assignment, "%s=%.9g", field->name, (double)refused[k]);
            expect_set_refused(assignment, bounds);
            snprintf(ini, sizeof ini, "# mine\n\n[rod]\n%s\n", assignment);
            expect_ini_refused(ini, 4, bounds);
        }
        for (int k = 0; k < 2; k++) {
            snprintf(assignment, sizeof assignment, "%s=%.9g", field->name, (double)allowed[k]);
            set(assignment);
        }
    }
}

static void test_refusals_on_the_command_line(void)
{
    static const char *const CASES[][2] = {
        {"spring", "must be key=value"},
        {"=80", "must be key=value"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        setUp();
        TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_set(&text, CASES[i][0]));
        TEST_ASSERT_NOT_NULL(strstr(complaint, CASES[i][1]));
    }
    expect_set_refused("spring=", "spring has no value");
    expect_set_refused("spring= , ,", "spring has no value");
    expect_set_refused("spring=soft", "spring = soft: not a number");
    expect_set_refused("spring=80,70x", "spring = 70x: not a number");
    expect_set_refused("spring=1e", "spring = 1e: not a number");
    expect_set_refused("spring=80;70", "spring = 80;70: not a number");
    expect_set_refused("Spring=80",
                       "unknown key 'Spring'; there are model, scheme, links, hold, length,");
    expect_set_refused("tick=0.001", "the tick is set by --rate");
    expect_set_refused("links=4.5", "links = 4.5: must be a whole number");
    expect_set_refused("links=4,4", "links takes at most 1 value");
    expect_set_refused("hold=1.0001", "hold = 1.0001: must be a whole number");
    expect_set_refused("model=rubber", "model = rubber: must be contour or elastic");
    expect_set_refused("scheme=1", "scheme = 1: must be midpoint or paper");
    expect_set_refused("scheme=midpoint paper", "scheme takes at most 1 value");
    expect_set_refused("a_key_longer_than_the_forty_characters_that_are_shown_of_one=1",
                       "unknown key 'a_key_longer_than_the_forty_characters_t'");
}

static float entry(const char *key, int joint)
{
    return rod_field_get(rod_field_find(key), &params, joint);
}

static void test_lists_must_fit_the_links(void)
{
    read_ini("[rod]\nlinks = 5\nspring = 80\n 70 60\n");
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
    expect_complaint(file_path, 3, "spring has 3 values for 5 links; give one, or one per joint",
                     "");
    setUp();
    read_ini("[rod]\n  spring = 80 70\n");
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
    expect_complaint(file_path, 2, "spring has 2 values for 4 links", "");
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_preset(&text, "foil"));
    set("damper=1,2,3");
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
    expect_complaint("--set", 0, "damper has 3 values for 8 links", "");
}

static void test_what_only_the_whole_shows(void)
{
    read_ini("[rod]\n\ndamper = 1 1 500 1\n");
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1000.0, &params));
    expect_complaint(file_path, 3, "damper of joint 3 is 500 N m s", "");
    TEST_ASSERT_NOT_NULL(strstr(complaint, "at most 400 is allowed"));
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_resolve(&text, 1.0, &params));
    expect_complaint("--rate", 0, "must be 10 ... 20000 Hz", "");
}

static void test_presets_and_precedence(void)
{
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_preset(&text, "sword"));
    expect_complaint("--preset sword", 0, "there is no such preset; there are foil, whip, ribbon,",
                     "");
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        for (int links = 1; links <= ROD_MAX_LINKS; links++) {
            char assignment[20];
            setUp();
            snprintf(assignment, sizeof assignment, "links=%d", links);
            set(assignment); /* before or after the preset: it changes the preset */
            TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_preset(&text, rod_presets[i].name));
            set("damper=0.25");
            resolve();
            TEST_ASSERT_EQUAL_INT(links, params.links_n);
            TEST_ASSERT_EQUAL_FLOAT(0.25f, entry("damper", links - 1));
            TEST_ASSERT_EQUAL_FLOAT(rod_presets[i].spring.first, entry("spring", 0));
        }
    }
}

/* The model decides which of a preset's two sets of numbers is meant, wherever it is said. */
static void test_presets_of_either_model(void)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        for (int model_first = 0; model_first < 2; model_first++) {
            rod_params wanted;
            setUp();
            if (model_first) {
                TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_model(&text, "elastic"));
            }
            TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_preset(&text, rod_presets[i].name));
            if (!model_first) {
                set("model=elastic");
            }
            set("links=9");
            resolve();
            rod_preset_fill(&rod_presets[i], ROD_MODEL_ELASTIC, 9, &wanted);
            TEST_ASSERT_EQUAL_MEMORY(&wanted, &params, sizeof params);
        }
    }
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_every_key_takes_a_number_or_a_list);
    RUN_TEST(test_models_and_schemes_by_name);
    RUN_TEST(test_keys_that_the_model_does_not_read);
    RUN_TEST(test_every_bound_is_named);
    RUN_TEST(test_refusals_on_the_command_line);
    RUN_TEST(test_lists_must_fit_the_links);
    RUN_TEST(test_what_only_the_whole_shows);
    RUN_TEST(test_presets_and_precedence);
    RUN_TEST(test_presets_of_either_model);
    fixture_end();
    return UNITY_END();
}
