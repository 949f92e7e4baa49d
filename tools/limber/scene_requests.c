/* scene_requests.c - see scene_requests.h. */
#include "scene_requests.h"

#include "texts.h"

enum { SCENE_MINOR = 3, ALL_PLACES = 255 };

static bool is_known(const session *s)
{
    return s->device.protocol_minor >= SCENE_MINOR;
}

int scene_requests_known(const session *s)
{
    const message_hello *device = &s->device;
    return is_known(s)
               ? SIM_OK
               : limber_refuse("the device (%.16s %.24s) speaks protocol %d.%d, and scenes and "
                               "shapes need %d.%d: flash newer firmware",
                               device->device, device->build, device->protocol_major,
                               device->protocol_minor, PROTOCOL_MAJOR, SCENE_MINOR);
}

int scene_requests_get(session *s, int index, message_scene_object *object)
{
    const int result = session_request(
        s, &(message){.type = MESSAGE_SCENE_GET, .scene_get = {.index = (uint8_t)index}});
    if (result == SIM_OK) {
        *object = s->answer.scene_object;
    }
    return result;
}

int scene_requests_count(session *s, int *objects_n)
{
    message_scene_object object = {.objects_max = is_known(s) ? 1 : 0};
    int result = SIM_OK, n = 0;
    for (int i = 0; i < object.objects_max && result == SIM_OK; i++) {
        result = scene_requests_get(s, i, &object);
        n += result == SIM_OK && object.kind != OBJECT_NONE;
    }
    *objects_n = is_known(s) ? n : -1;
    return result;
}

static message put_of(int index, const scene_object *o)
{
    return (message){.type = MESSAGE_SCENE_PUT,
                     .scene_put = {.index = (uint8_t)index,
                                   .kind = (uint8_t)o->kind,
                                   .place_m = {o->place_m.x, o->place_m.y, o->place_m.z},
                                   .orientation_xyzw = {o->orientation.x, o->orientation.y,
                                                        o->orientation.z, o->orientation.w},
                                   .half_m = {o->half_m.x, o->half_m.y, o->half_m.z},
                                   .radius_m = o->radius_m,
                                   .friction = o->friction}};
}

int scene_requests_put(session *s, int index, const scene_object *object)
{
    const message put = put_of(index, object);
    return session_request(s, &put);
}

void scene_requests_ask(session *s, int index, const scene_object *object)
{
    const message put = put_of(index, object);
    session_ask(s, &put);
}

scene_object scene_requests_object(const message_scene_object *o)
{
    return (scene_object){
        .kind = o->kind,
        .place_m = {o->place_m[0], o->place_m[1], o->place_m[2]},
        .orientation = {o->orientation_xyzw[0], o->orientation_xyzw[1], o->orientation_xyzw[2],
                        o->orientation_xyzw[3]},
        .half_m = {o->half_m[0], o->half_m[1], o->half_m[2]},
        .radius_m = o->radius_m,
        .friction = o->friction,
    };
}

static const scene_object NOTHING = {.kind = SCENE_NONE};

int scene_requests_clear(session *s)
{
    return scene_requests_put(s, ALL_PLACES, &NOTHING);
}

int scene_requests_send(session *s, const scene_text *text)
{
    int result = SIM_OK;
    for (int i = text->objects_n; i < SCENE_OBJECTS_MAX && result == SIM_OK; i++) {
        result = scene_requests_put(s, i, &NOTHING);
    }
    for (int i = 0; i < text->objects_n && result == SIM_OK; i++) {
        const message put = put_of(i, &text->objects[i].object);
        if (session_try(s, &put) == REQUEST_REFUSED) {
            port_why why;
            texts_refusal(&s->answer.nack, why);
            return limber_refuse("%s, object %d of %d: %s", text->objects[i].name, i + 1,
                                 text->objects_n, why);
        }
        result = s->request == REQUEST_DONE ? SIM_OK : session_complain(s);
    }
    return result;
}
