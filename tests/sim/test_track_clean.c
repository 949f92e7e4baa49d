/* test_track_clean.c - what cleaning drops, counts and converts, against rotation matrices written out.
 *
 *   test_track_clean         the tests
 *   test_track_clean FILE    a real recording at rest has two start-up jumps; exit 77 without the file
 */
#include <math.h>

#include "file_fixture.h"
#include "track.h"

typedef struct {
    double at[3][3];
} matrix;

static const track_options PLAIN = {.scale = 1.0};
static track read_in;

void setUp(void)
{
    forget_complaints();
    memset(&read_in, 0, sizeof read_in);
}

void tearDown(void)
{
    track_free(&read_in);
}

static void read_with(const char *text, const track_options *options)
{
    track_free(&read_in);
    write_text(text);
    const int result = track_read(file_path, options, &read_in);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, result, complaint);
}

static void test_repeated_times_and_zero_quaternions(void)
{
    read_with("1 1 0 0 0 0 0 0\n" /* no pose: dropped, and not the start */
              "2 2 0 0 0 0 0 1\n"
              "2 2.1 0 0 0 0 0 1\n" /* the last of these counts ... */
              "2 2.2 0 0 0 0 0 0\n" /* ... that has a pose */
              "3 3 0 0 0 0 0 1\n"
              "3 3.1 0 0 0 0 0 1\n"
              "3 3.2 0 0 0 0 0 1\n"
              "4 9 0 0 0 0 0 0\n",
              &PLAIN);
    TEST_ASSERT_EQUAL_size_t(2, read_in.samples_n);
    TEST_ASSERT_EQUAL_DOUBLE(2.1, read_in.samples[0].position_m[0]);
    TEST_ASSERT_EQUAL_DOUBLE(2.1, read_in.origin_m[0]);
    TEST_ASSERT_EQUAL_DOUBLE(3.2, read_in.samples[1].position_m[0]);
    TEST_ASSERT_EQUAL_INT(3, read_in.samples[0].line);
    TEST_ASSERT_EQUAL_INT(7, read_in.samples[1].line);
    TEST_ASSERT_EQUAL_INT(8, read_in.counts.lines);
    TEST_ASSERT_EQUAL_INT(3, read_in.counts.zero_quaternions);
    TEST_ASSERT_EQUAL_INT(3, read_in.counts.repeated_times);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, track_duration_s(&read_in));
}

static void test_quaternions_are_normalised_and_counted(void)
{
    read_with("1 0 0 0 0 0 0 1.009\n2 0 0 0 0 0 0 1.011\n3 0 0 0 0 0 0 0.989\n"
              "4 0 0 0 0 0 0 0.991\n5 0 0 0 0 3e-200 0 4e-200\n6 0 0 0 3e17 0 4e17 0\n"
              "7 0 0 0 0 0 0 5e-324\n8 0 0 0 0 0 0 -1\n9 0 0 0 0.1 0 0 -0.99\n10 0 0 0 0 0 0 1\n",
              &PLAIN);
    TEST_ASSERT_EQUAL_size_t(10, read_in.samples_n);
    TEST_ASSERT_EQUAL_INT(5, read_in.counts.not_unit);   /* 1 % is how far rounding may go */
    TEST_ASSERT_EQUAL_INT(2, read_in.counts.sign_flips); /* a right angle is none */
    for (size_t i = 0; i < read_in.samples_n; i++) {
        const double *q = read_in.samples[i].orientation;
        const double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.0, norm);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.6, read_in.samples[4].orientation[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.8, read_in.samples[5].orientation[2]);
}

static void test_gaps_are_longer_than_a_quarter_second(void)
{
    read_with("0 0 0 0 0 0 0 1\n0.25 0 0 0 0 0 0 1\n0.5001 0 0 0 0 0 0 1\n0.6 0 0 0 0 0 0 0\n"
              "0.8 0 0 0 0 0 0 1\n",
              &PLAIN);
    TEST_ASSERT_EQUAL_INT(2, read_in.counts.gaps); /* the second one by a dropped sample */
}

