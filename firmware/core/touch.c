/* touch.c - see touch.h: which nodes may touch, and what is remembered of it. */
#include "touch.h"

/* Two neighbours whose ways out are further apart than this cosine have the object between them. */
static const float THROUGH_COSINE = -0.5f;
/* Deep is further inside than this share of a link. */
static const float DEEP_LINKS = 0.1f;

/* What the last step knows of a point. Contacts are in the order of their nodes: *next is where to go on looking. */
static void recall(const touch_contacts *last, int *next, float h_squared_s2, touch_point *point)
{
    const int node = (int)point->node + 1;
    while (*next < last->contacts_n && (int)last->contact[*next].node < node) {
        ++*next;
    }
    for (int i = *next; i < last->contacts_n && (int)last->contact[i].node == node; i++) {
        if (last->contact[i].object == point->object) {
            point->touched = true;
            point->held = vec3_scale(last->contact[i].force_newton, h_squared_s2);
        }
    }
}

/* The node at a gap from an object; gap_before_m: where the step began, as far as the gap's normal tells. */
static touch_point make_point(const touch_nodes *nodes, int node, int object, float friction,
                              scene_gap gap, float gap_before_m)
{
    const vec3 moved = vec3_sub(nodes->after_m[node], nodes->before_m[node]);
    const float out = gap_before_m + nodes->step_s * TOUCH_ESCAPE_M_S;
    const float let = out < 0.0f ? out : 0.0f;
    return (touch_point){
        .normal = gap.normal,
        .gap_m = gap.gap_m - let,
        .let_m = let,
        .slip_m = vec3_add_scaled(moved, gap.normal, gap_before_m - gap.gap_m),
        .friction = friction,
        .node = (uint8_t)node,
        .object = (uint8_t)object,
        .state = TOUCH_OFF,
    };
}

/* The nearer two of those so far and one more. */
static int take_nearer(touch_point mine[2], int mine_n, const touch_point *point)
{
    if (mine_n < 2) {
        mine[mine_n] = *point;
        return mine_n + 1;
    }
    touch_point *farther = &mine[mine[0].gap_m > mine[1].gap_m ? 0 : 1];
    if (farther->gap_m > point->gap_m) {
        *farther = *point;
    }
    return 2;
}

void touch_find(const scene *objects, const touch_contacts *last, const touch_nodes *nodes,
                touch_points *points)
{
    scene_gap
        before[SCENE_OBJECTS_MAX]; /* the node before, from each object, where the step began */
    int next = 0;
    points->points_n = 0;
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        if (objects->body[i].object.kind != SCENE_NONE) {
            before[i] = scene_gap_to(&objects->body[i], nodes->base_m);
        }
    }
    for (int node = 0; node < nodes->nodes_n; node++) {
        touch_point *mine = &points->point[points->points_n];
        const float length_m = nodes->link[node].length_m;
        const vec3 moved = vec3_sub(nodes->after_m[node], nodes->before_m[node]);
        int mine_n = 0;
        for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
            const scene_body *body = &objects->body[i];
            if (body->object.kind == SCENE_NONE) {
                continue;
            }
            const scene_gap gap = scene_gap_to(body, nodes->after_m[node]);
            const float gap_before_m = gap.gap_m - vec3_dot(gap.normal, moved);
            const bool let_go = before[i].gap_m < -DEEP_LINKS * length_m ||
                                (before[i].gap_m < length_m &&
                                 vec3_dot(before[i].normal, gap.normal) < THROUGH_COSINE);
            before[i] = (scene_gap){gap_before_m, gap.normal};
            if (gap.gap_m <= length_m && !let_go) {
                const touch_point point =
                    make_point(nodes, node, i, body->object.friction, gap, gap_before_m);
                mine_n = take_nearer(mine, mine_n, &point);
            }
        }
        for (int i = 0; i < mine_n; i++) {
            recall(last, &next, nodes->h_squared_s2, &mine[i]);
        }
        points->points_n += mine_n;
    }
}

void touch_remember(const touch_points *points, float h_squared_s2, touch_contacts *contacts)
{
    const float per_h_squared = 1.0f / h_squared_s2;
    contacts->contacts_n = 0;
    for (int i = 0; i < points->points_n; i++) {
        const touch_point *point = &points->point[i];
        if (point->state != TOUCH_OFF) {
            contacts->contact[contacts->contacts_n++] = (touch_contact){
                .force_newton = vec3_scale(point->force, per_h_squared),
                .gap_m = point->end_m + point->let_m,
                .node = (uint8_t)(point->node + 1),
                .object = point->object,
            };
        }
    }
}
