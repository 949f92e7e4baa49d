/* vec.h - the few pieces of 3-D geometry the rod needs, in float32.
 *
 * Right-handed axes, metres. Quaternions are Hamilton, body -> world, stored x y z w, and of unit
 * length: every function here relies on that, none restores it. All functions are pure, inline,
 * free of division and square root unless their comment says so, and may be called anywhere.
 */
#ifndef LIMBER_VEC_H
#define LIMBER_VEC_H

typedef struct {
    float x, y, z;
} vec3;

typedef struct {
    float x, y, z, w;
} quat;

/* Three orthogonal unit axes, given in the parent's coordinates: the columns of a rotation. */
typedef struct {
    vec3 x, y, z;
} frame3;

static inline vec3 vec3_add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 vec3_sub(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 vec3_scale(vec3 a, float s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

/* a + s b */
static inline vec3 vec3_add_scaled(vec3 a, vec3 b, float s)
{
    return (vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static inline float vec3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline quat quat_conjugate(quat q)
{
    return (quat){-q.x, -q.y, -q.z, q.w};
}

/* a after b: the rotation that first applies b, then a. */
static inline quat quat_multiply(quat a, quat b)
{
    return (quat){
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    };
}

/* How far the rotation q moves v: q v q* - v. Keeps its digits when q is close to no rotation,
 * which is what a hand does between two ticks. */
static inline vec3 quat_displacement(quat q, vec3 v)
{
    const vec3 axis = {q.x, q.y, q.z};
    const vec3 once = vec3_cross(axis, v);
    const vec3 twice = vec3_cross(axis, once);
    return (vec3){
        2.0f * (q.w * once.x + twice.x),
        2.0f * (q.w * once.y + twice.y),
        2.0f * (q.w * once.z + twice.z),
    };
}

static inline vec3 quat_rotate(quat q, vec3 v)
{
    return vec3_add(v, quat_displacement(q, v));
}

static inline frame3 quat_frame(quat q)
{
    return (frame3){
        quat_rotate(q, (vec3){1.0f, 0.0f, 0.0f}),
        quat_rotate(q, (vec3){0.0f, 1.0f, 0.0f}),
        quat_rotate(q, (vec3){0.0f, 0.0f, 1.0f}),
    };
}

/* A vector given in the frame's axes, in the parent's. */
static inline vec3 frame3_to_parent(const frame3 *f, vec3 v)
{
    return (vec3){
        f->x.x * v.x + f->y.x * v.y + f->z.x * v.z,
        f->x.y * v.x + f->y.y * v.y + f->z.y * v.z,
        f->x.z * v.x + f->y.z * v.y + f->z.z * v.z,
    };
}

/* A vector given in the parent's axes, in the frame's own. */
static inline vec3 frame3_from_parent(const frame3 *f, vec3 v)
{
    return (vec3){vec3_dot(f->x, v), vec3_dot(f->y, v), vec3_dot(f->z, v)};
}

#endif
