/* test_scene_text.c - things to touch as text: every refusal with its place, what the keys mean, and the way from
 * objects to text and back, which keeps every bit. */
#include "scene_text.h"

#include <math.h>

#include "file_fixture.h"

static scene_text text;

void setUp(void)
{
    memset(&text, 0, sizeof text);
    forget_complaints();
}

void tearDown(void) {}

static void read_ini(const char *ini)
{
    write_text(ini);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, scene_text_read_ini(file_path, &text), complaint);
}

/* And nothing of it is taken. */
static void expect_refused(const char *ini, long line, const char *reason)
{
    const scene_text before = text;
    forget_complaints();
    write_text(ini);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, scene_text_read_ini(file_path, &text), ini);
    expect_complaint(file_path, line, reason, ini);
    TEST_ASSERT_EQUAL_MEMORY(&before, &text, sizeof text);
}

static const char BALL[] = "[sphere ball]\ncentre = 0, 0, 0.5\nradius = 0.1\n";

static void test_heads_that_are_refused(void)
{
    read_ini(BALL); /* stays as it is through all that follows */
    expect_refused("centre = 0,0,0\n", 1, "'centre' stands before any object; begin one");
    expect_refused("[cube die]\nsize = 1,1,1\n", 1,
                   "'cube' is no kind of object; there are plane, sphere, capsule and box");
    expect_refused("[none]\n", 1, "'none' is no kind");
    expect_refused("[]\n", 1, "'' is no kind");
    expect_refused("[sphere two words]\n", 1, "must be one word");
    expect_refused("[sphere a=b]\n", 1, "must be one word");
    expect_refused("[sphere a,b]\n", 1, "must be one word");
    expect_refused("[sphere \"a\"]\n", 1, "must be one word");
    expect_refused("[sphere a234567890123456789012345678901x]\n", 1, "longer than 31 characters");
    expect_refused("[sphere ball\nradius = 1\n", 1, "neither a [section]");
    expect_refused("[sphere ball]\nradius\n", 2, "neither a [section]");
    expect_refused("[sphere]\ncentre=0,0,0\nradius=1\n[sphere]\ncentre=0,0,0\nradius=1\n", 4,
                   "there is a 'sphere' already; give each object a name of its own");
    expect_refused("[sphere a]\ncentre=0,0,0\nradius=1\n\n[plane a]\n", 5,
                   "there is a 'a' already");
    char many[800] = "";
    for (int i = 0; i < 9; i++) {
        char one[80];
        snprintf(one, sizeof one, "[sphere %d]\ncentre = 0,0,%d\nradius = 0.1\n", i, i);
        strcat(many, one);
    }
    expect_refused(many, 25, "a scene has at most 8 objects, and this is one more");
}

static void test_keys_that_are_refused(void)
{
    expect_refused("[sphere a]\ncenter = 0,0,0\n", 2,
                   "'center' is no key of a sphere; there are centre, radius, friction");
    expect_refused("[plane a]\ncentre = 0,0,0\n", 2,
                   "no key of a plane; there are point, normal, friction");
    expect_refused("[capsule a]\ncentre = 0,0,0\n", 2,
                   "no key of a capsule; there are from, to, radius, friction");
    expect_refused("[box a]\nradius = 1\n", 2,
                   "of a box; there are centre, size, rounding, turn, quaternion, friction");
    static const char *const NEEDED[][2] = {
        {"[sphere a]\n", "sphere 'a' has no centre; give centre = 0, 0, 0.5"},
        {"[sphere a]\ncentre = 0,0,0\n[sphere b]\n", "sphere 'a' has no radius"},
        {"[plane a]\nnormal = 0,0,1\n", "plane 'a' has no point"},
        {"[plane a]\npoint = 0,0,0\n", "plane 'a' has no normal"},
        {"[capsule a]\nto = 0,0,0\nradius = 1\n", "capsule 'a' has no from"},
        {"[capsule a]\nfrom = 0,0,0\nradius = 1\n", "capsule 'a' has no to"},
        {"[capsule a]\nfrom = 0,0,0\nto = 0,0,1\n", "capsule 'a' has no radius"},
        {"[box a]\nsize = 1,1,1\n", "box 'a' has no centre"},
        {"[box a]\ncentre = 1,1,1\n", "box 'a' has no size"},
    };
    for (size_t i = 0; i < sizeof NEEDED / sizeof *NEEDED; i++) {
        expect_refused(NEEDED[i][0], 1, NEEDED[i][1]);
    }
    expect_refused("[box a]\ncentre=0,0,0\nsize=1,1,1\nturn=0,0,1\nquaternion=0,0,0,1\n", 5,
                   "a turn and a quaternion; give one of them");
}

