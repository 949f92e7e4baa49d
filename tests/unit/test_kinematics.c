/* test_kinematics.c - from angles to nodes and back, against explicit matrix products in double. */
#include "kinematics.h"
#include "rod_config.h"
#include "test_support.h"
#include "unity.h"

#include <stdio.h>

enum { N_MAX = ROD_MAX_LINKS, ROUNDS_N = HOST_OR_BOARD(2000, 200) };

static const rod_pose AT_ORIGIN = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}};

void setUp(void) {}
void tearDown(void) {}

/* --- one joint --------------------------------------------------------------------------------- */

static double distance_to(vec3 got, double x, double y, double z)
{
    return distance_double((point_double){(double)got.x, (double)got.y, (double)got.z},
                           (point_double){x, y, z});
}

/* A sine or cosine is good to 1.3 roundoffs of 1 (trig.h: 7.8e-8), a product of two to 3. */
static void test_direction_is_equation_6(void)
{
    uint32_t seed = 6;
    for (int i = 0; i < ROUNDS_N; i++) {
        const rod_joint angles = {(float)random_between(&seed, -PI, PI),
                                  (float)random_between(&seed, -1.57, 1.57)};
        const double theta = (double)angles[ROD_THETA], phi = (double)angles[ROD_PHI];
        const joint_trig t = kinematics_trig(angles);
        const double error = distance_to(kinematics_direction(&t), cos(phi) * sin(theta), sin(phi),
                                         cos(phi) * cos(theta));
        TEST_ASSERT_TRUE(error <= 3.0 * UNIT_ROUNDOFF);
    }
}

/* What people will check first with a joint in their hands. */
static void test_signs_of_the_angles(void)
{
    const rod_joint to_x = {0.5f, 0.0f}, to_y = {0.0f, 0.5f}, straight = {0.0f, 0.0f};
    joint_trig t = kinematics_trig(to_x);
    TEST_ASSERT_TRUE(kinematics_direction(&t).x > 0.4f);
    t = kinematics_trig(to_y);
    TEST_ASSERT_TRUE(kinematics_direction(&t).y > 0.4f);
    t = kinematics_trig(straight);
    TEST_ASSERT_TRUE(distance_to(kinematics_direction(&t), 0.0, 0.0, 1.0) <= 0.0);
}

/* --- the chain --------------------------------------------------------------------------------- */

typedef struct {
    rod_pose base;
    int links_n;
    rod_joint angles[N_MAX];
    float length_m[N_MAX];
} chain;

static void random_chain(chain *c, uint32_t *seed, int links_n, double bend_rad)
{
    c->base = random_pose(seed, 2.0);
    c->links_n = links_n;
    for (int i = 0; i < links_n; i++) {
        c->angles[i][ROD_THETA] = (float)random_between(seed, -bend_rad, bend_rad);
        c->angles[i][ROD_PHI] = (float)random_between(seed, -bend_rad, bend_rad);
        c->length_m[i] = (float)random_between(seed, 0.01, 0.3);
    }
}

/* Of a frame's axis, after some joints. A joint costs two rounds of products of two and a sum of numbers
 * up to 1, with trigonometry good to 1.3 roundoffs: at worst 10. They do not all conspire: 4 are asked. */
static double frame_error(int joints_n)
{
    return (3.0 + 4.0 * joints_n) * UNIT_ROUNDOFF;
}

static void test_frames_are_the_matrix_products(void)
{
    uint32_t seed = 1;
    static chain c;
    for (int round = 0; round < ROUNDS_N / 20; round++) {
        random_chain(&c, &seed, N_MAX, 1.57);
        frame3 link = quat_frame(c.base.orientation);
        matrix3 wanted = matrix3_of(c.base.orientation);
        for (int i = 0; i < c.links_n; i++) {
            const joint_trig t = kinematics_trig((const float *)c.angles[i]);
            link = kinematics_turn(&link, &t);
            wanted = matrix3_turned(&wanted, (double)c.angles[i][ROD_THETA],
                                    (double)c.angles[i][ROD_PHI]);
            const vec3 columns[3] = {link.x, link.y, link.z};
            for (int k = 0; k < 3; k++) {
                const double error =
                    distance_to(columns[k], wanted.at[0][k], wanted.at[1][k], wanted.at[2][k]);
                TEST_ASSERT_TRUE(error <= frame_error(i + 1));
            }
        }
    }
}

