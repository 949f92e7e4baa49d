/* test_device_scene.c - objects to touch and shapes to take, as requests to the whole device: taken, shown, refused by
 * name, done once. */
#include "scene_fixture.h"

void setUp(void)
{
    bench_connected(LINKS_N);
}

void tearDown(void)
{
    free(b);
}

/* --- taken and shown ------------------------------------------------------------------------------- */

static void test_objects_of_all_kinds_come_back_move_and_go(void)
{
    static const message_scene_put OBJECTS[] = {
        {.kind = OBJECT_PLANE, .orientation_xyzw = {0.0f, 0.6f, 0.0f, 0.8f}, .friction = 0.5f},
        {.kind = OBJECT_SPHERE,
         .place_m = {1000.0f, -1000.0f, 0.5f},
         .orientation_xyzw = {0.0f, 0.0f, 0.0f, 1.0f},
         .radius_m = 1e-3f},
        {.kind = OBJECT_CAPSULE,
         .orientation_xyzw = {1.0f, 0.0f, 0.0f, 0.0f},
         .half_m = {0.0f, 0.0f, 0.4f},
         .radius_m = 0.05f,
         .friction = 10.0f},
        {.kind = OBJECT_BOX,
         .orientation_xyzw = {0.5f, -0.5f, 0.5f, -0.5f},
         .half_m = {0.1f, 0.2f, 0.3f},
         .radius_m = 0.005f,
         .friction = 0.3f},
    };
    for (int i = 0; i < 4; i++) {
        const int place = 7 - 2 * i;
        put(place, OBJECTS[i]);
        done_at_once(MESSAGE_SCENE_PUT);
        const message_scene_object *o = shown(place);
        TEST_ASSERT_EQUAL_UINT8(OBJECTS[i].kind, o->kind);
        TEST_ASSERT_EQUAL_FLOAT_ARRAY(OBJECTS[i].place_m, o->place_m, 3);
        TEST_ASSERT_EQUAL_FLOAT_ARRAY(OBJECTS[i].orientation_xyzw, o->orientation_xyzw, 4);
        TEST_ASSERT_EQUAL_FLOAT_ARRAY(OBJECTS[i].half_m, o->half_m, 3);
        TEST_ASSERT_EQUAL_FLOAT(OBJECTS[i].radius_m, o->radius_m);
        TEST_ASSERT_EQUAL_FLOAT(OBJECTS[i].friction, o->friction);
        TEST_ASSERT_EQUAL_INT(i + 1, scene_objects_n(&dev()->body.scene));
    }
    message_scene_put moved = OBJECTS[1];
    moved.place_m[0] = 0.25f;
    put(5, moved);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, shown(5)->place_m[0]);
    take_away(5);
    done_at_once(MESSAGE_SCENE_PUT);
    static const message_scene_object FREE = {.objects_max = SCENE_OBJECTS_MAX};
    message_scene_object free_place = *shown(5);
    free_place.request_id = free_place.index = 0;
    TEST_ASSERT_EQUAL_MEMORY(&FREE, &free_place, sizeof FREE);
    TEST_ASSERT_EQUAL_INT(3, scene_objects_n(&dev()->body.scene));
    take_away(ALL_PLACES);
    done_at_once(MESSAGE_SCENE_PUT);
    TEST_ASSERT_EQUAL_INT(0, scene_objects_n(&dev()->body.scene));
}

/* --- refused -------------------------------------------------------------------------------------------- */

static void test_what_is_no_object_is_refused_by_name(void)
{
    put(0, BALL);
    message_scene_put o = BALL;
    (void)refuses_put(SCENE_OBJECTS_MAX, o, REASON_INDEX, "index", -1);
    (void)refuses_put(ALL_PLACES, o, REASON_INDEX, "index", -1);
    (void)refuses_put(254, (message_scene_put){.kind = OBJECT_NONE}, REASON_INDEX, "index", -1);
    o.kind = OBJECT_BOX + 1;
    TEST_ASSERT_EQUAL_FLOAT(4.0f, refuses_put(0, o, REASON_BOUNDS, "kind", -1)->maximum);
    o.kind = 255;
    (void)refuses_put(0, o, REASON_BOUNDS, "kind", -1);
    for (int axis = 0; axis < 3; axis++) {
        o = BALL;
        o.place_m[axis] = 1001.0f;
        const message_nack *nack = refuses_put(0, o, REASON_BOUNDS, "place", axis);
        TEST_ASSERT_EQUAL_FLOAT(1001.0f, nack->value);
        TEST_ASSERT_EQUAL_FLOAT(-1000.0f, nack->minimum);
        TEST_ASSERT_EQUAL_FLOAT(1000.0f, nack->maximum);
        o.place_m[axis] = NAN;
        (void)refuses_put(0, o, REASON_NOT_FINITE, "place", axis);
        o = BALL;
        o.half_m[axis] = 0.1f; /* a ball has none */
        (void)refuses_put(0, o, REASON_BOUNDS, "half", axis);
        o.kind = OBJECT_BOX;
        o.half_m[axis] = -INFINITY;
        (void)refuses_put(0, o, REASON_NOT_FINITE, "half", axis);
    }
    o = BALL;
    o.orientation_xyzw[3] = 0.98f;
    (void)refuses_put(0, o, REASON_BOUNDS, "orientation", -1);
    o.orientation_xyzw[1] = NAN;
    (void)refuses_put(0, o, REASON_NOT_FINITE, "orientation", -1);
    o = BALL;
    o.radius_m = 0.9e-3f;
    (void)refuses_put(0, o, REASON_BOUNDS, "radius", -1);
    o.radius_m = INFINITY;
    (void)refuses_put(0, o, REASON_NOT_FINITE, "radius", -1);
    o = BALL;
    o.friction = -0.1f;
    (void)refuses_put(0, o, REASON_BOUNDS, "friction", -1);
    o.friction = 10.1f;
    TEST_ASSERT_EQUAL_FLOAT(10.0f, refuses_put(0, o, REASON_BOUNDS, "friction", -1)->maximum);
    ask((message){.type = MESSAGE_SCENE_GET, .scene_get = {.index = SCENE_OBJECTS_MAX}});
    tick();
    (void)refused_at_once(REASON_INDEX);
    TEST_ASSERT_EQUAL_UINT(0, b->seen_n[MESSAGE_SCENE_OBJECT]);
}

