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
     .limit_rad = {1.0f, 1.0f}},
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
     .limit_rad = {1.2f, 1.2f}},
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
     .limit_rad = {1.2f, 1.2f}},
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
     .limit_rad = {1.2f, 1.2f}},
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
     .limit_rad = {0.5f, 0.5f}},
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

void rod_preset_fill(const rod_preset *preset, int links_n, rod_params *params)
{
    rod_params_defaults(params);
    params->links_n = links_n;
    params->hold_n = preset->hold_n;
    fill(preset->length_m, links_n, params->length_m);
    fill(preset->inertia, links_n, params->inertia);
    fill(preset->drag, links_n, params->drag);
    fill(preset->coupling, links_n, params->coupling);
    params->coupling[0] = preset->hand_coupling;
    fill(preset->smoothing, links_n, params->smoothing);
    fill(preset->spring, links_n, params->spring);
    fill(preset->damper, links_n, params->damper);
    fill(preset->limit_rad, links_n, params->limit_rad);
}
