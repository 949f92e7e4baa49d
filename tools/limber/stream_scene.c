/* stream_scene.c - see stream_scene.h. */
#include "stream_scene.h"

#include "progress.h"

enum { LOOK_US = 200000 };

static bool is_off(const stream_scene *o)
{
    return o == NULL || o->path == NULL;
}

static int read_file(stream_scene *o)
{
    scene_text text;
    progress_clear();
    (void)stat(o->path,
               &o->read); /* before it is read: who saves it meanwhile is heard the next time */
    const int result = scene_text_read_ini(o->path, &text);
    if (result == SIM_OK) {
        o->text = text;
    }
    return result;
}

int stream_scene_open(stream_scene *o, const char *path)
{
    *o = (stream_scene){.path = path, .next = SCENE_OBJECTS_MAX};
    return path == NULL ? SIM_OK : read_file(o);
}

/* The object of a place, in the poses' world. */
static scene_object object_in(const stream_scene *o, int place, const double origin_m[3])
{
    if (place >= o->text.objects_n) {
        return (scene_object){.kind = SCENE_NONE};
    }
    scene_object object = o->text.objects[place].object;
    object.place_m = (vec3){(float)((double)object.place_m.x - origin_m[0]),
                            (float)((double)object.place_m.y - origin_m[1]),
                            (float)((double)object.place_m.z - origin_m[2])};
    return object;
}

int stream_scene_begin(stream_scene *o, session *s, const double origin_m[3])
{
    if (is_off(o)) {
        return SIM_OK;
    }
    o->asked = false;
    o->next = origin_m == NULL ? 0 : SCENE_OBJECTS_MAX;
    const int result = scene_requests_known(s);
    if (result != SIM_OK || origin_m == NULL) {
        return result;
    }
    scene_text text = o->text;
    for (int i = 0; i < text.objects_n; i++) {
        text.objects[i].object = object_in(o, i, origin_m);
    }
    return scene_requests_send(s, &text);
}

static bool was_saved_again(stream_scene *o)
{
    struct stat now;
    return stat(o->path, &now) == 0 &&
           (now.st_mtim.tv_sec != o->read.st_mtim.tv_sec ||
            now.st_mtim.tv_nsec != o->read.st_mtim.tv_nsec || now.st_size != o->read.st_size ||
            now.st_ino != o->read.st_ino);
}

/* Places that become free go first, from the last on: what comes needs their time. */
static int place_of(int next)
{
    return SCENE_OBJECTS_MAX - 1 - next;
}

void stream_scene_step(stream_scene *o, session *s, const double origin_m[3])
{
    if (is_off(o) || s->lost || origin_m == NULL || s->request == REQUEST_WAITING) {
        return;
    }
    if (o->asked && s->request != REQUEST_DONE) {
        (void)session_complain(s);
        o->next = SCENE_OBJECTS_MAX;
    } else if (o->asked && ++o->next == SCENE_OBJECTS_MAX) {
        limber_note("%s: %d object%s now", o->path, o->text.objects_n,
                    o->text.objects_n == 1 ? " stands there" : "s stand there");
    }
    o->asked = false;
    const uint64_t now_us = limber_now_us();
    if (o->next == SCENE_OBJECTS_MAX && now_us - o->looked_us >= LOOK_US) {
        o->looked_us = now_us;
        if (was_saved_again(o) && read_file(o) == SIM_OK) {
            o->next = 0;
        }
    }
    if (o->next < SCENE_OBJECTS_MAX) {
        const scene_object object = object_in(o, place_of(o->next), origin_m);
        o->asked = true;
        scene_requests_ask(s, place_of(o->next), &object);
    }
}
