/* scene.h - what stands in the rod's way: up to eight convex objects in the world.
 *
 * A sphere, a capsule and a box are one thing: a box of half_m within its own axes, rounded off by radius_m all
 * round. A sphere has no half_m, a capsule only half_m.z; a box's edges are rounded by radius_m, which is
 * part of its size: it reaches half_m + radius_m from its centre. A plane is a half-space: everything below
 * its own z = 0 is solid.
 *
 *     static scene table;                          // caller-owned; all zero is an empty scene
 *     scene_put(&table, 0, &(scene_object){.kind = SCENE_SPHERE, .place_m = {0, 0, 0.5f}, ...}, NULL);
 *     rod_set_scene(&rod, &table);
 *
 * SI units, world axes. Plain data and pure functions; a scene must not be stepped through and changed at once.
 * Every gap costs about 60 instructions; nothing depends on where things are but which of two branches it takes.
 */
#ifndef LIMBER_SCENE_H
#define LIMBER_SCENE_H

#include "kinematics.h"
#include "rod_params.h"

enum { SCENE_OBJECTS_MAX = 8 };

enum { SCENE_NONE = 0, SCENE_PLANE, SCENE_SPHERE, SCENE_CAPSULE, SCENE_BOX, SCENE_KINDS_N };

/* Names of the kinds: "none", "plane", ... */
extern const char *const scene_kinds[SCENE_KINDS_N];

typedef struct {
    int32_t kind; /* SCENE_...; NONE: the place is free, and the rest is ignored */
    vec3 place_m; /* the centre; of a plane any point of its surface */
    quat
        orientation; /* object -> world, unit length: a plane's free side is its +z, a capsule lies along its z */
    vec3
        half_m; /* capsule: z is half the way between its ends' centres; box: half its edges, without the
                         rounding. What a kind does not use must be 0. */
    float radius_m; /* sphere, capsule; box: the rounding; plane: 0 */
    float friction; /* Coulomb's mu between it and the rod */
} scene_object;

/* Bounds of the above: place within +-SCENE_PLACE_MAX_M, half_m to SCENE_SIZE_MAX_M, radius_m from SCENE_RADIUS_MIN_M
 * to SCENE_SIZE_MAX_M, friction to SCENE_FRICTION_MAX. */
#define SCENE_PLACE_MAX_M 1000.0f
#define SCENE_SIZE_MAX_M 1000.0f
#define SCENE_RADIUS_MIN_M 1e-3f
#define SCENE_FRICTION_MAX 10.0f

/* Where and why an object was refused. */
typedef struct {
    rod_error error;
    const char
        *field; /* "kind", "place", "orientation", "half", "radius", "friction"; NULL for ROD_OK */
    int axis;   /* 0 ... 2 of place and half; -1 otherwise */
    float value, min, max;
} scene_refusal;

/* An object as the rod asks it. */
typedef struct {
    scene_object object;
    frame3 axes; /* of the object, in the world */
} scene_body;

typedef struct {
    scene_body body[SCENE_OBJECTS_MAX];
} scene;

/* How far a point is from an object (negative: inside), and the way out, of unit length. */
typedef struct {
    float gap_m;
    vec3 normal;
} scene_gap;

/* ROD_OK, or ROD_E_OBJECT with *refusal filled (which may be NULL). */
rod_error scene_check(const scene_object *object, scene_refusal *refusal);

/* Puts an object in place `index` (0 ... SCENE_OBJECTS_MAX - 1, else ROD_E_OBJECT), instead of what is there. On
 * an error nothing has changed. The orientation is normalised. */
rod_error scene_put(scene *s, int index, const scene_object *object, scene_refusal *refusal);

/* Objects in it. */
int scene_objects_n(const scene *s);

/* From a point to a body that is not NONE. About 110 instructions. */
scene_gap scene_gap_to(const scene_body *body, vec3 point_m);

/* From many points, only how far: about 50 instructions each. */
void scene_gaps_m(const scene_body *body, const vec3 *points_m, int points_n, float *gaps_m);

#endif
