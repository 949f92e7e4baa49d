/* test_params_ini.c - parameter files: what they may look like, every refusal with its line, and the way
 * from a rod to a file and back, which keeps every bit. */
#include "device_params.h"
#include "motions.h"
#include "params_fixture.h"
#include "replay.h"

static void test_refusals_in_files_name_their_line(void)
{
    expect_ini_refused("", 0, "empty; limber-sim params prints a complete file");
    expect_ini_refused("[rod]\nlinks = 4\nspringy = 80\n", 3, "unknown key 'springy'");
    expect_ini_refused("[rod]\r\nlinks = 4\r\nspring = 8o\r\n", 3, "spring = 8o: not a number");
    expect_ini_refused("[rod]\nspring = 80#soft\n", 2, "spring = 80#soft: not a number");
    expect_ini_refused("[rod]\nspring =\n", 2, "spring has no value");
    expect_ini_refused("[rod]\nspring = 80\n 70 sixty\n", 3, "spring = sixty: not a number");
    expect_ini_refused("[rod]\nspring = 80\n 1e9\n", 3, "out of bounds");
    expect_ini_refused("[rod]\ntick = 0.001\n", 2, "the tick is set by --rate");
    expect_ini_refused("links = 4\n", 1, "limber reads only [rod]");
    expect_ini_refused("[Rod]\nlinks = 4\n", 2, "section [Rod]; limber reads only [rod]");
    expect_ini_refused("[rod]\nlinks = 4\n[ROD]\n# more\nhold = 2\n", 5, "section [ROD]");
    expect_ini_refused("[rod]\nlinks\n", 2, "neither a [section], a key = value nor a comment");
    expect_ini_refused("[rod\n", 1, "neither a [section]");
    expect_ini_refused("\x7F"
                       "ELF\x01\x02\n",
                       1, "");
    char many[400] = "[rod]\nlinks = 64\nspring = 1\n";
    for (int i = 0; i < 64; i++) {
        strcat(many, i % 16 == 0 ? "\n 1" : " 1");
    }
    expect_ini_refused(many, 8, "spring takes at most 64 values");
}

static void test_files_that_cannot_be_read(void)
{
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_read_ini(&text, "/no/such.ini"));
    expect_complaint("/no/such.ini", 0, "No such file", "");
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_read_ini(&text, folder));
    expect_complaint(folder, 0, "Is a directory", "");
    setUp();
    static const char NUL[] = "[rod]\nlinks = 4\nspring = 80\0 70\n";
    write_file(NUL, sizeof NUL - 1);
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_read_ini(&text, file_path));
    expect_complaint(file_path, 3, "not a text file", "");
    setUp();
    write_file(NUL, sizeof NUL - 2); /* without the end of line */
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_read_ini(&text, file_path));
    expect_complaint(file_path, 3, "not a text file", "");
}

static void test_lines_that_are_too_long(void)
{
    char ini[600] = "[rod]\n#";
    const size_t start_n = strlen(ini) - 1; /* of line 2 */
    memset(ini + start_n + 1, '.', 300);
    strcpy(ini + start_n + 198, "\nlinks = 5\n");
    read_ini(ini);
    resolve();
    TEST_ASSERT_EQUAL_INT(5, params.links_n);
    memset(ini + start_n + 1, '.', 300);
    strcpy(ini + start_n + 199, "\nlinks = 6\n");
    expect_ini_refused(ini, 2,
                       "longer than 198 characters; go on with the list on an indented line");
}

static float entry(const char *key, int joint)
{
    return rod_field_get(rod_field_find(key), &params, joint);
}

static void test_what_files_may_look_like(void)
{
    static const char *const TEXTS[] = {
        "[rod]\nlinks = 6\nspring = 80 70 60 50 40 30\n",
        "[rod]\nspring=80,70,60,50,40,30\nlinks=6",
        "\xEF\xBB\xBF# mine\r\n[rod]\r\nlinks : 6\r\nspring = 80 70 60\r\n    50 40 30\r\n",
        ("; mine\n[rod]\n# about links\nlinks = 6 # six\n\nspring = 80 70 ; the first two\n"
         "\t60 50 ; and more\n\n  # among them a remark\n  40, 30\n"),
        "[rod] ; the section\nlinks = 3\nspring = 1 2 3\nlinks = 6\nspring = 80 70 60 50 40 30\n",
        "[rod]\nlinks = 6\nspring = 5\n[rod]\nspring = 80 70 60 50 40 30\n",
        "[rod]\n  links = 6\n[rod]\n  spring = 1 2 3 4 5 6\n[rod]\n  spring = 80 70 60 50 40 30\n",
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        setUp();
        read_ini(TEXTS[i]);
        resolve();
        TEST_ASSERT_EQUAL_INT_MESSAGE(6, params.links_n, TEXTS[i]);
        for (int joint = 0; joint < 6; joint++) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(80 - 10 * joint, entry("spring", joint), TEXTS[i]);
        }
    }
}

