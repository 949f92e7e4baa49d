/* scene_keys.h - the keys of things to touch, as their reader and their writer share them. */
#ifndef LIMBER_SCENE_KEYS_H
#define LIMBER_SCENE_KEYS_H

#include <stdbool.h>

#include "scene.h"

/* In the order in which they are written. */
enum {
    KEY_CENTRE = 0,
    KEY_POINT,
    KEY_NORMAL,
    KEY_FROM,
    KEY_TO,
    KEY_RADIUS,
    KEY_SIZE,
    KEY_ROUNDING,
    KEY_TURN,
    KEY_QUATERNION,
    KEY_FRICTION,
    SCENE_KEYS_N
};

typedef struct {
    const char *name;
    unsigned kinds; /* that have it: 1 << SCENE_... */
    int values_n;
    bool needed;
    double min, max; /* of each value; doubles that are what people write, not floats */
    const char *unit, *example;
} scene_key;

extern const scene_key scene_keys[SCENE_KEYS_N];

static inline bool scene_key_is_of(int key, int kind)
{
    return (scene_keys[key].kinds >> kind & 1u) != 0;
}

/* What an object has where it is not given. */
#define SCENE_FRICTION 0.3
#define SCENE_ROUNDING_M 5e-3 /* or half of the smallest edge */

/* A box's half_m from its whole edges. */
static inline vec3 scene_box_half(const double size_m[3], double rounding_m)
{
    return (vec3){(float)(0.5 * size_m[0] - rounding_m), (float)(0.5 * size_m[1] - rounding_m),
                  (float)(0.5 * size_m[2] - rounding_m)};
}

#endif
