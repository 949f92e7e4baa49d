/* summary.c - see summary.h. */
#include "summary.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

static __attribute__((format(printf, 3, 4))) void add_row(summary *s, const char *label,
                                                          const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    snprintf(s->labels[s->rows_n], SUMMARY_TEXT_MAX, "%s", label);
    vsnprintf(s->values[s->rows_n], SUMMARY_TEXT_MAX, format, arguments);
    va_end(arguments);
    for (char *c = s->values[s->rows_n]; *c != '\0'; c++) {
        if ((unsigned char)*c < ' ' || *c == 127) {
            *c = '?'; /* a track's name may hold anything; a row stays one line */
        }
    }
    s->rows_n++;
}

static __attribute__((format(printf, 2, 3))) void add_warning(summary *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s->warnings[s->warnings_n++], SUMMARY_TEXT_MAX, format, arguments);
    va_end(arguments);
}

static void add_count(char *list, long count, const char *one, const char *many)
{
    if (count > 0) {
        const size_t used = strlen(list);
        snprintf(list + used, SUMMARY_TEXT_MAX - used, "%s%ld %s", used > 0 ? ", " : "", count,
                 count == 1 ? one : many);
    }
}

static void describe_track(summary *s, const track *t)
{
    const track_counts *c = &t->counts;
    const double duration_s = track_duration_s(t);
    if (t->samples_n > 1) {
        add_row(s, "track", "%s: %zu samples, %.3f s, %.1f a second", t->path, t->samples_n,
                duration_s, (double)(t->samples_n - 1) / duration_s);
    } else {
        add_row(s, "track", "%s: a single sample", t->path);
    }
    summary_text list = "";
    add_count(list, c->zero_quaternions, "zero quaternion dropped", "zero quaternions dropped");
    add_count(list, c->repeated_times, "repeated time dropped", "repeated times dropped");
    add_count(list, c->too_fast, "sample too fast dropped", "samples too fast dropped");
    add_count(list, c->not_unit, "quaternion normalised", "quaternions normalised");
    add_count(list, c->sign_flips, "sign flip", "sign flips");
    add_count(list, c->gaps, "gap", "gaps");
    add_count(list, c->jumps, "jump", "jumps");
    add_row(s, "oddities", "%s", *list == '\0' ? "none" : list);
}

static double sum_of(const rod_params *p, const float *per_joint)
{
    double sum = 0.0;
    for (int i = 0; i < p->links_n; i++) {
        sum += (double)per_joint[i];
    }
    return sum;
}

static bool is_elastic(const replay *r)
{
    return r->params.model == ROD_MODEL_ELASTIC;
}

/* Into how many steps the model divides a tick. */
static int steps_of(const replay *r)
{
    return is_elastic(r) ? elastic_steps_n(r->params.tick_s, r->around.objects != NULL) : 1;
}

static void warn_under_resolved(summary *s, const replay *r)
{
    const double resolving_hz = (double)rod_params_resolving_rate_hz(&r->params);
    if (resolving_hz <= r->rate_hz * steps_of(r) * 1.0001) {
        return;
    }
    add_warning(s,
                is_elastic(r)
                    ? "under-resolved: the slowest swing takes less than six steps and is "
                      "damped away; --rate %.0f would show it, or less stiffness"
                    : "under-resolved: the stiffest joint swings faster than once in six "
                      "ticks; --rate %.0f would do, or less stiffness",
                ceil(resolving_hz));
}

static void warn_of_limits(summary *s, const replay *r)
{
    double share = 0.0;
    int joint = 0;
    for (int i = 0; i < r->params.links_n; i++) {
        if (r->joints[i].limit_share > share) {
            share = r->joints[i].limit_share;
            joint = i + 1;
        }
    }
    if (share > 0.0) {
        add_warning(
            s,
            is_elastic(r)
                ? "joint %d is bent beyond its limit %.2g %% of the time; the rod has no "
                  "stop there, its servo may: a higher spring keeps it in reach"
                : "joint %d is on its stop %.2g %% of the time; a higher spring keeps it off",
            joint, 100.0 * share);
    }
}

