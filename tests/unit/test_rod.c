/* test_rod.c - the rod as its users see it: what a call changes, and above all what it must not. */
#include "rod_fixture.h"

#include <stdbool.h>

void setUp(void)
{
    rod_params_defaults(&params);
    params.links_n = 6;
}

void tearDown(void) {}

/* --- helpers ----------------------------------------------------------------------------------- */

static void expect_same_angles(const rod *a, const rod *b)
{
    TEST_ASSERT_EQUAL_INT(a->params.links_n, b->params.links_n);
    TEST_ASSERT_EQUAL_MEMORY(rod_angles(a), rod_angles(b),
                             (size_t)a->params.links_n * sizeof(rod_joint));
}

/* Whatever a call did to one and not to the other shows when both go on. */
static void expect_same_future(rod *a, rod *b)
{
    expect_same_angles(a, b);
    for (int i = 0; i < 20; i++) {
        follow(a, 0.1 + 0.001 * i, 1);
        follow(b, 0.1 + 0.001 * i, 1);
        expect_same_angles(a, b);
    }
}

/* Valid one by one, but all stiffness and no inertia: in float32 the last pivot is zero. */
static void make_unfactorable(rod_params *p)
{
    p->tick_s = 0.1f;
    for (int i = 0; i < p->links_n; i++) {
        p->inertia[i] = 1e-6f;
        p->coupling[i] = i > 0 ? 1e6f : 0.0f;
        p->smoothing[i] = p->spring[i] = p->damper[i] = p->drag[i] = 0.0f;
    }
}

/* --- starting ---------------------------------------------------------------------------------- */

static void test_a_refused_init_leaves_a_living_rod_alone(void)
{
    for (int bad = 0; bad < 2; bad++) {
        setUp();
        swing(&one);
        swing(&twin);
        rod_refusal refusal;
        if (bad == 0) {
            params.spring[3] = NAN;
            TEST_ASSERT_EQUAL_INT(ROD_E_SPRING, rod_init(&one, &params, &refusal));
            TEST_ASSERT_EQUAL_INT(3, refusal.joint);
        } else {
            make_unfactorable(&params);
            TEST_ASSERT_EQUAL_INT(ROD_E_PIVOT, rod_init(&one, &params, &refusal));
            TEST_ASSERT_EQUAL_INT(params.links_n - 1, refusal.joint);
        }
        expect_same_future(&one, &twin);
    }
}

static void test_the_first_step_takes_the_pose_and_no_more(void)
{
    static const rod_joint STRAIGHT[ROD_MAX_LINKS];
    const rod_pose far_away = {{900.0f, -900.0f, 5.0f}, {0.6f, 0.0f, 0.8f, 0.0f}};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    TEST_ASSERT_EQUAL_INT(0, rod_nodes(&one, nodes));
    for (int i = 0; i < 2; i++) { /* the second one stays where it is, and so does the rod */
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &far_away));
        TEST_ASSERT_EQUAL_MEMORY(STRAIGHT, rod_angles(&one), 6 * sizeof(rod_joint));
    }
    TEST_ASSERT_EQUAL_INT(7, rod_nodes(&one, nodes));
    TEST_ASSERT_EQUAL_MEMORY(&far_away.position_m, &nodes[0], sizeof nodes[0]);
    TEST_ASSERT_EQUAL_PTR(&one.params, rod_params_of(&one));
    TEST_ASSERT_EQUAL_MEMORY(&params, rod_params_of(&one), sizeof params);
}

/* A rod that has lived and one in memory full of rubbish: after a reset or an init all is the same. */
static void test_reset_and_init_leave_nothing_behind(void)
{
    swing(&one);
    rod_reset(&one);
    TEST_ASSERT_EQUAL_INT(0, rod_nodes(&one, nodes));
    memset(&twin, 0xff, sizeof twin);
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&twin, &params, NULL));
    expect_same_future(&one, &twin);
}

/* --- changing parameters ----------------------------------------------------------------------- */

static void test_set_params_keeps_angles_and_speeds(void)
{
    swing(&one);
    swing(&twin);
    params.spring[0] = 500.0f;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
    expect_same_angles(&one, &twin); /* nothing jumps */
    params.spring[0] = twin.params.spring[0];
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
    expect_same_future(&one, &twin); /* and back again before a tick: nothing has happened */
}

static void test_refused_params_change_nothing(void)
{
    swing(&one);
    swing(&twin);
    for (int i = 0; i <= ROD_FIELDS_N; i++) {
        rod_params bad = params;
        rod_error expected = ROD_E_PIVOT;
        if (i < ROD_FIELDS_N) {
            rod_field_set(&rod_fields[i], &bad, 2, NAN);
            expected = rod_fields[i].error;
        } else {
            bad.links_n = ROD_MAX_LINKS;
            make_unfactorable(&bad);
        }
        rod_refusal refusal;
        TEST_ASSERT_EQUAL_INT(expected, rod_set_params(&one, &bad, &refusal));
        TEST_ASSERT_EQUAL_INT(expected, refusal.error);
        TEST_ASSERT_EQUAL_INT(expected, rod_set_params(&one, &bad, NULL));
        TEST_ASSERT_EQUAL_MEMORY(&params, rod_params_of(&one), sizeof params);
        expect_same_angles(&one, &twin);
    }
    expect_same_future(&one, &twin);
}

/* Joints taken away and given back, with some ticks between, are straight and at rest: uncoupled, they
 * stay so. */