static void test_values_that_are_refused(void)
{
    expect_refused("[sphere a]\nradius = wide\n", 2, "radius = wide: not a number");
    expect_refused("[sphere a]\nradius = 0.1m\n", 2, "radius = 0.1m: not a number");
    expect_refused("[sphere a]\nradius = 0.0009\n", 2,
                   "radius = 0.0009: out of bounds, must be 0.001 ... 1000 m");
    expect_refused("[sphere a]\nradius = nan\n", 2, "out of bounds");
    expect_refused("[sphere a]\nradius = 1 2\n", 2, "radius takes 1 value, and there are more");
    expect_refused("[sphere a]\ncentre = 0,0,1000.1\n", 2,
                   "centre = 1000.1: out of bounds, must be -1000 ... 1000 m");
    expect_refused("[sphere a]\ncentre = 0,0\nradius = 1\n", 2,
                   "centre has 2 values and needs 3, as in centre = 0, 0, 0.5");
    expect_refused("[sphere a]\ncentre = 0,0\n 1,\n 2\n", 4,
                   "centre takes 3 values, and there are more");
    expect_refused("[sphere a]\nradius = 1\nfriction = -0.1\n", 3,
                   "friction = -0.1: out of bounds, must be 0 ... 10");
    expect_refused("[sphere a]\ncentre = 0,0,0\nradius = 1\nfriction =\n", 4,
                   "friction has 0 values and needs 1");
    expect_refused("[plane a]\npoint=0,0,0\nnormal = 0,0,0\n", 3, "normal has no direction");
    expect_refused("[capsule a]\nfrom=0,0,1\nto=0,0,1\nradius=1\n", 3,
                   "from and to are 0 m apart, must be 0.001 ... 2000 m; a capsule of no length");
    expect_refused("[capsule a]\nfrom=-900,-900,-900\nto=900,900,900\nradius=1\n", 3,
                   "must be 0.001 ... 2000 m");
    expect_refused("[box a]\nsize = 1,0.001,1\n", 2, "out of bounds, must be 0.002 ... 2000 m");
    expect_refused("[box a]\ncentre=0,0,0\nsize=1,0.01,1\nrounding=0.006\n", 4,
                   "rounding = 0.006: out of bounds, must be 0.001 ... 0.005 m, half of the");
    expect_refused("[box a]\nturn = 0,0,361\n", 2, "must be -360 ... 360 degrees");
    expect_refused("[box a]\ncentre=0,0,0\nsize=1,1,1\nquaternion=0,0,0,0\n", 4,
                   "the quaternion's length is 0, must be about 1");
    expect_refused("[box a]\nquaternion=0,0,1.1,0\n", 2, "out of bounds, must be -1 ... 1");
}

static void expect_vec(float x, float y, float z, vec3 v)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, x, v.x);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, y, v.y);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, z, v.z);
}

static frame3 axes_of(int i)
{
    return quat_frame(text.objects[i].object.orientation);
}

