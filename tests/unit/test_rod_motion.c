/* test_rod_motion.c - a rod swings on, comes to rest, and never leaves its stops, whatever a hand does. */
#include "rod_fixture.h"

#include <stdbool.h>
#include <stdio.h>

void setUp(void)
{
    rod_params_defaults(&params);
}

void tearDown(void) {}

static double largest_angle(const rod *r)
{
    double largest = 0.0;
    for (int i = 0; i < params.links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            largest = worse(largest, fabs((double)rod_angles(r)[i][axis]));
        }
    }
    return largest;
}

/* The hand jumps aside by a third of a link, and stays there. Returns where. */
static rod_pose jolt(rod *r)
{
    const rod_pose aside = {{params.length_m[0] / 3.0f, params.length_m[0] / 4.0f, 0.0f},
                            AT_ORIGIN.orientation};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(r, &params, NULL));
    rest(r, &AT_ORIGIN, 1);
    rest(r, &aside, 1);
    TEST_ASSERT_TRUE(largest_angle(r) > 0.1);
    return aside;
}

/* The slowest of these dies away as exp(-c t / 2 mu) with c, or the drag, at least 0.5: after 10 s it is
 * down to exp(-12.5) = 4e-6 of what was at most the joint's stop of 1.4. */
static void test_a_bent_rod_comes_to_rest(void)
{
    uint32_t seed = 21;
    params.tick_s = 0.002f;
    for (int round = 0; round < HOST_OR_BOARD(60, 10); round++) {
        params.links_n = 1 + random_below(&seed, 12);
        params.hold_n = 1 + random_below(&seed, 2);
        const bool by_drag = round % 2;
        for (int i = 0; i < params.links_n; i++) {
            params.spring[i] = (float)random_between(&seed, 50.0, 2000.0);
            params.coupling[i] = (float)random_between(&seed, 0.0, 500.0);
            params.smoothing[i] = (float)random_between(&seed, 0.0, 200.0);
            params.drag[i] = by_drag ? (float)random_between(&seed, 0.5, 4.0) : 0.0f;
            params.damper[i] = by_drag ? 0.0f : (float)random_between(&seed, 0.5, 4.0);
        }
        const rod_pose still = jolt(&one);
        rest(&one, &still, 5000);
        TEST_ASSERT_TRUE(largest_angle(&one) < 1e-4);
    }
}

/* Not merely small: numbers under 1e-38 can cost a desktop processor a hundred times the time. With
 * c / 2 mu = 5 per second 1e-30 comes after 14 s; from there joint after joint is cleared, and many
 * neighbours refill one another for a while. */
static void test_a_rod_at_rest_ends_at_zero(void)
{
    static const int LINKS_N[4] = {1, 2, 5, ROD_MAX_LINKS};
    params.tick_s = 0.004f;
    for (int i = 0; i < 4; i++) {
        params.links_n = LINKS_N[i];
        const rod_pose still = jolt(&one);
        rest(&one, &still, 2500);
        TEST_ASSERT_TRUE(largest_angle(&one) > 1e-30); /* after 10 s it still moves */
        rest(&one, &still, i < 3 ? 2500 : 10000);
        TEST_ASSERT_TRUE(largest_angle(&one) <= 0.0);
    }
}

/* The largest angle within half a second: over a period of 2 pi sqrt(mu / k) = 0.31 s. */
static double amplitude(rod *r, const rod_pose *still)
{
    double largest = 0.0;
    for (int i = 0; i < 500; i++) {
        rest(r, still, 1);
        largest = worse(largest, largest_angle(r));
    }
    return largest;
}

/* The step adds no damping of its own: without damper and drag a rod swings on and on. What is lost or
 * won is the peaks' falling between two ticks: (pi dt / period)^2 / 2 = 5e-5, and rounding. */
static void test_an_undamped_rod_swings_on(void)
{
    params.links_n = 1;
    params.coupling[0] = params.damper[0] = 0.0f;
    const rod_pose still = jolt(&one);
    const double first = amplitude(&one, &still);
    rest(&one, &still, 10000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * first, first, amplitude(&one, &still));
}

/* A link's direction is good to 4 roundoffs a joint, as test_kinematics.c shows, and its ends are
 * rounded where they lie. */
static void test_links_keep_their_length_in_any_swing(void)
{
    params.links_n = ROD_MAX_LINKS;
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    for (int i = 0; i < 1000; i++) {
        const rod_pose hand = hand_at(0.01 * i);
        rest(&one, &hand, 1);
        const int nodes_n = rod_nodes(&one, nodes);
        for (int k = 1; k < nodes_n; k++) {
            const double length = length_double(vec3_sub(nodes[k], nodes[k - 1]));
            const double allowed =
                (double)params.length_m[k - 1] * (3.0 + 4.0 * k) + 2.0 * length_double(nodes[k]);
            TEST_ASSERT_DOUBLE_WITHIN(allowed * UNIT_ROUNDOFF, (double)params.length_m[k - 1],
                                      length);
        }
    }
}

