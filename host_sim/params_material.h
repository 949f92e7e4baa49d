/* params_material.h - rods asked for by what they are made of: a table of materials, and a blank from what was
 * written of one. */
#ifndef LIMBER_PARAMS_MATERIAL_H
#define LIMBER_PARAMS_MATERIAL_H

#include "params_text.h"

enum {
    MATERIAL_SPRING_STEEL,
    MATERIAL_ALUMINIUM,
    MATERIAL_CARBON,
    MATERIAL_FIBREGLASS,
    MATERIAL_BAMBOO,
    MATERIAL_ASH,
    MATERIAL_NYLON,
    MATERIALS_N
};

extern const char *const material_names[MATERIALS_N];

typedef struct {
    float youngs_modulus_pa, density_kg_m3, damping_ratio;
    const char *what; /* which kind of it these are numbers of */
} material;

extern const material materials[MATERIALS_N];

/* Was any key of a blank or a material written? */
bool params_material_is_asked(const params_text *text);

/* The blank that was written of: the preset's, where there is one, with its material, with its single numbers. Returns
 * SIM_OK, or SIM_BAD_INPUT after complaining of what is missing or contradicts it. */
int params_material_blank(const params_text *text, rod_blank *blank);

/* What to add to an INI file's title of keys that were written in place of what follows from the blank. */
void params_material_replaced(const params_text *text, FILE *out);

#endif
