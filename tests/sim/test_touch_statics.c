/* test_touch_statics.c - a rod at rest against something: how hard it presses, that what pushes it and how it is bent are
 * in balance, and what rod_contacts says. */
#include <stdio.h>

#include "beam_fixture.h"
#include "touch_energy.h"

void setUp(void) {}

void tearDown(void) {}

/* --- beam theory ---------------------------------------------------------------------------------------- */

/* How far under the horizon the rod points: the hand stays above the floor. */
static const double SLOPE_RAD = 0.1;

/* A uniform beam of 0.9 m, clamped, its tip pressed up by delta_m by a floor without friction: joint j bends by the
 * force times the level way from it to the tip. By going round until force and shape agree. */
static double chain_force(double delta_m)
{
    double alpha[ROD_MAX_LINKS] = {0.0}, level_m[ROD_MAX_LINKS];
    double force = 1e-3;
    const double target_m = rod_length_m() * sin(SLOPE_RAD) - delta_m;
    for (int round = 0; round < 500; round++) {
        double slope = SLOPE_RAD, tip_m = 0.0, down_m = 0.0;
        for (int i = 0; i < params.links_n; i++) {
            slope -= alpha[i];
            level_m[i] = tip_m;
            tip_m += (double)params.length_m[i] * cos(slope);
            down_m += (double)params.length_m[i] * sin(slope);
        }
        force *= 1.0 + 0.3 * (down_m - target_m) / delta_m;
        for (int i = 0; i < params.links_n; i++) {
            alpha[i] = force * (tip_m - level_m[i]) / (double)params.spring[i];
        }
    }
    return force;
}

static double floors_force(double delta_m, double speed_m_s)
{
    const vec3 along = {(float)cos(SLOPE_RAD), 0.0f, (float)-sin(SLOPE_RAD)};
    hold_rod(along);
    const vec3 tip_m = vec3_scale(along, (float)rod_length_m());
    put(0, thing(SCENE_PLANE, vec3_add_scaled(tip_m, UP, -2e-3f), UP, 0.0f));
    (void)move_hand((vec3){0.0f, 0.0f, (float)(-2e-3 - delta_m)}, speed_m_s, 3.0);
    vec3 force = {0.0f, 0.0f, 0.0f};
    const int ticks_n =
        ticks_in(0.2); /* one tick's force has the rounding of its places: 2 % of 0.06 N */
    for (int n = 0; n < ticks_n; n++) {
        tick();
        force = vec3_add_scaled(force, contact_force(), 1.0f / (float)ticks_n);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * (double)force.z, 0.0, (double)force.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * (double)force.z, 0.0, (double)force.y);
    return (double)force.z;
}

/* EI 7.5 N m^2: 3 EI delta / L^3 (1 - 1 / 2 N^2), and for 5 cm what the geometry adds, which the chain in double knows. */
static void tip_presses_a_floor_as_hard_as_beam_theory_says(void)
{
    static const int links_n[] = {5, 10, 20, 50};
    static const double delta_m[] = {2e-3, 9e-3, 50e-3}, rate_hz[] = {1000.0, 500.0, 100.0};
    double worst = 0.0;
    for (int i = 0; i < 12; i++) {
        const beam b = {links_n[i / 3], 0.9, 7.5, 0.2, 0.0, 0.3, rate_hz[i % 3]};
        params = beam_params(&b);
        const double delta = delta_m[(i + i / 3) % 3];
        const double force = floors_force(delta, 0.2), expected = chain_force(delta);
        const double aside =
            delta / (cos(SLOPE_RAD) * cos(SLOPE_RAD)); /* and the force as much aslant */
        const double theory = 3.0 * 7.5 * aside / (0.9 * 0.9 * 0.9);
        worst = worse(worst, fabs(force / expected - 1.0));
        if (delta < 5e-3) {
            TEST_ASSERT_DOUBLE_WITHIN(0.003, 1.0 / (1.0 + 0.5 / (params.links_n * params.links_n)),
                                      expected / theory);
        }
    }
    printf("forces at the tip are within %.1e of the chain's\n", worst);
    TEST_ASSERT_TRUE(worst < 0.01);
}

