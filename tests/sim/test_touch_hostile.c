/* test_touch_hostile.c - any rod, any objects, and a hand that jumps, flips and dashes through all of it, while objects
 * come, move and go. The rod stays finite and whole; and when the hand rests in the open it is free again.
 *
 *     test_touch_hostile [SETS]     of rod, scene and motion, 300 by default
 */
#include <stdio.h>
#include <stdlib.h>

#include "touch_fixture.h"

static long sets_n = 300;
static uint32_t seed;

void setUp(void)
{
    seed = 2463534242u;
}

void tearDown(void) {}

static bool one_in(int n)
{
    return random_below(&seed, n) == 0;
}

/* --- any rod ----------------------------------------------------------------------------------------- */

/* Of 5 cm to 2 m, 2 to 20 Hz, well damped, so that it is at rest again before long; with masses and stiffnesses up to
 * three times more or less from joint to joint. No gravity: it comes to rest straight. */
static void draw_rod(void)
{
    rod_params_defaults(&params);
    params.model = one_in(2) ? ROD_MODEL_CONTOUR : ROD_MODEL_ELASTIC;
    params.links_n = (int)random_magnitude(&seed, 2.0, 50.0);
    params.tick_s = (float)random_magnitude(&seed, 1e-3, 5e-3);
    params.gravity_m_s2 = 0.0f;
    const bool even = one_in(2);
    const double length_m = random_magnitude(&seed, 0.05, 2.0), link_m = length_m / params.links_n;
    const double omega = 2.0 * PI * random_magnitude(&seed, 2.0, 20.0);
    const double zeta = random_between(&seed, 0.4, 0.8);
    const double mass_kg = random_magnitude(&seed, 1e-2, 1.0) / params.links_n;
    const double inertia = random_magnitude(&seed, 1e-2, 1.0);
    /* of a cantilever: omega L^2 / 3.516 = sqrt(E I / mass per length) */
    const double root = omega * length_m * length_m / 3.516;
    const double bending = root * root * mass_kg / link_m;
    const double coupling = random_magnitude(&seed, 1e-2, 10.0);
    for (int i = 0; i < params.links_n; i++) {
        const double uneven = even ? 1.0 : random_magnitude(&seed, 0.58, 1.73);
        params.length_m[i] = (float)link_m;
        params.mass_kg[i] = (float)(mass_kg * uneven);
        params.drag[i] = 0.0f;
        params.inertia[i] = (float)inertia;
        if (params.model == ROD_MODEL_ELASTIC) {
            const double spring = (i == 0 ? 2.0 : 1.0) * bending / link_m * uneven;
            params.spring[i] = (float)spring;
            params.damper[i] = (float)(2.0 * zeta / omega * spring);
        } else {
            params.spring[i] = (float)(inertia * omega * omega * uneven);
            params.damper[i] = (float)(2.0 * zeta * inertia * omega);
            params.coupling[i] = i > 0 ? (float)(coupling * inertia * omega * omega) : 0.0f;
        }
    }
}

/* --- any objects ------------------------------------------------------------------------------------- */

static scene_object any_object(double size_m)
{
    scene_object o = {.kind = SCENE_PLANE + random_below(&seed, SCENE_KINDS_N - 1),
                      .place_m = random_vec3(&seed, 1.5 * size_m),
                      .orientation = random_quat(&seed),
                      .friction = one_in(3) ? 0.0f : (float)random_magnitude(&seed, 0.05, 10.0)};
    if (o.kind != SCENE_PLANE) {
        o.radius_m = (float)fmax(1e-3, size_m * random_magnitude(&seed, 0.005, 0.5));
    }
    if (o.kind == SCENE_CAPSULE || o.kind == SCENE_BOX) {
        o.half_m.z = (float)(size_m * random_between(&seed, 0.0, 1.0));
    }
    if (o.kind == SCENE_BOX) {
        o.half_m.x = (float)(size_m * random_between(&seed, 0.0, 1.0));
        o.half_m.y = (float)(size_m * random_between(&seed, 0.0, 1.0));
    }
    return o;
}

