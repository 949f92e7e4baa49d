/* stream_scene.h - objects for the rod to touch while poses stream, from a file that is read again when it changes.
 *
 *     stream_scene_open(&o, path)               before the device is asked anything
 *     stream_scene_begin(&o, &s, origin_m)      a session has begun: all of them, and no others
 *     stream_scene_step(&o, &s, origin_m)       often: what has changed since, one request at a time
 *
 * origin_m is where the poses' world begins in the file's; NULL while that is not known: then all waits for it. A
 * scene of NULL, or one whose path was NULL, does nothing.
 */
#ifndef LIMBER_STREAM_SCENE_H
#define LIMBER_STREAM_SCENE_H

#include <sys/stat.h>

#include "scene_requests.h"

typedef struct {
    const char *path; /* borrowed */
    scene_text text;
    struct stat read; /* of the file, as it was read last */
    uint64_t looked_us;
    bool asked; /* for the one that is next */
    int next; /* place to be filled or cleared, counted from the last; SCENE_OBJECTS_MAX: all are done */
} stream_scene;

/* SIM_OK, or SIM_BAD_INPUT after complaining. */
int stream_scene_open(stream_scene *o, const char *path);

/* SIM_OK, or LIMBER_DEVICE after complaining. */
int stream_scene_begin(stream_scene *o, session *s, const double origin_m[3]);

/* What is wrong with the file, or refused, is told; the stream goes on. */
void stream_scene_step(stream_scene *o, session *s, const double origin_m[3]);

#endif
