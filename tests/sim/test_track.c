/* test_track.c - track files as people have them: every spelling that is read, and every refusal with
 * its line and reason. What happens to the samples then: test_track_clean.c and test_resample.c. */
#include "file_fixture.h"
#include "track.h"

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
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, complaints_n, complaint);
}

#define EUROC "p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z"
#define EUROC_UNITS                                                                                \
    "p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []"
#define NS_ROWS "1500000000,1,2,3,0.8,0,0.6,0\n1625000000,-4,5.5,6,1,0,0,0\n"
#define TUM_ROWS "1.5 1 2 3 0 0.6 0 0.8\n1.625 -4 5.5 6 0 0 0 1\n"
#define CSV_ROWS "1.5,1,2,3,0,0.6,0,0.8\n1.625,-4,5.5,6,0,0,0,1\n"

static void test_every_spelling_of_the_same_two_samples(void)
{
    static const char *const TEXTS[] = {
        TUM_ROWS,
        "1.5\t1\t2\t3\t0\t0.6\t0\t0.8\n1.625\t-4\t5.5\t6\t0\t0\t0\t1\n",
        "  1.5  1 2 \t 3 0 0.6 0 0.8 \t\n 1.625 -4 5.5 6 0 0 0 1",
        "1.5 1 2 3 0 0.6 0 0.8\r\n1.625 -4 5.5 6 0 0 0 1\r\n",
        "1.5 1 2 3 0 0.6 0 0.8\r\n1.625 -4 5.5 6 0 0 0 1\r",
        "\xEF\xBB\xBF" TUM_ROWS,
        "\xEF\xBB\xBF# a mark, then a comment\n" TUM_ROWS,
        "# timestamp tx ty tz qx qy qz qw\n\n \t\n#\n" TUM_ROWS "\n\n# the end\n\n",
        "# t, tx, and other words, with, commas, in, a, row, of, prose\n" TUM_ROWS,
        "# timestamp, tx, ty, tz, qx, qy, qz, qw\n" TUM_ROWS,
        "+15e-1 +1 2. 3.0 -0 .6 0e5 8E-1\n1.625 -4 55e-1 6 0 0 0 1\n",
        "timestamp,tx,ty,tz,qx,qy,qz,qw\n" CSV_ROWS,
        "timestamp,tx,ty,tz,qx,qy,qz,qw\r\n1.5,1,2,3,0,0.6,0,0.8\r\n1.625,-4,5.5,6,0,0,0,1\r\n",
        "\xEF\xBB\xBFtimestamp,tx,ty,tz,qx,qy,qz,qw\n" CSV_ROWS,
        "\xEF\xBB\xBF#timestamp,tx,ty,tz,qx,qy,qz,qw\n" CSV_ROWS,
        "# made by hand\n\ntimestamp,tx,ty,tz,qx,qy,qz,qw\n\n# more\n" CSV_ROWS,
        "Time [s],X [m],Y [m],Z [m],QX,QY,QZ,QW\n" CSV_ROWS,
        "t,pos_x,pos_y,pos_z,rot_x,rot_y,rot_z,rot_w\n" CSV_ROWS,
        "timestamp_s,px,py,pz,q_x,q_y,q_z,q_w\n" CSV_ROWS,
        "time,position_x,position_y,position_z,orientation_x,orientation_y,orientation_z,"
        "orientation_w\n" CSV_ROWS,
        "time , x , y , z , quat_x , quat_y , quat_z , quat_w\n"
        "1.5 ,\t1, 2 ,3,0,0.6,0,0.8\n1.625,-4,5.5,6,0,0,0,1",
        "qw,name,t,z,y,x,qz,qy,qx,trust\n"
        "0.8,hand,1.5,3,2,1,0,0.6,0,\n1,,1.625,6,5.5,-4,0,0,0,0.5\n",
        "#timestamp [ns]," EUROC_UNITS "\n" NS_ROWS,
        "#timestamp," EUROC "\n" NS_ROWS,
        "# timestamp," EUROC "\r\n1500000000,1,2,3,0.8,0,0.6,0\r\n1625000000,-4,5.5,6,1,0,0,0",
        "#timestamp," EUROC ",v_RS_R_x [m s^-1],b_w_RS_S_x\n"
        "1500000000,1,2,3,0.8,0,0.6,0,9,9\n1625000000,-4,5.5,6,1,0,0,0,9,9\n",
        "t_ns,x,y,z,qw,qx,qy,qz\n" NS_ROWS,
        "TIMESTAMP_NS,x,y,z,qw,qx,qy,qz\n" NS_ROWS,
        "time [NS],x,y,z,qw,qx,qy,qz\n" NS_ROWS,
        "timestamp [s]," EUROC "\n1.5,1,2,3,0.8,0,0.6,0\n1.625,-4,5.5,6,1,0,0,0\n",
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        read_with(TEXTS[i], &PLAIN);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(2, read_in.samples_n, TEXTS[i]);
        const track_sample *s = read_in.samples;
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(0.125, track_duration_s(&read_in), TEXTS[i]);
        const double expected[2][7] = {{1, 2, 3, 0, 0.6, 0, 0.8}, {-4, 5.5, 6, 0, 0, 0, 1}};
        for (int k = 0; k < 2; k++) {
            for (int axis = 0; axis < 7; axis++) {
                const double got = axis < 3 ? s[k].position_m[axis] : s[k].orientation[axis - 3];
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-15, expected[k][axis], got, TEXTS[i]);
            }
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, read_in.counts.not_unit, TEXTS[i]);
    }
}