/* --- equilibrium ---------------------------------------------------------------------------------------- */

/* A rod as such, pressed 5 cm into a thing 70 % of the way along it, or with its tip aslant. */
static void press(int kind, double friction, bool tip_first)
{
    const vec3 along = tip_first ? (vec3){0.8f, 0.0f, -0.6f} : (vec3){0.98f, 0.0f, -0.2f};
    hold_rod(along);
    const double share = kind == SCENE_PLANE || tip_first ? 1.0 : 0.7;
    const vec3 place_m = vec3_scale(along, (float)(share * rod_length_m()));
    put(0, thing(kind, vec3_add_scaled(place_m, UP, -4e-3f), UP, (float)friction));
    (void)move_hand((vec3){0.0f, 0.0f, -0.054f}, 0.2, 4.0);
}

/* Along the way out, and within Coulomb's cone, to what the normal of round things turns in one correction. */
static void expect_good_contacts(double friction)
{
    int contacts_n;
    const touch_contact *contact = rod_contacts(&r, &contacts_n);
    TEST_ASSERT_TRUE(contacts_n > 0 && contacts_n <= params.links_n);
    (void)rod_nodes(&r, nodes_m);
    for (int i = 0; i < contacts_n; i++) {
        const touch_contact *c = &contact[i];
        TEST_ASSERT_TRUE(c->node >= 1 && c->node <= params.links_n);
        TEST_ASSERT_TRUE(i == 0 || c->node > contact[i - 1].node);
        TEST_ASSERT_EQUAL_INT(0, c->object);
        const scene_gap gap = scene_gap_to(&objects.body[0], nodes_m[c->node]);
        const double length_m = (double)params.length_m[c->node - 1];
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * length_m, (double)gap.gap_m, (double)c->gap_m);
        const double out = (double)vec3_dot(gap.normal, c->force_newton);
        const vec3 along = vec3_add_scaled(c->force_newton, gap.normal, (float)-out);
        TEST_ASSERT_TRUE(out > 0.0);
        TEST_ASSERT_TRUE(length_double(along) <= (friction + 1e-3) * out);
    }
}

/* contour puts its nodes out by links that give a little, of which nothing is kept, so its forces are too large:
 * two-sided, for 10 links and for 20. */
static void what_pushes_the_rod_is_what_bends_it(void)
{
    static const double friction[] = {0.0, 0.1, 0.8};
    double worst[ROD_MODEL_COUNT][2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int i = 0; i < 48; i++) {
        const int model = i & 1, kind = SCENE_PLANE + i / 2 % 4, many = i % 3 == 0 ? 1 : 0;
        take_rod("foil", model, many == 1 ? 20 : 10, 1000.0);
        params.gravity_m_s2 = i / 8 % 2 == 0 ? 0.0f : 9.81f;
        for (int k = 0; k < params.links_n && model == ROD_MODEL_ELASTIC; k++) {
            params.damper[k] *= 10.0f;
        }
        press(kind, friction[i / 8 % 3], i >= 24);
        expect_good_contacts(friction[i / 8 % 3]);
        worst[model][many] = worse(worst[model][many], out_of_balance());
    }
    printf("out of balance by at most %.1e, %.1e (contour, of 10 and 20 links), %.1e, %.1e "
           "(elastic)\n",
           worst[0][0], worst[0][1], worst[1][0], worst[1][1]);
    TEST_ASSERT_TRUE(worst[ROD_MODEL_ELASTIC][0] < 0.01 && worst[ROD_MODEL_ELASTIC][1] < 0.01);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.03, worst[ROD_MODEL_CONTOUR][0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 0.16, worst[ROD_MODEL_CONTOUR][1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(tip_presses_a_floor_as_hard_as_beam_theory_says);
    RUN_TEST(what_pushes_the_rod_is_what_bends_it);
    return UNITY_END();
}
