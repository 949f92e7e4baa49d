/* base_path.c: between two poses the base goes on the parabola through them and the one before. */
#include <float.h>

#include "base_path.h"
#include "test_support.h"
#include "unity.h"

static const double EPS = (double)FLT_EPSILON;
static uint32_t seed;

void setUp(void)
{
    seed = 57;
}

void tearDown(void) {}

static quat negated(quat q)
{
    return (quat){-q.x, -q.y, -q.z, -q.w};
}

/* Quaternions of the three poses, all on one side, and what Lagrange's weights make of them. */
static void expect_on_parabola(const rod_pose pose[3], const rod_pose *at, double share)
{
    const double weight[3] = {0.5 * share * (share - 1.0), 1.0 - share * share,
                              0.5 * share * (share + 1.0)};
    double q[4] = {0.0}, norm_squared = 0.0, dot = 0.0;
    for (int axis = 0; axis < 4; axis++) {
        for (int i = 0; i < 3; i++) {
            q[axis] += weight[i] * (double)(&pose[i].orientation.x)[axis];
        }
        norm_squared += q[axis] * q[axis];
    }
    for (int axis = 0; axis < 4; axis++) {
        dot += q[axis] / sqrt(norm_squared) * (double)(&at->orientation.x)[axis];
    }
    for (int axis = 0; axis < 4; axis++) {
        TEST_ASSERT_DOUBLE_WITHIN(16.0 * EPS, q[axis] / sqrt(norm_squared),
                                  copysign(1.0, dot) * (double)(&at->orientation.x)[axis]);
    }
    for (int axis = 0; axis < 3; axis++) {
        double place = 0.0;
        for (int i = 0; i < 3; i++) {
            place += weight[i] * (double)(&pose[i].position_m.x)[axis];
        }
        TEST_ASSERT_DOUBLE_WITHIN(16.0 * EPS, place, (double)(&at->position_m.x)[axis]);
    }
}

static void path_is_the_parabola_whatever_the_signs(void)
{
    for (int round = 0; round < HOST_OR_BOARD(2000, 100); round++) {
        rod_pose pose[3] = {random_pose(&seed, 1.0)}, given[3];
        for (int i = 1; i < 3; i++) {
            const quat turn = quat_about(random_vec3(&seed, 1.0), random_between(&seed, 0.0, 1.5));
            pose[i].position_m = vec3_add(pose[i - 1].position_m, random_vec3(&seed, 0.5));
            pose[i].orientation = quat_multiply(turn, pose[i - 1].orientation);
        }
        for (int i = 0; i < 3; i++) {
            given[i] = pose[i];
            if (random_below(&seed, 2)) {
                given[i].orientation = negated(given[i].orientation);
            }
        }
        const base_path path = base_path_between(&given[0], &given[1], &given[2]);
        for (int k = 0; k <= 10; k++) {
            const rod_pose at = base_path_pose(&path, (float)(0.1 * k));
            expect_on_parabola(pose, &at, (double)(float)(0.1 * k));
        }
    }
}

/* Half turns, one way and back again: nothing ends in no direction at all. */
static void quaternion_is_of_unit_length_after_any_turn(void)
{
    for (int round = 0; round < HOST_OR_BOARD(5000, 300); round++) {
        const rod_pose before = random_pose(&seed, 1.0);
        rod_pose from = before, to = before;
        from.orientation = quat_multiply(quat_about(random_vec3(&seed, 1.0), PI), from.orientation);
        to.orientation = random_below(&seed, 2) ? before.orientation : random_quat(&seed);
        const base_path path = base_path_between(&before, &from, &to);
        for (int k = 0; k <= 10; k++) {
            const quat q = base_path_pose(&path, (float)(0.1 * k)).orientation;
            const double x = (double)q.x, y = (double)q.y, z = (double)q.z, w = (double)q.w;
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * EPS, 1.0, sqrt(x * x + y * y + z * z + w * w));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(path_is_the_parabola_whatever_the_signs);
    RUN_TEST(quaternion_is_of_unit_length_after_any_turn);
    return UNITY_END();
}