static void test_what_the_keys_mean(void)
{
    read_ini("\xEF\xBB\xBF[plane floor]\r\npoint = 1 2 -3 ; anywhere on it\r\n"
             "normal = 0, 3, 4\r\n"
             "[sphere]\n  centre : 0.1, 0.2,\n    0.3\nradius = 7\nradius = 0.25 # wins\n"
             "friction = 0\n"
             "[capsule pole]\nfrom = 1, 0, 0\nto = 1, 0.5, 0\nradius = 0.02\nfriction=1.5\n"
             "[box table]\ncentre = 0,0,0\nsize = 2, 1, 0.5\n"
             "[box thin]\ncentre = 0,0,0\nsize = 1, 1, 0.004\nturn = 90, 0, 90\n"
             "[box beam]\ncentre = 0,0,0\nsize=1,1,1\nrounding=0.5\nquaternion=0,0.6,0,-0.8\n");
    TEST_ASSERT_EQUAL_INT(6, text.objects_n);
    const scene_text_object *o = text.objects;
    TEST_ASSERT_EQUAL_STRING("floor", o[0].name);
    TEST_ASSERT_EQUAL_INT(SCENE_PLANE, o[0].object.kind);
    expect_vec(1.0f, 2.0f, -3.0f, o[0].object.place_m);
    expect_vec(0.0f, 0.6f, 0.8f, axes_of(0).z);
    TEST_ASSERT_EQUAL_FLOAT(0.3f, o[0].object.friction);
    TEST_ASSERT_EQUAL_STRING("sphere", o[1].name);
    TEST_ASSERT_EQUAL_INT(SCENE_SPHERE, o[1].object.kind);
    expect_vec(0.1f, 0.2f, 0.3f, o[1].object.place_m);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, o[1].object.radius_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, o[1].object.friction);
    TEST_ASSERT_EQUAL_INT(SCENE_CAPSULE, o[2].object.kind);
    expect_vec(1.0f, 0.25f, 0.0f, o[2].object.place_m);
    expect_vec(0.0f, 1.0f, 0.0f, axes_of(2).z);
    expect_vec(0.0f, 0.0f, 0.25f, o[2].object.half_m);
    TEST_ASSERT_EQUAL_FLOAT(0.02f, o[2].object.radius_m);
    TEST_ASSERT_EQUAL_FLOAT(1.5f, o[2].object.friction);
    TEST_ASSERT_EQUAL_INT(SCENE_BOX, o[3].object.kind);
    expect_vec(0.995f, 0.495f, 0.245f, o[3].object.half_m); /* 5 mm round, part of the size */
    TEST_ASSERT_EQUAL_FLOAT(0.005f, o[3].object.radius_m);
    expect_vec(0.498f, 0.498f, 0.0f, o[4].object.half_m); /* too thin for 5 mm */
    TEST_ASSERT_EQUAL_FLOAT(0.002f, o[4].object.radius_m);
    /* first about the world's x, then about its z: its own y goes to z, and stays there */
    expect_vec(0.0f, 1.0f, 0.0f, axes_of(4).x);
    expect_vec(0.0f, 0.0f, 1.0f, axes_of(4).y);
    expect_vec(1.0f, 0.0f, 0.0f, axes_of(4).z);
    expect_vec(0.0f, 0.0f, 0.0f, o[5].object.half_m);
    TEST_ASSERT_EQUAL_FLOAT(0.6f, o[5].object.orientation.y);
    TEST_ASSERT_EQUAL_FLOAT(-0.8f, o[5].object.orientation.w);
    read_ini("[plane down]\npoint = 0,0,0\nnormal = 0,0,-5\n");
    expect_vec(0.0f, 0.0f, -1.0f, axes_of(0).z);
    read_ini("[box a]\ncentre=0,0,0\nsize=1,1,1\nturn = 30, 40, 50\n");
    const double s1 = sin(M_PI / 6), c1 = cos(M_PI / 6), s2 = sin(M_PI / 4.5), c2 = cos(M_PI / 4.5),
                 s3 = sin(M_PI / 3.6), c3 = cos(M_PI / 3.6); /* the columns of Rz Ry Rx */
    expect_vec((float)(c3 * c2), (float)(s3 * c2), (float)-s2, axes_of(0).x);
    expect_vec((float)(c3 * s2 * s1 - s3 * c1), (float)(s3 * s2 * s1 + c3 * c1), (float)(c2 * s1),
               axes_of(0).y);
    read_ini("# nothing at all\n");
    TEST_ASSERT_EQUAL_INT(0, text.objects_n);
    read_ini("");
    TEST_ASSERT_EQUAL_INT(0, text.objects_n);
}

