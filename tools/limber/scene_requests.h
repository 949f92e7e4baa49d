/* scene_requests.h - the device's scene, object by object: for limber scene, limber info and limber stream. */
#ifndef LIMBER_SCENE_REQUESTS_H
#define LIMBER_SCENE_REQUESTS_H

#include "scene_text.h"
#include "session.h"

/* SIM_OK, or LIMBER_DEVICE after complaining: the device is older than scenes and shapes. */
int scene_requests_known(const session *s);

/* One place, from 0. Each returns SIM_OK, or LIMBER_DEVICE after complaining. */
int scene_requests_get(session *s, int index, message_scene_object *object);
int scene_requests_put(session *s, int index, const scene_object *object);

/* The same without waiting: the request's fate is in s->request. */
void scene_requests_ask(session *s, int index, const scene_object *object);

/* As scene.h has it. */
scene_object scene_requests_object(const message_scene_object *object);

/* How many objects there are; -1 for a device that is older than scenes. */
int scene_requests_count(session *s, int *objects_n);

/* The device's scene is this one: places that it leaves free are cleared first. A refusal names the object; those
 * before it are there by then. */
int scene_requests_send(session *s, const scene_text *text);

/* No object stands anywhere. */
int scene_requests_clear(session *s);

#endif
