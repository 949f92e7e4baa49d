/* test_touch_press.c - a rod pressed into things, held there, withdrawn, run through them, and caught in corners: it stays
 * outside, lies still, and is let go without a kick.
 *
 *     test_touch_press [all]     every rod, thing, number of links and rate instead of some
 */
#include <stdio.h>

#include "touch_energy.h"

static bool all;

void setUp(void) {}

void tearDown(void) {}

/* --- pressed ------------------------------------------------------------------------------------------ */

typedef struct {
    const char *rod;
    int model, links_n, kind;
    double rate_hz, friction, speed_m_s; /* of the hand, in the mean */
    bool tip_first, weighs;
} press_case;

static const char *const RODS[] = {"foil", "whip", "ribbon", "fishing-rod", "stiff-bar", "default"};

/* The n-th of all combinations, or false beyond the last. */
static bool take_case(int n, press_case *c)
{
    static const int links_n[] = {0, 10, 20, 50}; /* 0: what suits the rod */
    static const double rate_hz[] = {1000.0, 500.0, 100.0}, friction[] = {0.0, 0.5};
    c->model = n % 2;
    c->kind = SCENE_PLANE + n / 2 % 4;
    c->tip_first = n / 8 % 2 == 1;
    c->friction = friction[n / 16 % 2];
    c->rod = RODS[n / 32 % 6];
    c->links_n = links_n[n / 192 % 4];
    c->rate_hz = rate_hz[n / 768 % 3];
    c->speed_m_s = 0.1 + 0.2 * (n % 3);
    c->weighs = n % 5 < 2;
    return n < 2304;
}

/* Nodes touch, links do not: where a link is longer than a thing is thick, the thing may pass between two nodes. The
 * stiff bar is 12 cm long and suits four links. */
static bool is_sensible(const press_case *c)
{
    const double thick_m = c->kind == SCENE_SPHERE ? 0.1 : c->kind == SCENE_CAPSULE ? 0.05 : 1.0;
    return (double)params.length_m[0] <= thick_m &&
           (rod_length_m() > 0.3 || (c->links_n == 0 && c->kind == SCENE_PLANE));
}

/* Holds the rod level, or so much down that the hand stays above a floor; what it is to press is 2 mm under it, at 70 % of
 * its length or, if that is to come first, at its tip. */
static void set_up(const press_case *c)
{
    const double length_m = rod_length_m();
    const double down_rad = c->tip_first             ? 0.25 * PI
                            : c->kind == SCENE_PLANE ? asin(fmin(0.9, 0.07 / length_m))
                                                     : 0.0;
    const vec3 along = {(float)cos(down_rad), 0.0f, (float)-sin(down_rad)};
    const double from_hand_m = down_rad > 0.0 ? length_m : 0.7 * length_m;
    const vec3 place_m = vec3_add_scaled(vec3_scale(along, (float)from_hand_m), DOWN, 2e-3f);
    hold_rod(along);
    put(0, thing(c->kind, place_m, UP, (float)c->friction));
}

static void describe(const press_case *c)
{
    printf("  %s %s N %d %s %.0f Hz friction %.1f %s: ", c->model == 0 ? "contour" : "elastic",
           c->rod, params.links_n, scene_kinds[c->kind], c->rate_hz, c->friction,
           c->tip_first ? "tip first" : "sideways");
}

/* What is bounded: elastic as it comes, contour at 1 kHz with up to 20 links that do not all lie flat. contour corrects each
 * step once, and its joints bear all that is beyond them: of many links or contacts, or in a long tick, that is not
 * enough. */
enum { ELASTIC, CONTOUR, CONTOUR_BEYOND, GROUPS_N };
static const char *const GROUPS[GROUPS_N] = {
    "elastic", "contour", "contour of many links, lying flat or at slow ticks (not bounded)"};

static int group_of(const press_case *c)
{
    const bool lies_flat = c->kind == SCENE_PLANE && !c->tip_first;
    return c->model == ROD_MODEL_ELASTIC                                        ? ELASTIC
           : params.links_n <= (lies_flat ? 12 : 20) && params.tick_s < 1.5e-3f ? CONTOUR
                                                                                : CONTOUR_BEYOND;
}

/* Over half a second, as soon as that is little: when the rod's own swing has died, after 2 to 8 s, or 30 where it has weight
 * as well. */
static double jitter_at_rest_rad(const press_case *c)
{
    double jitter = jitter_rad(0.5);
    for (int i = c->weighs ? 60 : 12; i > 0 && jitter > 1e-4; i--) {
        jitter = jitter_rad(0.5);
    }
    return jitter;
}

