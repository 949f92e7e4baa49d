/* object_fixture.h - good objects for tests. */
#ifndef LIMBER_OBJECT_FIXTURE_H
#define LIMBER_OBJECT_FIXTURE_H

#include "scene.h"

/* A good one of each kind. */
static inline scene_object example(int kind)
{
    scene_object o = {.kind = kind,
                      .place_m = {1.0f, -2.0f, 3.0f},
                      .orientation = {0.0f, 0.0f, 0.0f, 1.0f},
                      .radius_m = kind == SCENE_PLANE ? 0.0f : 0.1f,
                      .friction = 0.3f};
    if (kind == SCENE_CAPSULE || kind == SCENE_BOX) {
        o.half_m.z = 0.3f;
    }
    if (kind == SCENE_BOX) {
        o.half_m.x = 0.1f;
        o.half_m.y = 0.2f;
    }
    return o;
}

#endif