static void change_scene(double size_m)
{
    const int index = random_below(&seed, SCENE_OBJECTS_MAX);
    scene_object o = objects.body[index].object;
    switch (random_below(&seed, 3)) {
    case 0:
        put(index, any_object(size_m));
        break;
    case 1: /* moves by anything from a hair to itself */
        o.place_m =
            vec3_add(o.place_m, random_vec3(&seed, size_m * random_magnitude(&seed, 1e-4, 1.0)));
        put(index, o);
        break;
    default:
        take_away(index);
    }
}

/* --- any hand ---------------------------------------------------------------------------------------- */

typedef enum { TELEPORTS, FLIPS, JUMPS, TUMBLES, DASHES, SWAYS, TURNS, STILL, MOTIONS_N } motion;

static void move(motion m, int n, double size_m, vec3 speed_m_s)
{
    static const vec3 axis = {1.0f, 0.3f, 0.0f};
    switch (m) {
    case TELEPORTS:
        hand = random_pose(&seed, size_m);
        break;
    case FLIPS:
        hand.orientation = quat_about(axis, (n & 1) * PI);
        break;
    case JUMPS:
        hand.position_m = random_vec3(&seed, size_m);
        break;
    case TUMBLES:
        hand.orientation = random_quat(&seed);
        break;
    case DASHES: /* through whatever there is */
        hand.position_m = vec3_add_scaled(hand.position_m, speed_m_s, params.tick_s);
        break;
    case SWAYS:
        hand.position_m =
            vec3_add_scaled(hand.position_m, speed_m_s, (float)cos(0.2 * n) * params.tick_s);
        break;
    case TURNS:
        hand.orientation = quat_about(axis, 0.05 * n);
        break;
    default:
        break;
    }
}

/* --- what must hold ------------------------------------------------------------------------------------ */

static void expect_whole_and_finite(double *worst_error)
{
    for (int i = 0; i < 2 * params.links_n; i++) { /* NaN fails */
        TEST_ASSERT_TRUE(fabsf(rod_angles(&r)[i / 2][i % 2]) <= 3.1416f);
    }
    *worst_error = worse(*worst_error, worst_length_error());
    TEST_ASSERT_TRUE(*worst_error <= 1e-5);
    TEST_ASSERT_TRUE(isfinite(length_double(contact_force())));
}

static int touches_n(void)
{
    int contacts_n;
    (void)rod_contacts(&r, &contacts_n);
    return contacts_n;
}

static double bent_rad(void)
{
    double most = 0.0;
    for (int i = 0; i < 2 * params.links_n; i++) {
        most = worse(most, fabs((double)rod_angles(&r)[i / 2][i % 2]));
    }
    return most;
}

static double nearest_m(vec3 place_m)
{
    double nearest = HUGE_VAL;
    for (int k = 0; k < SCENE_OBJECTS_MAX; k++) {
        if (objects.body[k].object.kind != SCENE_NONE) {
            nearest = fmin(nearest, (double)scene_gap_to(&objects.body[k], place_m).gap_m);
        }
    }
    return nearest;
}

/* Is a straight rod, held like that, clear of everything by some of its length? */
static bool is_clear(rod_pose pose, double length_m)
{
    const vec3 along = quat_rotate(pose.orientation, (vec3){0.0f, 0.0f, 1.0f});
    bool clear = true;
    for (int i = 0; clear && i <= params.links_n; i++) {
        const float from_hand_m = (float)(length_m * i / params.links_n);
        clear = nearest_m(vec3_add_scaled(pose.position_m, along, from_hand_m)) > 0.05 * length_m;
    }
    return clear;
}

/* A pose where it is, or where nothing is within reach. */
static bool find_open(double length_m, bool out_of_reach, rod_pose *pose)
{
    for (int i = 0; i < 200; i++) {
        *pose = random_pose(&seed, (out_of_reach ? 6.0 : 3.0) * length_m);
        if (out_of_reach ? nearest_m(pose->position_m) > 1.02 * length_m
                         : is_clear(*pose, length_m)) {
            return true;
        }
    }
    return false;
}