/* A node inherits its predecessor's error, adds its link's, and is rounded where it lies. */
static void test_nodes_are_the_matrix_products(void)
{
    uint32_t seed = 2;
    static chain c;
    static vec3 nodes[N_MAX + 1];
    static point_double wanted[N_MAX + 1];
    static joint_double angles[N_MAX];
    for (int round = 0; round < ROUNDS_N / 10; round++) {
        random_chain(&c, &seed, 1 + random_below(&seed, N_MAX), 1.57);
        for (int i = 0; i < c.links_n; i++) {
            angles[i][ROD_THETA] = (double)c.angles[i][ROD_THETA];
            angles[i][ROD_PHI] = (double)c.angles[i][ROD_PHI];
        }
        kinematics_nodes(&c.base, (const rod_joint *)c.angles, c.length_m, c.links_n, nodes);
        nodes_double(&c.base, (const joint_double *)angles, c.length_m, c.links_n, wanted);
        double allowed = 0.0;
        for (int i = 0; i <= c.links_n; i++) {
            const double *w = wanted[i];
            TEST_ASSERT_TRUE(distance_to(nodes[i], w[0], w[1], w[2]) <= allowed);
            const double length = i < c.links_n ? (double)c.length_m[i] : 0.0;
            allowed += length * frame_error(i + 1) +
                       (length_double(nodes[i]) + length) * 2.0 * UNIT_ROUNDOFF;
        }
    }
}

static void test_links_keep_their_length(void)
{
    uint32_t seed = 3;
    static chain c;
    static vec3 nodes[N_MAX + 1];
    for (int round = 0; round < ROUNDS_N; round++) {
        random_chain(&c, &seed, N_MAX, 3.0);
        kinematics_nodes(&c.base, (const rod_joint *)c.angles, c.length_m, c.links_n, nodes);
        for (int i = 0; i < c.links_n; i++) {
            const double length = length_double(vec3_sub(nodes[i + 1], nodes[i]));
            const double allowed = (double)c.length_m[i] * frame_error(i + 1) +
                                   2.0 * length_double(nodes[i + 1]) * UNIT_ROUNDOFF;
            TEST_ASSERT_TRUE(fabs(length - (double)c.length_m[i]) <= allowed);
        }
    }
}

/* --- and back ---------------------------------------------------------------------------------- */

/* How far the angles of a joint may be off when they are read from nodes in float32, carried from joint
 * to joint. A node is rounded where it lies, so its link's direction is off by that over the length.
 * The parent's frame, as read, is tilted by its own link's error, which the next link corrects, and
 * twisted about its own link, which nothing corrects: a joint with a large phi passes a twist on
 * enlarged. That is the geometry's doing (a universal joint near its pole), not the arithmetic's. */
typedef struct {
    double tilt, twist; /* of the parent's frame */
    double theta, phi;  /* of the joint's angles */
} drift;

static void drift_through(drift *d, const rod_joint angles, double link_error)
{
    const double noise = 12.0 * UNIT_ROUNDOFF; /* trigonometry, its inverse, and the new frame */
    const double sin_theta = fabs(sin((double)angles[ROD_THETA]));
    const double cos_theta = fabs(cos((double)angles[ROD_THETA]));
    const double sin_phi = fabs(sin((double)angles[ROD_PHI]));
    const double cos_phi = cos((double)angles[ROD_PHI]);
    const double own = link_error + noise / cos_phi; /* asin is that much steeper there */
    const double seen = own + d->tilt;
    d->phi = seen + d->twist * sin_theta;
    d->theta = (seen + d->twist * sin_phi * cos_theta) / cos_phi;
    d->twist = (d->twist * cos_theta + seen * sin_phi) / cos_phi + noise;
    d->tilt = own;
}

static void read_angles(const rod_pose *base, const vec3 *nodes, int links_n, rod_joint *read)
{
    static vec3 links[N_MAX];
    for (int i = 0; i < links_n; i++) {
        links[i] = vec3_sub(nodes[i + 1], nodes[i]);
    }
    kinematics_angles(base, links, links_n, read);
}

static void test_angles_survive_the_round_trip(void)
{
    uint32_t seed = 4;
    static chain c;
    static vec3 nodes[N_MAX + 1];
    static rod_joint read[N_MAX];
    double worst = 0.0; /* as a share of what is allowed */
    int joints_n = 0, judged_n = 0;
    for (int round = 0; round < ROUNDS_N; round++) {
        random_chain(&c, &seed, 1 + random_below(&seed, N_MAX), round % 2 ? 1.4 : 0.4);
        kinematics_nodes(&c.base, (const rod_joint *)c.angles, c.length_m, c.links_n, nodes);
        memset(read, 0, sizeof read);
        read_angles(&c.base, nodes, c.links_n, read);
        drift allowed = {0.0, 0.0, 0.0, 0.0};
        joints_n += c.links_n;
        for (int i = 0; i < c.links_n && allowed.twist < 1e-3; i++) { /* where it is linear */
            const double lost = length_double(nodes[i + 1]) * sqrt(3.0) * UNIT_ROUNDOFF;
            drift_through(&allowed, c.angles[i], lost / (double)c.length_m[i]);
            const double theta = (double)read[i][ROD_THETA] - (double)c.angles[i][ROD_THETA];
            const double phi = (double)read[i][ROD_PHI] - (double)c.angles[i][ROD_PHI];
            worst = worse(worst, fabs(theta) / allowed.theta);
            worst = worse(worst, fabs(phi) / allowed.phi);
            judged_n++;
        }
    }
    printf("round trip: worst %.2f of what is allowed, %d of %d joints\n", worst, judged_n,
           joints_n);
    TEST_ASSERT_TRUE(worst <= 1.0);
    TEST_ASSERT_TRUE_MESSAGE(4 * judged_n > 3 * joints_n, "too little is judged");
}

