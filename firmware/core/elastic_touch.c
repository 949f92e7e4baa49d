/* elastic_touch.c - see elastic_private.h: the elastic rod against objects; MODEL.md, "Touch". */
#include <string.h>

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

/* Without what BDF2 remembers of how the speeds came about: as if they had always been so. */
static void forget(const elastic *model, vec3 base_step_m, elastic_state *state)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const float step_s = 1.5f * model->h_s;
    vec3 before_m = base_step_m;
    for (int i = 0; i < model->links_n; i++) {
        const vec3 step_m = vec3_scale(state->speed_m_s[i], step_s);
        state->link_step[i] = vec3_scale(vec3_sub(step_m, before_m), model->link[i].per_length);
        state->speed_step[i] = NONE;
        state->tension_step[i] = 0.0f;
        before_m = step_m;
    }
}

static bool is_blow(const touch_points *points)
{
    for (int i = 0; i < points->points_n; i++) {
        if (points->point[i].state != TOUCH_OFF && !points->point[i].touched) {
            return true;
        }
    }
    return false;
}

void elastic_touch_settle(const elastic *model, const bending_bands *bands, touch_points *points,
                          vec3 base_step_m, elastic_state *state)
{
    if (!is_blow(points)) {
        return;
    }
    const int n = model->links_n;
    vec3 none[ROD_MAX_LINKS], moving_m[ROD_MAX_LINKS], change_m[ROD_MAX_LINKS];
    memset(none, 0, sizeof none);
    for (int i = 0; i < n; i++) {
        moving_m[i] = vec3_scale(state->speed_m_s[i], model->h_s);
    }
    const touch_system system = {.nodes_n = n,
                                 .diagonal = bending_diagonal(bands),
                                 .off1 = bending_off1(bands),
                                 .off2 = bands->off2,
                                 .link = model->link,
                                 .hold = ELASTIC_LENGTH_HOLD,
                                 .force = none,
                                 .along = state->link};
    if (touch_blow(&system, points, moving_m, change_m)) {
        for (int i = 0; i < n; i++) {
            state->speed_m_s[i] = vec3_add_scaled(state->speed_m_s[i], change_m[i], model->per_h);
        }
    }
    forget(model, base_step_m, state);
}
