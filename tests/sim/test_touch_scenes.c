/* test_touch_scenes.c - more than one thing at a time, and things and hands that run through each other: corners, beds of
 * balls, one thing in another, blows at 5 and 15 m/s. */
#include <stdio.h>

#include "touch_fixture.h"

void setUp(void) {}

void tearDown(void) {}

static const vec3 LEVEL = {1.0f, 0.0f, 0.0f}, ASLANT = {0.8f, 0.0f, -0.6f};

/* With dampers that soon bring it to rest. */
static void take_foil(int model, int links_n)
{
    take_rod("foil", model, links_n, 1000.0);
    params.gravity_m_s2 = 0.0f;
    for (int i = 0; i < params.links_n && model == ROD_MODEL_ELASTIC; i++) {
        params.damper[i] *= 10.0f;
    }
}

/* --- several at a time --------------------------------------------------------------------------------- */

static void expect_still_and_outside(const sight *seen)
{
    double jitter = jitter_rad(0.5);
    for (int i = 0; i < 16 && jitter > 1e-4; i++) {
        jitter = jitter_rad(0.5);
    }
    TEST_ASSERT_TRUE(seen->deepest_links < 0.01);
    TEST_ASSERT_TRUE(seen->length_error <= 1e-5);
    TEST_ASSERT_TRUE(jitter < 1e-4);
}

/* In the open: straight again in 10 s, and whole all the while. */
static void expect_free(const sight *seen)
{
    double bent = HUGE_VAL;
    TEST_ASSERT_TRUE(seen->length_error <= 1e-5);
    for (int n = ticks_in(10.0); n > 0 && bent > 5e-3; n--) {
        tick();
        bent = 0.0;
        for (int i = 0; i < 2 * params.links_n; i++) {
            bent = worse(bent, fabs((double)rod_angles(&r)[i / 2][i % 2]));
        }
    }
    TEST_ASSERT_TRUE(bent <= 5e-3);
}

/* How many contacts an object has. */
static int touching_n(int object)
{
    int contacts_n, n = 0;
    const touch_contact *contact = rod_contacts(&r, &contacts_n);
    for (int i = 0; i < contacts_n; i++) {
        n += contact[i].object == object ? 1 : 0;
    }
    return n;
}

/* A floor, and a wall with its free side towards `out`, each 2 mm from the tip; the hand goes so far. */
static sight press_into_corner(vec3 along, vec3 out, vec3 way_m, float friction)
{
    hold_rod(along);
    const vec3 tip_m = vec3_scale(along, (float)rod_length_m());
    put(0, thing(SCENE_PLANE, vec3_add_scaled(tip_m, UP, -2e-3f), UP, friction));
    put(5, thing(SCENE_PLANE, vec3_add_scaled(tip_m, out, -2e-3f), out, friction));
    return move_hand(way_m, 0.1, 2.0);
}

/* Sideways into the groove between floor and wall, along which the rod lies. */
static void rods_lie_in_corners(void)
{
    static const vec3 aside = {0.0f, 1.0f, 0.0f};
    for (int i = 0; i < 8; i++) {
        take_foil(i & 1, i & 2 ? 20 : 10);
        const sight seen = press_into_corner((vec3){0.97f, -0.14f, -0.2f}, aside,
                                             (vec3){0.0f, -0.03f, -0.03f}, i & 4 ? 0.3f : 0.0f);
        expect_still_and_outside(&seen);
        TEST_ASSERT_TRUE(touching_n(0) > 0 && touching_n(5) > 0);
        TEST_ASSERT_TRUE(contact_force().y > 0.0f && contact_force().z > 0.0f);
    }
}

/* End-on into the corner, harder than the rod can bear without buckling, while both hold its tip: a known limit. The tip
 * goes in by up to a tenth of a link and the elastic rod trembles; out of it, it is free as ever. */
static void rods_wedged_end_on_in_a_corner_come_free(void)
{
    double deepest[2] = {0.0, 0.0};
    for (int i = 0; i < 8; i++) {
        take_foil(i & 1, i & 2 ? 20 : 10);
        const sight seen = press_into_corner(ASLANT, (vec3){-1.0f, 0.0f, 0.0f},
                                             (vec3){0.02f, 0.0f, -0.02f}, i & 4 ? 0.3f : 0.0f);
        deepest[i & 1] = worse(deepest[i & 1], seen.deepest_links);
        const sight back = move_hand((vec3){-0.05f, 0.0f, 0.05f}, 0.1, 0.0);
        expect_free(&back);
    }
    printf("wedged: contour %.3f, elastic %.3f of a link deep\n", deepest[0], deepest[1]);
    TEST_ASSERT_TRUE(deepest[ROD_MODEL_CONTOUR] < 0.1 && deepest[ROD_MODEL_ELASTIC] < 0.06);
}

