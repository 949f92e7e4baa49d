/* test_touch.c - rods among objects through rod.h: what rod_contacts says, that a scene out of the way changes no bit, and
 * what a rod forgets. Both models; also on the emulated board. */
#include "object_fixture.h"
#include "rod_fixture.h"

static scene objects;

/* Six links that point along x, 5 cm over a floor whose top is at z = 0; the hand can come down. */
static rod_pose hand;

static void take_rod(int model)
{
    elastic_params(6, 0.5f);
    params.model = model;
    params.gravity_m_s2 = 0.0f;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        params.mass_kg[i] = 0.02f;
        params.inertia[i] = 0.02f;
        params.coupling[i] = 0.0f;
    }
    memset(&objects, 0, sizeof objects);
    hand = (rod_pose){{0.0f, 0.0f, 0.05f}, quat_about((vec3){0.0f, 1.0f, 0.0f}, 0.5 * PI + 0.1)};
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
    TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &hand));
}

void setUp(void)
{
    take_rod(ROD_MODEL_ELASTIC);
}

void tearDown(void) {}

static void put_floor(float height_m, float friction)
{
    const scene_object plane = {.kind = SCENE_PLANE,
                                .place_m = {0.0f, 0.0f, height_m},
                                .orientation = {0.0f, 0.0f, 0.0f, 1.0f},
                                .friction = friction};
    TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&objects, 3, &plane, NULL));
    rod_set_scene(&one, &objects);
}

/* 2 cm down within 100 ticks, and 200 more. */
static void press(void)
{
    for (int n = 0; n < 100; n++) {
        hand.position_m.z -= 2e-4f;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_step(&one, &hand));
    }
    rest(&one, &hand, 200);
}

static int contacts_n(void)
{
    int n;
    TEST_ASSERT_NOT_NULL(rod_contacts(&one, &n));
    return n;
}

static void pressed_tips_are_reported(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        TEST_ASSERT_EQUAL_INT(0, contacts_n());
        put_floor(0.02f, 0.2f);
        rest(&one, &hand, 1);
        press();
        TEST_ASSERT_EQUAL_INT(1, contacts_n());
        int n;
        const touch_contact *c = rod_contacts(&one, &n);
        TEST_ASSERT_EQUAL_INT(6, c->node);
        TEST_ASSERT_EQUAL_INT(3, c->object);
        TEST_ASSERT_TRUE(c->force_newton.z > 0.1f);
        TEST_ASSERT_TRUE(fabsf(c->force_newton.x) <= 0.2001f * c->force_newton.z);
        (void)rod_nodes(&one, nodes);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.02, (double)nodes[6].z);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0, (double)c->gap_m);
    }
}

/* Two ceilings in one place, 1 mm under the top of a long level rod: each node would touch both, and there are places
 * for some of that. No node goes without. */
static void nodes_that_touch_two_things_share_the_places(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        params.links_n = ROD_MAX_LINKS;
        hand.orientation = quat_about((vec3){0.0f, 1.0f, 0.0f}, 0.5 * PI);
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_init(&one, &params, NULL));
        rest(&one, &hand, 1);
        for (int i = 0; i < 2; i++) {
            const scene_object ceiling = {.kind = SCENE_PLANE,
                                          .place_m = {0.0f, 0.0f, 0.049f},
                                          .orientation = {1.0f, 0.0f, 0.0f, 0.0f}};
            TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&objects, i, &ceiling, NULL));
        }
        rod_set_scene(&one, &objects);
        for (int n = 0; n < 20; n++) {
            rest(&one, &hand, 1);
            TEST_ASSERT_TRUE(contacts_n() <= TOUCH_CONTACTS_MAX);
            TEST_ASSERT_TRUE(n > 0 || contacts_n() > 0);
        }
        (void)rod_nodes(&one, nodes);
        for (int i = 1; i <= ROD_MAX_LINKS; i++) {
            TEST_ASSERT_TRUE(nodes[i].z < 0.0495f);
        }
    }
}

/* The floor is 1 m under a rod of 30 cm: not a bit is other than without. */
static void scenes_out_of_reach_change_no_bit(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        twin = one;
        put_floor(-1.0f, 0.5f);
        follow(&one, 0.0, 300);
        follow(&twin, 0.0, 300);
        TEST_ASSERT_EQUAL_MEMORY(rod_angles(&twin), rod_angles(&one), 6 * sizeof(rod_joint));
    }
}

static void equal_touching_is_equal_to_the_bit(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        rod_joint first[6];
        for (int i = 0; i < 2; i++) {
            take_rod(model);
            put_floor(0.02f, 0.4f);
            press();
            if (i == 0) {
                memcpy(first, rod_angles(&one), sizeof first);
            }
        }
        TEST_ASSERT_EQUAL_MEMORY(first, rod_angles(&one), sizeof first);
    }
}

/* Gone scenes, emptied ones, another start: no contacts are left from before, and the rod straightens. */
static void objects_that_are_gone_are_forgotten(void)
{
    for (int i = 0; i < 6; i++) {
        take_rod(i & 1);
        put_floor(0.02f, 0.4f);
        press();
        TEST_ASSERT_EQUAL_INT(1, contacts_n());
        if (i / 2 == 0) {
            rod_set_scene(&one, NULL);
        } else if (i / 2 == 1) {
            const scene_object none = {.kind = SCENE_NONE};
            TEST_ASSERT_EQUAL_INT(ROD_OK, scene_put(&objects, 3, &none, NULL));
            rest(&one, &hand, 1);
        } else {
            rod_reset(&one);
        }
        TEST_ASSERT_EQUAL_INT(0, contacts_n());
        rod_set_scene(&one, NULL);
        rest(&one, &hand, 2000);
        TEST_ASSERT_TRUE(fabsf(rod_angles(&one)[0][ROD_THETA]) < 1e-3f);
        TEST_ASSERT_EQUAL_INT(0, contacts_n());
    }
}

/* Changed parameters, the other model and its way back keep the scene. */
static void scenes_survive_other_parameters(void)
{
    for (int model = 0; model < ROD_MODEL_COUNT; model++) {
        take_rod(model);
        put_floor(0.02f, 0.4f);
        press();
        params.model = ROD_MODEL_COUNT - 1 - model;
        params.spring[0] *= 2.0f;
        TEST_ASSERT_EQUAL_INT(ROD_OK, rod_set_params(&one, &params, NULL));
        rest(&one, &hand, 500);
        TEST_ASSERT_EQUAL_INT(1, contacts_n());
        (void)rod_nodes(&one, nodes);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.02, (double)nodes[6].z);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(pressed_tips_are_reported);
    RUN_TEST(nodes_that_touch_two_things_share_the_places);
    RUN_TEST(scenes_out_of_reach_change_no_bit);
    RUN_TEST(equal_touching_is_equal_to_the_bit);
    RUN_TEST(objects_that_are_gone_are_forgotten);
    RUN_TEST(scenes_survive_other_parameters);
    return UNITY_END();
}
