/* test_device_touch.c - the whole device among objects and with shapes: kept, paid for, told, and replayed to the bit.
 *
 *     test_device_touch [REQUESTS]     of the storms, 10,000 by default
 */
#include <unistd.h>

#include "scene_fixture.h"
#include "tick_budget.h"

static int requests_n = 10000;
static uint32_t random_state;

void setUp(void)
{
    random_state = 20181003;
    bench_connected(LINKS_N);
}

void tearDown(void)
{
    free(b);
}

/* --- kept ------------------------------------------------------------------------------------------------ */

static void take_ball_and_shape(void)
{
    put(3, BALL);
    done_at_once(MESSAGE_SCENE_PUT);
    take_shape(LINKS_N, 0.05f, 0.1f, 0.1f);
    done_at_once(MESSAGE_SHAPE);
    TEST_ASSERT_EQUAL_INT(1, scene_objects_n(&dev()->body.scene));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, dev()->body.shape_ticks);
    take_away(3);
    take_shape(0, 0.0f, 0.0f, 0.0f);
    done_at_once(MESSAGE_SHAPE);
}

static void test_taken_in_every_state(void)
{
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_DISARMED, state_now());
    take_ball_and_shape();
    get_active();
    take_ball_and_shape();
    ticks(52);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_HOLD, state_now());
    take_ball_and_shape();
    ticks(501);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_RELAX, state_now());
    take_ball_and_shape();
    ticks(5001);
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_LIMP, state_now());
    take_ball_and_shape();
    ask_simply(MESSAGE_ESTOP);
    tick();
    TEST_ASSERT_EQUAL_INT(SUPERVISOR_ESTOP, state_now());
    take_ball_and_shape();
    TEST_ASSERT_FALSE(b->host.plant.powered);
}

static void test_stay_over_presets_sessions_and_poses_but_not_over_a_start(void)
{
    put(2, BALL);
    take_shape(LINKS_N, 0.05f, 0.1f, 0.1f);
    message preset = {.type = MESSAGE_PRESET, .preset = {.name = "whip"}};
    ask(preset);
    tick();
    done_at_once(MESSAGE_PRESET);
    b->session = 9;
    say_hello(100.0f);
    TEST_ASSERT_EQUAL_UINT8(OBJECT_SPHERE, shown(2)->kind);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, dev()->body.shape_ticks);
    stage("links", 0, (float)(LINKS_N - 1));
    commit();
    done_at_once(MESSAGE_PARAM_COMMIT);
    TEST_ASSERT_EQUAL_UINT8(OBJECT_SPHERE, shown(2)->kind);
    TEST_ASSERT_EQUAL_UINT32(0, dev()->body.shape_ticks); /* its angles are another rod's */
    save();
    bench_start(LINKS_N);
    say_hello(100.0f);
    TEST_ASSERT_EQUAL_INT(LINKS_N - 1, dev()->params.in_force.rod.links_n);
    TEST_ASSERT_EQUAL_UINT8(OBJECT_NONE, shown(2)->kind);
}

/* The simulator's world stays where it is, whatever the device forgets. */
static void test_what_the_simulator_was_given_is_there_after_each_start(void)
{
    const scene_object ball = {.kind = SCENE_SPHERE,
                               .place_m = {0.1f, 0.0f, 0.1f},
                               .orientation = {0.0f, 0.0f, 0.0f, 1.0f},
                               .radius_m = 0.08f};
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&b->host.objects, 6, &ball, NULL));
    for (int start = 0; start < 2; start++) {
        bench_start(LINKS_N);
        say_hello(100.0f);
        TEST_ASSERT_EQUAL_UINT8(OBJECT_SPHERE, shown(6)->kind);
        take_away(6);
    }
}

/* --- paid for ------------------------------------------------------------------------------------------- */

static void test_more_than_a_tick_has_time_for_is_refused(void)
{
    const tick_load nothing = {0, false};
    int links_n = 41; /* the most that fit with nothing to touch */
    make_elastic(links_n);
    TEST_ASSERT_EQUAL_INT(0,
                          tick_budget_of(&dev()->params.in_force, &nothing, 168000000).objects_max);
    const message_nack *nack = refuses_put(0, BALL, REASON_COMBINATION, "objects", -1);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, nack->value);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, nack->maximum);
    TEST_ASSERT_NOT_NULL(strstr(nack->text, "elastic, 41 links, 1 object: "));
    TEST_ASSERT_NOT_NULL(strstr(nack->text, " us at 168 MHz, a tick of 1000 has 900"));
    nack = refuses_shape(links_n, 0.01f, 1.0f, 0.1f, REASON_COMBINATION, "links");
    TEST_ASSERT_NOT_NULL(strstr(nack->text, "elastic, 41 links, a shape: "));

    /* as many links as leave time for three objects, one of which is replaced and one taken away */
    do {
        make_elastic(--links_n);
    } while (tick_budget_of(&dev()->params.in_force, &nothing, 168000000).objects_max < 3);
    const int most = tick_budget_of(&dev()->params.in_force, &nothing, 168000000).objects_max;
    for (int i = 0; i < most; i++) {
        put(i, BALL);
        done_at_once(MESSAGE_SCENE_PUT);
    }
    if (most < SCENE_OBJECTS_MAX) {
        (void)refuses_put(most, BALL, REASON_COMBINATION, "objects", -1);
        put(most - 1, BALL);
        done_at_once(MESSAGE_SCENE_PUT);
        take_away(0);
        put(most, BALL);
        done_at_once(MESSAGE_SCENE_PUT);
    }
    /* parameters pay for the scene as well */
    stage("links", 0, 41.0f);
    commit();
    TEST_ASSERT_EQUAL_STRING("links", refused_at_once(REASON_COMBINATION)->field);
    take_away(ALL_PLACES);
    commit();
    done_at_once(MESSAGE_PARAM_COMMIT);
    TEST_ASSERT_EQUAL_INT(41, dev()->params.in_force.rod.links_n);
}

