/* base_path.c - see base_path.h. */
#include "base_path.h"

static quat quat_minus(quat a, quat b)
{
    return (quat){a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}

/* a + s b */
static quat quat_plus(quat a, quat b, float s)
{
    return (quat){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s, a.w + b.w * s};
}

/* Of the two quaternions of an orientation the one nearer to `other`. */
static quat quat_near(quat q, quat other)
{
    const float dot = q.x * other.x + q.y * other.y + q.z * other.z + q.w * other.w;
    return dot < 0.0f ? (quat){-q.x, -q.y, -q.z, -q.w} : q;
}

base_path base_path_between(const rod_pose *before, const rod_pose *from, const rod_pose *to)
{
    const quat here = from->orientation;
    const vec3 way_m = vec3_sub(to->position_m, from->position_m);
    const vec3 way_before_m = vec3_sub(from->position_m, before->position_m);
    const quat way = quat_minus(quat_near(to->orientation, here), here);
    const quat bend = quat_minus(way, quat_minus(here, quat_near(before->orientation, here)));
    return (base_path){
        from,
        way_m,
        vec3_scale(vec3_sub(way_m, way_before_m), 0.5f),
        way,
        {bend.x * 0.5f, bend.y * 0.5f, bend.z * 0.5f, bend.w * 0.5f},
    };
}

/* The quaternion cannot come near zero: of its length at the worst of turns, 0.7, the parabola takes less than half. */
rod_pose base_path_pose(const base_path *path, float share)
{
    const float bend = (share - 1.0f) * share;
    const quat q =
        quat_plus(quat_plus(path->from->orientation, path->way, share), path->half_bend, bend);
    const float scale = 1.0f / trig_sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const vec3 position_m = vec3_add_scaled(path->from->position_m, path->way_m, share);
    return (rod_pose){vec3_add_scaled(position_m, path->half_bend_m, bend),
                      {q.x * scale, q.y * scale, q.z * scale, q.w * scale}};
}