/* Fills a list with values about one magnitude, or with none. */
static void random_list(uint32_t *seed, float *list, double smallest, double largest)
{
    const double middle = random_magnitude(seed, smallest, largest);
    for (int i = 0; i < params.links_n; i++) {
        const double value = middle * random_magnitude(seed, 0.1, 10.0);
        list[i] = (float)fmin(fmax(value, smallest), largest);
    }
}

/* Anything rod_params_check lets pass, over all the decades. */
static void random_params(uint32_t *seed)
{
    rod_params_defaults(&params);
    params.scheme = random_below(seed, ROD_SCHEME_COUNT);
    params.links_n = 1 + random_below(seed, ROD_MAX_LINKS);
    params.hold_n = 1 + random_below(seed, 2);
    params.tick_s = (float)random_magnitude(seed, 5e-5, 0.1);
    random_list(seed, params.length_m, 1e-3, 10.0);
    random_list(seed, params.inertia, 1e-6, 1e3);
    random_list(seed, params.coupling, 1e-3, 1e6);
    random_list(seed, params.smoothing, 1e-3, 1e6);
    random_list(seed, params.spring, 1e-3, 1e6);
    random_list(seed, params.limit_rad, 1e-3, 1.57);
    const bool coupled = random_below(seed, 4), smoothed = random_below(seed, 2);
    const bool sprung = random_below(seed, 4);
    for (int i = 0; i < params.links_n; i++) {
        params.coupling[i] *= (float)coupled;
        params.smoothing[i] *= (float)smoothed;
        params.spring[i] *= (float)sprung;
        const double most = fmin(0.99 * (double)params.inertia[i] / (double)params.tick_s, 1e4);
        params.drag[i] = (float)random_between(seed, 0.0, most);
        params.damper[i] = (float)random_between(seed, 0.0, most);
    }
    params.coupling[0] *= (float)random_below(seed, 2);
}

/* Teleports, half turns, thrusts by exactly a link, and pauses. */
static rod_pose hostile_pose(uint32_t *seed, const rod_pose *last)
{
    rod_pose next = *last;
    switch (random_below(seed, 6)) {
    case 0:
        return random_pose(seed, 600.0);
    case 1:
        next.orientation = quat_multiply(last->orientation, quat_about(random_vec3(seed, 1.0), PI));
        return next;
    case 2:
        next.position_m = quat_rotate(last->orientation, (vec3){0.0f, 0.0f, params.length_m[0]});
        next.position_m = vec3_add(next.position_m, last->position_m);
        return next;
    case 3:
        next.position_m = random_vec3(seed, 1e-3);
        return next;
    case 4:
        next.orientation = random_quat(seed);
        return next;
    default:
        return next;
    }
}

/* Two rods in step, so that determinism is tried along the way; one starts in rubbish. */
static void test_nothing_takes_a_rod_out_of_its_stops(void)
{
    uint32_t seed = 1234;
    int refused_n = 0;
    const int rods_n = HOST_OR_BOARD(1500, 100);
    for (int round = 0; round < rods_n; round++) {
        random_params(&seed);
        memset(&one, 0xff, sizeof one);
        memset(&twin, 0x00, sizeof twin);
        const rod_error error = rod_init(&one, &params, NULL);
        if (error == ROD_E_PIVOT) {
            refused_n++;
            continue;
        }
        TEST_ASSERT_EQUAL_INT(ROD_OK, error);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&twin, &params, NULL));
        rod_pose hand = AT_ORIGIN;
        for (int i = 0; i < 200; i++) {
            hand = hostile_pose(&seed, &hand);
            rest(&one, &hand, 1);
            rest(&twin, &hand, 1);
            TEST_ASSERT_EQUAL_MEMORY(rod_angles(&one), rod_angles(&twin),
                                     (size_t)params.links_n * sizeof(rod_joint));
            for (int joint = 0; joint < params.links_n; joint++) {
                const float *angles = rod_angles(&one)[joint];
                TEST_ASSERT_TRUE(fabsf(angles[ROD_THETA]) <= params.limit_rad[joint]);
                TEST_ASSERT_TRUE(fabsf(angles[ROD_PHI]) <= params.limit_rad[joint]);
            }
        }
    }
    printf("hostile: %d of %d rods refused as too stiff for float32\n", refused_n, rods_n);
    TEST_ASSERT_TRUE_MESSAGE(2 * refused_n < rods_n, "too few rods are tried");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_bent_rod_comes_to_rest);
    RUN_TEST(test_a_rod_at_rest_ends_at_zero);
    RUN_TEST(test_an_undamped_rod_swings_on);
    RUN_TEST(test_links_keep_their_length_in_any_swing);
    RUN_TEST(test_nothing_takes_a_rod_out_of_its_stops);
    return UNITY_END();
}