static void test_jumps_leave_the_hands_heading(void)
{
    read_with("0.00 0 0 0 0 0 0 1\n"
              "0.01 0.05 0 0 0 0 0 1\n" /* from rest, 5 m/s within 10 ms: under 1000 m/s^2 */
              "0.02 0.10 0 0 0 0 0 1\n"
              "0.03 0.15 0.09 0 0 0 0 1\n" /* 9 m/s sideways: 900 m/s^2 */
              "0.04 0.20 0.18 0 0 0 0 1\n"
              "0.05 0.25 0.27 0.11 0 0 0 1\n" /* 11 m/s: 1100 m/s^2 */
              "0.06 0.30 0.36 0.22 0 0 0 1\n"
              "0.061 0.314 0.369 0.231 0 0 0 1\n", /* 9 m/s more, but under 1 cm off its way */
              &PLAIN);
    TEST_ASSERT_EQUAL_INT(1, read_in.counts.jumps);
    TEST_ASSERT_EQUAL_INT(6, read_in.counts.first_jump_line);
    TEST_ASSERT_EQUAL_size_t(8, read_in.samples_n); /* told, not dropped */
}

static matrix matrix_of(const double q[4])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return (matrix){{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                     {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                     {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

static matrix multiply(matrix a, matrix b)
{
    matrix product = {{{0}}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                product.at[i][j] += a.at[i][k] * b.at[k][j];
            }
        }
    }
    return product;
}

static const matrix SAME = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const matrix MIRROR = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const matrix Y_TO_Z = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}; /* up: y to z, then z to -y */

/* Mirrored by S in the world and in the body, turned by T in the world: p' = T S p, R' = T S R S. */
static void check_conversion(const double q[4], const track_options *options)
{
    static const double PLACE[3] = {0.4, -1.25, 2.5};
    char text[400];
    snprintf(text, sizeof text, "1 %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", PLACE[0], PLACE[1],
             PLACE[2], q[0], q[1], q[2], q[3]);
    read_with(text, options);
    const matrix mirror = options->left_handed ? MIRROR : SAME;
    const matrix world = multiply(options->y_up ? Y_TO_Z : SAME, mirror);
    const matrix expected = multiply(multiply(world, matrix_of(q)), mirror);
    const matrix got = matrix_of(read_in.samples[0].orientation);
    for (int i = 0; i < 3; i++) {
        double place = 0.0;
        for (int j = 0; j < 3; j++) {
            place += options->scale * world.at[i][j] * PLACE[j];
            TEST_ASSERT_DOUBLE_WITHIN(1e-14, expected.at[i][j], got.at[i][j]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-14, place, read_in.samples[0].position_m[i]);
    }
}

static void test_up_left_handed_and_scale_against_matrices(void)
{
    static const double QUATERNIONS[][4] = {{0, 0, 0, 1},
                                            {0.5, -0.5, 0.5, 0.5},
                                            {0.6, 0, 0.64, 0.48},
                                            {-0.1, 0.7, -0.1, -0.7},
                                            {0, 1, 0, 0}};
    for (size_t i = 0; i < sizeof QUATERNIONS / sizeof *QUATERNIONS; i++) {
        for (int which = 0; which < 8; which++) {
            const track_options options = {.y_up = (which & 1) != 0,
                                           .left_handed = (which & 2) != 0,
                                           .scale = (which & 4) != 0 ? 0.001 : 1.0};
            check_conversion(QUATERNIONS[i], &options);
        }
    }
}

/* Said in a picture: in a left-handed, y-up world (Unity) the hand 1 up, 2 ahead, 3 to the right, its
 * rod pointing up. Right-handed with z up that is 3 to one side, 2 behind, 1 up, and up it points. */
static void test_unitys_up_is_up(void)
{
    const double h = sqrt(0.5);
    char text[200]; /* Unity's rotation of -90 degrees about x takes its z (ahead) to its y (up) */
    snprintf(text, sizeof text, "0 3 1 2 %.17g 0 0 %.17g\n", -h, h);
    read_with(text, &(track_options){.y_up = true, .left_handed = true, .scale = 1.0});
    const double expected_m[3] = {-3.0, -2.0, 1.0};
    const matrix r = matrix_of(read_in.samples[0].orientation);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, expected_m[i], read_in.samples[0].position_m[i]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, i == 2 ? 1.0 : 0.0, r.at[i][2]);
    }
}