static void test_new_joints_are_straight_and_at_rest(void)
{
    static const rod_joint STRAIGHT[ROD_MAX_LINKS];
    for (int ticks_between_n = 0; ticks_between_n < 3; ticks_between_n++) {
        setUp();
        swing(&one);
        swing(&twin);
        params.links_n = 2;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), 2 * sizeof(rod_joint));
        follow(&one, 0.1, ticks_between_n);
        params.links_n = ROD_MAX_LINKS;
        memset(params.coupling, 0, sizeof params.coupling);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_EQUAL_MEMORY(STRAIGHT, rod_angles(&one) + 2,
                                     (ROD_MAX_LINKS - 2) * sizeof(rod_joint));
            follow(&one, 0.11 + 0.001 * i, 1);
        }
    }
}

/* Runs to 1/8 s at one tick and on to 1/4 s at another. */
static void follow_at_two_ticks(rod *r, float first_s, float second_s)
{
    params.tick_s = first_s;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(r, &params, NULL));
    follow(r, 0.0, 1 + (int)(0.125f / first_s));
    params.tick_s = second_s;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(r, &params, NULL));
    follow(r, 0.125 + (double)second_s, (int)(0.125f / second_s));
}

/* A rod without springs goes on in the world at its speed. A speed is the mean over the last tick, so
 * it is known half a tick late: at the 60 rad/s^2 of this hand that is 0.03 rad/s, or 4e-3 rad after
 * 1/8 s. One not scaled with the tick, the rod's or the hand's, is off by ten times as much and more. */
static void test_a_change_of_tick_keeps_speeds_per_second(void)
{
    static const float NEW_TICKS_S[3] = {0x1p-12f, 0x1p-11f, 0x1p-9f};
    params.links_n = 3;
    params.hold_n = 2;
    for (int i = 0; i < 3; i++) {
        params.length_m[i] = 0.5f;
        params.damper[i] = 1.0f;
        params.spring[i] = params.coupling[i] = 0.0f;
    }
    for (int i = 0; i < 3; i++) {
        follow_at_two_ticks(&one, 0x1p-10f, NEW_TICKS_S[i]);
        follow_at_two_ticks(&twin, NEW_TICKS_S[i], NEW_TICKS_S[i]);
        for (int joint = 0; joint < 3; joint++) {
            for (int axis = 0; axis < 2; axis++) {
                TEST_ASSERT_FLOAT_WITHIN(4e-3f, rod_angles(&twin)[joint][axis],
                                         rod_angles(&one)[joint][axis]);
            }
        }
    }
}

/* --- poses ------------------------------------------------------------------------------------- */

static void test_bad_poses_are_refused(void)
{
    static const float BAD_PLACES[] = {NAN, INFINITY, -INFINITY, 1000.1f, -1000.1f, 3e38f};
    static const float BAD_NORMS[] = {NAN, INFINITY, 0.0f, 1.0011f, -1.0011f, 0.9989f, 3e38f};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    rod_pose bad = AT_ORIGIN;
    bad.position_m.y = NAN;
    TEST_ASSERT_EQUAL_INT(ROD_E_POSE, rod_step(&one, &bad));
    TEST_ASSERT_EQUAL_INT(0, rod_nodes(&one, nodes)); /* it has not become the first pose */
    swing(&one);
    swing(&twin);
    for (int axis = 0; axis < 4; axis++) {
        for (size_t i = 0; axis < 3 && i < sizeof BAD_PLACES / sizeof BAD_PLACES[0]; i++) {
            bad = AT_ORIGIN;
            (&bad.position_m.x)[axis] = BAD_PLACES[i];
            TEST_ASSERT_EQUAL_INT(ROD_E_POSE, rod_step(&one, &bad));
        }
        for (size_t i = 0; i < sizeof BAD_NORMS / sizeof BAD_NORMS[0]; i++) {
            bad = (rod_pose){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f}};
            (&bad.orientation.x)[axis] = BAD_NORMS[i];
            TEST_ASSERT_EQUAL_INT(ROD_E_POSE, rod_step(&one, &bad));
        }
    }
    expect_same_future(&one, &twin);
    const rod_pose corner = {{1000.0f, -1000.0f, 1000.0f}, {0.0f, 1.0009f, 0.0f, 0.0f}};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &corner));
}

/* q and -q are the same attitude, and only differences of positions count: to the last bit, over a
 * change of tick too. 16 m and steps of 2^-12 m have room in a float together. */
static void test_no_bit_depends_on_signs_or_places(void)
{
    uint32_t seed = 9;
    swing(&one);
    swing(&twin);
    rod_reset(&one);
    rod_reset(&twin);
    for (int i = 0; i < 400; i++) {
        rod_pose hand = hand_at(0.001 * i);
        hand.position_m.x = (float)floor((double)hand.position_m.x * 4096.0) / 4096.0f;
        hand.position_m.y = hand.position_m.z = 0.0f;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &hand));
        hand.position_m = vec3_add(hand.position_m, (vec3){16.0f, -8.0f, 900.0f});
        const quat q = hand.orientation;
        if (random_below(&seed, 2)) {
            hand.orientation = (quat){-q.x, -q.y, -q.z, -q.w};
        }
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&twin, &hand));
        expect_same_angles(&one, &twin);
        if (i % 50 == 49) {
            params.tick_s = i % 100 == 99 ? 0.001f : 0.003f;
            TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
            TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&twin, &params, NULL));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_refused_init_leaves_a_living_rod_alone);
    RUN_TEST(test_the_first_step_takes_the_pose_and_no_more);
    RUN_TEST(test_reset_and_init_leave_nothing_behind);
    RUN_TEST(test_set_params_keeps_angles_and_speeds);
    RUN_TEST(test_refused_params_change_nothing);
    RUN_TEST(test_new_joints_are_straight_and_at_rest);
    RUN_TEST(test_a_change_of_tick_keeps_speeds_per_second);
    RUN_TEST(test_bad_poses_are_refused);
    RUN_TEST(test_no_bit_depends_on_signs_or_places);
    return UNITY_END();
}
