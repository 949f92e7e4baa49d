/* test_scene_gap.c - how far a point is from an object, and which way is out, against a second way to find it, in
 * double. */
#include "object_fixture.h"
#include "test_support.h"
#include "unity.h"

static uint32_t seed;
static scene s;

void setUp(void)
{
    seed = 2463534242u;
    memset(&s, 0, sizeof s);
}

void tearDown(void) {}

/* --- a second way to tell how far --------------------------------------------------------------------- */

/* A convex object is where n . x <= h(n) for every direction n, and a point's signed distance from it, inside and
 * out, is the largest n . x - h(n) of all n of unit length. For a box of half_m rounded off by r about the origin,
 * h(n) = sum half |n| + r. All in the object's axes. */
typedef struct {
    double half_m[3], radius_m, point_m[3];
} question;

static double beyond_face(const question *q, const double *n)
{
    double sum = -q->radius_m;
    for (int i = 0; i < 3; i++) {
        sum += n[i] * q->point_m[i] - q->half_m[i] * fabs(n[i]);
    }
    return sum;
}

/* Uphill from a direction by turns about the axes, ever smaller; a turn about an axis keeps that part of n, so the
 * search can follow the creases where one part is 0. */
static double climb(const question *q, double *n)
{
    double best = beyond_face(q, n);
    const double rounding_m =
        1e-15 * (q->radius_m + fabs(q->point_m[0]) + fabs(q->point_m[1]) + fabs(q->point_m[2]));
    for (double turn = 0.4; turn > 1e-7; turn *= 0.5) {
        for (int move = 0; move < 6; move++) {
            const int a = move % 3, b = (a + 1) % 3;
            const double c = cos(turn), sine = move < 3 ? sin(turn) : -sin(turn);
            double other[3] = {n[0], n[1], n[2]};
            other[a] = c * n[a] - sine * n[b];
            other[b] = sine * n[a] + c * n[b];
            const double there = beyond_face(q, other);
            if (there > best + rounding_m) {
                best = there;
                memcpy(n, other, sizeof other);
                move = -1;
            }
        }
    }
    return best;
}

/* From every face, edge and corner. */
static double signed_distance(const question *q, double *normal)
{
    double best = -HUGE_VAL;
    for (int start = 0; start < 27; start++) {
        double n[3] = {start % 3 - 1.0, start / 3 % 3 - 1.0, start / 9 - 1.0};
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (length > 0.0) {
            for (int i = 0; i < 3; i++) {
                n[i] /= length;
            }
            const double here = climb(q, n);
            if (here > best) {
                best = here;
                memcpy(normal, n, sizeof n);
            }
        }
    }
    return best;
}

static void to_axes(const matrix3 *m, vec3 from, vec3 v, double *out)
{
    const double d[3] = {(double)v.x - (double)from.x, (double)v.y - (double)from.y,
                         (double)v.z - (double)from.z};
    for (int i = 0; i < 3; i++) {
        out[i] = m->at[0][i] * d[0] + m->at[1][i] * d[1] + m->at[2][i] * d[2];
    }
}

/* Any object of a kind, a hair off unit orientation, within a few of its sizes of the origin. */
static scene_object random_object(int kind)
{
    const double size = random_magnitude(&seed, 2e-3, 100.0);
    scene_object o = example(kind);
    o.place_m = random_vec3(&seed, 3.0 * size);
    o.orientation = random_quat(&seed);
    o.orientation.w *= 1.001f;
    float *const half[] = {&o.half_m.x, &o.half_m.y, &o.half_m.z};
    for (int axis = 0; axis < 3; axis++) {
        *half[axis] = *half[axis] > 0.0f ? (float)random_between(&seed, 0.0, size) : 0.0f;
    }
    o.radius_m = kind == SCENE_PLANE ? 0.0f : (float)random_between(&seed, 0.5 * size, size);
    if (kind == SCENE_BOX && (random_bits(&seed) & 1) != 0) {
        o.radius_m = SCENE_RADIUS_MIN_M;
    }
    return o;
}

static double size_of(const scene_object *o)
{
    return length_double(o->half_m) + (double)o->radius_m + length_double(o->place_m);
}

