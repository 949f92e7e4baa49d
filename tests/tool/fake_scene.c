/* fake_scene.c - the fake device's objects and shapes: kept, shown and told, not felt. */
#include <string.h>

#include "fake_device.h"

void fake_scene_put(fake_device *d, const message *m)
{
    const message_scene_put *const p = &m->scene_put;
    const bool all = p->index == 255 && p->kind == OBJECT_NONE;
    if (!all && p->index >= FAKE_OBJECTS_N) {
        fake_nack(d, m, (message_nack){.reason = REASON_INDEX, .entry = -1, .field = "index"});
        return;
    }
    for (int i = 0; i < FAKE_OBJECTS_N; i++) {
        if (all || i == p->index) {
            d->objects[i] = *p;
        }
    }
    fake_tell("object %d kind %d at %g %g %g", p->index, p->kind, (double)p->place_m[0],
              (double)p->place_m[1], (double)p->place_m[2]);
    fake_ack(d, m);
}

/* Its balls are touched, all of them, by two nodes and with 5 N. */
void fake_scene_show(fake_device *d, const message *m)
{
    const int i = m->scene_get.index;
    if (i >= FAKE_OBJECTS_N) {
        fake_nack(d, m, (message_nack){.reason = REASON_INDEX, .entry = -1});
        return;
    }
    const message_scene_put *const p = &d->objects[i];
    message answer = {.type = MESSAGE_SCENE_OBJECT,
                      .scene_object = {.request_id = m->scene_get.request_id,
                                       .index = (uint8_t)i,
                                       .objects_max = FAKE_OBJECTS_N,
                                       .kind = p->kind,
                                       .radius_m = p->radius_m,
                                       .friction = p->friction}};
    message_scene_object *const o = &answer.scene_object;
    memcpy(o->place_m, p->place_m, sizeof o->place_m);
    memcpy(o->orientation_xyzw, p->orientation_xyzw, sizeof o->orientation_xyzw);
    memcpy(o->half_m, p->half_m, sizeof o->half_m);
    if (p->kind == OBJECT_SPHERE) {
        o->contacts_n = 2;
        o->force_newton[0] = -3.0f;
        o->force_newton[2] = 4.0f;
    }
    fake_send(d, &answer);
}

void fake_shape(fake_device *d, const message *m)
{
    const message_shape *const s = &m->shape;
    fake_tell("shape %d strength %g blend %g first %d %d", s->angles_n, (double)s->strength_nm,
              (double)s->blend_s, s->angles_n > 0 ? s->angles_tenth_mrad[0][0] : 0,
              s->angles_n > 0 ? s->angles_tenth_mrad[0][1] : 0);
    fake_ack(d, m);
}