/* It costs until it is out. */
static void test_a_shape_let_go_is_paid_for_until_its_blend_is_over(void)
{
    sway(20, 10, 0.0f);
    take_shape(LINKS_N, 0.05f, 0.1f, 0.1f);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, dev()->body.shape_ticks);
    take_shape(0, 0.0f, 0.0f, 0.1f);
    sway(95, 10, 0.0f);
    TEST_ASSERT_TRUE(dev()->body.shape_ticks > 0);
    sway(10, 10, 0.0f);
    TEST_ASSERT_EQUAL_UINT32(0, dev()->body.shape_ticks);
}

/* --- touched --------------------------------------------------------------------------------------------- */

static void test_touch_is_told_ten_times_a_second_and_once_when_it_ends(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        stage("model", 0, (float)model);
        commit();
        rest(300);
        TEST_ASSERT_EQUAL_UINT(0, b->seen_n[MESSAGE_TOUCH]);
        message_scene_put ball =
            BALL; /* overlaps the rod, which lies along z, from -x: the rod is pushed to +x */
        ball.place_m[0] = -0.06f;
        ball.place_m[1] = 0.0f;
        ball.place_m[2] = 0.09f; /* the hand is outside */
        put(1, ball);
        rest(1000);
        TEST_ASSERT_UINT_WITHIN(1, 10, b->seen_n[MESSAGE_TOUCH]);
        const message_touch told = b->newest[MESSAGE_TOUCH].touch;
        TEST_ASSERT_TRUE(told.contacts_n > 0);
        TEST_ASSERT_TRUE(told.force_newton[0] > 0.0f);
        rest(1);
        const message_scene_object *o = shown(1);
        TEST_ASSERT_TRUE(o->contacts_n > 0);
        TEST_ASSERT_TRUE(o->force_newton[0] > 0.0f);
        TEST_ASSERT_EQUAL_UINT16(0, shown(0)->contacts_n);
        take_away(1);
        const unsigned before = b->seen_n[MESSAGE_TOUCH];
        rest(500);
        TEST_ASSERT_EQUAL_UINT(before + 1, b->seen_n[MESSAGE_TOUCH]);
        TEST_ASSERT_EQUAL_UINT16(0, b->newest[MESSAGE_TOUCH].touch.contacts_n);
        b->seen_n[MESSAGE_TOUCH] = 0;
    }
}

/* --- storms and logs -------------------------------------------------------------------------------------- */

static float random_within(float from, float to)
{
    random_state = random_state * 1664525u + 1013904223u;
    return from + (to - from) * (float)(random_state >> 8) / 16777216.0f;
}

static message random_request(void)
{
    message m = {.type = MESSAGE_SCENE_PUT};
    if (random_within(0.0f, 1.0f) < 0.2f) {
        m.type = MESSAGE_SHAPE;
        m.shape = (message_shape){.strength_nm = random_within(0.0f, 20.0f),
                                  .blend_s = random_within(0.0f, 0.3f),
                                  .angles_n = random_within(0.0f, 1.0f) < 0.7f ? LINKS_N : 0};
        for (int i = 0; i < 2 * m.shape.angles_n; i++) {
            m.shape.angles_tenth_mrad[i / 2][i % 2] = (int16_t)random_within(-6000.0f, 6000.0f);
        }
        return m;
    }
    m.scene_put = (message_scene_put){.index = (uint8_t)random_within(0.0f, 8.0f),
                                      .kind = (uint8_t)random_within(0.0f, 5.0f),
                                      .orientation_xyzw = {0.0f, 0.6f, 0.0f, 0.8f},
                                      .friction = random_within(0.0f, 2.0f)};
    const float reach_m = m.scene_put.kind == OBJECT_PLANE ? 0.3f : 0.2f;
    for (int axis = 0; axis < 3; axis++) {
        m.scene_put.place_m[axis] = random_within(-reach_m, reach_m);
        m.scene_put.half_m[axis] =
            m.scene_put.kind == OBJECT_BOX ? random_within(0.0f, 0.1f) : 0.0f;
    }
    m.scene_put.half_m[2] = m.scene_put.kind >= OBJECT_CAPSULE ? random_within(0.0f, 0.2f) : 0.0f;
    m.scene_put.radius_m = m.scene_put.kind >= OBJECT_SPHERE ? random_within(1e-3f, 0.1f) : 0.0f;
    return m;
}

