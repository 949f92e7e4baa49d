/* test_rod_params.c - every bound of every parameter, from both sides, and the table behind them. */
#include "rod_params.h"
#include "test_support.h"
#include "unity.h"

#include <stdbool.h>

static rod_params params;

/* A set that no single field at either bound spoils: undamped, and with inertia enough for any damper. */
void setUp(void)
{
    rod_params_defaults(&params);
    params.links_n = ROD_MAX_LINKS;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.inertia[i] = 1e3f;
        params.drag[i] = params.damper[i] = 0.0f;
    }
}

void tearDown(void) {}

static bool is_whole(const rod_field *field)
{
    return field->kind == ROD_FIELD_CHOICE || field->kind == ROD_FIELD_COUNT_OF;
}

static int entries_of(const rod_field *field)
{
    return field->kind == ROD_FIELD_PER_JOINT ? ROD_MAX_LINKS : 1;
}

/* --- bounds ------------------------------------------------------------------------------------ */

/* Writes `value`, expects the field's own refusal, and puts the old value back. */
static void expect_refused(const rod_field *field, int joint, float value)
{
    const bool per_joint = field->kind == ROD_FIELD_PER_JOINT;
    const float before = rod_field_get(field, &params, joint);
    rod_field_set(field, &params, joint, value);
    const float kept = rod_field_get(field, &params, joint); /* whole numbers cannot be NaN */

    rod_refusal refusal;
    TEST_ASSERT_EQUAL_INT_MESSAGE(field->error, rod_params_check(&params, &refusal), field->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(field->error, refusal.error, field->name);
    TEST_ASSERT_EQUAL_PTR_MESSAGE(field, refusal.field, field->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(per_joint ? joint : -1, refusal.joint, field->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(kept), bits_of(refusal.value), field->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(field->min), bits_of(refusal.min), field->name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(field->max), bits_of(refusal.max), field->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(field->error, rod_params_check(&params, NULL), field->name);
    rod_field_set(field, &params, joint, before);
}

static void expect_accepted(const rod_field *field, int joint, float value)
{
    const float before = rod_field_get(field, &params, joint);
    rod_field_set(field, &params, joint, value);
    rod_refusal refusal;
    TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_params_check(&params, &refusal), field->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, refusal.error, field->name);
    TEST_ASSERT_NULL_MESSAGE(refusal.field, field->name);
    rod_field_set(field, &params, joint, before);
}

static void test_bounds_of_every_field_at_every_joint(void)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        const float step = is_whole(field) ? 1.0f : 0.0f;
        for (int joint = 0; joint < entries_of(field); joint++) {
            expect_accepted(field, joint, field->min);
            expect_accepted(field, joint, field->max);
            expect_refused(field, joint,
                           step > 0.0f ? field->min - 1.0f : nextafterf(field->min, -1.0f));
            expect_refused(field, joint,
                           step > 0.0f ? field->max + 1.0f : nextafterf(field->max, 1e9f));
            expect_refused(field, joint, NAN);
            expect_refused(field, joint, INFINITY);
            expect_refused(field, joint, -INFINITY);
            expect_refused(field, joint, -1e30f);
        }
    }
}

/* What the bounds are: a bound that moves is a change people must be told of. */
static void test_bounds_are_these(void)
{
    static const struct {
        const char *name;
        float min, max;
    } WANTED[ROD_FIELDS_N] = {
        {"model", 0.0f, 1.0f},     {"scheme", 0.0f, 1.0f}, {"links", 1.0f, ROD_MAX_LINKS},
        {"hold", 1.0f, 2.0f},      {"tick", 5e-5f, 0.1f},  {"length", 1e-3f, 10.0f},
        {"inertia", 1e-6f, 1e3f},  {"drag", 0.0f, 1e4f},   {"coupling", 0.0f, 1e6f},
        {"smoothing", 0.0f, 1e6f}, {"spring", 0.0f, 1e6f}, {"damper", 0.0f, 1e4f},
        {"limit", 1e-3f, 1.57f},   {"mass", 1e-6f, 1e3f},  {"gravity", 0.0f, 100.0f},
    };
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = rod_field_find(WANTED[i].name);
        TEST_ASSERT_NOT_NULL_MESSAGE(field, WANTED[i].name);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(WANTED[i].min), bits_of(field->min), field->name);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(WANTED[i].max), bits_of(field->max), field->name);
    }
}

static void test_joints_beyond_the_last_are_ignored(void)
{
    for (int links_n = 1; links_n < ROD_MAX_LINKS; links_n++) {
        setUp();
        params.links_n = links_n;
        for (int i = 0; i < ROD_FIELDS_N; i++) {
            const rod_field *field = &rod_fields[i];
            if (field->kind == ROD_FIELD_PER_JOINT) {
                rod_field_set(field, &params, links_n, NAN);
                TEST_ASSERT_EQUAL_INT_MESSAGE(ROD_OK, rod_params_check(&params, NULL), field->name);
                expect_refused(field, links_n - 1, NAN);
            }
        }
    }
}

