/* presets.c - see presets.h. */
#include "presets.h"

#include <string.h>

const rod_preset rod_presets[ROD_PRESETS_N] = {
    {.name = "foil",
     .what = "a fencing blade: stiff at the guard, whippy at the point",
     .links_n = 8,
     .hold_n = 1,
     .length_m = {0.11f, 0.11f},
     .inertia = {0.2f, 0.2f},
     .drag = {0.0f, 0.0f},
     .hand_coupling = 0.0f,
     .coupling = {800.0f, 800.0f},
     .smoothing = {0.0f, 0.0f},
     .spring = {800.0f, 200.0f},
     .damper = {3.0f, 1.0f},
     .limit_rad = {1.0f, 1.0f},
     /* A steel blade of 0.18 kg, 4.3 Hz. Clamped 70 cm from its point, 200 g on it bend it by 7.6 cm; the FIE's
      * material rules (m.8) want 5.5 to 9.5. */
     .elastic = {.length_m = 0.88f,
                 .bending_n_m2 = 7.5f,
                 .mass_kg_m = 0.36f,
                 .tip = 0.5f,
                 .relaxation_s = 2e-3f,
                 .drag_n_s_m2 = 0.01f}},
    {.name = "whip",
     .what = "a bullwhip: soft all along, the bend runs out to the tip",
     .links_n = 12,
     .hold_n = 1,
     .length_m = {0.08f, 0.08f},
     .inertia = {0.2f, 0.2f},
     .drag = {0.0f, 0.0f},
     .hand_coupling = 0.0f,
     .coupling = {1500.0f, 1500.0f},
     .smoothing = {0.0f, 0.0f},
     .spring = {40.0f, 20.0f},
     .damper = {1.0f, 0.5f},
     .limit_rad = {1.2f, 1.2f},
     /* 0.13 kg, 0.9 Hz; stands upright, but only just. */
     .elastic = {.length_m = 0.96f,
                 .bending_n_m2 = 0.25f,
                 .mass_kg_m = 0.3f,
                 .tip = 0.3f,
                 .relaxation_s = 0.02f,
                 .drag_n_s_m2 = 0.02f}},
    {.name = "ribbon",
     .what = "a gymnast's ribbon: hardly any spring, much air, rounded curves",
     .links_n = 20,
     .hold_n = 1,
     .length_m = {0.06f, 0.06f},
     .inertia = {0.2f, 0.2f},
     .drag = {1.0f, 2.0f},
     .hand_coupling = 0.0f,
     .coupling = {1500.0f, 1500.0f},
     .smoothing = {500.0f, 500.0f},
     .spring = {15.0f, 5.0f},
     .damper = {1.0f, 1.0f},
     .limit_rad = {1.2f, 1.2f},
     /* 13 g, 0.7 Hz; stiff enough to be held out level, and no more. */
     .elastic = {.length_m = 1.2f,
                 .bending_n_m2 = 0.03f,
                 .mass_kg_m = 0.02f,
                 .tip = 0.4f,
                 .relaxation_s = 0.01f,
                 .drag_n_s_m2 = 0.05f}},
    {.name = "fishing-rod",
     .what = "fast taper: a stout butt, a tip that nods",
     .links_n = 12,
     .hold_n = 1,
     .length_m = {0.15f, 0.15f},
     .inertia = {0.4f, 0.1f},
     .drag = {0.0f, 0.5f},
     .hand_coupling = 0.0f,
     .coupling = {1500.0f, 500.0f},
     .smoothing = {100.0f, 50.0f},
     .spring = {600.0f, 30.0f},
     .damper = {4.0f, 0.5f},
     .limit_rad = {1.2f, 1.2f},
     /* A carbon blank of 77 g with its guides, 3.1 Hz. */
     .elastic = {.length_m = 1.8f,
                 .bending_n_m2 = 12.0f,
                 .mass_kg_m = 0.1f,
                 .tip = 0.25f,
                 .relaxation_s = 0.005f,
                 .drag_n_s_m2 = 0.01f}},
    {.name = "stiff-bar",
     .what = "nearly rigid: to check wiring and directions with",
     .links_n = 4,
     .hold_n = 1,
     .length_m = {0.03f, 0.03f},
     .inertia = {0.2f, 0.2f},
     .drag = {0.0f, 0.0f},
     .hand_coupling = 100.0f,
     .coupling = {100.0f, 100.0f},
     .smoothing = {0.0f, 0.0f},
     .spring = {8000.0f, 8000.0f},
     .damper = {30.0f, 30.0f},
     .limit_rad = {0.5f, 0.5f},
     /* A round 10 mm bar of acrylic, 150 Hz: about what a tick of 1 ms resolves. */
     .elastic = {.length_m = 0.12f,
                 .bending_n_m2 = 1.5f,
                 .mass_kg_m = 0.1f,
                 .tip = 1.0f,
                 .relaxation_s = 5e-4f,
                 .drag_n_s_m2 = 0.0f}},
};