/* At once, or straight there within half a second and so pulling the rod out of what it is caught in. */
static void go_to(rod_pose pose)
{
    const rod_pose from = hand;
    const double cosine =
        (double)(from.orientation.x * pose.orientation.x + from.orientation.y * pose.orientation.y +
                 from.orientation.z * pose.orientation.z + from.orientation.w * pose.orientation.w);
    const double sign = cosine < 0.0 ? -1.0 : 1.0, angle = acos(fmin(1.0, fabs(cosine)));
    const int ticks_n = one_in(2) || angle < 1e-3 ? 1 : ticks_in(0.5);
    for (int n = 1; n <= ticks_n; n++) {
        const double share = (double)n / ticks_n;
        const double a = n == ticks_n ? 0.0 : sin((1.0 - share) * angle) / sin(angle);
        const double b = n == ticks_n ? sign : sign * sin(share * angle) / sin(angle);
        const quat p = from.orientation, q = pose.orientation;
        hand.orientation = (quat){
            (float)(a * (double)p.x + b * (double)q.x), (float)(a * (double)p.y + b * (double)q.y),
            (float)(a * (double)p.z + b * (double)q.z), (float)(a * (double)p.w + b * (double)q.w)};
        hand.position_m = vec3_add_scaled(from.position_m,
                                          vec3_sub(pose.position_m, from.position_m), (float)share);
        tick();
    }
}

/* Straight again within 5 s? */
static bool comes_free(double *worst_error)
{
    for (int n = 0; n < ticks_in(5.0); n++) {
        tick();
        if (n % 16 == 0) {
            expect_whole_and_finite(worst_error);
            if (bent_rad() < 0.02) {
                return true;
            }
        }
    }
    return false;
}

typedef struct {
    long touching_n, ticks_n;
    long clear_n, leaning_n; /* rests in the open, and how often something still bent the rod */
    long away_n, trapped_n;  /* the same out of reach of everything */
    double length_error;
} outcome;

static void go_wild(outcome *o, double length_m)
{
    const motion kind = (motion)random_below(&seed, MOTIONS_N);
    const vec3 speed_m_s = random_vec3(&seed, random_magnitude(&seed, 0.1, 15.0));
    for (int i = random_below(&seed, SCENE_OBJECTS_MAX); i >= 0; i--) {
        put(i, any_object(length_m));
    }
    for (int n = 0; n < 64; n++) {
        if (one_in(8)) {
            change_scene(length_m);
        }
        move(kind, n, length_m, speed_m_s);
        tick();
        expect_whole_and_finite(&o->length_error);
        o->touching_n += touches_n() > 0 ? 1 : 0;
        o->ticks_n++;
    }
}

/* Where a straight rod would touch nothing it may still lean on something, held by friction or on its other side; but
 * not for good: out of reach it is always free. */
static void any_rod_gets_through_anything(void)
{
    outcome o = {0};
    for (long set = 0; set < sets_n; set++) {
        draw_rod();
        hold_rod(random_vec3(&seed, 1.0));
        const double length_m = rod_length_m();
        rod_pose pose;
        go_wild(&o, length_m);
        if (find_open(length_m, false, &pose)) {
            go_to(pose);
            o.clear_n++;
            o.leaning_n += comes_free(&o.length_error) ? 0 : 1;
        }
        if (find_open(length_m, true, &pose)) {
            go_to(pose);
            o.away_n++;
            o.trapped_n += comes_free(&o.length_error) ? 0 : 1;
        }
    }
    printf("%ld sets; touching in %ld of %ld ticks; lengths within %.1e; %ld of %ld lean on "
           "something, %ld of %ld "
           "are trapped\n",
           sets_n, o.touching_n, o.ticks_n, o.length_error, o.leaning_n, o.clear_n, o.trapped_n,
           o.away_n);
    TEST_ASSERT_TRUE(15 * o.touching_n > o.ticks_n); /* hostile it was */
    TEST_ASSERT_TRUE(10 * o.clear_n > 9 * sets_n && 10 * o.away_n > 7 * sets_n);
    TEST_ASSERT_TRUE(100 * o.leaning_n <= o.clear_n);
    TEST_ASSERT_EQUAL_INT(0, o.trapped_n);
}

int main(int argc, char **argv)
{
    if (argc > 1) {
        sets_n = atol(argv[1]);
    }
    UNITY_BEGIN();
    RUN_TEST(any_rod_gets_through_anything);
    return UNITY_END();
}