static void test_files_that_cannot_be_read(void)
{
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, scene_text_read_ini("/no/such.ini", &text));
    expect_complaint("/no/such.ini", 0, "No such file", "");
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, scene_text_read_ini(folder, &text));
    expect_complaint(folder, 0, "Is a directory", "");
    expect_refused("[sphere a]\n\x01\n", 2, "not a text file");
    char longer[400];
    snprintf(longer, sizeof longer, "%sfriction = 0.%0250d\n", BALL, 3);
    expect_refused(longer, 4, "longer than 198 characters");
}

static void expect_line_refused(const char *line, const char *reason)
{
    scene_text_object object;
    memset(&object, 7, sizeof object);
    const scene_text_object before = object;
    forget_complaints();
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, scene_text_read_line("put", line, &object), line);
    expect_complaint("put", 0, reason, line);
    TEST_ASSERT_EQUAL_MEMORY(&before, &object, sizeof object);
}

static void test_one_object_on_a_line(void)
{
    scene_text_object object;
    TEST_ASSERT_EQUAL_INT(
        SIM_OK, scene_text_read_line("put", " sphere  ball centre=0,0,0.5 radius=0.1 ", &object));
    TEST_ASSERT_EQUAL_STRING("ball", object.name);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, object.object.place_m.z);
    read_ini(BALL);
    TEST_ASSERT_EQUAL_MEMORY(&text.objects[0], &object, sizeof object);
    TEST_ASSERT_EQUAL_INT(
        SIM_OK, scene_text_read_line("put", "plane point=0,0,0 normal=0,0,1 friction=1", &object));
    TEST_ASSERT_EQUAL_STRING("plane", object.name);
    expect_line_refused("", "'' is no kind of object");
    expect_line_refused("ball", "'ball' is no kind");
    expect_line_refused("sphere ball", "sphere 'ball' has no centre");
    expect_line_refused("sphere ball centre", "'centre': must be key=value");
    expect_line_refused("sphere centre=0,0,0 radius=", "radius has 0 values");
    expect_line_refused("sphere centre=0, 0, 0 radius=1", "'0,': must be key=value, without");
    expect_line_refused("sphere centre=0,0,0 radius=1 size=1,1,1", "no key of a sphere");
}

static void test_a_place(void)
{
    vec3 place = {9.0f, 9.0f, 9.0f};
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, scene_text_read_place("move", "1,2", &place));
    expect_complaint("move 1,2", 0, "must be x,y,z in m", "");
    forget_complaints();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, scene_text_read_place("move", "1,2,3,4", &place));
    forget_complaints();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, scene_text_read_place("move", "1,2,1001", &place));
    expect_complaint("move", 0, "must be -1000 ... 1000 m", "");
    expect_vec(9.0f, 9.0f, 9.0f, place);
    TEST_ASSERT_EQUAL_INT(SIM_OK, scene_text_read_place("move", "1,-2,3.5", &place));
    expect_vec(1.0f, -2.0f, 3.5f, place);
}

/* --- there and back ------------------------------------------------------------------------------- */

static uint32_t random_state = 1;

static float random_between(float min, float max)
{
    random_state = random_state * 1664525u + 1013904223u;
    return min + (max - min) * ((float)(random_state >> 8) / 16777216.0f);
}

static vec3 random_vec(float most)
{
    const float x = random_between(-most, most), y = random_between(-most, most);
    return (vec3){x, y, random_between(-most, most)};
}

/* As a device keeps it: any place and size, and turned as scene_put has it. */
static scene_object random_object(int kind)
{
    const float size = random_between(0.0f, 1.0f) < 0.2f ? 400.0f : 0.5f;
    const vec3 half = random_vec(size);
    scene body = {0};
    scene_object o = {.kind = kind, .place_m = random_vec(500.0f), .orientation.w = 1.0f};
    o.friction = random_between(0.0f, 10.0f);
    o.radius_m = kind == SCENE_PLANE ? 0.0f : random_between(1e-3f, 0.3f);
    o.half_m.z = kind == SCENE_CAPSULE || kind == SCENE_BOX ? fabsf(half.z) + 1e-3f : 0.0f;
    if (kind == SCENE_BOX) {
        o.half_m = (vec3){fabsf(half.x), fabsf(half.y), o.half_m.z};
    }
    if (kind != SCENE_SPHERE) {
        const vec3 q = random_vec(0.5f);
        o.orientation = (quat){q.x, q.y, q.z, sqrtf(1.0f - vec3_dot(q, q))};
    }
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&body, 0, &o, NULL));
    return body.body[0].object;
}

