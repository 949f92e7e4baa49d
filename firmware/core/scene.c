/* scene.c - see scene.h. */
#include "scene.h"

#include <stddef.h>

const char *const scene_kinds[SCENE_KINDS_N] = {"none", "plane", "sphere", "capsule", "box"};

/* --- what is a good object ----------------------------------------------------------------------- */

/* How many of half_m's axes a kind has, counted from z, and whether it has a radius. */
static const struct {
    uint8_t halves_n;
    bool round;
} SHAPES[SCENE_KINDS_N] = {
    [SCENE_SPHERE] = {0, true}, [SCENE_CAPSULE] = {1, true}, [SCENE_BOX] = {3, true}};

static bool is_within(scene_refusal *why, const char *field, int axis, float value, float min,
                      float max)
{
    if (value >= min && value <= max) { /* NaN is not */
        return true;
    }
    *why = (scene_refusal){ROD_E_OBJECT, field, axis, value, min, max};
    return false;
}

static bool is_good(const scene_object *o, scene_refusal *why)
{
    if (!is_within(why, "kind", -1, (float)o->kind, 0.0f, (float)(SCENE_KINDS_N - 1))) {
        return false;
    }
    if (o->kind == SCENE_NONE) {
        return true;
    }
    const float place[] = {o->place_m.x, o->place_m.y, o->place_m.z};
    const float half[] = {o->half_m.x, o->half_m.y, o->half_m.z};
    for (int axis = 0; axis < 3; axis++) {
        const float most = axis >= 3 - SHAPES[o->kind].halves_n ? SCENE_SIZE_MAX_M : 0.0f;
        if (!is_within(why, "place", axis, place[axis], -SCENE_PLACE_MAX_M, SCENE_PLACE_MAX_M) ||
            !is_within(why, "half", axis, half[axis], 0.0f, most)) {
            return false;
        }
    }
    const quat q = o->orientation;
    const float norm = trig_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const bool round = SHAPES[o->kind].round;
    return is_within(why, "orientation", -1, norm, 0.99f, 1.01f) &&
           is_within(why, "radius", -1, o->radius_m, round ? SCENE_RADIUS_MIN_M : 0.0f,
                     round ? SCENE_SIZE_MAX_M : 0.0f) &&
           is_within(why, "friction", -1, o->friction, 0.0f, SCENE_FRICTION_MAX);
}

rod_error scene_check(const scene_object *object, scene_refusal *refusal)
{
    scene_refusal why = {.error = ROD_OK, .field = NULL, .axis = -1};
    const rod_error error = is_good(object, &why) ? ROD_OK : ROD_E_OBJECT;
    if (refusal != NULL) {
        *refusal = why;
    }
    return error;
}

rod_error scene_put(scene *s, int index, const scene_object *object, scene_refusal *refusal)
{
    const rod_error error = scene_check(object, refusal);
    if (error != ROD_OK) {
        return error;
    }
    if (index < 0 || index >= SCENE_OBJECTS_MAX) {
        if (refusal != NULL) {
            *refusal = (scene_refusal){ROD_E_OBJECT, "index", -1,
                                       (float)index, 0.0f,    (float)(SCENE_OBJECTS_MAX - 1)};
        }
        return ROD_E_OBJECT;
    }
    scene_body body = {.object = {.kind = SCENE_NONE, .orientation = {0.0f, 0.0f, 0.0f, 1.0f}}};
    if (object->kind != SCENE_NONE) {
        quat *q = &body.object.orientation;
        body.object = *object;
        const float per_norm =
            1.0f / trig_sqrt(q->x * q->x + q->y * q->y + q->z * q->z + q->w * q->w);
        *q = (quat){q->x * per_norm, q->y * per_norm, q->z * per_norm, q->w * per_norm};
    }
    body.axes = quat_frame(body.object.orientation);
    s->body[index] = body;
    return ROD_OK;
}

int scene_objects_n(const scene *s)
{
    int objects_n = 0;
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        objects_n += s->body[i].object.kind != SCENE_NONE ? 1 : 0;
    }
    return objects_n;
}

/* --- how far -------------------------------------------------------------------------------------- */

/* So near to the box within an object (m^2) a way out of it is not known in float32; the nearest face's serves. */
static const float WITHIN_M2 = 1e-12f;

static float beyond(float place, float half)
{
    return place > half ? place - half : place < -half ? place + half : 0.0f;
}

static float positive(float x)
{
    return x > 0.0f ? x : 0.0f;
}

/* From the faces of the box within, seen from inside: the nearest. */
static float depth(float x, float y, float z)
{
    const float nearer = x > y ? x : y;
    return nearer > z ? nearer : z;
}

static vec3 along(vec3 axis, float place)
{
    return vec3_scale(axis, place < 0.0f ? -1.0f : 1.0f);
}

scene_gap scene_gap_to(const scene_body *body, vec3 point_m)
{
    const scene_object *o = &body->object;
    const frame3 *axes = &body->axes;
    const vec3 offset = vec3_sub(point_m, o->place_m);
    if (o->kind == SCENE_PLANE) {
        return (scene_gap){vec3_dot(axes->z, offset), axes->z};
    }
    const vec3 p = frame3_from_parent(axes, offset);
    const vec3 out = {beyond(p.x, o->half_m.x), beyond(p.y, o->half_m.y), beyond(p.z, o->half_m.z)};
    const float squared = vec3_dot(out, out);
    if (squared >= WITHIN_M2) {
        const float distance = trig_sqrt(squared);
        return (scene_gap){distance - o->radius_m,
                           frame3_to_parent(axes, vec3_scale(out, 1.0f / distance))};
    }
    const float x = trig_abs(p.x) - o->half_m.x, y = trig_abs(p.y) - o->half_m.y,
                z = trig_abs(p.z) - o->half_m.z;
    const float nearest = depth(x, y, z);
    return (scene_gap){nearest - o->radius_m, nearest <= z   ? along(axes->z, p.z)
                                              : nearest <= y ? along(axes->y, p.y)
                                                             : along(axes->x, p.x)};
}

void scene_gaps_m(const scene_body *body, const vec3 *points_m, int points_n, float *gaps_m)
{
    const frame3 axes = body->axes; /* copies: gaps_m might be anything to the compiler */
    const vec3 place = body->object.place_m, half = body->object.half_m;
    const float radius = body->object.radius_m;
    if (body->object.kind == SCENE_PLANE) {
        for (int i = 0; i < points_n; i++) {
            gaps_m[i] = vec3_dot(axes.z, vec3_sub(points_m[i], place));
        }
        return;
    }
    for (int i = 0; i < points_n; i++) {
        const vec3 p = frame3_from_parent(&axes, vec3_sub(points_m[i], place));
        const float x = trig_abs(p.x) - half.x, y = trig_abs(p.y) - half.y,
                    z = trig_abs(p.z) - half.z;
        const vec3 out = {positive(x), positive(y), positive(z)};
        const float squared = vec3_dot(out, out);
        gaps_m[i] = (squared >= WITHIN_M2 ? trig_sqrt(squared) : depth(x, y, z)) - radius;
    }
}
