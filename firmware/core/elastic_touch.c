/* elastic_touch.c - see elastic_private.h: the elastic rod against objects; MODEL.md, "Touch". */
#include "elastic_private.h"

/* From link to link, from a base on. */
static void nodes_along(const elastic *model, vec3 base_m, const vec3 *link, vec3 *nodes_m)
{
    vec3 place = base_m;
    for (int i = 0; i < model->links_n; i++) {
        place = vec3_add_scaled(place, link[i], model->link[i].length_m);
        nodes_m[i] = place;
    }
}

void elastic_touch_find(const elastic *model, const elastic_state *state, const elastic_outcome *o,
                        vec3 from_m, vec3 to_m, const elastic_outside *outside,
                        touch_points *points)
{
    vec3 before_m[ROD_MAX_LINKS], after_m[ROD_MAX_LINKS];
    nodes_along(model, from_m, state->link, before_m);
    nodes_along(model, to_m, o->link, after_m);
    const touch_nodes nodes = {.nodes_n = model->links_n,
                               .step_s = 1.5f * model->h_s,
                               .h_squared_s2 = model->h_s * model->h_s,
                               .base_m = to_m,
                               .before_m = before_m,
                               .after_m = after_m,
                               .link = model->link};
    touch_find(outside->objects, outside->contacts, &nodes, points);
}

/* What is left of a motion at a point: nothing where it sticks, what goes along the surface where it slides. */
static vec3 left_of(vec3 motion, const touch_point *point)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    if (point->state == TOUCH_STICKS) {
        return NONE;
    }
    return vec3_add_scaled(motion, point->normal, -vec3_dot(motion, point->normal));
}

void elastic_touch_settle(const elastic *model, const touch_points *points, vec3 base_step_m,
                          elastic_state *state)
{
    vec3 step_m = base_step_m;              /* how far the node went */
    vec3 taken_before = {0.0f, 0.0f, 0.0f}; /* what of that the node before lost */
    int p = 0;
    for (int i = 0; i < model->links_n; i++) {
        const bending_link *row = &model->link[i];
        step_m = vec3_add_scaled(step_m, state->link_step[i], row->length_m);
        vec3 left = step_m;
        for (; p < points->points_n && points->point[p].node == i; p++) {
            const touch_point *point = &points->point[p];
            if (point->state != TOUCH_OFF) {
                left = left_of(left, point);
                state->speed_m_s[i] = left_of(state->speed_m_s[i], point);
                state->speed_step[i] = left_of(state->speed_step[i], point);
            }
        }
        const vec3 taken = vec3_sub(step_m, left);
        state->link_step[i] =
            vec3_add_scaled(state->link_step[i], vec3_sub(taken_before, taken), row->per_length);
        taken_before = taken;
    }
}
