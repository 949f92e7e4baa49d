/* test_touch_friction.c - a rod's tip on a floor: within Coulomb's cone it stays where it is, beyond it slides and is rubbed
 * with mu times what presses, against its way, and without friction nothing holds it. */
#include <stdio.h>

#include "touch_fixture.h"

void setUp(void) {}

void tearDown(void) {}

typedef struct {
    double press, rub; /* N: up, and along the floor */
    vec3 tip_m;
} grip;

static grip grip_now(void)
{
    const vec3 f = contact_force();
    (void)rod_nodes(&r, nodes_m);
    return (grip){(double)f.z, hypot((double)f.x, (double)f.y), nodes_m[params.links_n]};
}

/* The rod points down aslant, its tip pressed 3 cm into a floor; dampers that let it settle. */
static void press_tip(int model, int links_n, double rate_hz, double friction)
{
    const vec3 along = {0.8f, 0.0f, -0.6f};
    take_rod("foil", model, links_n, rate_hz);
    for (int i = 0; i < params.links_n && model == ROD_MODEL_ELASTIC; i++) {
        params.damper[i] *= 10.0f;
    }
    hold_rod(along);
    const vec3 tip_m = vec3_scale(along, (float)rod_length_m());
    put(0, thing(SCENE_PLANE, vec3_add_scaled(tip_m, UP, -4e-3f), UP, (float)friction));
    (void)move_hand(vec3_scale(DOWN, 0.034f), 0.1, 2.0);
}

/* The hand goes aside at 2 cm/s until the floor holds the tip back with four fifths of what it can. */
static void drag_aside(double friction)
{
    double gone_m = 0.0;
    for (grip g = grip_now(); g.rub < 0.8 * friction * g.press; g = grip_now()) {
        gone_m += 0.02 * (double)params.tick_s;
        hand.position_m.y = (float)gone_m;
        tick();
        TEST_ASSERT_TRUE(gone_m < 0.2);
    }
}

/* More than half the cone is in use: no node creeps by 10 um in a second. elastic only: contour remembers no force and creeps
 * (contour.h), by a twentieth a second of what it is held aside. */
static void elastic_sticks_within_the_cone(void)
{
    double worst_m = 0.0;
    for (int i = 0; i < 8; i++) {
        const double friction = i & 1 ? 4.0 : 3.0;
        press_tip(ROD_MODEL_ELASTIC, i & 2 ? 20 : 10, i & 4 ? 500.0 : 1000.0, friction);
        drag_aside(friction);
        wait_s(0.5);
        const grip before = grip_now();
        wait_s(1.0);
        const grip after = grip_now();
        TEST_ASSERT_TRUE(after.rub > 0.5 * friction * after.press);
        TEST_ASSERT_TRUE(after.rub < 0.9 * friction * after.press);
        worst_m = worse(worst_m, length_double(vec3_sub(after.tip_m, before.tip_m)));
    }
    printf("elastic: creep of at most %.1e m a second\n", worst_m);
    TEST_ASSERT_TRUE(worst_m < 1e-5);
}

static void contour_creeps_slowly_within_the_cone(void)
{
    double worst = 0.0;
    for (int i = 0; i < 2; i++) {
        press_tip(ROD_MODEL_CONTOUR, 10, i == 0 ? 500.0 : 1000.0, 1.5);
        (void)move_hand((vec3){0.0f, 2e-3f, 0.0f}, 0.02, 0.5);
        const double before_m = 2e-3 - (double)grip_now().tip_m.y;
        wait_s(1.0);
        const double after_m = 2e-3 - (double)grip_now().tip_m.y;
        TEST_ASSERT_TRUE(before_m > 1e-3);
        worst = worse(worst, fabs(1.0 - after_m / before_m));
    }
    printf("contour: creep of at most %.3f a second of what it is held aside\n", worst);
    TEST_ASSERT_TRUE(worst < 0.1);
}

/* Dragged 40 cm aside at 0.1 m/s, the last 5 cm looked at: no tick beyond the cone, all but a few on it, and the tip goes
 * where the hand does. */
static void it_slides_beyond_the_cone_and_is_rubbed_back(void)
{
    double least_mean = 1.0, most = 0.0;
    for (int i = 0; i < 8; i++) {
        const double friction = 0.1 + 0.1 * (i / 2);
        press_tip(i & 1, i % 3 == 0 ? 20 : 10, 1000.0, friction);
        (void)move_hand((vec3){0.0f, 0.3f, 0.0f}, 0.1, 0.0);
        grip start = grip_now();
        double sum = 0.0;
        const int ticks_n = ticks_in(0.5);
        for (int n = -ticks_n; n < ticks_n; n++) {
            hand.position_m.y += 0.1f * params.tick_s;
            tick();
            const grip g = grip_now();
            if (n < 0) {
                start = g;
                continue;
            }
            const double share = g.rub / (friction * g.press);
            TEST_ASSERT_TRUE(contact_force().y <= 0.0f);
            sum += share / ticks_n;
            most = worse(most, share);
        }
        least_mean = fmin(least_mean, sum);
        TEST_ASSERT_DOUBLE_WITHIN(0.005, 0.05, (double)(grip_now().tip_m.y - start.tip_m.y));
    }
    printf("sliding: %.4f of mu times what presses in the mean, %.6f at most\n", least_mean, most);
    TEST_ASSERT_TRUE(least_mean > 0.97 && most < 1.0 + 1e-4);
}

static void without_friction_nothing_holds_it(void)
{
    double worst = 0.0;
    for (int i = 0; i < 4; i++) {
        press_tip(i & 1, i < 2 ? 10 : 20, 1000.0, 0.0);
        for (int n = ticks_in(0.5); n > 0; n--) {
            hand.position_m.y += 0.2f * params.tick_s;
            tick();
            const grip g = grip_now();
            TEST_ASSERT_TRUE(g.press > 0.0);
            worst = worse(worst, g.rub / g.press);
        }
    }
    TEST_ASSERT_TRUE(worst < 1e-4);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(elastic_sticks_within_the_cone);
    RUN_TEST(contour_creeps_slowly_within_the_cone);
    RUN_TEST(it_slides_beyond_the_cone_and_is_rubbed_back);
    RUN_TEST(without_friction_nothing_holds_it);
    return UNITY_END();
}
