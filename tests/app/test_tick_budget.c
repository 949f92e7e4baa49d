/* test_tick_budget.c - which rods fit a tick, and how one that does not is refused. The constants themselves are held
 * against counted instructions by tests/target/cost.py. */
#include "tick_budget.h"

#include <string.h>

#include "messages.h"
#include "servo_types.h"
#include "unity.h"

enum { BOARD_HZ = 168000000, OSCILLATOR_HZ = 16000000 };

static params all;
static params_refusal why;
static char text[MESSAGES_TEXT_MAX + 1];
static const tick_load NOTHING = {0, false};
static tick_load load; /* none, but where a test says so */

void setUp(void)
{
    params_init(&all);
    load = (tick_load){0, false};
    memset(&why, 0, sizeof why);
    memset(text, 'x', sizeof text);
}

void tearDown(void) {}

static bool fits(int model, int links_n, int servo_kind, float tick_s, uint32_t clock_hz)
{
    all.in_force.rod.model = model;
    all.in_force.rod.links_n = links_n;
    all.in_force.rod.tick_s = tick_s;
    all.in_force.device.servo_kind = (float)servo_kind;
    return tick_budget_check(&all.in_force, &load, clock_hz, text, &why);
}

/* The most links that fit; every number up to there does, and none beyond. */
static int links_max(int model, int servo_kind, float tick_s, uint32_t clock_hz)
{
    int most = 0;
    for (int n = 1; n <= ROD_MAX_LINKS; n++) {
        if (fits(model, n, servo_kind, tick_s, clock_hz)) {
            TEST_ASSERT_EQUAL_INT(n - 1, most);
            most = n;
        }
    }
    return most;
}

static void what_fits_the_board(void)
{
    static const struct {
        int model, servo_kind;
        float tick_s;
        uint32_t clock_hz;
        int links_max;
    } ROWS[] = {
        {ROD_MODEL_CONTOUR, SERVOS_BUS, 1e-3f, BOARD_HZ, 64},
        {ROD_MODEL_CONTOUR, SERVOS_BUS, 5e-4f, BOARD_HZ, 12},
        {ROD_MODEL_CONTOUR, SERVOS_NONE, 1e-2f, OSCILLATOR_HZ, 64},
        {ROD_MODEL_ELASTIC, SERVOS_NONE, 1e-3f, BOARD_HZ, 41},
        {ROD_MODEL_ELASTIC, SERVOS_PWM, 1e-3f, BOARD_HZ, 41},
        {ROD_MODEL_ELASTIC, SERVOS_BUS, 1e-3f, BOARD_HZ, 27},
        {ROD_MODEL_ELASTIC, SERVOS_BUS, 2e-3f, BOARD_HZ, 64},
        {ROD_MODEL_ELASTIC, SERVOS_NONE, 1e-2f, OSCILLATOR_HZ, 5},
        {ROD_MODEL_ELASTIC, SERVOS_NONE, 1e-3f, OSCILLATOR_HZ, 0},
        {ROD_MODEL_ELASTIC, SERVOS_BUS, 1e-3f, 0, 64}, /* nobody knows the clock */
    };
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        const int most = ROWS[i].links_max < ROD_MAX_LINKS ? ROWS[i].links_max : ROD_MAX_LINKS;
        TEST_ASSERT_EQUAL_INT(
            most, links_max(ROWS[i].model, ROWS[i].servo_kind, ROWS[i].tick_s, ROWS[i].clock_hz));
    }
}