/* Seven balls of 10 cm side by side under the rod, and a floor below: all eight places. */
static void rods_lie_on_beds_of_balls(void)
{
    for (int i = 0; i < 4; i++) {
        take_foil(i & 1, 20);
        hold_rod(LEVEL);
        for (int k = 0; k < 7; k++) {
            const vec3 place_m = {0.3f + 0.11f * (float)k, 0.0f, -2e-3f - 0.01f * (float)(k % 2)};
            put(k, thing(SCENE_SPHERE, place_m, UP, i & 2 ? 0.3f : 0.0f));
        }
        put(7, thing(SCENE_PLANE, (vec3){0.0f, 0.0f, -0.3f}, UP, 0.3f));
        const sight seen = move_hand(vec3_scale(DOWN, 0.05f), 0.2, 2.0);
        expect_still_and_outside(&seen);
        TEST_ASSERT_TRUE(contact_force().z > 0.0f);
    }
}

/* A ball in a box is not felt. */
static void of_things_in_each_other_the_outer_counts(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        rod_joint alone[ROD_MAX_LINKS];
        for (int nested = 0; nested < 2; nested++) {
            take_foil(model, 20);
            hold_rod(LEVEL);
            const vec3 place_m = {0.7f * (float)rod_length_m(), 0.0f, -2e-3f};
            put(0, thing(SCENE_BOX, place_m, UP, 0.3f));
            if (nested == 1) {
                scene_object ball = objects.body[0].object;
                ball.kind = SCENE_SPHERE;
                ball.half_m = (vec3){0.0f, 0.0f, 0.0f};
                ball.radius_m = 0.03f;
                put(1, ball);
            }
            const sight seen = move_hand(vec3_scale(DOWN, 0.05f), 0.2, 2.0);
            expect_still_and_outside(&seen);
            if (nested == 0) {
                memcpy(alone, rod_angles(&r), sizeof alone);
            }
        }
        for (int i = 0; i < 2 * params.links_n; i++) {
            TEST_ASSERT_FLOAT_WITHIN(2e-4f, alone[i / 2][i % 2], rod_angles(&r)[i / 2][i % 2]);
        }
    }
}

/* --- blows --------------------------------------------------------------------------------------------- */

/* The rod, or the hand itself, is driven 1.2 m through the thing and out of it. */
static void nothing_holds_a_rod_that_is_driven_through_it(void)
{
    for (int i = 0; i < 32; i++) {
        take_foil(i & 1, i % 3 == 0 ? 20 : 10);
        hold_rod(LEVEL);
        const double speed_m_s = i & 2 ? 15.0 : 5.0;
        const vec3 place_m = {i & 4 ? 0.0f : 0.7f * (float)rod_length_m(), 0.01f, -0.3f};
        scene_object o = thing(SCENE_PLANE + i / 8, place_m, UP, 0.5f);
        if (o.kind == SCENE_PLANE) { /* there is no other side: a wide board */
            o = thing(SCENE_BOX, place_m, UP, 0.5f);
            o.half_m = (vec3){2.0f, 2.0f, 0.02f};
        }
        put(0, o);
        const sight seen = move_hand(vec3_scale(DOWN, 1.6f), speed_m_s, 0.0);
        expect_free(&seen);
    }
}

/* A thing runs against the rod at 1 or 5 m/s and through it, and stays there, or vanishes on the way. */
static void nothing_holds_a_rod_that_a_thing_runs_through(void)
{
    for (int i = 0; i < 32; i++) {
        take_foil(i & 1, i % 3 == 0 ? 20 : 10);
        hold_rod(LEVEL);
        const double speed_m_s = i & 2 ? 5.0 : 1.0;
        scene_object o =
            thing(SCENE_SPHERE + i / 8 % 3, (vec3){0.5f, 0.01f, -0.05f}, UP, i & 4 ? 0.0f : 0.5f);
        for (int n = ticks_in(1.0 / speed_m_s); n > 0; n--) {
            put(0, o);
            tick();
            o.place_m.z += (float)speed_m_s * params.tick_s;
        }
        if (i >= 24) {
            take_away(0);
        }
        const sight seen = move_hand((vec3){0.0f, 0.0f, 0.0f}, 1.0, 0.5);
        expect_free(&seen);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(rods_lie_in_corners);
    RUN_TEST(rods_wedged_end_on_in_a_corner_come_free);
    RUN_TEST(rods_lie_on_beds_of_balls);
    RUN_TEST(of_things_in_each_other_the_outer_counts);
    RUN_TEST(nothing_holds_a_rod_that_is_driven_through_it);
    RUN_TEST(nothing_holds_a_rod_that_a_thing_runs_through);
    return UNITY_END();
}
