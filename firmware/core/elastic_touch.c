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

/* How stiff a link is along itself, so many times what its node is in the matrix: what sticks and a rod that is too long
 * would fight if lengths came after contacts alone. */
static const float LENGTH_HOLD = 100.0f;

static touch_system system_of(const elastic *model, const bending_bands *bands, const vec3 *force,
                              const vec3 *along)
{
    return (touch_system){.nodes_n = model->links_n,
                          .diagonal = bending_diagonal(bands),
                          .off1 = bending_off1(bands),
                          .off2 = bands->off2,
                          .link = model->link,
                          .hold = LENGTH_HOLD,
                          .force = force,
                          .along = along};
}

bool elastic_touch_solve(const elastic *model, const bending_bands *bands, touch_points *points,
                         elastic_outcome *o)
{
    vec3 displacement_m[ROD_MAX_LINKS];
    float tension[ROD_MAX_LINKS];
    const size_t n = (size_t)model->links_n;
    memcpy(tension, o->tension, n * sizeof *tension);
    const touch_system system = system_of(model, bands, o->node, o->link);
    const bool solved = touch_solve(&system, points, displacement_m, tension);
    if (solved) {
        memcpy(o->node, displacement_m, n * sizeof *displacement_m);
        memcpy(o->tension, tension, n * sizeof *tension);
    }
    return solved;
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
    vec3 none[ROD_MAX_LINKS], moving_m[ROD_MAX_LINKS], change_m[ROD_MAX_LINKS];
    memset(none, 0, sizeof none);
    memset(moving_m, 0, sizeof moving_m);
    for (int i = 0; i < model->links_n; i++) {
        moving_m[i] = vec3_scale(state->speed_m_s[i], model->h_s);
    }
    const touch_system system = system_of(model, bands, none, state->link);
    if (touch_blow(&system, points, moving_m, change_m)) {
        for (int i = 0; i < model->links_n; i++) {
            state->speed_m_s[i] = vec3_add_scaled(state->speed_m_s[i], change_m[i], model->per_h);
        }
    }
    forget(model, base_step_m, state);
}