static void a_refusal_has_the_arithmetic(void)
{
    TEST_ASSERT_FALSE(fits(ROD_MODEL_ELASTIC, 50, SERVOS_BUS, 1e-3f, BOARD_HZ));
    TEST_ASSERT_EQUAL_INT(REASON_COMBINATION, why.reason);
    TEST_ASSERT_EQUAL_STRING("links", why.field);
    TEST_ASSERT_EQUAL_INT(-1, why.entry);
    TEST_ASSERT_EQUAL_FLOAT(50.0f, why.value);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, why.min);
    TEST_ASSERT_EQUAL_FLOAT(27.0f, why.max);
    /* 174,000 cycles; 70 % of a tick */
    TEST_ASSERT_EQUAL_STRING("elastic, 50 links: 1036 us at 168 MHz, a tick of 1000 has 700: "
                             "fewer links, longer tick",
                             why.text);
}

/* The longest that numbers can get is told whole. */
static void the_longest_text_has_room(void)
{
    TEST_ASSERT_FALSE(fits(ROD_MODEL_ELASTIC, 256, SERVOS_NONE, 2e-2f, OSCILLATOR_HZ));
    TEST_ASSERT_EQUAL_STRING("elastic, 256 links: 530106 us at 16 MHz, a tick of 20000 has 18000: "
                             "fewer links, longer tick",
                             why.text);
}

static void needs_grow_with_the_links_and_the_clock_divides_them(void)
{
    all.in_force.rod.model = ROD_MODEL_ELASTIC;
    all.in_force.rod.links_n = 20;
    const tick_budget fast = tick_budget_of(&all.in_force, &load, BOARD_HZ);
    const tick_budget slow = tick_budget_of(&all.in_force, &load, BOARD_HZ / 2);
    TEST_ASSERT_UINT32_WITHIN(1, 2 * fast.needed_us, slow.needed_us);
    TEST_ASSERT_EQUAL_UINT32(fast.given_us, slow.given_us);
    TEST_ASSERT_EQUAL_UINT32(900, fast.given_us);
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        const uint32_t a_link = tick_budget_cycles(model, 11, 1e-3f, &NOTHING) -
                                tick_budget_cycles(model, 10, 1e-3f, &NOTHING);
        TEST_ASSERT_TRUE(a_link > 0);
        TEST_ASSERT_EQUAL_UINT32(tick_budget_cycles(model, 10, 1e-3f, &NOTHING) + 30 * a_link,
                                 tick_budget_cycles(model, 40, 1e-3f, &NOTHING));
    }
}

static uint32_t more(int model, int links_n, float tick_s, tick_load with)
{
    return tick_budget_cycles(model, links_n, tick_s, &with) -
           tick_budget_cycles(model, links_n, tick_s, &NOTHING);
}

/* Every link asks every object in each step, and any link may touch. */
static void objects_and_shapes_take_time(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        const uint32_t one = more(model, 10, 1e-3f, (tick_load){1, false});
        const uint32_t eight = more(model, 10, 1e-3f, (tick_load){8, false});
        const uint32_t shaped = more(model, 10, 1e-3f, (tick_load){8, true});
        TEST_ASSERT_TRUE(0 < one && one < eight && eight < shaped);
        TEST_ASSERT_EQUAL_UINT32(2 * shaped, more(model, 20, 1e-3f, (tick_load){8, true}));
    }
    const uint32_t a_shape = more(ROD_MODEL_ELASTIC, 10, 1e-3f, (tick_load){0, true});
    TEST_ASSERT_EQUAL_UINT32(4 * a_shape, more(ROD_MODEL_ELASTIC, 10, 4e-3f, (tick_load){0, true}));
    /* among objects a tick of 4 ms is one step, too */
    TEST_ASSERT_EQUAL_UINT32(
        tick_budget_cycles(ROD_MODEL_ELASTIC, 10, 1e-3f, &(tick_load){2, false}),
        tick_budget_cycles(ROD_MODEL_ELASTIC, 10, 4e-3f, &(tick_load){2, false}));
}

