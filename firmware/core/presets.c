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
     /* FIE material rules, m.8: a blade of steel, quadrangular, at most 90 cm; clamped 70 cm from its point, 200 g hung
      * 3 cm from it bend it by 5.5 to 9.5 cm. A square one that runs evenly from 4.7 to 2.2 mm bends by 7.3 cm; this
      * round one is as stiff, and 2 % heavier. 88 g, 6.8 Hz. */
     .blank = {.youngs_modulus_pa = 206e9f,
               .density_kg_m3 = 7850.0f,
               .diameter_m = {5.4e-3f, 2.5e-3f},
               .bore = 0.0f,
               .damping_ratio = 0.03f,
               .length_m = 0.88f,
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
     /* A bullwhip's belly as its maker gives it (Palo Duro Whips, no. 28 "Ranger", 2018, kangaroo hide): 15.5 mm at
      * the handle and 5.3 mm after 1.68 m; of that the 0.96 m next to the hand. Leather's modulus varies tenfold with
      * hide and tanning; with this one the whip stands upright, but only just. 0.12 kg, 0.9 Hz. */
     .blank = {.youngs_modulus_pa = 85e6f,
               .density_kg_m3 = 950.0f,
               .diameter_m = {15.5e-3f, 9.7e-3f},
               .bore = 0.0f,
               .damping_ratio = 0.055f,
               .length_m = 0.96f,
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
     /* No satin stands up: this is a cord of soft plastic. 12 g, 0.7 Hz; stiff enough to be held out level, and no
      * more. */
     .blank = {.youngs_modulus_pa = 1e9f,
               .density_kg_m3 = 1000.0f,
               .diameter_m = {5e-3f, 2e-3f},
               .bore = 0.0f,
               .damping_ratio = 0.02f,
               .length_m = 1.2f,
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
     /* A carbon fly-rod blank as its maker gives it (Rod Geeks, Carbon 4 Fly spec sheet, C4F703.4): 7 ft, butt 0.276
      * in, tip 4/64 in, 0.85 oz, from which the bore follows. Of its 2.13 m the 1.8 m beyond the handle. 17 g, 5 Hz. */
     .blank = {.youngs_modulus_pa = 127e9f,
               .density_kg_m3 = 1500.0f,
               .diameter_m = {6.2e-3f, 1.6e-3f},
               .bore = 0.735f,
               .damping_ratio = 0.05f,
               .length_m = 1.8f,
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
     /* A round 10 mm bar of acrylic, 157 Hz: about what a tick of 1 ms resolves. */
     .blank = {.youngs_modulus_pa = 3.1e9f,
               .density_kg_m3 = 1190.0f,
               .diameter_m = {0.01f, 0.01f},
               .bore = 0.0f,
               .damping_ratio = 0.24f,
               .length_m = 0.12f,
               .drag_n_s_m2 = 0.0f}},
    {.name = "ribbon-stick",
     .what = "the stick of a gymnast's ribbon: light and quick",
     .links_n = 10,
     .hold_n = 1,
     .length_m = {0.06f, 0.06f},
     .inertia = {0.2f, 0.2f},
     .drag = {0.0f, 0.0f},
     .hand_coupling = 0.0f,
     .coupling = {40000.0f, 40000.0f},
     .smoothing = {0.0f, 0.0f},
     .spring = {3200.0f, 1600.0f},
     .damper = {1.0f, 1.0f},
     .limit_rad = {1.0f, 1.0f},
     /* FIG apparatus norms, rhythmic gymnastics (2016), the ribbon's cane: wood, bamboo, fibreglass or synthetics, 500
      * to 600 mm, at most 10 mm thick, cylindrical or conical. Of fibreglass 30 g, 21 Hz. */
     .blank = {.youngs_modulus_pa = 41e9f,
               .density_kg_m3 = 2000.0f,
               .diameter_m = {8e-3f, 3e-3f},
               .bore = 0.0f,
               .damping_ratio = 0.01f,
               .length_m = 0.6f,
               .drag_n_s_m2 = 0.005f}},
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

void rod_preset_fill(const rod_preset *preset, int32_t model, int links_n, rod_params *params)
{
    rod_params_defaults(params);
    params->model = model;
    params->links_n = links_n;
    fill(preset->limit_rad, links_n, params->limit_rad);
    if (model == ROD_MODEL_ELASTIC) {
        rod_blank_fill(&preset->blank, params);
    } else {
        fill_contour(preset, params);
    }
}
