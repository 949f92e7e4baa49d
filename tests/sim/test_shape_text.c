/* test_shape_text.c - shapes as text: every refusal with its place, and what comes of arcs, coils and tables. */
#include "shape_text.h"

#include <math.h>

#include "file_fixture.h"
#include "rod_config.h"

static rod_joint angles[ROD_MAX_LINKS];

void setUp(void)
{
    memset(angles, 0, sizeof angles);
    forget_complaints();
}

void tearDown(void) {}

static void read_shape(const char *shape, int links_n)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, shape_text_read(shape, links_n, angles), complaint);
}

static void expect_file_refused(const char *table, long line, const char *reason)
{
    setUp();
    write_text(table);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, shape_text_read(file_path, 3, angles), table);
    expect_complaint(file_path, line, reason, table);
}

static void expect_joint(double theta, double phi, int joint)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)theta, angles[joint][ROD_THETA]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)phi, angles[joint][ROD_PHI]);
}

static void test_what_is_refused(void)
{
    static const char *const NAMES[][2] = {{"arc:", "must be arc: and a number from -360 to 360"},
                                           {"arc:9o", "must be arc: and a number"},
                                           {"arc:361", "must be arc: and a number"},
                                           {"arc:nan", "must be arc: and a number"},
                                           {"coil:11", "must be coil: and a number from -10 to 10"},
                                           {"ring:1", "a shape is a file, arc:DEGREES or coil:"},
                                           {"/no/such", "No such file"}};
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        setUp();
        TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, shape_text_read(NAMES[i][0], 3, angles));
        expect_complaint(NAMES[i][0], 0, NAMES[i][1], "");
    }
    setUp();
    TEST_ASSERT_EQUAL_INT(SIM_BAD_INPUT, shape_text_read(folder, 3, angles));
    expect_complaint(folder, 0, "Is a directory", "");
    expect_file_refused("", 0, "empty; a shape is a table with the header");
    expect_file_refused("# nothing\n\n", 0, "empty");
    expect_file_refused("0,0\n0,0\n0,0\n", 1, "'0,0' is no header of a shape");
    expect_file_refused("theta,phi\n0,0\n0\n", 3, "1 columns where theta,phi has 2");
    expect_file_refused("theta,phi\n0,0,0\n", 2, "3 columns where theta,phi has 2");
    expect_file_refused("theta,phi\n0,x\n", 2, "'x': must be a number from -3.14159 to 3.14159");
    expect_file_refused("theta,phi\n0,90\n", 2, "'90': must be a number from -3.14159");
    expect_file_refused("theta,phi\n0,\n", 2, "'': must be a number");
    expect_file_refused("theta_deg,phi_deg\n0,181\n", 2, "must be a number from -180 to 180");
    expect_file_refused("theta,phi\n0,0\n0,0\n", 0,
                        "2 rows of theta,phi for a rod of 3 links; it "
                        "needs 3, one per joint");
    expect_file_refused("x,y,z\n0,0,0\n0,0,1\n0,0,2\n", 0,
                        "3 rows of x,y,z for a rod of 3 links; "
                        "it needs 4, the base's own point first");
    expect_file_refused("x,y,z\n0,0,0\n0,0,1\n0,0,1\n0,0,2\n", 0, "point 3 is where point 2 is");
    char longer[1500] = "theta,phi\n";
    memset(longer + 10, ' ', 300);
    expect_file_refused(longer, 2, "longer than 198 characters");
    char many[1500] = "theta,phi\n";
    for (int i = 0; i < ROD_MAX_LINKS + 2; i++) {
        strcat(many, "0,0\n");
    }
    expect_file_refused(many, ROD_MAX_LINKS + 3, "more than 65 rows");
}

static void test_tables(void)
{
    write_text("# a bow\r\n theta, phi # rad\r\n\r\n0.1, -0.2\r\n 0.3,0.4\n-0.5,3.14159");
    read_shape(file_path, 3);
    expect_joint(0.1, -0.2, 0);
    expect_joint(0.3, 0.4, 1);
    expect_joint(-0.5, 3.14159, 2);
    write_text("theta_deg,phi_deg\n90,-45\n180,0\n");
    read_shape(file_path, 2);
    expect_joint(M_PI / 2, -M_PI / 4, 0);
    expect_joint(M_PI, 0.0, 1);
}

/* Points of a known rod lead back to its angles, whatever their scale. */
static void test_points(void)
{
    const rod_joint bent[] = {{0.3f, -0.2f}, {0.5f, 0.4f}, {-0.7f, 0.1f}, {0.0f, 0.6f}};
    const float length_m[] = {0.1f, 0.25f, 0.1f, 0.4f};
    const rod_pose upright = {.position_m = {5.0f, 6.0f, 7.0f}, .orientation.w = 1.0f};
    vec3 nodes[5];
    kinematics_nodes(&upright, bent, length_m, 4, nodes);
    char table[600] = "x,y,z\n";
    for (int i = 0; i < 5; i++) {
        char row[100];
        snprintf(row, sizeof row, "%.9g,%.9g,%.9g\n", 1e3 * (double)nodes[i].x,
                 1e3 * (double)nodes[i].y, 1e3 * (double)nodes[i].z);
        strcat(table, row);
    }
    write_text(table);
    read_shape(file_path, 4);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FLOAT_WITHIN(2e-5f, bent[i][ROD_THETA], angles[i][ROD_THETA]);
        TEST_ASSERT_FLOAT_WITHIN(2e-5f, bent[i][ROD_PHI], angles[i][ROD_PHI]);
    }
}

static vec3 tip_of(int links_n)
{
    static const rod_pose UPRIGHT = {.orientation.w = 1.0f};
    float length_m[ROD_MAX_LINKS];
    vec3 nodes[ROD_MAX_LINKS + 1];
    for (int i = 0; i < links_n; i++) {
        length_m[i] = 1.0f / (float)links_n;
    }
    kinematics_nodes(&UPRIGHT, (const rod_joint *)angles, length_m, links_n, nodes);
    return nodes[links_n];
}

static void test_arcs_and_coils(void)
{
    read_shape("arc:90", 3);
    for (int i = 0; i < 3; i++) {
        expect_joint(M_PI / 6, 0.0, i);
    }
    read_shape("arc:-90", 64); /* a quarter of a circle of radius 2 / pi, towards -x */
    TEST_ASSERT_FLOAT_WITHIN(0.01f, -(float)M_2_PI, tip_of(64).x);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, (float)M_2_PI, tip_of(64).z);
    read_shape("arc:360", 64);
    TEST_ASSERT_FLOAT_WITHIN(0.03f, 0.0f, tip_of(64).x); /* links have corners */
    TEST_ASSERT_FLOAT_WITHIN(0.03f, 0.0f, tip_of(64).z);
    /* a helix comes round beside itself: it rises by 0.25 radii a radian of its turns */
    for (int turns = -2; turns <= 2; turns += 4) {
        read_shape(turns < 0 ? "coil:-2" : "coil:2", 64);
        const vec3 tip = tip_of(64);
        TEST_ASSERT_FLOAT_WITHIN(0.03f, 0.25f / sqrtf(1.0625f), sqrtf(vec3_dot(tip, tip)));
    }
    read_shape("coil:0", 5);
    expect_joint(0.0, 0.0, 4);
}

int main(void)
{
    fixture_start();
    UNITY_BEGIN();
    RUN_TEST(test_what_is_refused);
    RUN_TEST(test_tables);
    RUN_TEST(test_points);
    RUN_TEST(test_arcs_and_coils);
    fixture_end();
    return UNITY_END();
}