static void test_one_link_comes_back_closely(void)
{
    const float length = 0.03f;
    for (int i = -14; i <= 14; i++) {
        const rod_joint bent = {0.1f * (float)i, -0.05f * (float)i};
        rod_joint read = {0.0f, 0.0f};
        vec3 nodes[2];
        kinematics_nodes(&AT_ORIGIN, (const rod_joint *)&bent, &length, 1, nodes);
        read_angles(&AT_ORIGIN, nodes, 1, &read);
        TEST_ASSERT_FLOAT_WITHIN(5e-7f, bent[ROD_THETA],
                                 read[ROD_THETA]); /* 2 last places of 1.4 */
        TEST_ASSERT_FLOAT_WITHIN(5e-7f, bent[ROD_PHI], read[ROD_PHI]);
    }
}

/* Along the parent's y theta has no meaning, and is left alone: within 1e-6 of it, not beyond. */
static void test_theta_is_kept_at_the_pole(void)
{
    for (int side = -1; side <= 1; side += 2) {
        const float y = 0.25f * (float)side;
        rod_joint read = {0.7f, 0.1f};
        vec3 nodes[2] = {{0.0f, 0.0f, 0.0f}, {0.9e-6f * 0.25f, y, 0.0f}};
        read_angles(&AT_ORIGIN, nodes, 1, &read);
        TEST_ASSERT_EQUAL_HEX32(bits_of(0.7f), bits_of(read[ROD_THETA]));
        TEST_ASSERT_EQUAL_HEX32(bits_of((float)side * TRIG_HALF_PI), bits_of(read[ROD_PHI]));
        nodes[1].x = 1.1e-6f * 0.25f;
        read_angles(&AT_ORIGIN, nodes, 1, &read);
        TEST_ASSERT_EQUAL_HEX32(bits_of(TRIG_HALF_PI), bits_of(read[ROD_THETA]));
    }
}

/* A link of no length keeps its angles, and the next one is read from the frame they make. */
static void test_a_link_without_length_keeps_its_angles(void)
{
    const rod_joint bent[3] = {{0.3f, -0.2f}, {0.5f, 0.4f}, {-0.6f, 0.1f}};
    const float length[3] = {0.1f, 0.0f, 0.1f};
    rod_joint read[3] = {{0.0f, 0.0f}, {0.5f, 0.4f}, {0.0f, 0.0f}};
    vec3 nodes[4];
    kinematics_nodes(&AT_ORIGIN, bent, length, 3, nodes);
    read_angles(&AT_ORIGIN, nodes, 3, read);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, bent[i][ROD_THETA], read[i][ROD_THETA]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, bent[i][ROD_PHI], read[i][ROD_PHI]);
    }
}

/* --- the base ---------------------------------------------------------------------------------- */

/* What the motion says: the old axes as seen in the new ones, R_to' R_from, and the old place there,
 * R_to' (p_from - p_to). The quaternions are unit to a roundoff, a rotation by one costs ten. */
static void test_motion_of_the_base(void)
{
    uint32_t seed = 5;
    for (int round = 0; round < ROUNDS_N; round++) {
        const rod_pose from = random_pose(&seed, 2.0), to = random_pose(&seed, 2.0);
        const rod_motion motion = kinematics_motion(&from, &to);
        const matrix3 new_axes = matrix3_of(to.orientation),
                      old_axes = matrix3_of(from.orientation);
        const matrix3 turn = matrix3_of(motion.turn);
        const vec3 moved = vec3_sub(from.position_m, to.position_m);
        const double m[3] = {(double)moved.x, (double)moved.y, (double)moved.z};
        double shift[3];
        for (int i = 0; i < 3; i++) {
            shift[i] = 0.0;
            for (int k = 0; k < 3; k++) {
                double wanted = 0.0;
                for (int j = 0; j < 3; j++) {
                    wanted += new_axes.at[j][i] * old_axes.at[j][k];
                }
                TEST_ASSERT_DOUBLE_WITHIN(10.0 * UNIT_ROUNDOFF, wanted, turn.at[i][k]);
                shift[i] += new_axes.at[k][i] * m[k];
            }
        }
        TEST_ASSERT_TRUE(distance_to(motion.shift_m, shift[0], shift[1], shift[2]) <=
                         10.0 * UNIT_ROUNDOFF * length_double(moved));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_direction_is_equation_6);
    RUN_TEST(test_signs_of_the_angles);
    RUN_TEST(test_frames_are_the_matrix_products);
    RUN_TEST(test_nodes_are_the_matrix_products);
    RUN_TEST(test_links_keep_their_length);
    RUN_TEST(test_angles_survive_the_round_trip);
    RUN_TEST(test_one_link_comes_back_closely);
    RUN_TEST(test_theta_is_kept_at_the_pole);
    RUN_TEST(test_a_link_without_length_keeps_its_angles);
    RUN_TEST(test_motion_of_the_base);
    return UNITY_END();
}
