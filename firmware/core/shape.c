/* shape.c - see shape.h. */
#include "shape.h"

#include <string.h>

static bool is_good(const rod_joint *angle_rad, int links_n, float strength_nm, float blend_s)
{
    bool good = strength_nm >= 0.0f && strength_nm <= ROD_SHAPE_STRENGTH_MAX_NM &&
                blend_s >= 0.0f && blend_s <= ROD_SHAPE_BLEND_MAX_S;
    for (int i = 0; good && angle_rad != NULL && i < links_n; i++) {
        good = trig_abs(angle_rad[i][ROD_THETA]) <= TRIG_PI &&
               trig_abs(angle_rad[i][ROD_PHI]) <= TRIG_PI;
    }
    return good; /* each comparison fails for NaN */
}

rod_error shape_set(shape *s, const rod_joint *angle_rad, const rod_joint *standing_rad,
                    int links_n, float strength_nm, float blend_s, float tick_s)
{
    if (!is_good(angle_rad, links_n, strength_nm, blend_s)) {
        return ROD_E_SHAPE;
    }
    const size_t bytes = (size_t)links_n * sizeof *angle_rad;
    const bool none = angle_rad == NULL || !(strength_nm > 0.0f);
    if (!(s->strength_nm > 0.0f)) {
        memcpy(s->angle_rad, standing_rad, bytes);
    }
    memcpy(s->goal_rad, none ? (const rod_joint *)s->angle_rad : angle_rad, bytes);
    s->goal_nm = none ? 0.0f : strength_nm;
    s->ticks_left = (int)(blend_s / tick_s) + 1;
    return ROD_OK;
}

bool shape_advance(shape *s, int links_n)
{
    if (s->ticks_left == 0) {
        return false;
    }
    const float strength_nm = s->strength_nm;
    const float share = 1.0f / (float)s->ticks_left;
    for (int i = 0; i < links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            s->angle_rad[i][axis] += (s->goal_rad[i][axis] - s->angle_rad[i][axis]) * share;
        }
    }
    s->ticks_left--;
    s->strength_nm =
        s->ticks_left == 0 ? s->goal_nm : strength_nm + (s->goal_nm - strength_nm) * share;
    return s->strength_nm < strength_nm || s->strength_nm > strength_nm;
}

void shape_links(const shape *s, int links_n, vec3 *link)
{
    frame3 frame = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    for (int i = 0; i < links_n; i++) {
        const joint_trig t = kinematics_trig(s->angle_rad[i]);
        frame = kinematics_turn(&frame, &t);
        link[i] = frame.z;
    }
}
