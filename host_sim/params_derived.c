/* params_derived.c - see params_derived.h. */
#include "params_derived.h"

#include <math.h>
#include <string.h>

#include "sim.h"

/* Where sideways forces on the nodes push a clamped chain of joints. */
static void deflect(const rod_params *p, const double *force_n, double *place_m)
{
    double bend[ROD_MAX_LINKS] = {0.0}, force = 0.0, moment = 0.0, slope = 0.0, place = 0.0;
    for (int i = p->links_n - 1; i >= 0; i--) {
        force += force_n[i];
        moment += force * (double)p->length_m[i];
        bend[i] = moment / (double)p->spring[i];
    }
    for (int i = 0; i < p->links_n; i++) {
        slope += bend[i];
        place += slope * (double)p->length_m[i];
        place_m[i] = place;
    }
}

/* sum of m x y */
static double inner(const rod_params *p, const double *x, const double *y)
{
    double sum = 0.0;
    for (int i = 0; i < p->links_n; i++) {
        sum += (double)p->mass_kg[i] * x[i] * y[i];
    }
    return sum;
}

/* Loaded by its own inertia again and again a chain takes the shape of its slowest mode; kept clear of those already
 * found, that of the next. */
void params_modes_hz(const rod_params *p, double hz[PARAMS_MODES_N])
{
    enum { PASSES_N = 100 };
    double shape[PARAMS_MODES_N][ROD_MAX_LINKS];
    for (int mode = 0; mode < PARAMS_MODES_N; mode++) {
        double *const x = shape[mode], load[ROD_MAX_LINKS], squared = 0.0;
        for (int i = 0; i < p->links_n; i++) {
            x[i] = 1.0 + (double)(i % (mode + 2)); /* any shape that has something of every mode */
        }
        for (int pass = 0; pass < PASSES_N && mode < p->links_n; pass++) {
            for (int m = 0; m < mode; m++) {
                const double share = inner(p, x, shape[m]) / inner(p, shape[m], shape[m]);
                for (int i = 0; i < p->links_n; i++) {
                    x[i] -= share * shape[m][i];
                }
            }
            const double size = sqrt(inner(p, x, x));
            for (int i = 0; i < p->links_n; i++) {
                load[i] = (double)p->mass_kg[i] * x[i] / size;
            }
            deflect(p, load, x);
            squared = 1.0 / sqrt(inner(p, x, x));
        }
        hz[mode] = sqrt(squared) / (2.0 * M_PI);
    }
}

double params_droop_m(const rod_params *p)
{
    double weight[ROD_MAX_LINKS], place_m[ROD_MAX_LINKS];
    for (int i = 0; i < p->links_n; i++) {
        weight[i] = (double)p->mass_kg[i] * 9.81;
    }
    deflect(p, weight, place_m);
    return place_m[p->links_n - 1];
}

/* The elastic chain that the blank makes, whatever the model. */
static rod_params chain_of(const rod_blank *blank, const rod_params *params)
{
    rod_params chain = *params;
    chain.model = ROD_MODEL_ELASTIC;
    rod_blank_fill(blank, &chain);
    return chain;
}

/* E I at an end, N m^2. */
static double bending_nm2(const rod_blank *blank, int end)
{
    const double d = (double)blank->diameter_m[end], b = (double)blank->bore;
    return (double)blank->youngs_modulus_pa * M_PI / 64.0 * pow(d, 4.0) * (1.0 - pow(b, 4.0));
}

/* Of the whole blank, kg. */
static double mass_kg(const rod_blank *blank)
{
    const double a = (double)blank->diameter_m[ROD_BUTT], b = (double)blank->diameter_m[ROD_TIP];
    const double bore = (double)blank->bore;
    return (double)blank->density_kg_m3 * M_PI / 12.0 * (a * a + a * b + b * b) *
           (1.0 - bore * bore) * (double)blank->length_m;
}