const rod_preset *rod_preset_find(const char *name)
{
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        if (strcmp(rod_presets[i].name, name) == 0) {
            return &rod_presets[i];
        }
    }
    return NULL;
}

static void fill(rod_taper taper, int links_n, float *per_joint)
{
    const float step = links_n > 1 ? (taper.last - taper.first) / (float)(links_n - 1) : 0.0f;
    for (int i = 0; i < ROD_MAX_LINKS; i++) {
        per_joint[i] = i < links_n ? taper.first + (float)i * step : taper.last;
    }
}

static void fill_contour(const rod_preset *preset, rod_params *params)
{
    const int links_n = params->links_n;
    params->hold_n = preset->hold_n;
    fill(preset->length_m, links_n, params->length_m);
    fill(preset->inertia, links_n, params->inertia);
    fill(preset->drag, links_n, params->drag);
    fill(preset->coupling, links_n, params->coupling);
    params->coupling[0] = preset->hand_coupling;
    fill(preset->smoothing, links_n, params->smoothing);
    fill(preset->spring, links_n, params->spring);
    fill(preset->damper, links_n, params->damper);
}

/* A joint bends for the half links on its sides, a node weighs what they weigh: the first joint has but half a
 * link, hence twice the stiffness, and the last node half the mass (MODEL.md, Section 5). */
static void fill_elastic(const rod_blank *blank, rod_params *params)
{
    const int links_n = params->links_n;
    const float length_m = blank->length_m / (float)links_n;
    const float thinner = (1.0f - blank->tip) / (float)links_n;
    for (int i = 0; i < links_n; i++) {
        const float near = 1.0f - thinner * (float)i, far = near - thinner;
        const float joint_share = i == 0 ? 0.5f : 1.0f, node_share = i + 1 == links_n ? 0.5f : 1.0f;
        const float spring =
            blank->bending_n_m2 * (near * near) * (near * near) / (length_m * joint_share);
        params->length_m[i] = length_m;
        params->spring[i] = spring;
        params->damper[i] = blank->relaxation_s * spring;
        params->mass_kg[i] = blank->mass_kg_m * (far * far) * (length_m * node_share);
        params->drag[i] = blank->drag_n_s_m2 * (length_m * node_share);
    }
    for (int i = links_n; i < ROD_MAX_LINKS; i++) { /* for links that come later */
        params->length_m[i] = length_m;
        params->spring[i] = params->spring[links_n - 1];
        params->damper[i] = params->damper[links_n - 1];
        params->mass_kg[i] = params->mass_kg[links_n - 1];
        params->drag[i] = params->drag[links_n - 1];
    }
}

void rod_preset_fill(const rod_preset *preset, int32_t model, int links_n, rod_params *params)
{
    rod_params_defaults(params);
    params->model = model;
    params->links_n = links_n;
    fill(preset->limit_rad, links_n, params->limit_rad);
    if (model == ROD_MODEL_ELASTIC) {
        fill_elastic(&preset->elastic, params);
    } else {
        fill_contour(preset, params);
    }
}
