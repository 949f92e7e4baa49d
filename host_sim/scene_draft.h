/* scene_draft.h - an object to touch while it is being read. For scene_text.c. */
#ifndef LIMBER_SCENE_DRAFT_H
#define LIMBER_SCENE_DRAFT_H

#include "scene_keys.h"
#include "scene_text.h"

/* What has been written of one object so far; every value is within its key's bounds. */
typedef struct {
    int kind;
    char name[SCENE_NAME_MAX], origin[160];
    bool written[SCENE_KEYS_N];
    int values_n[SCENE_KEYS_N];
    double values[SCENE_KEYS_N][4];
    char origins[SCENE_KEYS_N][160];
} scene_draft;

static inline vec3 scene_vector(const double *v)
{
    return (vec3){(float)v[0], (float)v[1], (float)v[2]};
}

/* The object it describes. Returns SIM_OK, or an exit code after complaining of what is missing or does not go together;
 * then *out is as it was. */
int scene_draft_finish(const scene_draft *d, scene_text_object *out);

#endif
