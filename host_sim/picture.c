/* picture.c - see picture.h. */
#include "picture.h"

#include <math.h>

#include "output.h"

static const double FRAMES_PER_S = 25.0;
enum { FRAMES_MAX = 160, SHADOWS_N = 28, OUTLINE_N = 96 };
static const double WIDTH_PX = 760.0, MARGIN_PX = 24.0;

/* Where a point of the world lies on the paper: x to the right, z up, y away to the upper right. */
typedef struct {
    double left, top, px_per_m, height_px;
} paper;

static const double Y_RIGHT = 0.35, Y_UP = 0.2;

typedef struct {
    double right, up; /* m */
} flat;

static flat flatten(const double p[3])
{
    return (flat){p[0] + Y_RIGHT * p[1], p[2] + Y_UP * p[1]};
}

/* What has to be seen. */
typedef struct {
    double left, right, bottom, top;
} window;

static void widen(window *w, flat p)
{
    w->left = fmin(w->left, p.right);
    w->right = fmax(w->right, p.right);
    w->bottom = fmin(w->bottom, p.up);
    w->top = fmax(w->top, p.up);
}

static void write_point(const paper *p, flat at, const char *before, FILE *file)
{
    fprintf(file, "%s%.1f %.1f", before, MARGIN_PX + (at.right - p->left) * p->px_per_m,
            MARGIN_PX + (p->top - at.up) * p->px_per_m);
}

/* --- things to touch ------------------------------------------------------------------------------ */

/* A point of an object: so many half edges along each of its axes, and so far out. */
static flat point_of(const scene_object *o, const double steps[3])
{
    const frame3 axes = quat_frame(o->orientation);
    const vec3 offset =
        frame3_to_parent(&axes, (vec3){(float)steps[0], (float)steps[1], (float)steps[2]});
    return flatten((const double[]){(double)o->place_m.x + (double)offset.x,
                                    (double)o->place_m.y + (double)offset.y,
                                    (double)o->place_m.z + (double)offset.z});
}

/* The outline's point that lies farthest in a direction: a corner of the box inside, and from there the farthest point
 * of the rounding, which is a sphere and on this paper an ellipse. */
static flat farthest(const scene_object *o, double right, double up)
{
    flat best = {0.0, 0.0};
    double most = -HUGE_VAL;
    for (int corner = 0; corner < 8; corner++) {
        const flat p =
            point_of(o, (const double[]){(corner & 1 ? 1.0 : -1.0) * (double)o->half_m.x,
                                         (corner & 2 ? 1.0 : -1.0) * (double)o->half_m.y,
                                         (corner & 4 ? 1.0 : -1.0) * (double)o->half_m.z});
        const double far = p.right * right + p.up * up;
        if (far > most) {
            most = far;
            best = p;
        }
    }
    const double out[] = {right, Y_RIGHT * right + Y_UP * up, up};
    const double per = (double)o->radius_m / hypot(hypot(out[0], out[1]), out[2]);
    const flat rounded = flatten((const double[]){out[0] * per, out[1] * per, out[2] * per});
    return (flat){best.right + rounded.right, best.up + rounded.up};
}

static flat outline(const scene_object *o, int i)
{
    const double turn = 2.0 * M_PI * i / OUTLINE_N;
    return farthest(o, cos(turn), sin(turn));
}

static void write_outline(const scene_object *o, const paper *p, FILE *file)
{
    fprintf(file, "<path d=\"");
    for (int i = 0; i < OUTLINE_N; i++) {
        write_point(p, outline(o, i), i == 0 ? "M" : " ", file);
    }
    fprintf(file, "Z\"/>\n");
}

/* The face of a box that looks along one of its axes. */
static void write_face(const scene_object *o, int axis, double sign, const paper *p, FILE *file)
{
    const double half[] = {(double)o->half_m.x, (double)o->half_m.y, (double)o->half_m.z};
    fprintf(file, "<path d=\"");
    for (int corner = 0; corner < 4; corner++) {
        double steps[3];
        steps[axis] = sign * (half[axis] + (double)o->radius_m);
        steps[(axis + 1) % 3] = (corner == 1 || corner == 2 ? 1.0 : -1.0) * half[(axis + 1) % 3];
        steps[(axis + 2) % 3] = (corner >= 2 ? 1.0 : -1.0) * half[(axis + 2) % 3];
        write_point(p, point_of(o, steps), corner == 0 ? "M" : " ", file);
    }
    fprintf(file, "Z\"/>\n");
}

static void write_faces(const scene_object *o, const paper *p, FILE *file)
{
    const frame3 axes = quat_frame(o->orientation);
    const vec3 axis[] = {axes.x, axes.y, axes.z};
    for (int i = 0; i < 3; i++) {
        const double seen =
            Y_RIGHT * (double)axis[i].x - (double)axis[i].y + Y_UP * (double)axis[i].z;
        write_face(o, i, seen > 0.0 ? 1.0 : -1.0, p, file);
    }
}

/* Of a plane a piece is drawn: a thin box that is as large as the picture. */
static scene_object drawn(const scene_object *o, const window *w)
{
    scene_object piece = *o;
    if (o->kind == SCENE_PLANE) {
        const float reach = 0.3f * (float)(w->right - w->left + w->top - w->bottom);
        piece.half_m = (vec3){reach, reach, 0.0f};
    }
    return piece;
}

