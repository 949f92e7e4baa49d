/* touch.c - see touch.h: which nodes may touch, and what is remembered of it. */
#include "touch.h"

#include <float.h>

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
            point->force = vec3_scale(last->contact[i].force_newton, h_squared_s2);
            const float pressed = vec3_dot(point->normal, point->force);
            point->pressed = pressed > 0.0f ? pressed : 0.0f;
        }
    }
}

/* The node at a gap from an object. */
static touch_point make_point(const touch_nodes *nodes, int node, int object, float friction,
                              scene_gap gap)
{
    const vec3 moved = vec3_sub(nodes->after_m[node], nodes->before_m[node]);
    const float closer = vec3_dot(gap.normal, moved);
    /* where the step began, as far as the normal tells; and where it may go at most if that was inside */
    const float out = gap.gap_m - closer + nodes->step_s * TOUCH_ESCAPE_M_S;
    const float let = out < 0.0f ? out : 0.0f;
    return (touch_point){
        .normal = gap.normal,
        .gap_m = gap.gap_m - let,
        .let_m = let,
        .slip_m = vec3_add_scaled(moved, gap.normal, -closer),
        .friction = friction,
        .node = (uint8_t)node,
        .object = (uint8_t)object,
        .state = TOUCH_OFF,
    };
}

/* Up to two objects of a node, the nearer first. */
typedef struct {
    int n;
    int object[2];
    vec3 normal[2];
} near_objects;

/* The nearest that are within a link's length and not let go for being deep around the node before. */
static near_objects nearest(const float gap_m[SCENE_OBJECTS_MAX][ROD_MAX_LINKS + 1], int place,
                            float length_m)
{
    near_objects found = {.n = 0};
    float gap[2] = {length_m, length_m};
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        const float own = gap_m[i][place];
        if (!(own < gap[1]) || gap_m[i][place - 1] < -DEEP_LINKS * length_m) {
            continue;
        }
        const int rank = own < gap[0] ? 0 : 1;
        if (rank == 0) {
            gap[1] = gap[0];
            found.object[1] = found.object[0];
        }
        gap[rank] = own;
        found.object[rank] = i;
        found.n = found.n < 2 ? found.n + 1 : 2;
    }
    return found;
}

/* Is the node before on another side of the object? */
static bool is_through(const near_objects *before, int object, vec3 normal)
{
    for (int i = 0; i < before->n; i++) {
        if (before->object[i] == object && vec3_dot(before->normal[i], normal) < THROUGH_COSINE) {
            return true;
        }
    }
    return false;
}

/* How far the base and all nodes are from all objects. What is not there is far. */
static void measure(const scene *objects, const touch_nodes *nodes,
                    float gap_m[SCENE_OBJECTS_MAX][ROD_MAX_LINKS + 1])
{
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        const scene_body *body = &objects->body[i];
        if (body->object.kind != SCENE_NONE) {
            scene_gaps_m(body, &nodes->base_m, 1, gap_m[i]);
            scene_gaps_m(body, nodes->after_m, nodes->nodes_n, gap_m[i] + 1);
            continue;
        }
        for (int place = 0; place <= nodes->nodes_n; place++) {
            gap_m[i][place] = FLT_MAX;
        }
    }
}

void touch_find(const scene *objects, const touch_contacts *last, const touch_nodes *nodes,
                touch_points *points)
{
    float gap_m[SCENE_OBJECTS_MAX][ROD_MAX_LINKS + 1];
    near_objects before = {.n = 0};
    int next = 0;
    points->points_n = 0;
    measure(objects, nodes, gap_m);
    for (int node = 0; node < nodes->nodes_n; node++) {
        near_objects here = nearest(gap_m, node + 1, nodes->link[node].length_m);
        const int left_n = TOUCH_CONTACTS_MAX - points->points_n - (nodes->nodes_n - 1 - node);
        here.n = here.n < left_n ? here.n : left_n;
        for (int i = 0; i < here.n; i++) {
            const scene_body *body = &objects->body[here.object[i]];
            const scene_gap gap = scene_gap_to(body, nodes->after_m[node]);
            here.normal[i] = gap.normal;
            if (is_through(&before, here.object[i], gap.normal)) {
                continue;
            }
            touch_point *point = &points->point[points->points_n++];
            *point = make_point(nodes, node, here.object[i], body->object.friction, gap);
            recall(last, &next, nodes->h_squared_s2, point);
        }
        before = here;
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
