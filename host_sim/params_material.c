/* params_material.c - see params_material.h. */
#include "params_material.h"

#include <string.h>

#include "sim.h"

const char *const material_names[MATERIALS_N] = {
    [MATERIAL_SPRING_STEEL] = "spring-steel",
    [MATERIAL_ALUMINIUM] = "aluminium",
    [MATERIAL_CARBON] = "carbon",
    [MATERIAL_FIBREGLASS] = "fibreglass",
    [MATERIAL_BAMBOO] = "bamboo",
    [MATERIAL_ASH] = "ash",
    [MATERIAL_NYLON] = "nylon",
};

/* Along the fibres or the grain. Damping is that of the material alone only where its source says so: metals and
 * composites have ten times less (loss factors of 1e-4 to 1e-3: Cremer and Heckl, Structure-Borne Sound, chapter 3)
 * than a rod shows that a handle holds and air surrounds; for metal "under 0.01" (Adams and Askenazi, Building Better
 * Products with Finite Element Analysis). */
const material materials[MATERIALS_N] = {
    /* EN 10270-1, patented cold drawn spring wire: E = 206 GPa, 7.85 kg/dm^3; damping see above */
    [MATERIAL_SPRING_STEEL] = {206e9f, 7850.0f, 0.005f, "spring wire, EN 10270-1"},
    /* EN AW-6061-T6: E = 69 GPa, 2.70 kg/dm^3 (ASM Handbook, vol. 2); damping see above */
    [MATERIAL_ALUMINIUM] = {69e9f, 2700.0f, 0.005f, "6061-T6"},
    /* pultruded tube, 60 % of standard fibre by volume: flexural modulus 127 GPa, 1.5 g/cm^3 (Goodwinds, technical
     * material specifications); damping see above */
    [MATERIAL_CARBON] = {127e9f, 1500.0f, 0.005f, "standard fibre, unidirectional, 60 % by volume"},
    /* pultruded rod, 75 % of E-glass by weight: flexural modulus 6.0e6 psi, specific gravity 2.0 (Glasforms,
     * comparative material properties); damping see above */
    [MATERIAL_FIBREGLASS] = {41e9f, 2000.0f, 0.005f, "E-glass, unidirectional, 75 % by weight"},
    /* moso: as stiff as North American construction woods, but denser (Dixon and Gibson, J. R. Soc. Interface 11,
     * 20140321, 2014), of which Douglas-fir has 13.4 GPa (Wood Handbook, table 5-3); tan delta 0.01 in bending (Amada
     * and Lakes, J. Mater. Sci. 32, 2693, 1997) */
    [MATERIAL_BAMBOO] = {13e9f, 700.0f, 0.005f, "moso, along the culm"},
    /* white ash at 12 % moisture: 12.0 GPa, specific gravity 0.60 by dry mass; logarithmic decrement 0.02 (hot, dry) to
     * 0.1 (hot, moist) (Wood Handbook, FPL-GTR-190, chapter 5) */
    [MATERIAL_ASH] = {12e9f, 670.0f, 0.008f, "white ash at 12 % moisture, along the grain"},
    /* PA 66, conditioned at 50 % humidity: flexural modulus 1.2 GPa, 1.14 g/cm^3 (DuPont, Zytel 101 design guide); near
     * its glass transition, hence tan delta of some 0.08 */
    [MATERIAL_NYLON] = {1.2e9f, 1140.0f, 0.04f, "PA 66 as it is in a room"},
};

static const params_entry *entry_of(const params_text *text, const char *key)
{
    return &text->entries[params_key_find(key)];
}

static bool is_written(const params_text *text, const char *key)
{
    return entry_of(text, key)->values_n > 0;
}

/* The first key of a blank or a material that was written, or NULL. */
static const params_entry *asked(const params_text *text, const char **key)
{
    for (int i = PARAMS_KEYS_N - 1; i >= PARAMS_KEY_BLANK; i--) {
        if (text->entries[i].values_n > 0) {
            *key = params_key_at(i).name;
            return &text->entries[i];
        }
    }
    return NULL;
}

bool params_material_is_asked(const params_text *text)
{
    const char *key;
    return asked(text, &key) != NULL;
}

/* What a blank decides cannot be written as well; what it only suggests can, but not both ways. */
static int check_contradictions(const params_text *text)
{
    static const struct {
        const char *field, *beside; /* NULL: any key of a blank */
    } PAIRS[] = {
        {"length", NULL},
        {"spring", NULL},
        {"mass", NULL},
        {"inertia", NULL},
        {"damper", "damping_ratio"},
        {"drag", "air_drag"},
    };
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++) {
        const char *key = PAIRS[i].beside;
        const params_entry *beside = key == NULL ? asked(text, &key) : entry_of(text, key);
        const params_entry *field = entry_of(text, PAIRS[i].field);
        if (field->values_n > 0 && beside->values_n > 0) {
            return sim_complain(
                "%s: %s follows from %s (%s): leave out one of them%s", field->origin,
                PAIRS[i].field, key, beside->origin,
                strcmp(PAIRS[i].field, "length") == 0 ? "; total_length is the whole rod's" : "");
        }
    }
    return SIM_OK;
}

static int check_complete(const params_text *text)
{
    static const char *const NEEDED[] = {"youngs_modulus", "density", "diameter", "total_length"};
    const bool of_material = is_written(text, "material");
    char missing[100] = "";
    for (int i = 0; i < 4; i++) {
        const bool from_material = of_material && i < 2;
        if (!from_material && !is_written(text, NEEDED[i])) {
            strcat(strcat(missing, *missing == '\0' ? "" : ", "), NEEDED[i]);
        }
    }
    if (*missing == '\0' || text->preset != NULL) {
        return SIM_OK;
    }
    const char *key = NULL;
    const params_entry *first = asked(text, &key);
    return sim_complain("%s: for a rod that follows from %s add %s%s, or a preset", first->origin,
                        key, missing, of_material ? "" : " (a material gives the first two)");
}

int params_material_blank(const params_text *text, rod_blank *blank)
{
    int result = check_contradictions(text);
    if (result == SIM_OK) {
        result = check_complete(text);
    }
    if (result != SIM_OK) {
        return result;
    }
    *blank = text->preset != NULL ? text->preset->blank : (rod_blank){.damping_ratio = 0.01f};
    if (is_written(text, "material")) {
        const material *m = &materials[(int)entry_of(text, "material")->values[0]];
        blank->youngs_modulus_pa = m->youngs_modulus_pa;
        blank->density_kg_m3 = m->density_kg_m3;
        blank->damping_ratio = m->damping_ratio;
    }
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        const params_entry *entry = &text->entries[PARAMS_KEY_BLANK + i];
        for (int end = 0; end < rod_blank_fields[i].values_n && entry->values_n > 0; end++) {
            rod_blank_set(&rod_blank_fields[i], blank, end,
                          entry->values[end < entry->values_n ? end : entry->values_n - 1]);
        }
    }
    return SIM_OK;
}

void params_material_replaced(const params_text *text, FILE *out)
{
    static const char *const KEYS[] = {"damper", "drag", "coupling", "smoothing"};
    for (int i = 0; i < 4; i++) {
        if (is_written(text, KEYS[i])) {
            fprintf(out, "\n# but %s as written (%s)", KEYS[i], entry_of(text, KEYS[i])->origin);
        }
    }
}
