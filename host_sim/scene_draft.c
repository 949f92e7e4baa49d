/* scene_draft.c - see scene_draft.h: from keys in people's terms to what the rod asks of an object. */
#include "scene_draft.h"

#include <math.h>
#include <string.h>

#include "sim.h"

static int check_whole(const scene_draft *d)
{
    for (int i = 0; i < SCENE_KEYS_N; i++) {
        const scene_key *const k = &scene_keys[i];
        if (!scene_key_is_of(i, d->kind)) {
            continue;
        }
        if (!d->written[i] && k->needed) {
            return sim_complain("%s: %s '%s' has no %s; give %s = %s", d->origin,
                                scene_kinds[d->kind], d->name, k->name, k->name, k->example);
        }
        if (d->written[i] && d->values_n[i] < k->values_n) {
            return sim_complain("%s: %s has %d value%s and needs %d, as in %s = %s", d->origins[i],
                                k->name, d->values_n[i], d->values_n[i] == 1 ? "" : "s",
                                k->values_n, k->name, k->example);
        }
    }
    if (d->written[KEY_TURN] && d->written[KEY_QUATERNION]) {
        return sim_complain("%s: %s '%s' has a turn and a quaternion; give one of them",
                            d->origins[KEY_QUATERNION], scene_kinds[d->kind], d->name);
    }
    return SIM_OK;
}

static double norm(const double *v, int n)
{
    double squares = 0.0;
    for (int i = 0; i < n; i++) {
        squares += v[i] * v[i];
    }
    return sqrt(squares);
}

/* Of unit length to a float's digits already: taken as it is, so that what was written reads back the same. */
static quat unit(const double q[4])
{
    const double length = norm(q, 4), per_length = fabs(length - 1.0) < 5e-7 ? 1.0 : 1.0 / length;
    return (quat){(float)(q[0] * per_length), (float)(q[1] * per_length),
                  (float)(q[2] * per_length), (float)(q[3] * per_length)};
}

/* The shortest way from +z to a direction of unit length. */
static quat up_turned_to(const double direction[3])
{
    if (direction[2] < -1.0 + 1e-12) {
        return (quat){1.0f, 0.0f, 0.0f, 0.0f};
    }
    const double w = sqrt(0.5 * (1.0 + direction[2]));
    return unit((const double[]){-0.5 * direction[1] / w, 0.5 * direction[0] / w, 0.0, w});
}

/* About the world's x, then its y, then its z. */
static quat turned(const double degrees[3])
{
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin(degrees[i] * M_PI / 360.0);
        c[i] = cos(degrees[i] * M_PI / 360.0);
    }
    return unit((const double[]){
        s[0] * c[1] * c[2] - c[0] * s[1] * s[2], c[0] * s[1] * c[2] + s[0] * c[1] * s[2],
        c[0] * c[1] * s[2] - s[0] * s[1] * c[2], c[0] * c[1] * c[2] + s[0] * s[1] * s[2]});
}

static int stand_plane(const scene_draft *d, scene_object *o)
{
    const double *normal = d->values[KEY_NORMAL];
    const double length = norm(normal, 3);
    if (length < 1e-3) {
        return sim_complain("%s: normal has no direction; give one out of the solid, as in 0, 0, 1",
                            d->origins[KEY_NORMAL]);
    }
    o->place_m = scene_vector(d->values[KEY_POINT]);
    o->orientation =
        up_turned_to((const double[]){normal[0] / length, normal[1] / length, normal[2] / length});
    return SIM_OK;
}

static int stand_sphere(const scene_draft *d, scene_object *o)
{
    o->place_m = scene_vector(d->values[KEY_CENTRE]);
    o->radius_m = (float)d->values[KEY_RADIUS][0];
    return SIM_OK;
}

static int stand_capsule(const scene_draft *d, scene_object *o)
{
    const double *from = d->values[KEY_FROM], *to = d->values[KEY_TO];
    const double way[] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = norm(way, 3), longest = 2.0 * (double)SCENE_SIZE_MAX_M;
    if (!(length >= 1e-3 && length <= longest)) {
        return sim_complain("%s: from and to are %g m apart, must be 0.001 ... %g m%s",
                            d->origins[KEY_TO], length, longest,
                            length < 1e-3 ? "; a capsule of no length is a sphere" : "");
    }
    o->place_m = scene_vector((const double[]){0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]),
                                               0.5 * (from[2] + to[2])});
    o->orientation =
        up_turned_to((const double[]){way[0] / length, way[1] / length, way[2] / length});
    o->half_m.z = (float)(0.5 * length);
    o->radius_m = (float)d->values[KEY_RADIUS][0];
    return SIM_OK;
}

static int stand_box(const scene_draft *d, scene_object *o)
{
    const double *size = d->values[KEY_SIZE];
    const double most = 0.5 * fmin(size[0], fmin(size[1], size[2]));
    const double rounding =
        d->written[KEY_ROUNDING] ? d->values[KEY_ROUNDING][0] : fmin(SCENE_ROUNDING_M, most);
    if (rounding > most) {
        return sim_complain("%s: rounding = %g: out of bounds, must be 0.001 ... %g m, half of the "
                            "smallest edge",
                            d->origins[KEY_ROUNDING], rounding, most);
    }
    o->place_m = scene_vector(d->values[KEY_CENTRE]);
    o->half_m = scene_box_half(size, rounding);
    o->radius_m = (float)rounding;
    if (d->written[KEY_QUATERNION]) {
        const double *q = d->values[KEY_QUATERNION];
        if (norm(q, 4) < 0.1) {
            return sim_complain("%s: the quaternion's length is %g, must be about 1; 0, 0, 0, 1 "
                                "is no turn",
                                d->origins[KEY_QUATERNION], norm(q, 4));
        }
        o->orientation = unit(q);
    } else {
        o->orientation = turned(d->values[KEY_TURN]); /* 0, 0, 0 where it is not given */
    }
    return SIM_OK;
}

int scene_draft_finish(const scene_draft *d, scene_text_object *out)
{
    static int (*const STAND[SCENE_KINDS_N])(const scene_draft *,
                                             scene_object *) = {[SCENE_PLANE] = stand_plane,
                                                                [SCENE_SPHERE] = stand_sphere,
                                                                [SCENE_CAPSULE] = stand_capsule,
                                                                [SCENE_BOX] = stand_box};
    scene_text_object made = {.object = {.kind = d->kind, .orientation.w = 1.0f}};
    memcpy(made.name, d->name, sizeof made.name);
    made.object.friction =
        d->written[KEY_FRICTION] ? (float)d->values[KEY_FRICTION][0] : (float)SCENE_FRICTION;
    int result = check_whole(d);
    if (result == SIM_OK) {
        result = STAND[d->kind](d, &made.object);
    }
    scene_refusal why;
    if (result == SIM_OK && scene_check(&made.object, &why) != ROD_OK) {
        result =
            sim_give_up("%s: the rod refuses a %s that has been checked", d->origin, why.field);
    }
    if (result == SIM_OK) {
        *out = made;
    }
    return result;
}