static void write_objects(const replay *r, const paper *p, const window *w, FILE *file)
{
    if (r->around.objects == NULL) {
        return;
    }
    fprintf(file, "<g fill=\"#8b98aa\" fill-opacity=\".3\" stroke=\"#6b7788\">\n");
    for (int i = 0; i < r->around.objects->objects_n; i++) {
        const scene_object o = drawn(&r->around.objects->objects[i].object, w);
        write_outline(&o, p, file);
        if (o.kind == SCENE_BOX) {
            write_faces(&o, p, file);
        }
    }
    fprintf(file, "</g>\n");
}

/* What of the objects is near the rod belongs to the picture too. */
static void widen_for_objects(window *w, const replay *r)
{
    const window rod = *w;
    const double margin = 0.25 * fmax(rod.right - rod.left, rod.top - rod.bottom);
    for (int i = 0; r->around.objects != NULL && i < r->around.objects->objects_n; i++) {
        const scene_object *const o = &r->around.objects->objects[i].object;
        for (int k = 0; o->kind != SCENE_PLANE && k < OUTLINE_N; k++) {
            const flat p = outline(o, k);
            widen(w, (flat){fmin(fmax(p.right, rod.left - margin), rod.right + margin),
                            fmin(fmax(p.up, rod.bottom - margin), rod.top + margin)});
        }
    }
}

/* --- the rod -------------------------------------------------------------------------------------- */

static long frame_count(const replay *r)
{
    const double frames = floor((double)(r->ticks_n - 1) / r->rate_hz * FRAMES_PER_S) + 1.0;
    return frames < FRAMES_MAX ? (long)frames : FRAMES_MAX;
}

static long tick_of(const replay *r, long frame)
{
    const long tick = lround((double)frame / FRAMES_PER_S * r->rate_hz);
    return tick < r->ticks_n ? tick : r->ticks_n - 1;
}

static window look(const replay *r, long frames_n)
{
    window w = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (long frame = 0; frame < frames_n; frame++) {
        double nodes_m[ROD_MAX_LINKS + 1][3];
        replay_nodes(r, tick_of(r, frame), nodes_m);
        for (int i = 0; i <= r->params.links_n; i++) {
            widen(&w, flatten(nodes_m[i]));
        }
    }
    widen_for_objects(&w, r);
    return w;
}

static paper fit(const window *w)
{
    /* never so narrow that the picture becomes a tower */
    const double room = fmax(w->right - w->left, 1.6 * (w->top - w->bottom));
    const double px_per_m = (WIDTH_PX - 2.0 * MARGIN_PX) / fmax(room, 1e-3);
    return (paper){0.5 * (w->left + w->right - room), w->top, px_per_m,
                   2.0 * MARGIN_PX + (w->top - w->bottom) * px_per_m};
}

/* The rod at a tick as the data of a path; every tick has as many points, so that one can turn into
 * the next. */
static void write_rod(const replay *r, const paper *p, long tick, FILE *file)
{
    double nodes_m[ROD_MAX_LINKS + 1][3];
    replay_nodes(r, tick, nodes_m);
    for (int i = 0; i <= r->params.links_n; i++) {
        write_point(p, flatten(nodes_m[i]), i == 0 ? "M" : i == 1 ? "L" : " ", file);
    }
}

int picture_write(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    const long frames_n = frame_count(r);
    const window w = look(r, frames_n);
    const paper p = fit(&w);
    FILE *file = out.file;
    fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" fill=\"none\" "
        "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>A rod of %d links, bent by "
        "the hand at its foot (limber-sim replay --picture)</title>\n"
        "<linearGradient id=\"g\" gradientUnits=\"userSpaceOnUse\" x1=\"0\" y1=\"%.0f\" x2=\"0\" "
        "y2=\"0\"><stop stop-color=\"#1d4fc4\"/><stop offset=\".55\" stop-color=\"#c13b8a\"/>"
        "<stop offset=\"1\" stop-color=\"#f0a020\"/></linearGradient>\n",
        WIDTH_PX, p.height_px, r->params.links_n, p.height_px);
    write_objects(r, &p, &w, file);
    fprintf(file, "<g stroke=\"url(#g)\" stroke-width=\"1.5\" opacity=\".22\">\n");
    const long step = frames_n / SHADOWS_N + 1;
    for (long frame = 0; frame < frames_n; frame += step) {
        fprintf(file, "<path d=\"");
        write_rod(r, &p, tick_of(r, frame), file);
        fprintf(file, "\"/>\n");
    }
    fprintf(file, "</g>\n<path stroke=\"url(#g)\" stroke-width=\"6\" d=\"");
    write_rod(r, &p, tick_of(r, frames_n / 2), file);
    fprintf(file,
            "\"><animate attributeName=\"d\" dur=\"%.2fs\" repeatCount=\"indefinite\" values=\"",
            (double)frames_n / FRAMES_PER_S);
    for (long frame = 0; frame < frames_n; frame++) {
        fprintf(file, "%s", frame == 0 ? "" : ";\n");
        write_rod(r, &p, tick_of(r, frame), file);
    }
    fprintf(file, "\"/></path>\n</svg>\n");
    return output_close(&out, true);
}