static uint64_t hash_now(void)
{
    static track_sample samples[100];
    static track source = {.path = file_path, .samples = samples, .samples_n = 100};
    for (int i = 0; i < 100; i++) {
        const rod_pose pose = motions[3].pose(i + 200);
        const float p[] = {pose.position_m.x, pose.position_m.y, pose.position_m.z};
        const float q[] = {pose.orientation.x, pose.orientation.y, pose.orientation.z,
                           pose.orientation.w};
        samples[i] = (track_sample){.t_s = i * 0.01, .line = i + 1};
        for (int axis = 0; axis < 4; axis++) {
            samples[i].orientation[axis] = (double)q[axis];
            samples[i].position_m[axis % 3] = (double)p[axis % 3];
        }
    }
    replay r;
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, replay_run(&source, &params, 1000.0, NULL, &r),
                                  complaint);
    const uint64_t hash = r.hash;
    replay_free(&r);
    return hash;
}

/* Writes what is in force, reads it back, and expects the same bits and the same run. */
static void check_round_trip(void)
{
    resolve();
    const rod_params before = params;
    const uint64_t hash = hash_now();
    FILE *file = fopen(file_path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    params_text_write_ini(&params, "a title", file);
    fclose(file);
    setUp();
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, params_text_read_ini(&text, file_path), complaint);
    resolve();
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        if (!rod_field_is_read(&rod_fields[i], before.model)) {
            continue; /* left out of the file */
        }
        const int entries_n = is_per_joint(&rod_fields[i]) ? before.links_n : 1;
        for (int joint = 0; joint < entries_n; joint++) {
            const float value = rod_field_get(&rod_fields[i], &params, joint);
            const float expected = rod_field_get(&rod_fields[i], &before, joint);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(&expected, &value, 1, rod_fields[i].name);
        }
    }
    TEST_ASSERT_EQUAL_HEX64(hash, hash_now());
}

static void check_every_preset(const char *model, const char *const *sets, size_t sets_n)
{
    for (int preset = -1; preset < ROD_PRESETS_N; preset++) {
        for (size_t i = 0; i < sets_n; i++) {
            setUp();
            TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_model(&text, model));
            if (preset >= 0) {
                (void)params_text_preset(&text, rod_presets[preset].name);
            }
            if (*sets[i] != '\0') {
                set(sets[i]);
            }
            check_round_trip();
        }
    }
}

static void test_ini_and_back_is_the_same_rod(void)
{
    static const char *const CONTOUR[] = {
        "",
        "links=1",
        "links=2",
        "links=3",
        "links=33",
        "links=64",
        "hold=2",
        "scheme=paper",
        "spring=79.999993",
        "inertia=0.1",
        "length=0.012345678",
        "smoothing=33.3",
        "drag=0.3333333",
        "limit=1.57",
        "coupling=1e-3",
        "damper=0",
    };
    static const char *const ELASTIC[] = {
        "",
        "links=1",
        "links=2",
        "links=33",
        "links=64",
        "spring=79.999993",
        "mass=0.012345678",
        "gravity=0",
        "drag=0.3333333",
        "damper=0",
    };
    check_every_preset("contour", CONTOUR, sizeof CONTOUR / sizeof *CONTOUR);
    check_every_preset("elastic", ELASTIC, sizeof ELASTIC / sizeof *ELASTIC);
}

static void expect_in_file(const char *words, bool there)
{
    char content[6000];
    FILE *file = fopen(file_path, "rb");
    TEST_ASSERT_NOT_NULL(file);
    const size_t size = fread(content, 1, sizeof content - 1, file);
    fclose(file);
    content[size] = '\0';
    TEST_ASSERT_EQUAL_INT_MESSAGE(there, strstr(content, words) != NULL, words);
}