void params_derived_write(const rod_blank *blank, const rod_params *params, FILE *out)
{
    const rod_params chain = chain_of(blank, params);
    const double droop_m = params_droop_m(&chain), length_m = (double)blank->length_m;
    double hz[PARAMS_MODES_N];
    params_modes_hz(&chain, hz);
    fprintf(out, "\n#\n# It follows from");
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        const rod_blank_field *field = &rod_blank_fields[i];
        fprintf(out, "\n#   %s = %g", field->name, (double)rod_blank_get(field, blank, ROD_BUTT));
        if (field->values_n > 1) {
            fprintf(out, ", %g", (double)rod_blank_get(field, blank, ROD_TIP));
        }
        fprintf(out, "%s%s", *field->unit == '\0' ? "" : " ", field->unit);
    }
    fprintf(out, "\n# in %d links:", params->links_n);
    fprintf(out, "\n#   E I          %.4g N m^2 at the butt, %.4g at the tip",
            bending_nm2(blank, ROD_BUTT), bending_nm2(blank, ROD_TIP));
    fprintf(out, "\n#   mass         %.4g kg", mass_kg(blank));
    fprintf(out, "\n#   frequencies ");
    for (int mode = 0; mode < PARAMS_MODES_N && mode < params->links_n; mode++) {
        fprintf(out, "%s %.4g", mode == 0 ? "" : ",", hz[mode]);
    }
    fprintf(out, " Hz, in a still hand");
    if (droop_m > length_m) {
        fprintf(out, "\n#   droop        it hangs: it cannot be held out level");
    } else {
        fprintf(out, "\n#   droop        %.4g m at the tip, held out level%s", droop_m,
                droop_m > 0.2 * length_m ? ", if small deflections' theory held so far" : "");
    }
    if (params->model == ROD_MODEL_CONTOUR) {
        fprintf(out, "\n# contour keeps of it the first frequency, its damping, and how far a "
                     "sideways push of the"
                     "\n# hand bends it; not gravity, nor the higher frequencies, nor how far a "
                     "turn of the hand does.");
    }
}

static void warn_elastic(const rod_params *p, const double *hz)
{
    const double rate_hz = 1.0 / (double)p->tick_s;
    for (int mode = 0; mode < PARAMS_MODES_N && mode < p->links_n; mode++) {
        const double needed_hz = 2.0 * M_PI * hz[mode];
        if (needed_hz > rate_hz) {
            (void)sim_complain("warning: %s natural frequency, %.3g Hz, wants %.0f steps a second: "
                               "at a tick of %g ms it and those above are damped away; longer or "
                               "thinner is slower",
                               mode == 0   ? "the first"
                               : mode == 1 ? "the second"
                                           : "the third",
                               hz[mode], needed_hz, 1000.0 / rate_hz);
            break;
        }
    }
    for (int i = 0; i < p->links_n; i++) {
        for (int beyond = i + 1; beyond < p->links_n; beyond++) {
            if (1000.0f * p->mass_kg[i] < p->mass_kg[beyond]) {
                (void)sim_complain("warning: node %d weighs %.2g kg and node %d beyond it %.2g: a "
                                   "thousand times as much swings up by itself; hold the rod by "
                                   "its thick end",
                                   i + 1, (double)p->mass_kg[i], beyond + 1,
                                   (double)p->mass_kg[beyond]);
                return;
            }
        }
    }
}

/* Between joint i - 1 and joint i coupling has to hand on what all springs from i on take: over an arc bent by x that
 * is a step of x sum k / beta. Where the steps come to 2 x the tip hardly bends. */
static double steps_of_arc(const rod_params *p)
{
    double beyond = 0.0, steps = 0.0;
    for (int i = p->links_n - 1; i > 0; i--) {
        beyond += (double)p->spring[i];
        steps += beyond / (double)p->coupling[i];
    }
    return steps;
}

static void warn_contour(const rod_params *p)
{
    const double needed_hz = (double)rod_params_resolving_rate_hz(p);
    if (needed_hz * (double)p->tick_s > 1.001) {
        (void)sim_complain(
            "warning: its springs want %.0f steps a second, at a tick of %g ms there "
            "are fewer; longer or thinner is slower",
            needed_hz, 1000.0 * (double)p->tick_s);
    }
    if (steps_of_arc(p) > 2.0) {
        (void)sim_complain(
            "warning: as much coupling as a tick of %g ms resolves does not carry the "
            "bend to the tip, it stays near the hand; ask for fewer links",
            1000.0 * (double)p->tick_s);
    }
}

void params_derived_warn(const rod_blank *blank, const rod_params *params)
{
    if (params->model == ROD_MODEL_CONTOUR) {
        warn_contour(params);
        return;
    }
    const rod_params chain = chain_of(blank, params);
    double hz[PARAMS_MODES_N];
    params_modes_hz(&chain, hz);
    warn_elastic(params, hz);
}
