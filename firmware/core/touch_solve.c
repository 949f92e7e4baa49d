/* touch_solve.c - see touch.h: which contacts hold, and with what force. MODEL.md, "Touch". */
#include <string.h>

#include "touch_private.h"

/* How stiff a contact is across the surface and along it, so many times what its node is in the matrix. The force of the
 * last step does the rest, so that at rest nothing is missing. Found by trial: what goes along the surface must be
 * soft beside what goes across, or a node that sticks and a rod that is too long fight. */
static const float GRIP = 10.0f, RUB = 0.3f;
/* Another pass is worth it where what rubs changes by more than this. */
static const float SHARE_CHANGE = 0.05f;

/* What a displacement calls for: how hard the object presses, and the force along the surface that would make the node
 * stick. */
typedef struct {
    float press;
    vec3 along;
} touch_call;

static touch_call call_of(const touch_point *point, vec3 displacement_m)
{
    const vec3 n = point->normal;
    const float out = vec3_dot(n, displacement_m);
    const float held = vec3_dot(n, point->force);
    const vec3 slip = vec3_add(point->slip_m, vec3_add_scaled(displacement_m, n, -out));
    return (touch_call){
        .press = held - point->grip * (point->gap_m + out),
        .along = vec3_add_scaled(vec3_add_scaled(point->force, n, -held), slip, -point->rub),
    };
}

/* Is a neighbour further in the same object? Where several nodes have come into one, the deepest pushed out takes the
 * others with it; all pushed at once, some would have to be pulled. */
static bool is_beside_deeper(const touch_points *points, int i)
{
    const touch_point *p = points->point, *own = &points->point[i];
    for (int k = i - 1; k >= 0 && p[k].node + 1 >= own->node; k--) {
        if (p[k].object == own->object && p[k].end_m <= own->end_m) {
            return true;
        }
    }
    for (int k = i + 1; k < points->points_n && p[k].node <= own->node + 1; k++) {
        if (p[k].object == own->object && p[k].end_m < own->end_m) {
            return true;
        }
    }
    return false;
}

/* The state for the next solution: no object may pull, and along the surface it may use what lies within the cone. How hard
 * it presses is sure only where the last solution was with it; otherwise no harder than in the last step. At first,
 * what touched then does so still. Returns whether the state is another than it was. */
static bool decide(touch_points *points, int i, vec3 displacement_m, bool first)
{
    touch_point *point = &points->point[i];
    const touch_call call = call_of(point, displacement_m);
    const bool unsure = first || (point->state == TOUCH_OFF && point->pressed < call.press);
    const float most = point->friction * (unsure ? point->pressed : call.press);
    const float along_squared = vec3_dot(call.along, call.along);
    const bool stays = first && point->touched;
    uint8_t state = TOUCH_OFF;
    float share = 0.0f;
    if (stays || (call.press > 0.0f &&
                  (point->state != TOUCH_OFF || point->touched || !is_beside_deeper(points, i)))) {
        const bool sticks = along_squared <= most * most && most > 0.0f;
        state = sticks ? TOUCH_STICKS : TOUCH_SLIDES;
        share = sticks ? 1.0f : most > 0.0f ? most / trig_sqrt(along_squared) : 0.0f;
    }
    const bool changed = state != point->state || trig_abs(share - point->share) > SHARE_CHANGE;
    point->state = state;
    point->share = share;
    return changed;
}

/* All of them. */
static bool decide_all(touch_points *points, const vec3 *displacement_m, bool first)
{
    bool changed = false;
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        point->end_m = point->gap_m + vec3_dot(point->normal, displacement_m[point->node]);
    }
    for (int i = 0; i < points->points_n; i++) {
        changed = decide(points, i, displacement_m[points->point[i].node], first) || changed;
    }
    return changed;
}

/* The force of the solution. A contact that would have pulled in it is none. */
static void conclude(touch_point *point, vec3 displacement_m)
{
    const touch_call call = call_of(point, displacement_m);
    if (call.press <= 0.0f) {
        point->state = TOUCH_OFF;
    }
    point->end_m = point->gap_m + vec3_dot(point->normal, displacement_m);
    point->force = vec3_add_scaled(vec3_scale(call.along, point->share), point->normal, call.press);
}

/* The links' directions and what they have too much, linear about where the nodes stand; and the forces with their pulls. */
static void take_links(const touch_system *system, const vec3 *displacement_m, touch_links *links,
                       vec3 *force)
{
    static const vec3 Z = {0.0f, 0.0f, 1.0f};
    vec3 before = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < system->nodes_n; i++) {
        const vec3 gain = vec3_sub(displacement_m[i], before);
        const bending_link *own = &system->link[i];
        const vec3 link = vec3_add_scaled(system->along[i], gain, own->per_length);
        const float length = trig_sqrt(vec3_dot(link, link));
        const vec3 unit = length > 1e-3f ? vec3_scale(link, 1.0f / length) : Z;
        const float excess_m = (length - 1.0f) * own->length_m - vec3_dot(unit, gain);
        const vec3 pull = vec3_scale(unit, links->hold[i] * excess_m);
        force[i] = vec3_sub(system->force[i], pull);
        if (i > 0) {
            force[i - 1] = vec3_add(force[i - 1], pull);
        }
        links->unit[i] = unit;
        links->excess_m[i] = excess_m;
        before = displacement_m[i];
    }
}

bool touch_solve(const touch_system *system, touch_points *points, vec3 *displacement_m,
                 float *tension)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const int n = system->nodes_n;
    touch_links links;
    for (int i = 0; i < n; i++) {
        links.hold[i] = system->hold * system->diagonal[i];
        displacement_m[i] = NONE;
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        point->grip = GRIP * system->diagonal[point->node];
        point->rub = RUB * system->diagonal[point->node];
    }
    (void)decide_all(points, displacement_m, true);
    bool again = true;
    for (int pass = 1; again; pass++) {
        vec3 b[ROD_MAX_LINKS];
        take_links(system, displacement_m, &links, b);
        if (!touch_solve_blocks(system, points, &links, b)) {
            return false;
        }
        memcpy(displacement_m, b, (size_t)n * sizeof *b);
        again = pass < TOUCH_PASSES_MAX && decide_all(points, displacement_m, false);
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        conclude(point, displacement_m[point->node]);
    }
    vec3 before = NONE;
    for (int i = 0; i < n; i++) {
        const vec3 gain = vec3_sub(displacement_m[i], before);
        tension[i] += links.hold[i] * (links.excess_m[i] + vec3_dot(links.unit[i], gain));
        before = displacement_m[i];
    }
    return true;
}

bool touch_blow(const touch_system *system, touch_points *points, const vec3 *moving_m,
                vec3 *change_m)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const int n = system->nodes_n;
    touch_links links;
    for (int i = 0; i < n; i++) {
        links.hold[i] = system->hold * system->diagonal[i];
        change_m[i] = NONE;
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        const vec3 moving = moving_m[point->node];
        point->force = NONE;
        point->gap_m = vec3_dot(point->normal, moving);
        point->slip_m = vec3_add_scaled(moving, point->normal, -point->gap_m);
    }
    vec3 b[ROD_MAX_LINKS];
    take_links(system, change_m, &links, b);
    memcpy(change_m, b, (size_t)n * sizeof *b);
    return touch_solve_blocks(system, points, &links, change_m);
}
