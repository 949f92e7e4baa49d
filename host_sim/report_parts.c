/* report_parts.c - see report_parts.h. */
#include "report_parts.h"

#include <stdlib.h>
#include <string.h>

float_list float_list_for(size_t values_n)
{
    return (float_list){malloc(values_n * sizeof(float)), 0};
}

void float_list_append(float_list *list, float value)
{
    if (list->bytes != NULL) {
        memcpy(list->bytes + list->bytes_n, &value, sizeof value);
        list->bytes_n += sizeof value;
    }
}

static char *base64(const float_list *list)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc(4 * (list->bytes_n / 3 + 1) + 1);
    if (text == NULL) {
        return NULL;
    }
    char *out = text;
    for (size_t i = 0; i < list->bytes_n; i += 3) {
        const size_t left = list->bytes_n - i;
        const unsigned bits = (unsigned)list->bytes[i] << 16 |
                              (left > 1 ? (unsigned)list->bytes[i + 1] << 8 : 0) |
                              (left > 2 ? (unsigned)list->bytes[i + 2] : 0);
        *out++ = DIGITS[bits >> 18];
        *out++ = DIGITS[bits >> 12 & 63];
        *out++ = left > 1 ? DIGITS[bits >> 6 & 63] : '=';
        *out++ = left > 2 ? DIGITS[bits & 63] : '=';
    }
    *out = '\0';
    return text;
}

void float_list_add_to(cJSON *page, const char *name, float_list *list)
{
    char *text = list->bytes == NULL ? NULL : base64(list);
    if (text != NULL) {
        cJSON_AddStringToObject(page, name, text);
    }
    free(text);
    free(list->bytes);
    *list = (float_list){0};
}

/* --- what is touched ------------------------------------------------------------------------------ */

static void add_numbers(cJSON *entry, const char *name, const float *values, int values_n)
{
    cJSON_AddItemToObject(entry, name, cJSON_CreateFloatArray(values, values_n));
}

static void add_object(cJSON *list, const scene_text_object *given)
{
    const scene_object *const o = &given->object;
    const float place[] = {o->place_m.x, o->place_m.y, o->place_m.z};
    const float half[] = {o->half_m.x, o->half_m.y, o->half_m.z};
    const float q[] = {o->orientation.x, o->orientation.y, o->orientation.z, o->orientation.w};
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddItemToArray(list, entry);
    cJSON_AddStringToObject(entry, "name", given->name);
    cJSON_AddStringToObject(entry, "kind", scene_kinds[o->kind]);
    add_numbers(entry, "place", place, 3);
    add_numbers(entry, "q", q, 4);
    add_numbers(entry, "half", half, 3);
    cJSON_AddNumberToObject(entry, "radius", (double)o->radius_m);
}

static void append_contacts(float_list *list, const replay *r, long tick, long frame)
{
    int contacts_n;
    const touch_contact *const contacts = replay_contacts(r, tick, &contacts_n);
    for (int i = 0; i < contacts_n; i++) {
        const touch_contact *const c = &contacts[i];
        float_list_append(list, (float)frame);
        float_list_append(list, (float)c->node);
        float_list_append(list, (float)c->object);
        float_list_append(list, c->force_newton.x);
        float_list_append(list, c->force_newton.y);
        float_list_append(list, c->force_newton.z);
    }
}

void report_add_touch(cJSON *page, const replay *r, long frame_step)
{
    cJSON *objects = cJSON_AddArrayToObject(page, "objects");
    for (int i = 0; i < r->around.objects->objects_n; i++) {
        add_object(objects, &r->around.objects->objects[i]);
    }
    float_list list = float_list_for(6 * r->contacts_n + 1);
    for (long tick = 0, frame = 0; tick < r->ticks_n; tick += frame_step, frame++) {
        append_contacts(&list, r, tick, frame);
    }
    float_list_add_to(page, "contacts", &list);
}