static void expect_gap(const scene_object *o, vec3 point_m)
{
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, 0, o, NULL));
    const scene_gap gap = scene_gap_to(&s.body[0], point_m);
    const matrix3 axes = matrix3_of(o->orientation);
    question q = {{(double)o->half_m.x, (double)o->half_m.y, (double)o->half_m.z},
                  (double)o->radius_m,
                  {0.0}};
    double normal[3] = {0.0, 0.0, 1.0}, found[3];
    to_axes(&axes, o->place_m, point_m, q.point_m);
    const double distance_m = o->kind == SCENE_PLANE ? q.point_m[2] : signed_distance(&q, normal);
    to_axes(&axes, (vec3){0.0f, 0.0f, 0.0f}, gap.normal, found);

    const double rounding_m = 1e-6 * (size_of(o) + length_double(point_m));
    float gap_alone_m;
    scene_gaps_m(&s.body[0], &point_m, 1, &gap_alone_m);
    TEST_ASSERT_DOUBLE_WITHIN(rounding_m, distance_m, (double)gap.gap_m);
    TEST_ASSERT_DOUBLE_WITHIN(rounding_m, distance_m, (double)gap_alone_m);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, length_double(gap.normal));
    if (o->kind != SCENE_PLANE) { /* deep inside several ways out may be as good */
        TEST_ASSERT_DOUBLE_WITHIN(2.0 * rounding_m, distance_m, beyond_face(&q, found));
    }
    const double round_m = distance_m + (double)o->radius_m;
    if (o->kind == SCENE_PLANE || round_m > 0.01 * size_of(o)) {
        TEST_ASSERT_DOUBLE_WITHIN(2e-6 + 2.0 * rounding_m / round_m, 0.0,
                                  distance_double(found, normal));
    }
}

static void gaps_are_those_of_the_second_way(void)
{
    int inside_n = 0;
    const int points_n = HOST_OR_BOARD(2000, 8);
    for (int i = 0; i < points_n; i++) {
        const scene_object o = random_object(1 + i % (SCENE_KINDS_N - 1));
        const double reach_m = 1.5 * (length_double(o.half_m) + (double)o.radius_m) + 0.01;
        const vec3 point =
            vec3_add(o.place_m, random_vec3(&seed, random_magnitude(&seed, 0.05, 1.0) * reach_m));
        expect_gap(&o, point);
        inside_n += scene_gap_to(&s.body[0], point).gap_m < 0.0f ? 1 : 0;
    }
    TEST_ASSERT_TRUE(8 * inside_n > points_n && 8 * inside_n < 7 * points_n);
}

/* Where the formula has its branches: centres, axes, faces, edges and corners. */
static void gaps_are_right_on_every_seam(void)
{
    for (int kind = SCENE_SPHERE; kind < SCENE_KINDS_N; kind++) {
        const scene_object o = example(kind);
        for (int i = 0; i < 125; i += HOST_OR_BOARD(1, 31)) {
            const double x = i % 5 - 2.0, y = i / 5 % 5 - 2.0, z = i / 25 - 2.0;
            const vec3 offset = {(float)(x * (double)o.half_m.x), (float)(y * (double)o.half_m.y),
                                 (float)(z * (double)o.half_m.z)};
            const vec3 tiny = vec3_scale(random_vec3(&seed, 1.0), i & 1 ? 3e-7f : 0.0f);
            expect_gap(&o, vec3_add(vec3_add(o.place_m, offset), tiny));
        }
    }
}

/* From one point to the next the gap changes by no more than the way, and outside, the normal by no more than
 * the way over the distance from what is rounded. */
static void gaps_and_normals_have_no_jumps(void)
{
    for (int walk = 0; walk < HOST_OR_BOARD(400, 4); walk++) {
        enum { STEPS_N = 500 };
        const scene_object o = random_object(SCENE_SPHERE + walk % 3);
        const double size = length_double(o.half_m) + (double)o.radius_m;
        const vec3 step = vec3_scale(random_vec3(&seed, 1.0), (float)(size * 4.0 / STEPS_N));
        const vec3 middle = vec3_add(o.place_m, random_vec3(&seed, 0.5 * size));
        const double rounding_m = 1e-6 * size_of(&o);
        TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&s, 0, &o, NULL));
        scene_gap before = scene_gap_to(&s.body[0], vec3_add_scaled(middle, step, -0.5f * STEPS_N));
        for (int i = 1; i <= STEPS_N; i++) {
            const vec3 here = vec3_add_scaled(middle, step, (float)i - 0.5f * STEPS_N);
            const scene_gap now = scene_gap_to(&s.body[0], here);
            const double way_m = length_double(step) + 2.0 * rounding_m;
            const double round_m = (double)fminf(now.gap_m, before.gap_m) + (double)o.radius_m;
            TEST_ASSERT_TRUE(fabs((double)now.gap_m - (double)before.gap_m) <= way_m);
            if (round_m > 0.0) {
                const double turn = length_double(vec3_sub(now.normal, before.normal));
                TEST_ASSERT_TRUE(turn <= 1e-5 + way_m / round_m);
            }
            before = now;
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(gaps_are_those_of_the_second_way);
    RUN_TEST(gaps_are_right_on_every_seam);
    RUN_TEST(gaps_and_normals_have_no_jumps);
    return UNITY_END();
}