/* The whole of what a scene may hold, at rods of fifty links: contour at 300 Hz, elastic at 250. */
static void fifty_links_among_eight_objects_fit(void)
{
    load = (tick_load){8, false};
    TEST_ASSERT_TRUE(fits(ROD_MODEL_CONTOUR, 50, SERVOS_NONE, 1.0f / 300.0f, BOARD_HZ));
    TEST_ASSERT_TRUE(fits(ROD_MODEL_ELASTIC, 50, SERVOS_NONE, 4e-3f, BOARD_HZ));
    TEST_ASSERT_FALSE(fits(ROD_MODEL_ELASTIC, 50, SERVOS_NONE, 2e-3f, BOARD_HZ));
}

/* What is told as the most that fits does fit, and one more does not. */
static void the_most_objects_are_the_most(void)
{
    for (int links_n = 1; links_n <= ROD_MAX_LINKS; links_n++) {
        load = (tick_load){0, false};
        if (!fits(ROD_MODEL_ELASTIC, links_n, SERVOS_NONE, 1e-3f, BOARD_HZ)) {
            break;
        }
        const int most = tick_budget_of(&all.in_force, &load, BOARD_HZ).objects_max;
        for (load.objects_n = 1; load.objects_n <= SCENE_OBJECTS_MAX; load.objects_n++) {
            const bool fit = tick_budget_check_objects(&all.in_force, &load, BOARD_HZ, text, &why);
            TEST_ASSERT_EQUAL_INT(load.objects_n <= most, fit);
            TEST_ASSERT_EQUAL_INT(fit,
                                  fits(ROD_MODEL_ELASTIC, links_n, SERVOS_NONE, 1e-3f, BOARD_HZ));
        }
    }
    load.objects_n = 8;
    TEST_ASSERT_TRUE(tick_budget_check_objects(&all.in_force, &load, 0, text, &why));
}

static void refused_objects_have_the_arithmetic(void)
{
    (void)fits(ROD_MODEL_ELASTIC, 40, SERVOS_NONE, 1e-3f, BOARD_HZ);
    load = (tick_load){3, true};
    TEST_ASSERT_FALSE(tick_budget_check_objects(&all.in_force, &load, BOARD_HZ, text, &why));
    TEST_ASSERT_EQUAL_INT(REASON_COMBINATION, why.reason);
    TEST_ASSERT_EQUAL_STRING("objects", why.field);
    TEST_ASSERT_EQUAL_INT(-1, why.entry);
    TEST_ASSERT_EQUAL_FLOAT(3.0f, why.value);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, why.max);
    /* 46,500 + 40 (2550 + 6400 + 3 * 100 + 430) cycles */
    TEST_ASSERT_EQUAL_STRING(
        "elastic, 40 links, 3 objects, a shape: 2582 us at 168 MHz, a tick of 1000 has 900",
        why.text);
    TEST_ASSERT_FALSE(fits(ROD_MODEL_ELASTIC, 40, SERVOS_NONE, 1e-3f, BOARD_HZ));
    TEST_ASSERT_EQUAL_STRING("links", why.field);
    /* (900 us - 46,500) / 9680 */
    TEST_ASSERT_EQUAL_FLOAT(10.0f, why.max);
    load = (tick_load){8, true};
    TEST_ASSERT_FALSE(fits(ROD_MODEL_ELASTIC, 256, SERVOS_NONE, 2e-2f, OSCILLATOR_HZ));
    TEST_ASSERT_EQUAL_STRING("elastic, 256 links, 8 objects, a shape: 2971706 us at 16 MHz, "
                             "a tick of 20000 has 18000",
                             why.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(what_fits_the_board);
    RUN_TEST(a_refusal_has_the_arithmetic);
    RUN_TEST(the_longest_text_has_room);
    RUN_TEST(objects_and_shapes_take_time);
    RUN_TEST(fifty_links_among_eight_objects_fit);
    RUN_TEST(the_most_objects_are_the_most);
    RUN_TEST(refused_objects_have_the_arithmetic);
    RUN_TEST(needs_grow_with_the_links_and_the_clock_divides_them);
    return UNITY_END();
}