static void check_same(const scene_object *a, const scene_object *b, const char *shown)
{
    if (a->kind == SCENE_SPHERE || a->kind == SCENE_BOX) {
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(a, b, sizeof *a, shown);
        return;
    }
    /* along a direction, with nothing known of the roll about it */
    const frame3 was = quat_frame(a->orientation), is = quat_frame(b->orientation);
    const vec3 off = vec3_sub(was.z, is.z), moved = vec3_sub(a->place_m, b->place_m);
    const float arm_m = a->kind == SCENE_CAPSULE ? a->half_m.z : 1.0f;
    TEST_ASSERT_TRUE_MESSAGE(sqrtf(vec3_dot(off, off)) * arm_m < 5e-7f * (1.0f + arm_m), shown);
    TEST_ASSERT_TRUE_MESSAGE(vec3_dot(moved, moved) < 1e-8f, shown); /* 0.1 mm at 500 m */
    TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1e-4f, a->half_m.z, b->half_m.z, shown);
    TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(&a->radius_m, &b->radius_m, 1, shown);
    TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(&a->friction, &b->friction, 1, shown);
}

static void test_objects_to_text_and_back(void)
{
    for (int round = 0; round < 500; round++) {
        scene_text given = {.objects_n = SCENE_OBJECTS_MAX};
        for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
            scene_text_object *const o = &given.objects[i], back;
            char line[SCENE_LINE_MAX];
            o->object = random_object(SCENE_PLANE + i % 4);
            snprintf(o->name, sizeof o->name, "no%d%s", i,
                     i < 4 ? "" : "-and-a-name-as-long-as-any");
            scene_text_write_line(&o->object, o->name, line);
            TEST_ASSERT_TRUE(strlen(line) < sizeof line);
            TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, scene_text_read_line("", line, &back), complaint);
            TEST_ASSERT_EQUAL_STRING(o->name, back.name);
            check_same(&o->object, &back.object, line);
        }
        FILE *const file = fopen(file_path, "wb");
        TEST_ASSERT_NOT_NULL(file);
        scene_text_write_ini(&given, "a title", file);
        fclose(file);
        TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, scene_text_read_ini(file_path, &text), complaint);
        TEST_ASSERT_EQUAL_INT(given.objects_n, text.objects_n);
        for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
            TEST_ASSERT_EQUAL_STRING(given.objects[i].name, text.objects[i].name);
            check_same(&given.objects[i].object, &text.objects[i].object, "ini");
        }
    }
}

static void test_lines_are_as_short_as_can_be(void)
{
    static const char *const LINES[] = {
        "sphere centre=0,0,0.5 radius=0.1 friction=0.3",
        "sphere centre=-0,0.125,1e-12 radius=0.0123457 friction=0",
        "plane point=1,2,3 normal=0,0,1 friction=0.5",
        "capsule from=0.5,0,0 to=0.5,0,2 radius=0.05 friction=0.3",
        "box centre=0,0,-0.25 size=1,0.6,0.04 rounding=0.005 friction=0.3",
        "box centre=0,0,0 size=1,0.6,0.04 rounding=0.02 quaternion=0,0.6,0,0.8 friction=0.3"};
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
        scene_text_object object;
        char line[SCENE_LINE_MAX];
        TEST_ASSERT_EQUAL_INT(SIM_OK, scene_text_read_line("", LINES[i], &object));
        scene_text_write_line(&object.object, NULL, line);
        TEST_ASSERT_EQUAL_STRING(LINES[i], line);
    }
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_heads_that_are_refused);
    RUN_TEST(test_keys_that_are_refused);
    RUN_TEST(test_values_that_are_refused);
    RUN_TEST(test_what_the_keys_mean);
    RUN_TEST(test_files_that_cannot_be_read);
    RUN_TEST(test_one_object_on_a_line);
    RUN_TEST(test_a_place);
    RUN_TEST(test_objects_to_text_and_back);
    RUN_TEST(test_lines_are_as_short_as_can_be);
    fixture_end();
    return UNITY_END();
}
