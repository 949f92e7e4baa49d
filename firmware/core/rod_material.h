/* rod_material.h - a rod asked for by what it is made of: a round blank of one material, solid or a tube, whose
 * thickness runs evenly from butt to tip, becomes the coefficients of either model (MODEL.md, "Rods of real
 * materials").
 *
 *     rod_params_defaults(&params);
 *     params.model = ROD_MODEL_ELASTIC;
 *     params.links_n = 20;
 *     if (rod_blank_check(&blank, NULL)) {
 *         rod_blank_fill(&blank, &params);      // then rod_init, which says what the rod itself cannot take
 *     }
 *
 * SI units. Plain data, pure functions; no heap, no libm.
 */
#ifndef LIMBER_ROD_MATERIAL_H
#define LIMBER_ROD_MATERIAL_H

#include "rod_params.h"

enum { ROD_BUTT, ROD_TIP, ROD_ENDS_N };

/* A blank of rectangular section, b wide and h thick, bends across h like a round one of diameter 2 h / sqrt 3 whose
 * modulus and density are both 3 b / (pi h) times the material's; for a square that factor is 0.95. */
typedef struct {
    float youngs_modulus_pa; /* E */
    float density_kg_m3;     /* rho */
    float diameter_m[ROD_ENDS_N];
    float bore;          /* inner / outer diameter: 0 is solid */
    float damping_ratio; /* zeta: of the first mode, of critical */
    float length_m;      /* from the hand to the tip */
    float drag_n_s_m2;   /* of the air, per metre of rod */
} rod_blank;

typedef struct {
    const char *name; /* the key in INI files and on the command line */
    const char *unit; /* "" where there is none */
    const char *what; /* half a sentence for people */
    int values_n;     /* ROD_ENDS_N where butt and tip differ, else 1 */
    float min, max;
    size_t offset; /* into rod_blank: float[values_n] */
} rod_blank_field;

enum { ROD_BLANK_FIELDS_N = 7 };
extern const rod_blank_field rod_blank_fields[ROD_BLANK_FIELDS_N];

float rod_blank_get(const rod_blank_field *field, const rod_blank *blank, int end);
void rod_blank_set(const rod_blank_field *field, rod_blank *blank, int end, float value);

/* Where and why a blank was refused. */
typedef struct {
    const rod_blank_field *field;
    int end; /* ROD_BUTT or ROD_TIP */
    float value;
} rod_blank_refusal;

/* Is every number of it within its bounds? Otherwise *refusal, which may be NULL, says which is not. */
bool rod_blank_check(const rod_blank *blank, rod_blank_refusal *refusal);

/* What follows from the blank for a rod of params->model and params->links_n: length, spring, damper, drag and mass;
 * for contour also inertia, coupling and smoothing, at params->tick_s. Of these lists the entries beyond links_n are
 * those of the last link; all else stays as it is. The result may be out of the rod's own bounds: rod_params_check. */
void rod_blank_fill(const rod_blank *blank, rod_params *params);

#endif
