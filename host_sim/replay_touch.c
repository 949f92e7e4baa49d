/* replay_touch.c - see replay_touch.h. */
#include "replay_touch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim.h"

static int place_one(replay *r, int index)
{
    const scene_text_object *const given = &r->around.objects->objects[index];
    const double *const origin = r->source->origin_m;
    scene_object moved = given->object;
    moved.place_m = (vec3){(float)((double)given->object.place_m.x - origin[0]),
                           (float)((double)given->object.place_m.y - origin[1]),
                           (float)((double)given->object.place_m.z - origin[2])};
    scene_refusal why;
    if (scene_put(&r->objects, index, &moved, &why) == ROD_OK) {
        return SIM_OK;
    }
    return sim_complain("%s: '%s' is %g m from where the track begins, at most %g m are allowed; "
                        "objects are where the track is",
                        r->around.scene_path, given->name, fabs((double)why.value),
                        (double)why.max);
}

int replay_touch_place(replay *r)
{
    if (r->around.objects == NULL) {
        return SIM_OK;
    }
    int result = SIM_OK;
    for (int i = 0; result == SIM_OK && i < r->around.objects->objects_n; i++) {
        result = place_one(r, i);
    }
    r->contacts_begin = calloc((size_t)r->ticks_n + 1, sizeof *r->contacts_begin);
    return result == SIM_OK && r->contacts_begin == NULL
               ? sim_give_up("out of memory for %ld ticks", r->ticks_n)
               : result;
}

static bool make_room(replay *r, int more_n)
{
    while (r->contacts_room < r->contacts_n + (size_t)more_n) {
        const size_t room = 2 * r->contacts_room + TOUCH_CONTACTS_MAX;
        touch_contact *const longer = realloc(r->contacts, room * sizeof *longer);
        if (longer == NULL) {
            return false;
        }
        r->contacts = longer;
        r->contacts_room = room;
    }
    return true;
}

static void sum_up_forces(replay *r, const touch_contact *contacts, int contacts_n)
{
    int nodes_n[SCENE_OBJECTS_MAX] = {0};
    vec3 force[SCENE_OBJECTS_MAX] = {{0.0f, 0.0f, 0.0f}};
    for (int i = 0; i < contacts_n; i++) {
        const int object = contacts[i].object;
        nodes_n[object]++;
        force[object] = vec3_add(force[object], contacts[i].force_newton);
    }
    for (int i = 0; i < SCENE_OBJECTS_MAX; i++) {
        replay_touch *const touch = &r->touches[i];
        touch->ticks_n += nodes_n[i] > 0 ? 1 : 0;
        touch->nodes_n = nodes_n[i] > touch->nodes_n ? nodes_n[i] : touch->nodes_n;
        touch->force_most_newton =
            fmax(touch->force_most_newton, sqrt((double)vec3_dot(force[i], force[i])));
    }
}

/* Where the nodes are in truth, not where a step takes them to be. The base is the hand's. */
static void sum_up_depths(replay *r, const rod *rod, long tick)
{
    vec3 nodes_m[ROD_MAX_LINKS + 1];
    const int nodes_n = rod_nodes(rod, nodes_m);
    for (int i = 0; i < r->around.objects->objects_n; i++) {
        replay_touch *const touch = &r->touches[i];
        for (int node = 1; node < nodes_n; node++) {
            const scene_gap gap = scene_gap_to(&r->objects.body[i], nodes_m[node]);
            touch->deepest_m = fmax(touch->deepest_m, -(double)gap.gap_m);
        }
        if (tick == 0) {
            touch->deepest_first_m = touch->deepest_m;
        }
    }
}

bool replay_touch_keep(replay *r, const rod *rod, long tick)
{
    if (r->contacts_begin == NULL) {
        return true;
    }
    int contacts_n;
    const touch_contact *const contacts = rod_contacts(rod, &contacts_n);
    if (!make_room(r, contacts_n)) {
        return false;
    }
    if (contacts_n > 0) {
        memcpy(r->contacts + r->contacts_n, contacts, (size_t)contacts_n * sizeof *contacts);
    }
    r->contacts_n += (size_t)contacts_n;
    r->contacts_begin[tick + 1] = r->contacts_n;
    sum_up_forces(r, contacts, contacts_n);
    sum_up_depths(r, rod, tick);
    return true;
}

const touch_contact *replay_contacts(const replay *r, long tick, int *contacts_n)
{
    *contacts_n = 0;
    if (r->contacts_n == 0) {
        return NULL;
    }
    const size_t begin = r->contacts_begin[tick];
    *contacts_n = (int)(r->contacts_begin[tick + 1] - begin);
    return r->contacts + begin;
}

vec3 replay_contact_force(const replay *r, long tick)
{
    int contacts_n;
    const touch_contact *const contacts = replay_contacts(r, tick, &contacts_n);
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < contacts_n; i++) {
        sum = vec3_add(sum, contacts[i].force_newton);
    }
    return sum;
}