/* A count of links that no array has must not be used as one. */
static void test_a_wild_count_of_links_reads_nothing(void)
{
    static const int32_t WILD[] = {0, -1, ROD_MAX_LINKS + 1, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof WILD / sizeof WILD[0]; i++) {
        params.links_n = WILD[i];
        TEST_ASSERT_EQUAL_INT(ROD_E_LINKS, rod_params_check(&params, NULL));
    }
}

/* --- (drag + damper) * tick <= 2 * inertia ----------------------------------------------------- */

static void expect_overdamped(int joint, float damper_max)
{
    rod_refusal refusal;
    TEST_ASSERT_EQUAL_INT(ROD_E_OVERDAMPED, rod_params_check(&params, &refusal));
    TEST_ASSERT_EQUAL_INT(ROD_E_OVERDAMPED, refusal.error);
    TEST_ASSERT_EQUAL_PTR(rod_field_find("damper"), refusal.field);
    TEST_ASSERT_EQUAL_INT(joint, refusal.joint);
    TEST_ASSERT_EQUAL_HEX32(bits_of(params.damper[joint]), bits_of(refusal.value));
    TEST_ASSERT_EQUAL_HEX32(bits_of(0.0f), bits_of(refusal.min));
    TEST_ASSERT_EQUAL_HEX32(bits_of(damper_max), bits_of(refusal.max));
}

/* Powers of two, so that the bound is met to the bit: 2 * 0.25 * 1024 = 512 = drag + damper. */
static void test_overdamped_begins_just_beyond_the_bound(void)
{
    params.tick_s = 0x1p-10f;
    for (int joint = 0; joint < ROD_MAX_LINKS; joint++) {
        params.inertia[joint] = 0.25f;
        params.drag[joint] = 12.0f;
        params.damper[joint] = 500.0f;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_params_check(&params, NULL));
        params.damper[joint] = nextafterf(500.0f, 1e9f);
        expect_overdamped(joint, 500.0f);
        params.damper[joint] = 500.0f;
        params.drag[joint] = 13.0f;
        expect_overdamped(joint, 499.0f);
        params.drag[joint] = 12.0f;
        params.inertia[joint] = nextafterf(0.25f, 0.0f);
        TEST_ASSERT_EQUAL_INT(ROD_E_OVERDAMPED, rod_params_check(&params, NULL));
        params.inertia[joint] = 0.25f;
    }
}

/* Drag alone can be too much: no damper would do then, and none at all is refused as well. */
static void test_overdamped_by_drag_alone(void)
{
    params.tick_s = 0x1p-10f;
    params.inertia[0] = 0.25f;
    params.drag[0] = 512.0f;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_params_check(&params, NULL));
    params.drag[0] = 513.0f;
    expect_overdamped(0, -1.0f);
}

/* --- the table --------------------------------------------------------------------------------- */

static void test_every_error_has_its_own_text(void)
{
    for (int a = 0; a >= ROD_E_SHAPE; a--) {
        const char *text = rod_error_text((rod_error)a);
        TEST_ASSERT_NOT_NULL(text);
        TEST_ASSERT_TRUE(text[0] != '\0');
        TEST_ASSERT_TRUE(strcmp(text, "unknown error") != 0);
        for (int b = 0; b > a; b--) {
            TEST_ASSERT_TRUE_MESSAGE(strcmp(text, rod_error_text((rod_error)b)) != 0, text);
        }
    }
    TEST_ASSERT_EQUAL_STRING("unknown error", rod_error_text((rod_error)(ROD_E_SHAPE - 1)));
    TEST_ASSERT_EQUAL_STRING("unknown error", rod_error_text((rod_error)1));
}

static void test_fields_are_told_apart(void)
{
    for (int a = 0; a < ROD_FIELDS_N; a++) {
        const rod_field *field = &rod_fields[a];
        TEST_ASSERT_EQUAL_PTR(field, rod_field_find(field->name));
        TEST_ASSERT_TRUE(field->name[0] != '\0' && field->what[0] != '\0');
        TEST_ASSERT_NOT_NULL(field->symbol);
        TEST_ASSERT_NOT_NULL(field->unit);
        TEST_ASSERT_TRUE(field->min <= field->initial && field->initial <= field->max);
        for (int choice = 0; field->kind == ROD_FIELD_CHOICE && choice <= (int)field->max;
             choice++) {
            TEST_ASSERT_TRUE(field->choices[choice][0] != '\0');
        }
        for (int b = 0; b < a; b++) {
            TEST_ASSERT_TRUE_MESSAGE(strcmp(field->name, rod_fields[b].name) != 0, field->name);
            TEST_ASSERT_TRUE_MESSAGE(field->error != rod_fields[b].error, field->name);
            TEST_ASSERT_TRUE_MESSAGE(field->offset != rod_fields[b].offset, field->name);
        }
    }
    TEST_ASSERT_NULL(rod_field_find("stiffness"));
    TEST_ASSERT_NULL(rod_field_find(""));
    TEST_ASSERT_NULL(rod_field_find("sprin"));
}