/* A file has the keys that its rod's model reads, in that model's units. */
static void test_files_speak_of_their_model(void)
{
    static const char *const ONLY_CONTOUR[] = {"\nscheme =",     "\nhold =",
                                               "\ninertia =",    "\ncoupling =",
                                               "\nsmoothing =",  "10000 N m s, one value",
                                               "(paper: gamma)", "joint's stop, either side"};
    static const char *const ONLY_ELASTIC[] = {"\nmass =", "\ngravity =", "10000 N s/m, one value",
                                               "(gamma)", "the rod itself has no stop"};
    for (int elastic = 0; elastic < 2; elastic++) {
        setUp();
        TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_model(&text, elastic ? "elastic" : "contour"));
        TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_preset(&text, "foil"));
        resolve();
        FILE *file = fopen(file_path, "wb");
        TEST_ASSERT_NOT_NULL(file);
        params_text_write_ini(&params, "a title", file);
        fclose(file);
        for (size_t i = 0; i < sizeof ONLY_CONTOUR / sizeof *ONLY_CONTOUR; i++) {
            const bool damper_too = strstr(ONLY_CONTOUR[i], "N m s") != NULL; /* in both */
            expect_in_file(ONLY_CONTOUR[i], !elastic || damper_too);
        }
        for (size_t i = 0; i < sizeof ONLY_ELASTIC / sizeof *ONLY_ELASTIC; i++) {
            expect_in_file(ONLY_ELASTIC[i], elastic);
        }
    }
}

/* What limber params list --ini writes beside the rod: passed over; but a slip of the pen is not. */
static void test_what_is_the_devices_own_is_passed_over(void)
{
    char ini[4000] = "[rod]\nlinks = 6\n";
    for (int i = 0; i < DEVICE_FIELDS_N; i++) {
        strcat(strcat(ini, device_fields[i].name), " = 1 2\n 3\n");
    }
    read_ini(strcat(ini, "spring = 70\n"));
    resolve();
    TEST_ASSERT_EQUAL_INT(6, params.links_n);
    TEST_ASSERT_EQUAL_FLOAT(70.0f, entry("spring", 5));
    TEST_ASSERT_EQUAL_FLOAT(2.0f, entry("damper", 5));
    expect_ini_refused("[rod]\nservo_kind = bus\nservo_kinds = bus\n", 3,
                       "unknown key 'servo_kinds'");
    expect_ini_refused("[device]\nservo_kind = bus\n", 2, "section [device]");
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, params_text_set(&text, "servo_kind=bus"));
    expect_complaint("--set", 0, "unknown key 'servo_kind'", "");
}

static void check_uneven_lists(const char *model, const char *const *keys, size_t keys_n)
{
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_OK, params_text_model(&text, model));
    set("links=64");
    uint32_t random = 1;
    for (size_t i = 0; i < keys_n; i++) {
        char assignment[2000];
        int used = snprintf(assignment, sizeof assignment, "%s=", keys[i]);
        for (int joint = 0; joint < 64; joint++) {
            random = random * 1664525u + 1013904223u;
            used += snprintf(assignment + used, sizeof assignment - (size_t)used, "%.9g,",
                             0.1 + random / 4294967296.0);
        }
        set(assignment);
    }
    check_round_trip();
}

static void test_lists_of_64_uneven_numbers_and_back(void)
{
    static const char *const CONTOUR[] = {"length",    "inertia", "drag",   "coupling",
                                          "smoothing", "spring",  "damper", "limit"};
    static const char *const ELASTIC[] = {"length", "mass", "drag", "spring", "damper", "limit"};
    check_uneven_lists("contour", CONTOUR, sizeof CONTOUR / sizeof *CONTOUR);
    check_uneven_lists("elastic", ELASTIC, sizeof ELASTIC / sizeof *ELASTIC);
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_refusals_in_files_name_their_line);
    RUN_TEST(test_files_that_cannot_be_read);
    RUN_TEST(test_lines_that_are_too_long);
    RUN_TEST(test_what_files_may_look_like);
    RUN_TEST(test_ini_and_back_is_the_same_rod);
    RUN_TEST(test_files_speak_of_their_model);
    RUN_TEST(test_what_is_the_devices_own_is_passed_over);
    RUN_TEST(test_lists_of_64_uneven_numbers_and_back);
    fixture_end();
    return UNITY_END();
}
