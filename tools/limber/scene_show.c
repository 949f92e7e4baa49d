/* scene_show.c - see scene_show.h. */
#include "scene_show.h"

#include <math.h>
#include <stdio.h>

#include "scene_requests.h"
#include "texts.h"

static const char *plural(int n)
{
    return n == 1 ? "" : "s";
}

static void print_object(int index, const message_scene_object *o)
{
    const scene_object object = scene_requests_object(o);
    char line[SCENE_LINE_MAX] = "an object of a kind that this limber does not know";
    if (o->kind < SCENE_KINDS_N) {
        scene_text_write_line(&object, NULL, line);
    }
    printf("%d  %s\n", index + 1, line);
    if (o->contacts_n > 0) {
        const float *f = o->force_newton;
        const double newton = sqrt((double)f[0] * (double)f[0] + (double)f[1] * (double)f[1] +
                                   (double)f[2] * (double)f[2]);
        printf("   touched by %d node%s, pushes with %.3g N (%.3g, %.3g, %.3g)\n", o->contacts_n,
               plural(o->contacts_n), newton, (double)f[0], (double)f[1], (double)f[2]);
    }
}

static cJSON *floats_json(const float *values, int values_n)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < values_n; i++) {
        cJSON_AddItemToArray(list, texts_float_json(values[i]));
    }
    return list;
}

static cJSON *object_json(int index, const message_scene_object *o)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "place", index + 1);
    cJSON_AddStringToObject(json, "kind", o->kind < SCENE_KINDS_N ? scene_kinds[o->kind] : "?");
    cJSON_AddItemToObject(json, "centre_m", floats_json(o->place_m, 3));
    cJSON_AddItemToObject(json, "quaternion_xyzw", floats_json(o->orientation_xyzw, 4));
    cJSON_AddItemToObject(json, "half_m", floats_json(o->half_m, 3));
    cJSON_AddItemToObject(json, "radius_m", texts_float_json(o->radius_m));
    cJSON_AddItemToObject(json, "friction", texts_float_json(o->friction));
    cJSON_AddNumberToObject(json, "contacts", o->contacts_n);
    cJSON_AddItemToObject(json, "force_newton", floats_json(o->force_newton, 3));
    return json;
}

int scene_show(session *s, bool json)
{
    cJSON *const all = json ? cJSON_CreateArray() : NULL;
    int result = SIM_OK, objects_n = 0;
    for (int i = 0, places_n = 1; i < places_n && result == SIM_OK; i++) {
        message_scene_object object;
        result = scene_requests_get(s, i, &object);
        if (result == SIM_OK) {
            places_n = object.objects_max;
        }
        if (result != SIM_OK || object.kind == OBJECT_NONE) {
            continue;
        }
        objects_n++;
        if (all != NULL) {
            cJSON_AddItemToArray(all, object_json(i, &object));
        } else {
            print_object(i, &object);
        }
    }
    if (all != NULL && result == SIM_OK) {
        texts_print_json(all);
        return result;
    }
    cJSON_Delete(all);
    if (result == SIM_OK && objects_n == 0) {
        printf("nothing stands there; limber scene send FILE.ini\n");
    }
    return result;
}
