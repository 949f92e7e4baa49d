/* presets.h - ready-made rods: for the contour model stiff enough for real hands (3 ... 15 m/s, 50 ... 100 m/s^2),
 * for the elastic one what such a thing is made of.
 *
 * A contour preset has coefficients that run linearly from the first joint to the last, and links of one length,
 * so with more links it is longer. An elastic preset is one rod whatever the number of links: with more of them
 * it is the same length, cut finer. Constant tables in flash; pure functions.
 */
#ifndef LIMBER_PRESETS_H
#define LIMBER_PRESETS_H

#include "rod_material.h"

typedef struct {
    float first, last;
} rod_taper;

typedef struct {
    const char *name;
    const char *what; /* half a sentence for people */
    int links_n;      /* suits it best */
    int hold_n;
    float hand_coupling; /* beta of joint 1, to the hand: 0 lets it turn freely */
    rod_taper length_m, inertia, drag, coupling, smoothing, spring, damper, limit_rad;
    rod_blank blank;
} rod_preset;

enum { ROD_PRESETS_N = 6 };
extern const rod_preset rod_presets[ROD_PRESETS_N];

/* The preset of that name, or NULL. */
const rod_preset *rod_preset_find(const char *name);

/* All parameters of the preset for a model (ROD_MODEL_...) and links_n links (1 ... ROD_MAX_LINKS; preset->links_n
 * suits it best), at a 1 ms tick; what the model does not read, and the scheme, as by default. */
void rod_preset_fill(const rod_preset *preset, int32_t model, int links_n, rod_params *params);

#endif
