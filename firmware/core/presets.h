/* presets.h - ready-made rods, stiff enough for real hands (3 ... 15 m/s, 50 ... 100 m/s^2).
 *
 * Each coefficient runs linearly from the first joint to the last, so a preset exists for every N.
 * Constant tables in flash; pure functions.
 */
#ifndef LIMBER_PRESETS_H
#define LIMBER_PRESETS_H

#include "rod_params.h"

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
} rod_preset;

enum { ROD_PRESETS_N = 5 };
extern const rod_preset rod_presets[ROD_PRESETS_N];

/* The preset of that name, or NULL. */
const rod_preset *rod_preset_find(const char *name);

/* All parameters of the preset for links_n links (1 ... ROD_MAX_LINKS; preset->links_n suits it
 * best), model and scheme as by default, at a 1 ms tick. */
void rod_preset_fill(const rod_preset *preset, int links_n, rod_params *params);

#endif