/* No node in by more than a hundredth of a link at any tick, and at rest no joint moves by more than 0.1 mrad. */
static void pressed_rods_stay_outside_and_lie_still(void)
{
    press_case c;
    double deepest[GROUPS_N] = {0.0}, restless_rad[GROUPS_N] = {0.0};
    int cases_n[GROUPS_N] = {0};
    for (int n = 0; take_case(n, &c); n += all ? 1 : 23) {
        take_rod(c.rod, c.model, c.links_n, c.rate_hz);
        params.gravity_m_s2 = c.weighs ? 9.81f : 0.0f;
        const int group = group_of(&c);
        if (!is_sensible(&c) || (group == CONTOUR_BEYOND && !all)) {
            continue;
        }
        set_up(&c);
        const sight seen = move_hand(vec3_scale(DOWN, 0.052f), c.speed_m_s, 2.0);
        const double jitter = jitter_at_rest_rad(&c);
        if (seen.deepest_links > 0.01 || jitter > 1e-4) {
            describe(&c);
            printf("%.4f links deep, jitter %.1e rad\n", seen.deepest_links, jitter);
        }
        cases_n[group]++;
        deepest[group] = worse(deepest[group], seen.deepest_links);
        restless_rad[group] = worse(restless_rad[group], jitter);
        TEST_ASSERT_TRUE(seen.length_error <= 1e-5);
    }
    for (int group = 0; group < GROUPS_N; group++) {
        printf("%d %s: %.1e of a link deep, still to %.1e rad\n", cases_n[group], GROUPS[group],
               deepest[group], restless_rad[group]);
        TEST_ASSERT_TRUE(group == CONTOUR_BEYOND || deepest[group] < 0.01);
        TEST_ASSERT_TRUE(group == CONTOUR_BEYOND || restless_rad[group] < 1e-4);
    }
}

/* Every kind of object, by a foil and by another rod of 20 links, of both models: case i of 16. Returns the model. */
static int press_tip_first(int i, const char *other, double rate_hz, double friction, double rest_s)
{
    const press_case c = {.model = i & 1,
                          .links_n = 20,
                          .kind = SCENE_PLANE + i / 2 % 4,
                          .rod = i / 8 == 0 ? "foil" : other,
                          .rate_hz = rate_hz,
                          .friction = friction,
                          .speed_m_s = 0.2,
                          .tip_first = true};
    take_rod(c.rod, c.model, c.links_n, c.rate_hz);
    params.gravity_m_s2 = 0.0f;
    set_up(&c);
    (void)move_hand(vec3_scale(DOWN, 0.052f), c.speed_m_s, rest_s);
    return c.model;
}

/* --- let go ------------------------------------------------------------------------------------------- */

/* Withdrawn at 0.1 m/s (0.16 at most): no node gets faster than three times that, and it ends untouched. */
static void withdrawn_rods_are_not_kicked(void)
{
    double fastest[2] = {0.0, 0.0};
    for (int i = 0; i < 16; i++) {
        const int model = press_tip_first(i, "fishing-rod", 1000.0, 0.0, 2.0);
        const sight seen = move_hand(vec3_scale(UP, 0.1f), 0.1, 1.0);
        fastest[model] = worse(fastest[model], seen.fastest_m_s);
        TEST_ASSERT_TRUE(length_double(contact_force()) <= 0.0);
    }
    printf("withdrawn at 0.16 m/s at most: nodes reach %.2f m/s (contour), %.2f m/s (elastic)\n",
           fastest[0], fastest[1]);
    TEST_ASSERT_TRUE(fastest[0] < 0.48 && fastest[1] < 0.48);
}

/* What was bent springs free with what it had, and no more. */
static void rods_whose_object_is_taken_away_have_no_more_energy_than_before(void)
{
    double worst = 0.0;
    for (int i = 0; i < 16; i++) {
        (void)press_tip_first(i, "whip", i % 3 == 0 ? 500.0 : 1000.0, 0.5, 3.0);
        const double before = energy();
        TEST_ASSERT_TRUE(before > 0.0);
        take_away(0);
        for (int n = ticks_in(1.0); n > 0; n--) {
            tick();
            worst = worse(worst, energy() / before - 1.0);
        }
    }
    printf("set free: energy at most %.1e more than before\n", worst);
    TEST_ASSERT_TRUE(worst < 1e-4);
}

/* From 2 cm inside, at TOUCH_ESCAPE_M_S; the tip goes at a few of that. From 3 cm and more the nodes next to a box's side
 * come out there, against those that come out on top, and the elastic rod leaps out at 20 m/s. */
static void objects_that_appear_around_a_rod_let_it_out_gently(void)
{
    double fastest[2] = {0.0, 0.0};
    for (int i = 0; i < 16; i++) {
        const int kind = SCENE_PLANE + i / 2 % 4;
        take_rod(i / 8 == 0 ? "foil" : "whip", i & 1, 20, 1000.0);
        params.gravity_m_s2 = 0.0f;
        hold_rod((vec3){0.9f, 0.0f, -0.1f});
        (void)rod_nodes(&r, nodes_m);
        const vec3 place_m = nodes_m[params.links_n * (kind == SCENE_PLANE ? 20 : 14) / 20];
        put(0, thing(kind, vec3_add_scaled(place_m, UP, 0.02f), UP, 0.3f));
        const sight seen = move_hand((vec3){0.0f, 0.0f, 0.0f}, 1.0, 1.0);
        fastest[i & 1] = worse(fastest[i & 1], seen.fastest_m_s);
        TEST_ASSERT_TRUE(deepest_links() < 0.01);
    }
    printf("let out: nodes reach %.2f m/s (contour), %.2f m/s (elastic)\n", fastest[0], fastest[1]);
    TEST_ASSERT_TRUE(fastest[0] < 5.0 && fastest[1] < 5.0);
}

int main(int argc, char **argv)
{
    all = argc > 1 && strcmp(argv[1], "all") == 0;
    UNITY_BEGIN();
    RUN_TEST(pressed_rods_stay_outside_and_lie_still);
    RUN_TEST(withdrawn_rods_are_not_kicked);
    RUN_TEST(rods_whose_object_is_taken_away_have_no_more_energy_than_before);
    RUN_TEST(objects_that_appear_around_a_rod_let_it_out_gently);
    return UNITY_END();
}