static void test_max_speed_drops_what_is_too_far_from_the_last_kept(void)
{
    static const char TEXT[] = "0.0 0 0 0 0 0 0 1\n"
                               "0.1 1000 0 0 0 0 0 1\n"  /* in millimetres: 10 m/s */
                               "0.2 5000 0 0 0 0 0 1\n"  /* 40 m/s */
                               "0.3 5000 0 0 0 0 0 1\n"  /* 20 m/s from 1000 */
                               "0.4 5000 0 0 0 0 0 1\n"  /* 13.3 m/s */
                               "0.5 5000 0 0 0 0 0 1\n"; /* 10 m/s from 1000, and from 0 */
    static const struct {
        double speed_mps;
        int kept;
    } CASES[] = {{0.0, 6}, {41.0, 6}, {39.0, 5}, {19.0, 4}, {13.0, 3}, {9.9, 1}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        read_with(TEXT, &(track_options){.scale = 0.001, .max_speed_mps = CASES[i].speed_mps});
        TEST_ASSERT_EQUAL_INT(CASES[i].kept, read_in.samples_n);
        TEST_ASSERT_EQUAL_INT(6 - CASES[i].kept, read_in.counts.too_fast);
        TEST_ASSERT_EQUAL_INT(1, read_in.samples[0].line); /* the first is always believed */
    }
}

static void test_the_origin_may_lie_anywhere(void)
{
    read_with(
        "0 4e6 -5e5 100 0 0 0 1\n1 4000000.5 -5e5 100 0 0 0 1\n2 4000899 -499101 100 0 0 0 1\n",
        &PLAIN);
    TEST_ASSERT_EQUAL_DOUBLE(4e6, read_in.origin_m[0]);
    TEST_ASSERT_EQUAL_DOUBLE(4000000.5, read_in.samples[1].position_m[0]);
}

static const char *recording_path;

static void test_a_recording_at_rest_has_two_start_up_jumps(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, track_read(recording_path, &PLAIN, &read_in), complaint);
    TEST_ASSERT_EQUAL_INT(2, read_in.counts.jumps);
    TEST_ASSERT_TRUE(read_in.counts.first_jump_line < 20);
    TEST_ASSERT_EQUAL_INT(0, read_in.counts.gaps + read_in.counts.repeated_times);
}

int main(int argc, char **argv)
{
    if (argc > 1 && access(argv[1], R_OK) != 0) {
        printf("SKIPPED: no %s\n", argv[1]);
        return 77;
    }
    fixture_start();
    UNITY_BEGIN();
    if (argc > 1) {
        recording_path = argv[1];
        RUN_TEST(test_a_recording_at_rest_has_two_start_up_jumps);
    } else {
        RUN_TEST(test_repeated_times_and_zero_quaternions);
        RUN_TEST(test_quaternions_are_normalised_and_counted);
        RUN_TEST(test_gaps_are_longer_than_a_quarter_second);
        RUN_TEST(test_jumps_leave_the_hands_heading);
        RUN_TEST(test_up_left_handed_and_scale_against_matrices);
        RUN_TEST(test_unitys_up_is_up);
        RUN_TEST(test_max_speed_drops_what_is_too_far_from_the_last_kept);
        RUN_TEST(test_the_origin_may_lie_anywhere);
    }
    fixture_end();
    return UNITY_END();
}