static void test_what_is_no_shape_is_refused_by_name(void)
{
    (void)refuses_shape(LINKS_N, 0.1f, -1.0f, 0.5f, REASON_BOUNDS, "strength");
    (void)refuses_shape(LINKS_N, 0.1f, 1.1e6f, 0.5f, REASON_BOUNDS, "strength");
    (void)refuses_shape(0, 0.1f, NAN, 0.5f, REASON_NOT_FINITE, "strength");
    (void)refuses_shape(LINKS_N, 0.1f, 5.0f, -0.1f, REASON_BOUNDS, "blend");
    (void)refuses_shape(0, 0.1f, 5.0f, 61.0f, REASON_BOUNDS, "blend");
    (void)refuses_shape(LINKS_N, 0.1f, 5.0f, INFINITY, REASON_NOT_FINITE, "blend");
    const message_nack *nack = refuses_shape(LINKS_N, -3.15f, 5.0f, 0.5f, REASON_BOUNDS, "angles");
    TEST_ASSERT_EQUAL_INT16(0, nack->entry);
    TEST_ASSERT_EQUAL_FLOAT(-3.15f, nack->value);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 3.14159265f, nack->maximum);
    static const int COUNTS[] = {1, LINKS_N - 1, LINKS_N + 1, ROD_MAX_LINKS + 1,
                                 MESSAGES_ANGLES_MAX};
    for (int i = 0; i < 5; i++) {
        nack = refuses_shape(COUNTS[i], 0.1f, 5.0f, 0.5f, REASON_ENTRIES, "angles");
        TEST_ASSERT_EQUAL_FLOAT((float)COUNTS[i], nack->value);
        TEST_ASSERT_EQUAL_FLOAT((float)LINKS_N, nack->maximum);
    }
    message m = {.type = MESSAGE_SHAPE, .shape = {.strength_nm = 1.0f, .angles_n = LINKS_N}};
    m.shape.angles_tenth_mrad[4][1] = MESSAGES_ANGLE_INVALID; /* "none" is no angle to pull at */
    ask(m);
    tick();
    TEST_ASSERT_EQUAL_INT16(4, refused_at_once(REASON_BOUNDS)->entry);
}

static void test_a_stranger_changes_nothing(void)
{
    put(0, BALL);
    const uint8_t ours = b->session;
    b->session = 77;
    take_away(0);
    (void)refused_at_once(REASON_SESSION);
    take_shape(LINKS_N, 0.1f, 5.0f, 0.5f);
    (void)refused_at_once(REASON_SESSION);
    b->session = ours;
    TEST_ASSERT_EQUAL_UINT8(OBJECT_SPHERE, shown(0)->kind);
    TEST_ASSERT_EQUAL_UINT32(0, dev()->body.shape_ticks);
}

/* The same id again is the same request, whatever it says now: a late repetition must not undo what came after. */
static void test_a_request_sent_again_is_done_once(void)
{
    message m = {.type = MESSAGE_SCENE_PUT, .scene_put = BALL};
    m.scene_put.request_id = 900;
    say_as(&m, 1);
    tick();
    put(0, (message_scene_put){.kind = OBJECT_NONE});
    const unsigned acks = b->seen_n[MESSAGE_ACK];
    say_as(&m, 2);
    tick();
    TEST_ASSERT_EQUAL_UINT(acks + 1, b->seen_n[MESSAGE_ACK]);
    TEST_ASSERT_EQUAL_UINT16(900, b->newest[MESSAGE_ACK].ack.request_id);
    TEST_ASSERT_EQUAL_INT(0, scene_objects_n(&dev()->body.scene));
    m = (message){.type = MESSAGE_SHAPE,
                  .shape = {.request_id = 901, .strength_nm = 5.0f, .angles_n = LINKS_N}};
    say_as(&m, 3);
    tick();
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, dev()->body.shape_ticks);
    take_shape(0, 0.0f, 0.0f, 0.0f);
    ticks(5);
    say_as(&m, 4);
    tick();
    TEST_ASSERT_NOT_EQUAL(UINT32_MAX, dev()->body.shape_ticks);
    TEST_ASSERT_EQUAL_UINT32(2, dev()->commands_repeated);
    m = (message){.type = MESSAGE_SCENE_PUT,
                  .scene_put = BALL}; /* without an id it could not be told */
    say_as(&m, 5);
    tick();
    TEST_ASSERT_EQUAL_STRING("request_id", b->newest[MESSAGE_NACK].nack.field);
    TEST_ASSERT_EQUAL_INT(0, scene_objects_n(&dev()->body.scene));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_objects_of_all_kinds_come_back_move_and_go);
    RUN_TEST(test_what_is_no_object_is_refused_by_name);
    RUN_TEST(test_what_is_no_shape_is_refused_by_name);
    RUN_TEST(test_a_stranger_changes_nothing);
    RUN_TEST(test_a_request_sent_again_is_done_once);
    return UNITY_END();
}
