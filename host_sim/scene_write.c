/* scene_write.c - see scene_text.h: from objects to text. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene_keys.h"
#include "scene_text.h"

enum {
    PLANE = 1 << SCENE_PLANE,
    SPHERE = 1 << SCENE_SPHERE,
    CAPSULE = 1 << SCENE_CAPSULE,
    BOX = 1 << SCENE_BOX
};

const scene_key scene_keys[SCENE_KEYS_N] = {
    [KEY_CENTRE] = {"centre", SPHERE | BOX, 3, true, -1000.0, 1000.0, "m", "0, 0, 0.5"},
    [KEY_POINT] = {"point", PLANE, 3, true, -1000.0, 1000.0, "m", "0, 0, 0"},
    [KEY_NORMAL] = {"normal", PLANE, 3, true, -1000.0, 1000.0, "", "0, 0, 1"},
    [KEY_FROM] = {"from", CAPSULE, 3, true, -1000.0, 1000.0, "m", "0.3, 0, 0"},
    [KEY_TO] = {"to", CAPSULE, 3, true, -1000.0, 1000.0, "m", "0.3, 0, 1"},
    [KEY_RADIUS] = {"radius", SPHERE | CAPSULE, 1, true, 1e-3, 1000.0, "m", "0.1"},
    [KEY_SIZE] = {"size", BOX, 3, true, 2e-3, 2000.0, "m", "1, 0.6, 0.04"},
    [KEY_ROUNDING] = {"rounding", BOX, 1, false, 1e-3, 1000.0, "m", "0.005"},
    [KEY_TURN] = {"turn", BOX, 3, false, -360.0, 360.0, "degrees", "0, 0, 45"},
    [KEY_QUATERNION] = {"quaternion", BOX, 4, false, -1.0, 1.0, "", "0, 0, 0, 1"},
    [KEY_FRICTION] = {"friction", PLANE | SPHERE | CAPSULE | BOX, 1, false, 0.0, 10.0, "", "0.3"},
};

/* What a plane's normal and a capsule's ends are written to, m; they come out of a quaternion, and no kind of digits
 * would lead back to its bits. */
static const double RESOLUTION = 1e-7;

typedef struct {
    char text[32];
} decimal;

/* The shortest decimal that leads back to the same bits. */
static decimal of_float(float value)
{
    decimal d;
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(d.text, sizeof d.text, "%.*g", digits, (double)value);
        const float back = strtof(d.text, NULL);
        if (!(back < value || back > value)) {
            break;
        }
    }
    return d;
}

/* The shortest decimal that is near enough. What is that small itself has no digits of its own. */
static decimal near(double value)
{
    decimal d = {"0"};
    for (int digits = 6; digits <= 17 && fabs(strtod(d.text, NULL) - value) > RESOLUTION;
         digits++) {
        snprintf(d.text, sizeof d.text, "%.*g", digits, value);
    }
    return d;
}

/* A box's whole edge, so that half of it less the rounding, as written, is its half_m again. */
static decimal of_edge(float half_m, float radius_m)
{
    const decimal radius = of_float(radius_m);
    const double rounding = strtod(radius.text, NULL);
    decimal d;
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(d.text, sizeof d.text, "%.*g", digits, 2.0 * ((double)half_m + rounding));
        const float back = (float)(0.5 * strtod(d.text, NULL) - rounding);
        if (!(back < half_m || back > half_m)) {
            break;
        }
    }
    return d;
}

/* One of the values of a key. */
static decimal value_of(const scene_object *o, int key, int i)
{
    const frame3 axes = quat_frame(o->orientation);
    const float place[] = {o->place_m.x, o->place_m.y, o->place_m.z};
    const float half[] = {o->half_m.x, o->half_m.y, o->half_m.z};
    const float up[] = {axes.z.x, axes.z.y, axes.z.z};
    const float q[] = {o->orientation.x, o->orientation.y, o->orientation.z, o->orientation.w};
    switch (key) {
    case KEY_NORMAL:
        return near((double)up[i]);
    case KEY_FROM:
        return near((double)place[i] - (double)half[2] * (double)up[i]);
    case KEY_TO:
        return near((double)place[i] + (double)half[2] * (double)up[i]);
    case KEY_SIZE:
        return of_edge(half[i], o->radius_m);
    case KEY_QUATERNION:
        return of_float(q[i]);
    case KEY_FRICTION:
        return of_float(o->friction);
    case KEY_RADIUS:
    case KEY_ROUNDING:
        return of_float(o->radius_m);
    default:
        return of_float(place[i]);
    }
}

/* Is there anything to say? A box that is not turned has no quaternion, and nothing is turned twice. */
static bool is_written(const scene_object *o, int key)
{
    const bool straight = !(fabsf(o->orientation.w) < 1.0f);
    return scene_key_is_of(key, o->kind) && key != KEY_TURN && !(key == KEY_QUATERNION && straight);
}

/* "key = 1, 2, 3" with these between the parts. */
static void write_key(const scene_object *o, int key, const char *equals, const char *comma,
                      FILE *out)
{
    fprintf(out, "%s%s", scene_keys[key].name, equals);
    for (int i = 0; i < scene_keys[key].values_n; i++) {
        fprintf(out, "%s%s", i == 0 ? "" : comma, value_of(o, key, i).text);
    }
}

void scene_text_write_line(const scene_object *object, const char *name, char line[SCENE_LINE_MAX])
{
    FILE *const out = fmemopen(line, SCENE_LINE_MAX, "w");
    line[0] = '\0';
    if (out == NULL) {
        return;
    }
    fprintf(out, "%s%s%s", scene_kinds[object->kind], name == NULL ? "" : " ",
            name == NULL ? "" : name);
    for (int key = 0; key < SCENE_KEYS_N; key++) {
        if (is_written(object, key)) {
            putc(' ', out);
            write_key(object, key, "=", ",", out);
        }
    }
    fclose(out);
}

void scene_text_write_ini(const scene_text *text, const char *title, FILE *out)
{
    fprintf(out, "# %s\n# Read by: limber-sim replay TRACK --scene THIS_FILE\n", title);
    for (int i = 0; i < text->objects_n; i++) {
        const scene_object *const o = &text->objects[i].object;
        fprintf(out, "\n[%s %s]\n", scene_kinds[o->kind], text->objects[i].name);
        for (int key = 0; key < SCENE_KEYS_N; key++) {
            if (is_written(o, key)) {
                write_key(o, key, " = ", ", ", out);
                putc('\n', out);
            }
        }
    }
}
