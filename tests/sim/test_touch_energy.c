/* test_touch_energy.c - touching never adds energy, nor takes what it should not: a rod that swings into something while
 * the hand is still. Kinetic energy, that of the bend and that of the weight, in double from the rod's state.
 *
 *     test_touch_energy [all]     every rod, thing, number of links and rate instead of some
 */
#include <stdio.h>

#include "touch_energy.h"

static bool all;

void setUp(void) {}

void tearDown(void) {}

static float each_newton;

static void push_down(const vec3 *places_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)places_m;
    (void)context;
    for (int i = 1; i < nodes_n; i++) {
        forces_newton[i].z = -each_newton;
    }
}

/* Bends the level rod down by about a third of its length for 0.3 s and lets it go; what BDF2 remembers of the push is
 * gone ten ticks later. */
static void let_swing(void)
{
    double softness = 0.0, arm_m = 0.0;
    for (int i = params.links_n - 1; i >= 0; i--) {
        arm_m += (double)params.length_m[i];
        softness += arm_m * arm_m / (double)params.spring[i];
    }
    each_newton = (float)(0.75 * arm_m / softness / (params.links_n + 1));
    hold_rod((vec3){1.0f, 0.0f, 0.0f});
    rod_set_force(&r, push_down, NULL);
    wait_s(0.3);
    rod_set_force(&r, NULL, NULL);
    for (int n = 0; n < 10; n++) {
        tick();
    }
}

typedef struct {
    double rise, over; /* the most in one tick, and above the start; of the energy at the start */
    int touching_n;
} account;

static account keep_account(double seconds)
{
    account a = {0.0, 0.0, 0};
    const double start = energy();
    double last = start;
    for (int n = ticks_in(seconds); n > 0; n--) {
        int contacts_n;
        tick();
        const double now = energy();
        a.rise = worse(a.rise, (now - last) / start);
        a.over = worse(a.over, now / start - 1.0);
        (void)rod_contacts(&r, &contacts_n);
        a.touching_n += contacts_n > 0 ? 1 : 0;
        last = now;
    }
    return a;
}

static const char *const RODS[] = {"foil", "whip", "ribbon", "fishing-rod"};

/* The n-th of all combinations. Weight only where the rod stands it: its energy is then counted from below. */
static int take_case(int n)
{
    static const int links_n[] = {0, 10, 20, 50};
    const int model = n % 2, kind = SCENE_PLANE + n / 2 % 4, rod_n = n / 16 % 4;
    take_rod(RODS[rod_n], model, links_n[n / 64 % 4], n / 256 % 2 == 0 ? 1000.0 : 500.0);
    params.gravity_m_s2 = rod_n % 3 == 0 && n / 512 % 2 == 1 ? 9.81f : 0.0f;
    let_swing();
    const float length_m = (float)rod_length_m();
    const vec3 above = {kind == SCENE_PLANE ? 0.0f : 0.7f * length_m, 0.0f, 0.02f * length_m};
    put(0, thing(kind, above, DOWN, n / 8 % 2 == 0 ? 0.0f : 0.5f));
    return model;
}

/* Nodes touch, links do not: a capsule of 10 cm may come between two nodes that are further apart. */
static bool is_sensible(void)
{
    return objects.body[0].object.kind == SCENE_PLANE || params.length_m[0] < 0.1f;
}

/* Never above the start. From tick to tick nothing rises by more than 1e-7 without objects. A hard blow lasts a few ticks,
 * and of what its first ones take some comes back in the last: less than a thousandth, but with 50 links, whose
 * fast modes no tick resolves, a tenth in elastic and a fifth in contour. */
static void touching_never_adds_energy(void)
{
    double rise[2][2] = {{0.0, 0.0}, {0.0, 0.0}}, over = 0.0; /* [model][more than 20 links] */
    int touching_n = 0;
    for (int n = 0; n < 1024; n += all ? 1 : 11) {
        const int model = take_case(n), many = params.links_n > 20 ? 1 : 0;
        if (is_sensible()) {
            const account a = keep_account(1.0);
            touching_n += a.touching_n;
            over = worse(over, a.over);
            rise[model][many] = worse(rise[model][many], a.rise);
        }
    }
    printf(
        "touching in %d ticks; rises of at most %.1e (contour; %.1e of 50 links), %.1e (elastic; "
        "%.1e), %.1e above the start\n",
        touching_n, rise[0][0], rise[0][1], rise[1][0], rise[1][1], over);
    TEST_ASSERT_TRUE(touching_n > 1000);
    TEST_ASSERT_TRUE(over < 1e-6);
    TEST_ASSERT_TRUE(rise[ROD_MODEL_CONTOUR][0] < 1e-3 && rise[ROD_MODEL_CONTOUR][1] < 0.3);
    TEST_ASSERT_TRUE(rise[ROD_MODEL_ELASTIC][0] < 1e-3 && rise[ROD_MODEL_ELASTIC][1] < 0.1);
}

static void flick_tip(const vec3 *places_m, int nodes_n, vec3 *forces_newton, void *context)
{
    (void)places_m;
    (void)context;
    forces_newton[nodes_n - 1].y = 0.05f;
}

/* How far the tip goes to and fro aside within 0.2 s, m. */
static double swing_m(void)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int n = ticks_in(0.2); n > 0; n--) {
        tick();
        (void)rod_nodes(&r, nodes_m);
        least = fmin(least, (double)nodes_m[params.links_n].y);
        most = fmax(most, (double)nodes_m[params.links_n].y);
    }
    return most - least;
}

/* A rod without dampers, held down on a box that it sticks to: beyond it the rod swings on as if nothing touched. */
static void what_does_not_touch_swings_on(void)
{
    take_rod("foil", ROD_MODEL_ELASTIC, 20, 1000.0);
    params.gravity_m_s2 = 0.0f;
    hold_rod((vec3){1.0f, 0.0f, 0.0f});
    put(0, thing(SCENE_BOX, (vec3){0.4f * (float)rod_length_m(), 0.0f, -2e-3f}, UP, 3.0f));
    (void)move_hand(vec3_scale(DOWN, 0.03f), 0.1, 4.0);
    for (int i = 0; i < params.links_n; i++) {
        params.damper[i] = params.drag[i] = 0.0f;
    }
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&r, &params, NULL));
    rod_set_force(&r, flick_tip, NULL);
    wait_s(0.02);
    rod_set_force(&r, NULL, NULL);
    const double first_m = swing_m();
    wait_s(1.0);
    const double share = swing_m() / first_m;
    printf("of a swing beyond a contact %.3f is left after a second\n", share);
    TEST_ASSERT_TRUE(length_double(contact_force()) > 0.0);
    TEST_ASSERT_TRUE(share > 0.95 && share < 1.01);
}

int main(int argc, char **argv)
{
    all = argc > 1 && strcmp(argv[1], "all") == 0;
    UNITY_BEGIN();
    RUN_TEST(touching_never_adds_energy);
    RUN_TEST(what_does_not_touch_swings_on);
    return UNITY_END();
}