/* 1.4e18 ns do not fit a double: differences must not lose a nanosecond. */
static void test_nanoseconds_since_1970_keep_their_digits(void)
{
    read_with("#timestamp," EUROC "\n1403636579763555584,0,0,0,1,0,0,0\n"
              "1403636579763555585,0,0,0,1,0,0,0\n1403636579768555584,0,0,0,1,0,0,0\n"
              "1403636580763555584,0,0,0,1,0,0,0\n",
              &PLAIN);
    const double expected_s[] = {0.0, 1e-9, 0.005, 1.0};
    TEST_ASSERT_EQUAL_size_t(4, read_in.samples_n);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-18, expected_s[i], read_in.samples[i].t_s);
    }
}

static void test_refusals_name_line_and_reason(void)
{
    static const struct {
        long line;
        const char *reason, *text;
    } CASES[] = {
        {0, "no samples", ""},
        {0, "no samples", "\xEF\xBB\xBF"},
        {0, "no samples", "\n \n\t\r\n"},
        {0, "no samples", "# only\n# comments\n"},
        {0, "no samples", "timestamp,tx,ty,tz,qx,qy,qz,qw\n"},
        {0, "every quaternion is all zeros", "1 0 0 0 0 0 0 0\n2 0 0 0 -0 0 0 0\n"},
        {2, "7 columns where 8 are expected", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"},
        {1, "9 columns where 8 are expected", "1 0 0 0 0 0 0 1 0\n"},
        {1, "1 columns where 8 are expected", "hello\n"},
        {1, "65 columns where 8 are expected",
         "1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 "
         "1 "
         "1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 "
         "1\n"},
        {3, "7 columns where 8 are expected (as the header has)",
         "# mine\nt,x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,1\n"},
        {2, "10 columns where 9 are expected", "t,x,y,z,qx,qy,qz,qw,a\n1,0,0,0,0,0,0,1,2,3\n"},
        {2, "1 columns where 8 are expected", "t,x,y,z,qx,qy,qz,qw\n1 0 0 0 0 0 0 1\n"},
        {1, "no header line names the columns", "1,0,0,0,0,0,0,1\n"},
        {2, "no header line names the columns", "# t,x\n1,0,0,0,0,0,0,1\n"},
        {1, "the header has no column for qw", "t,x,y,z,qx,qy,qz\n1,0,0,0,0,0,0\n"},
        {1, "the header has no column for timestamp", "when,x,y,z,qx,qy,qz,qw\n"},
        {1, "the header has no column for tz",
         "#timestamp,p_RS_R_x,p_RS_R_y,height,q_RS_w,q_RS_x,q_RS_y,q_RS_z\n1,0,0,0,1,0,0,0\n"},
        {1, "two columns for tx", "t,x,tx,y,z,qx,qy,qz,qw\n"},
        {1, "is in mm", "t,x [mm],y [mm],z [mm],qx,qy,qz,qw\n"},
        {1, "is in ms", "t [ms],x,y,z,qx,qy,qz,qw\n"},
        {1, "timestamp is not a number: 'timestamp'", "timestamp tx ty tz qx qy qz qw\n"},
        {2, "ty is not a number: 'zero'", "1 0 0 0 0 0 0 1\n2 0 zero 0 0 0 0 1\n"},
        {1, "qz is not a number: '1.0x'", "1 0 0 0 0 0 1.0x 1\n"},
        {2, "tx is not a number: '1,5'", "1 0 0 0 0 0 0 1\n2 1,5 0 0 0 0 0 1\n"},
        {2, "tx is not a number: ''", "t,x,y,z,qx,qy,qz,qw\n1,,0,0,0,0,0,1\n"},
        {1, "tx is not a finite", "1 nan 0 0 0 0 0 1\n"},
        {1, "timestamp is not a finite", "nan 0 0 0 0 0 0 1\n"},
        {1, "tz is not a finite", "1 0 0 -inf 0 0 0 1\n"},
        {1, "qw is not a finite", "1 0 0 0 0 0 0 1e999\n"},
        {1, "timestamp is not a finite", "1403636579763555584 0 0 0 0 0 0 1\n"},
        {2, "timestamp is not a count of nanoseconds: '1.5'",
         "t_ns,x,y,z,qx,qy,qz,qw\n1.5,0,0,0,0,0,0,1"},
        {2, "timestamp is not a count of nanoseconds", "t_ns,x,y,z,qx,qy,qz,qw\n-1,0,0,0,0,0,0,1"},
        {2, "timestamp is not a count of nanoseconds",
         "t_ns,x,y,z,qx,qy,qz,qw\n9223372036854775808,0,0,0,0,0,0,1"},
        {3, "time runs backwards, by 0.5 s",
         "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1\n"},
        {3, "time runs backwards, by 1e-09 s",
         "t_ns,x,y,z,qx,qy,qz,qw\n2,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n"},
        {2, "m away from the first sample", "1 0 0 0 0 0 0 1\n2 0 950 0 0 0 0 1\n"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        forget_complaints();
        write_text(CASES[i].text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, track_read(file_path, &PLAIN, &read_in),
                                      CASES[i].text);
        expect_complaint(file_path, CASES[i].line, CASES[i].reason, CASES[i].text);
        TEST_ASSERT_NULL(read_in.samples);
    }
}

static void expect_bytes_refused(const char *bytes, size_t bytes_n, long line, const char *reason)
{
    forget_complaints();
    write_file(bytes, bytes_n);
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, track_read(file_path, &PLAIN, &read_in));
    expect_complaint(file_path, line, reason, bytes);
}

static void test_what_is_not_text_or_has_no_end_of_line(void)
{
    static const char NUL[] = "1 0 0 0 0 0 0 1\n2 0 0\0 0 0 0 1\n";
    expect_bytes_refused(NUL, sizeof NUL - 1, 2, "not a text file");
    static const char ELF[] = "\x7F"
                              "ELF\x02\x01\x01\0\0\0\0";
    expect_bytes_refused(ELF, sizeof ELF - 1, 1, "not a text file");
    static const char UTF_16[] = "\xFF\xFE"
                                 "1\0 \0000\0";
    expect_bytes_refused(UTF_16, sizeof UTF_16 - 1, 1, "not a text file");

    static char text[5000] = "1 0 0 0 0 0 0 1\n#";
    const size_t start_n = strlen(text) - 1; /* of line 2 */
    memset(text + start_n + 1, '.', sizeof text - start_n - 1);
    text[start_n + 4095] = '\n';
    write_file(text, start_n + 4096);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, track_read(file_path, &PLAIN, &read_in), complaint);
    track_free(&read_in);
    text[start_n + 4095] = '.';
    text[start_n + 4096] = '\n';
    expect_bytes_refused(text, start_n + 4097, 2, "longer than 4095 characters");
    expect_bytes_refused(text, start_n + 4096, 2, "longer than 4095 characters");
}

static void expect_path_refused(const char *path, const char *reason)
{
    forget_complaints();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, track_read(path, &PLAIN, &read_in));
    expect_complaint(path, 0, reason, path);
}

static void test_what_cannot_be_opened_or_read(void)
{
    expect_path_refused("/no/such/track.txt", "No such file");
    expect_path_refused("", "No such file");
    expect_path_refused(folder, "Is a directory");
    if (access("/proc/self/mem", R_OK) == 0) {
        expect_path_refused("/proc/self/mem", "cannot be read"); /* opens, and then fails */
    }
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_every_spelling_of_the_same_two_samples);
    RUN_TEST(test_nanoseconds_since_1970_keep_their_digits);
    RUN_TEST(test_refusals_name_line_and_reason);
    RUN_TEST(test_what_is_not_text_or_has_no_end_of_line);
    RUN_TEST(test_what_cannot_be_opened_or_read);
    fixture_end();
    return UNITY_END();
}
