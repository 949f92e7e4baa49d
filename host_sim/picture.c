/* picture.c - see picture.h. */
#include "picture.h"

#include <math.h>

#include "output.h"

static const double FRAMES_PER_S = 25.0;
enum { FRAMES_MAX = 160, SHADOWS_N = 28 };
static const double WIDTH_PX = 760.0, MARGIN_PX = 24.0;

/* Where a point of the world lies on the paper: x to the right, z up, y away to the upper right. */
typedef struct {
    double left, top, px_per_m, height_px;
} paper;

static void flatten(const double p[3], double *right, double *up)
{
    *right = p[0] + 0.35 * p[1];
    *up = p[2] + 0.2 * p[1];
}

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

static paper fit(const replay *r, long frames_n)
{
    double left = HUGE_VAL, right = -HUGE_VAL, bottom = HUGE_VAL, top = -HUGE_VAL;
    for (long frame = 0; frame < frames_n; frame++) {
        double nodes_m[ROD_MAX_LINKS + 1][3];
        replay_nodes(r, tick_of(r, frame), nodes_m);
        for (int i = 0; i <= r->params.links_n; i++) {
            double u, v;
            flatten((const double *)nodes_m[i], &u, &v);
            left = fmin(left, u);
            right = fmax(right, u);
            bottom = fmin(bottom, v);
            top = fmax(top, v);
        }
    }
    /* never so narrow that the picture becomes a tower */
    const double room = fmax(right - left, 1.6 * (top - bottom));
    const double px_per_m = (WIDTH_PX - 2.0 * MARGIN_PX) / fmax(room, 1e-3);
    return (paper){0.5 * (left + right - room), top, px_per_m,
                   2.0 * MARGIN_PX + (top - bottom) * px_per_m};
}

/* The rod at a tick as the data of a path; every tick has as many points, so that one can turn into
 * the next. */
static void write_rod(const replay *r, const paper *p, long tick, FILE *file)
{
    double nodes_m[ROD_MAX_LINKS + 1][3];
    replay_nodes(r, tick, nodes_m);
    for (int i = 0; i <= r->params.links_n; i++) {
        double u, v;
        flatten((const double *)nodes_m[i], &u, &v);
        fprintf(file, "%s%.1f %.1f",
                i == 0   ? "M"
                : i == 1 ? "L"
                         : " ",
                MARGIN_PX + (u - p->left) * p->px_per_m, MARGIN_PX + (p->top - v) * p->px_per_m);
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
    const paper p = fit(r, frames_n);
    FILE *file = out.file;
    fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" fill=\"none\" "
        "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>A rod of %d links, bent by "
        "the hand at its foot (limber-sim replay --picture)</title>\n"
        "<linearGradient id=\"g\" gradientUnits=\"userSpaceOnUse\" x1=\"0\" y1=\"%.0f\" x2=\"0\" "
        "y2=\"0\"><stop stop-color=\"#1d4fc4\"/><stop offset=\".55\" stop-color=\"#c13b8a\"/>"
        "<stop offset=\"1\" stop-color=\"#f0a020\"/></linearGradient>\n"
        "<g stroke=\"url(#g)\" stroke-width=\"1.5\" opacity=\".22\">\n",
        WIDTH_PX, p.height_px, r->params.links_n, p.height_px);
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