/* What is written is read again, at that entry, and at no other of any field. */
static void test_set_and_get_meet_one_entry(void)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        for (int joint = 0; joint < entries_of(field); joint++) {
            static rod_params before, after;
            before = params;
            const float old = rod_field_get(field, &params, joint);
            rod_field_set(field, &params, joint, 7.0f);
            TEST_ASSERT_EQUAL_HEX32(bits_of(7.0f), bits_of(rod_field_get(field, &params, joint)));
            after = params;
            rod_field_set(field, &params, joint, old);
            TEST_ASSERT_EQUAL_MEMORY(&before, &params, sizeof params);
            int differ_n = 0;
            for (size_t word = 0; word < sizeof params / 4; word++) {
                differ_n += memcmp((char *)&before + 4 * word, (char *)&after + 4 * word, 4) != 0;
            }
            TEST_ASSERT_EQUAL_INT(1, differ_n);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(bits_of(80.0f), bits_of(params.spring[0]));
}

/* model.md, section 4. */
static void test_defaults_are_the_papers(void)
{
    rod_params_defaults(&params);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_params_check(&params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_MODEL_CONTOUR, params.model);
    TEST_ASSERT_EQUAL_INT(ROD_SCHEME_MIDPOINT, params.scheme);
    TEST_ASSERT_EQUAL_INT(4, params.links_n);
    TEST_ASSERT_EQUAL_INT(1, params.hold_n);
    TEST_ASSERT_EQUAL_HEX32(bits_of(0.001f), bits_of(params.tick_s));
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        const float got[8] = {params.length_m[i], params.inertia[i],   params.drag[i],
                              params.coupling[i], params.smoothing[i], params.spring[i],
                              params.damper[i],   params.limit_rad[i]};
        static const float WANTED[8] = {0.03f, 0.2f, 0.0f, 100.0f, 0.0f, 80.0f, 2.0f, 1.4f};
        TEST_ASSERT_EQUAL_MEMORY(WANTED, got, sizeof got);
    }
}

static void test_resolving_rate_is_that_of_the_fastest_joint(void)
{
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.inertia[i] = 0.2f;
        params.spring[i] = params.coupling[i] = params.smoothing[i] = 1.0f;
    }
    for (int joint = 0; joint < ROD_MAX_LINKS; joint++) {
        params.inertia[joint] = 0.1f;
        params.spring[joint] = 80.0f;
        params.coupling[joint] = 100.0f;
        params.smoothing[joint] = 30.0f;
        const double wanted = sqrt((80.0 + 4.0 * 100.0 + 16.0 * 30.0) / 0.1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * wanted, wanted,
                                  (double)rod_params_resolving_rate_hz(&params));
        params.inertia[joint] = 1e3f; /* no longer the fastest */
        TEST_ASSERT_TRUE(rod_params_resolving_rate_hz(&params) < 20.0f);
    }
}

static void test_models_read_what_is_theirs(void)
{
    static const char *const CONTOUR_ONLY[] = {"scheme", "hold", "inertia", "coupling",
                                               "smoothing"};
    static const char *const ELASTIC_ONLY[] = {"mass", "gravity"};
    int contour_n = 0, elastic_n = 0;
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        contour_n += rod_field_is_read(&rod_fields[i], ROD_MODEL_CONTOUR);
        elastic_n += rod_field_is_read(&rod_fields[i], ROD_MODEL_ELASTIC);
    }
    TEST_ASSERT_EQUAL_INT(ROD_FIELDS_N - 2, contour_n);
    TEST_ASSERT_EQUAL_INT(ROD_FIELDS_N - 5, elastic_n);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_FALSE(rod_field_is_read(rod_field_find(CONTOUR_ONLY[i]), ROD_MODEL_ELASTIC));
    }
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_FALSE(rod_field_is_read(rod_field_find(ELASTIC_ONLY[i]), ROD_MODEL_CONTOUR));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bounds_of_every_field_at_every_joint);
    RUN_TEST(test_bounds_are_these);
    RUN_TEST(test_joints_beyond_the_last_are_ignored);
    RUN_TEST(test_a_wild_count_of_links_reads_nothing);
    RUN_TEST(test_overdamped_begins_just_beyond_the_bound);
    RUN_TEST(test_overdamped_by_drag_alone);
    RUN_TEST(test_every_error_has_its_own_text);
    RUN_TEST(test_fields_are_told_apart);
    RUN_TEST(test_set_and_get_meet_one_entry);
    RUN_TEST(test_defaults_are_the_papers);
    RUN_TEST(test_resolving_rate_is_that_of_the_fastest_joint);
    RUN_TEST(test_models_read_what_is_theirs);
    return UNITY_END();
}