/* What a hand that holds the rod relies on, tick by tick: servos within their speed and range, angles finite. */
static void check_goals(float *last_rad)
{
    const servo_map *map = &dev()->body.map;
    const rod_joint *angles_rad = rod_angles(&dev()->body.rod);
    const float step_rad = dev()->params.in_force.device.servo_rate_radps * map->period_s * 1.001f;
    for (int s = 0; s < map->servos_n; s++) {
        const float goal_rad = servo_map_goals(map)[s];
        TEST_ASSERT_TRUE(fabsf(angles_rad[s / 2][s % 2]) <= 3.1416f);
        TEST_ASSERT_TRUE(fabsf(goal_rad - last_rad[s]) <= step_rad);
        TEST_ASSERT_TRUE(map->servo[s].goal >= map->servo[s].min &&
                         map->servo[s].goal <= map->servo[s].max);
        last_rad[s] = goal_rad;
    }
}

/* Ticks in which the rod touched anything. */
static int storm(int n)
{
    float last_rad[SERVOS_MAX];
    vec3 force;
    int touched_n = 0;
    memcpy(last_rad, servo_map_goals(&dev()->body.map), sizeof last_rad);
    for (int i = 0; i < n; i++) {
        b->request_id = b->request_id < UINT16_MAX ? b->request_id : 0; /* 0 is none */
        ask(random_request());
        sway(1, 1, 0.1f);
        check_goals(last_rad);
        touched_n += body_touch(&dev()->body, BODY_ANY_OBJECT, &force) > 0;
    }
    return touched_n;
}

static void test_storms_of_objects_and_shapes_do_no_harm(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        ask_simply(MESSAGE_DISARM);
        tick();
        become(model);
        get_active();
        const unsigned refused = b->seen_n[MESSAGE_NACK];
        const int touched_n = storm(requests_n);
        TEST_ASSERT_TRUE(touched_n > requests_n / 10);
        TEST_ASSERT_EQUAL_UINT(refused, b->seen_n[MESSAGE_NACK]);
        TEST_ASSERT_EQUAL_INT(SUPERVISOR_ACTIVE, state_now());
        TEST_ASSERT_EQUAL_UINT32(0, dev()->faults.solver_failures);
        take_away(ALL_PLACES);
        take_shape(0, 0.0f, 0.0f, 0.1f);
        rest(5000);
        const rod_joint *angles = rod_angles(&dev()->body.rod);
        for (int i = 0; i < LINKS_N; i++) {
            TEST_ASSERT_FLOAT_WITHIN(0.05f, 0.0f, angles[i][0]);
            TEST_ASSERT_FLOAT_WITHIN(0.05f, 0.0f, angles[i][1]);
        }
    }
    TEST_ASSERT_TRUE(dev()->commands_done >= 2u * (unsigned)requests_n);
}

/* The log of a storm, replayed, comes to the same angles: objects and shapes are in it. */
static void test_a_log_replays_to_the_same_bits(void)
{
    char path[] = "/tmp/limber-scene-XXXXXX";
    const int fd = mkstemp(path);
    TEST_ASSERT_TRUE(fd >= 0);
    close(fd);
    TEST_ASSERT_EQUAL_INT(SIM_OK, body_log_open(&b->host.log, path));
    bench_start(LINKS_N);
    say_hello(100.0f);
    become(ROD_MODEL_ELASTIC);
    get_active();
    TEST_ASSERT_TRUE(storm(requests_n / 10) > 0);
    become(ROD_MODEL_ELASTIC);
    rest(200);
    bench_start(LINKS_N); /* straight, with nothing around it */
    get_active();
    const uint64_t hash = b->host.log.hash;
    TEST_ASSERT_EQUAL_INT(SIM_OK, body_log_close(&b->host.log, path));
    uint64_t again = 0;
    TEST_ASSERT_EQUAL_INT(SIM_OK, body_log_replay(path, NULL, &again));
    TEST_ASSERT_EQUAL_HEX64(hash, again);
    TEST_ASSERT_EQUAL_INT(0, unlink(path));
}

int main(int argc, char **argv)
{
    requests_n = argc > 1 ? atoi(argv[1]) : requests_n;
    UNITY_BEGIN();
    RUN_TEST(test_taken_in_every_state);
    RUN_TEST(test_stay_over_presets_sessions_and_poses_but_not_over_a_start);
    RUN_TEST(test_what_the_simulator_was_given_is_there_after_each_start);
    RUN_TEST(test_more_than_a_tick_has_time_for_is_refused);
    RUN_TEST(test_a_shape_let_go_is_paid_for_until_its_blend_is_over);
    RUN_TEST(test_touch_is_told_ten_times_a_second_and_once_when_it_ends);
    RUN_TEST(test_storms_of_objects_and_shapes_do_no_harm);
    RUN_TEST(test_a_log_replays_to_the_same_bits);
    return UNITY_END();
}
