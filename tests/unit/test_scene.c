/* test_scene.c - objects: what is refused, and what is put where. */
#include "object_fixture.h"
#include "test_support.h"
#include "unity.h"

static uint32_t seed;
static scene s;

void setUp(void)
{
    seed = 2463534242u;
    memset(&s, 0, sizeof s);
}

void tearDown(void) {}

/* --- what is good ----------------------------------------------------------------------------------- */

static void one_of_each_kind_is_good(void)
{
    for (int kind = SCENE_NONE; kind < SCENE_KINDS_N; kind++) {
        const scene_object o = example(kind);
        scene_refusal why = {.error = ROD_E_OBJECT, .field = "left over"};
        TEST_ASSERT_EQUAL_INT(ROD_OK, scene_check(&o, &why));
        TEST_ASSERT_EQUAL_INT(ROD_OK, why.error);
        TEST_ASSERT_NULL(why.field);
        TEST_ASSERT_EQUAL_INT(ROD_OK, scene_check(&o, NULL));
    }
}

/* A number of an object, by the name and axis that a refusal calls it. */
static float *number_of(scene_object *o, const char *field, int axis)
{
    float *const all[] = {&o->place_m.x, &o->place_m.y, &o->place_m.z,
                          &o->half_m.x,  &o->half_m.y,  &o->half_m.z};
    return strcmp(field, "place") == 0    ? all[axis]
           : strcmp(field, "half") == 0   ? all[3 + axis]
           : strcmp(field, "radius") == 0 ? &o->radius_m
                                          : &o->friction;
}

static void expect_refused(const scene_object *o, const char *field, int axis, float min, float max)
{
    scene_refusal why;
    const scene before = s;
    TEST_ASSERT_EQUAL_INT(ROD_E_OBJECT, scene_check(o, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_E_OBJECT, scene_put(&s, 0, o, &why));
    TEST_ASSERT_EQUAL_MEMORY(&before, &s, sizeof s);
    TEST_ASSERT_EQUAL_INT(ROD_E_OBJECT, why.error);
    TEST_ASSERT_EQUAL_STRING(field, why.field);
    TEST_ASSERT_EQUAL_INT(axis, why.axis);
    TEST_ASSERT_EQUAL_FLOAT(min, why.min);
    TEST_ASSERT_EQUAL_FLOAT(max, why.max);
    TEST_ASSERT_FALSE(why.value >= min && why.value <= max);
}

/* Good on both bounds, refused a hair beyond either, and as NaN or infinity. */
static void expect_bounds(int kind, const char *field, int axis, float min, float max)
{
    const float beyond[] = {nextafterf(min, -INFINITY), nextafterf(max, INFINITY), NAN, INFINITY,
                            -INFINITY};
    scene_object o = example(kind);
    float *number = number_of(&o, field, axis);
    *number = min;
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_check(&o, NULL));
    *number = max;
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_check(&o, NULL));
    for (int i = 0; i < 5; i++) {
        *number = beyond[i];
        expect_refused(&o, field, axis, min, max);
    }
}

static void every_number_has_its_bounds(void)
{
    /* how many of half_m's axes a kind has, from z on */
    static const int halves_n[SCENE_KINDS_N] = {0, 0, 0, 1, 3};
    for (int kind = SCENE_PLANE; kind < SCENE_KINDS_N; kind++) {
        for (int axis = 0; axis < 3; axis++) {
            const float most = axis >= 3 - halves_n[kind] ? SCENE_SIZE_MAX_M : 0.0f;
            expect_bounds(kind, "place", axis, -SCENE_PLACE_MAX_M, SCENE_PLACE_MAX_M);
            expect_bounds(kind, "half", axis, 0.0f, most);
        }
        const bool round = kind != SCENE_PLANE;
        expect_bounds(kind, "radius", -1, round ? SCENE_RADIUS_MIN_M : 0.0f,
                      round ? SCENE_SIZE_MAX_M : 0.0f);
        expect_bounds(kind, "friction", -1, 0.0f, SCENE_FRICTION_MAX);
    }
}

static void unknown_kinds_are_refused(void)
{
    static const int32_t unknown[] = {-1, SCENE_KINDS_N, INT32_MAX, INT32_MIN};
    for (int i = 0; i < 4; i++) {
        scene_object o = example(SCENE_SPHERE);
        o.kind = unknown[i];
        expect_refused(&o, "kind", -1, 0.0f, (float)(SCENE_KINDS_N - 1));
    }
}

static void orientations_are_of_unit_length_to_a_hundredth(void)
{
    static const float refused[] = {0.0f, 0.989f, 1.011f, NAN, INFINITY};
    const quat turn = random_quat(&seed);
    for (int i = 0; i < 5; i++) {
        scene_object o = example(SCENE_BOX);
        o.orientation = (quat){turn.x * refused[i], turn.y * refused[i], turn.z * refused[i],
                               turn.w * refused[i]};
        expect_refused(&o, "orientation", -1, 0.99f, 1.01f);
    }
}

static void free_places_are_not_looked_at(void)
{
    scene_object o = {.kind = SCENE_NONE, .place_m = {NAN, 0.0f, 0.0f}, .friction = -1.0f};
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, 3, &o, NULL));
    TEST_ASSERT_EQUAL_INT(0, scene_objects_n(&s));
}

/* --- putting ---------------------------------------------------------------------------------------- */

static void put_objects_are_counted_replaced_and_taken_away(void)
{
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        const scene_object o = example(1 + i % (SCENE_KINDS_N - 1));
        TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, i, &o, NULL));
        TEST_ASSERT_EQUAL_INT(i + 1, scene_objects_n(&s));
    }
    const scene_object other = example(SCENE_BOX), none = {.kind = SCENE_NONE};
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, 0, &other, NULL));
    TEST_ASSERT_EQUAL_INT(SCENE_BOX, s.body[0].object.kind);
    TEST_ASSERT_EQUAL_INT(SCENE_OBJECTS_MAX, scene_objects_n(&s));
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, 7, &none, NULL));
    TEST_ASSERT_EQUAL_INT(SCENE_OBJECTS_MAX - 1, scene_objects_n(&s));
}

static void there_are_eight_places(void)
{
    static const int beyond[] = {-1, SCENE_OBJECTS_MAX, 255};
    const scene_object o = example(SCENE_SPHERE);
    const scene before = s;
    for (int i = 0; i < 3; i++) {
        scene_refusal why;
        TEST_ASSERT_EQUAL_INT(ROD_E_OBJECT, scene_put(&s, beyond[i], &o, &why));
        TEST_ASSERT_EQUAL_STRING("index", why.field);
        TEST_ASSERT_EQUAL_INT(ROD_E_OBJECT, scene_put(&s, beyond[i], &o, NULL));
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &s, sizeof s);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_of_each_kind_is_good);
    RUN_TEST(every_number_has_its_bounds);
    RUN_TEST(unknown_kinds_are_refused);
    RUN_TEST(orientations_are_of_unit_length_to_a_hundredth);
    RUN_TEST(free_places_are_not_looked_at);
    RUN_TEST(put_objects_are_counted_replaced_and_taken_away);
    RUN_TEST(there_are_eight_places);
    return UNITY_END();
}