static double shortest_link_m(const rod_params *p)
{
    double length_m = HUGE_VAL;
    for (int i = 0; i < p->links_n; i++) {
        length_m = fmin(length_m, (double)p->length_m[i]);
    }
    return length_m;
}

static double longest_link_m(const rod_params *p)
{
    double length_m = 0.0;
    for (int i = 0; i < p->links_n; i++) {
        length_m = fmax(length_m, (double)p->length_m[i]);
    }
    return length_m;
}

/* From the middle of an object to the surface that is nearest. */
static double thickness_m(const scene_object *o)
{
    const vec3 half = o->half_m;
    return o->kind == SCENE_PLANE ? HUGE_VAL
           : o->kind == SCENE_BOX
               ? (double)o->radius_m + fmin((double)half.x, fmin((double)half.y, (double)half.z))
               : (double)o->radius_m;
}

static void warn_of_thin_objects(summary *s, const replay *r)
{
    const scene_text *const t = r->around.objects;
    const double link_m = longest_link_m(&r->params);
    const scene_text_object *thinnest = NULL;
    for (int i = 0; i < t->objects_n; i++) {
        const double here = thickness_m(&t->objects[i].object);
        if (here < link_m && (thinnest == NULL || here < thickness_m(&thinnest->object))) {
            thinnest = &t->objects[i];
        }
    }
    if (thinnest != NULL) {
        add_warning(
            s,
            "%s is %.3g mm from middle to surface and a link is %.3g mm long: nodes touch, the "
            "links between them do not, and may slip through; more links cut the rod finer",
            thinnest->name, 1e3 * thickness_m(&thinnest->object), 1e3 * link_m);
    }
}

static void warn_of_beginning_inside(summary *s, const replay *r)
{
    const scene_text *const t = r->around.objects;
    for (int i = 0; i < t->objects_n; i++) {
        const double deep_m = r->touches[i].deepest_first_m;
        if (deep_m > 0.01 * shortest_link_m(&r->params)) {
            add_warning(s,
                        "the rod begins %.3g mm inside %s and is let out at %.3g m/s; objects are "
                        "where the track is",
                        1e3 * deep_m, t->objects[i].name, (double)TOUCH_ESCAPE_M_S);
            return;
        }
    }
}

static void warn(summary *s, const replay *r)
{
    const track_counts *c = &r->source->counts;
    warn_under_resolved(s, r);
    warn_of_limits(s, r);
    if (r->restored_n > 0) {
        add_warning(s,
                    "the base moved so violently that links had to be pulled back to their "
                    "lengths, at the price of momentum: %ld tick%s",
                    r->restored_n, r->restored_n == 1 ? "" : "s");
    }
    if (c->jumps > 0) {
        add_warning(s,
                    "%ld jump%s no hand makes (over 1 cm off its way at over 1000 m/s^2), first at "
                    "line %ld; "
                    "--max-speed 15 drops the worst",
                    c->jumps, c->jumps == 1 ? "" : "s", c->first_jump_line);
    }
    if (c->gaps > 0) {
        add_warning(s, "%ld gap%s over 0.25 s: the pose is held and the rod restarts straight",
                    c->gaps, c->gaps == 1 ? "" : "s");
    }
    if (r->around.objects != NULL) {
        warn_of_thin_objects(s, r);
        warn_of_beginning_inside(s, r);
    }
}

static void describe_rod(summary *s, const replay *r, const char *preset)
{
    const rod_params *p = &r->params;
    const char *const model = rod_field_find("model")->choices[p->model];
    const double length_m = sum_of(p, p->length_m);
    if (preset == NULL) {
        preset = "own parameters";
    }
    if (is_elastic(r)) {
        add_row(s, "rod", "%s: %d links, %.3g m, %.3g kg, %s", preset, p->links_n, length_m,
                sum_of(p, p->mass_kg), model);
        add_row(s, "first mode", "%.3g Hz in a still hand; gravity %.3g m/s^2",
                (double)rod_params_first_mode_hz(p), (double)p->gravity_m_s2);
    } else {
        add_row(s, "rod", "%s: %d links, %.3g m, %s, %s", preset, p->links_n, length_m, model,
                rod_field_find("scheme")->choices[p->scheme]);
    }
}

