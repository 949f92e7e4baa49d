/* scene_fixture.h - what stands in the rod's way and what shape it is to take, asked for over the wire. */
#ifndef LIMBER_SCENE_FIXTURE_H
#define LIMBER_SCENE_FIXTURE_H

#include <math.h>

#include "device_fixture.h"
#include "sim.h"

enum { LINKS_N = 6, ALL_PLACES = 255 };

static device *dev(void)
{
    return &b->host.device;
}

static const message_scene_put BALL = {.kind = OBJECT_SPHERE,
                                       .place_m = {0.1f, 0.02f, 0.05f},
                                       .orientation_xyzw = {0.0f, 0.0f, 0.0f, 1.0f},
                                       .radius_m = 0.08f,
                                       .friction = 0.3f};

__attribute__((unused)) static void put(int index, message_scene_put object)
{
    object.index = (uint8_t)index;
    ask((message){.type = MESSAGE_SCENE_PUT, .scene_put = object});
    tick();
}

__attribute__((unused)) static void take_away(int index)
{
    put(index, (message_scene_put){.kind = OBJECT_NONE});
}

__attribute__((unused)) static const message_scene_object *shown(int index)
{
    ask((message){.type = MESSAGE_SCENE_GET, .scene_get = {.index = (uint8_t)index}});
    tick();
    const message_scene_object *object = &b->newest[MESSAGE_SCENE_OBJECT].scene_object;
    TEST_ASSERT_EQUAL_UINT16(b->request_id, object->request_id);
    TEST_ASSERT_EQUAL_UINT8(index, object->index);
    TEST_ASSERT_EQUAL_UINT8(SCENE_OBJECTS_MAX, object->objects_max);
    return object;
}

/* All joints alike. */
__attribute__((unused)) static void take_shape(int angles_n, float angle_rad, float strength_nm,
                                               float blend_s)
{
    message m = {
        .type = MESSAGE_SHAPE,
        .shape = {.strength_nm = strength_nm, .blend_s = blend_s, .angles_n = (uint16_t)angles_n}};
    for (int i = 0; i < angles_n; i++) {
        m.shape.angles_tenth_mrad[i][0] = m.shape.angles_tenth_mrad[i][1] =
            (int16_t)lrintf(1e4f * angle_rad);
    }
    ask(m);
    do { /* the longest takes some ticks to read */
        tick();
    } while (b->to_n > 0);
}

__attribute__((unused)) static void done_at_once(uint8_t type)
{
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(b->request_id, b->newest[MESSAGE_ACK].ack.request_id,
                                     b->newest[MESSAGE_NACK].nack.text);
    TEST_ASSERT_EQUAL_UINT8(type, b->newest[MESSAGE_ACK].ack.answered);
}

__attribute__((unused)) static void commit(void)
{
    ask_simply(MESSAGE_PARAM_COMMIT);
    tick();
}

__attribute__((unused)) static void make_elastic(int links_n)
{
    stage("servo_kind", 0, (float)SERVOS_NONE);
    stage("model", 0, (float)ROD_MODEL_ELASTIC);
    stage("links", 0, (float)links_n);
    commit();
    done_at_once(MESSAGE_PARAM_COMMIT);
}

/* The base rests in a stream of poses. */
__attribute__((unused)) static void rest(int n)
{
    sway(n, 10, 0.0f);
}

__attribute__((unused)) static void become(int model)
{
    stage("model", 0, (float)model);
    commit();
    done_at_once(MESSAGE_PARAM_COMMIT);
}

__attribute__((unused)) static const message_nack *
refuses_put(int index, message_scene_put object, uint8_t reason, const char *field, int entry)
{
    const scene before = dev()->body.scene;
    put(index, object);
    const message_nack *nack = refused_at_once(reason);
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_SCENE_PUT, nack->answered);
    TEST_ASSERT_EQUAL_STRING(field, nack->field);
    TEST_ASSERT_EQUAL_INT16(entry, nack->entry);
    TEST_ASSERT_EQUAL_MEMORY(&before, &dev()->body.scene, sizeof before);
    return nack;
}

__attribute__((unused)) static const message_nack *refuses_shape(int angles_n, float angle_rad,
                                                                 float strength_nm, float blend_s,
                                                                 uint8_t reason, const char *field)
{
    take_shape(angles_n, angle_rad, strength_nm, blend_s);
    const message_nack *nack = refused_at_once(reason);
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_SHAPE, nack->answered);
    TEST_ASSERT_EQUAL_STRING(field, nack->field);
    TEST_ASSERT_EQUAL_UINT32(0, dev()->body.shape_ticks);
    return nack;
}

#endif