static void describe_touches(summary *s, const replay *r)
{
    const scene_text *const t = r->around.objects;
    const double link_m = shortest_link_m(&r->params);
    add_row(s, "scene", "%s: %d object%s%s", r->around.scene_path, t->objects_n,
            t->objects_n == 1 ? "" : "s", r->contacts_n == 0 ? ", nothing touches" : "");
    for (int i = 0; i < t->objects_n; i++) {
        const replay_touch *const touch = &r->touches[i];
        if (touch->ticks_n > 0) {
            add_row(s, "touches",
                    "%s: %d node%s, %.3g N at most, %.2g mm deep (%.2g %% of a link), "
                    "%.3g %% of the time",
                    t->objects[i].name, touch->nodes_n, touch->nodes_n == 1 ? "" : "s",
                    touch->force_most_newton, 1e3 * touch->deepest_m,
                    100.0 * touch->deepest_m / link_m,
                    100.0 * (double)touch->ticks_n / (double)r->ticks_n);
        }
    }
}

static void describe_surroundings(summary *s, const replay *r)
{
    if (r->around.objects != NULL) {
        describe_touches(s, r);
    }
    if (r->around.shape_rad != NULL) {
        add_row(s, "shape", "%s, like springs of %.4g N m, blended in over %.4g s",
                r->around.shape_name, (double)r->around.shape_strength_nm,
                (double)r->around.shape_blend_s);
    }
}

void summary_make(const replay *r, const char *preset, summary *s)
{
    *s = (summary){0};
    describe_track(s, r->source);
    describe_rod(s, r, preset);
    describe_surroundings(s, r);
    summary_text parts = "";
    if (steps_of(r) > 1) {
        snprintf(parts, sizeof parts, ", each in %d parts", steps_of(r));
    }
    add_row(s, "steps", "%ld at %g Hz%s%s", r->ticks_n, r->rate_hz, parts,
            r->restarts > 0 ? ", restarted after gaps" : "");
    add_row(s, "a step", "%.2f us (median), %.2f us (p99), %.1f us (max)", r->step_median_us,
            r->step_p99_us, r->step_max_us);
    if (r->lag_frequency_hz > 0.0) {
        add_row(s, "lags at", "%.2f Hz, where joint 1 swings most", r->lag_frequency_hz);
    }
    add_row(s, "hash", "%016" PRIx64, r->hash);
    warn(s, r);
}

static void print_joints(const replay *r, FILE *out)
{
    fprintf(out, "joint      peak theta, phi        rms theta, phi     lag       %s\n",
            is_elastic(r) ? "beyond limit" : "on stop");
    for (int i = 0; i < r->params.links_n; i++) {
        const replay_joint *j = &r->joints[i];
        fprintf(out, "%5d  %8.4f %8.4f rad  %8.4f %8.4f rad", i + 1, j->peak_rad[0], j->peak_rad[1],
                j->rms_rad[0], j->rms_rad[1]);
        if (j->lag_known) {
            fprintf(out, "  %6.1f deg", j->lag_deg);
        } else {
            fprintf(out, "       -    ");
        }
        fprintf(out, "  %5.2f %%\n", 100.0 * j->limit_share);
    }
}

void summary_print(const replay *r, const char *preset, FILE *out)
{
    summary s;
    summary_make(r, preset, &s);
    for (int i = 0; i < s.rows_n; i++) {
        if (i == s.rows_n - 1) { /* the table stands before the hash, which is looked for last */
            print_joints(r, out);
            for (int w = 0; w < s.warnings_n; w++) {
                fprintf(out, "warning    %s\n", s.warnings[w]);
            }
        }
        fprintf(out, "%-10s %s\n", s.labels[i], s.values[i]);
    }
}
