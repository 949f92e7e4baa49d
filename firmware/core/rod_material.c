/* rod_material.c - see rod_material.h. The derivation is in MODEL.md, "Rods of real materials". */
#include "rod_material.h"

#include <string.h>

#include "trig.h"

const rod_blank_field rod_blank_fields[ROD_BLANK_FIELDS_N] = {
    {"youngs_modulus", "Pa", "stiffness of the material, along the rod", 1, 1e5f, 1e12f,
     offsetof(rod_blank, youngs_modulus_pa)},
    {"density", "kg/m^3", "of the material", 1, 10.0f, 25000.0f,
     offsetof(rod_blank, density_kg_m3)},
    {"diameter", "m", "outside; one value, or butt and tip", ROD_ENDS_N, 1e-4f, 0.5f,
     offsetof(rod_blank, diameter_m)},
    {"bore", "", "inner / outer diameter of a tube; 0 is solid", 1, 0.0f, 0.99f,
     offsetof(rod_blank, bore)},
    {"damping_ratio", "", "of the first mode; 1 is critical", 1, 0.0f, 1.0f,
     offsetof(rod_blank, damping_ratio)},
    {"total_length", "m", "from the hand to the tip", 1, 0.01f, 100.0f,
     offsetof(rod_blank, length_m)},
    {"air_drag", "N s/m^2", "of the air, per metre of rod", 1, 0.0f, 100.0f,
     offsetof(rod_blank, drag_n_s_m2)},
};

static size_t place(const rod_blank_field *field, int end)
{
    return field->offset + (field->values_n > 1 ? (size_t)end * sizeof(float) : 0);
}

float rod_blank_get(const rod_blank_field *field, const rod_blank *blank, int end)
{
    float value;
    memcpy(&value, (const char *)blank + place(field, end), sizeof value);
    return value;
}

void rod_blank_set(const rod_blank_field *field, rod_blank *blank, int end, float value)
{
    memcpy((char *)blank + place(field, end), &value, sizeof value);
}

bool rod_blank_check(const rod_blank *blank, rod_blank_refusal *refusal)
{
    for (int i = 0; i < ROD_BLANK_FIELDS_N; i++) {
        const rod_blank_field *field = &rod_blank_fields[i];
        for (int end = 0; end < field->values_n; end++) {
            const float value = rod_blank_get(field, blank, end);
            if (!(value >= field->min && value <= field->max)) { /* NaN fails as well */
                if (refusal != NULL) {
                    *refusal = (rod_blank_refusal){field, end, value};
                }
                return false;
            }
        }
    }
    return true;
}

/* --- elastic ---------------------------------------------------------------------------------------- */

/* Outside diameter where `share` of the length lies behind. */
static float diameter_at(const rod_blank *blank, float share)
{
    const float *d = blank->diameter_m;
    return d[ROD_BUTT] + (d[ROD_TIP] - d[ROD_BUTT]) * share;
}

/* E I, N m^2. */
static float bending_stiffness(const rod_blank *blank, float share)
{
    const float d = diameter_at(blank, share), b = blank->bore;
    const float squared = d * d, hollow = b * b;
    return blank->youngs_modulus_pa * (TRIG_PI / 64.0f) * (squared * squared) *
           (1.0f - hollow * hollow);
}

/* Of a frustum of this length between two shares of the whole, kg. */
static float frustum_mass(const rod_blank *blank, float from, float to, float length_m)
{
    const float a = diameter_at(blank, from), b = diameter_at(blank, to);
    const float mean_squared = (a * a + a * b + b * b) * (1.0f / 3.0f);
    return blank->density_kg_m3 * (TRIG_PI / 4.0f) * mean_squared *
           (1.0f - blank->bore * blank->bore) * length_m;
}

/* A joint bends for the half links on its sides, a node weighs what they weigh: the first joint has but half a
 * link, hence twice the stiffness, and the last node but half a link's mass. The stiffness is that at the joint: with
 * it a tapered chain is no farther from its beam than a uniform one (MODEL.md has the numbers). */
static void fill_elastic(const rod_blank *blank, rod_params *params)
{
    const int links_n = params->links_n;
    const float per_link = 1.0f / (float)links_n, link_m = blank->length_m / (float)links_n;
    for (int i = 0; i < links_n; i++) {
        const float joint_at = (float)i * per_link, node_at = (float)(i + 1) * per_link;
        const float half = 0.5f * per_link;
        const float joint_m = i == 0 ? 0.5f * link_m : link_m;
        const float node_m = i + 1 == links_n ? 0.5f * link_m : link_m;
        params->length_m[i] = link_m;
        params->spring[i] = bending_stiffness(blank, joint_at) / joint_m;
        params->mass_kg[i] = frustum_mass(blank, node_at - half,
                                          i + 1 == links_n ? node_at : node_at + half, node_m);
        params->drag[i] = blank->drag_n_s_m2 * node_m;
    }
    const float omega = 2.0f * TRIG_PI * rod_params_first_mode_hz(params);
    const float relaxation_s = 2.0f * blank->damping_ratio / omega;
    for (int i = 0; i < links_n; i++) {
        params->damper[i] = relaxation_s * params->spring[i];
    }
}

/* --- contour ---------------------------------------------------------------------------------------- */

/* What the rod shows of itself to a hand that accelerates sideways by 1 m/s^2. */
typedef struct {
    float tip_m;      /* how far the tip stays behind */
    float drag_per_s; /* drag / mass, as the bent shape weights them */
} sway;

static sway sway_of(const rod_params *params)
{
    const int n = params->links_n;
    float bend[ROD_MAX_LINKS] = {0.0f}, force = 0.0f, moment = 0.0f;
    for (int i = n - 1; i >= 0; i--) {
        force += params->mass_kg[i];
        moment += force * params->length_m[i];
        bend[i] = moment / params->spring[i];
    }
    float slope = 0.0f, behind_m = 0.0f, drag = 0.0f, mass = 0.0f;
    for (int i = 0; i < n; i++) {
        slope += bend[i];
        behind_m += slope * params->length_m[i];
        drag += params->drag[i] * behind_m * behind_m;
        mass += params->mass_kg[i] * behind_m * behind_m;
    }
    return (sway){behind_m, drag / mass};
}

static float smaller(float a, float b)
{
    return a < b ? a : b;
}

/* beta: what gives a uniform rod its second frequency as well, as far as the tick resolves it (rod_params.h). */
static void couple(rod_params *params)
{
    const int n = params->links_n;
    const float per_tick_squared = 1.0f / (params->tick_s * params->tick_s);
    params->coupling[0] = 0.0f; /* joint 1 turns freely in the hand */
    for (int i = 1; i < n; i++) {
        const float mean = 0.5f * (params->spring[i - 1] + params->spring[i]);
        const float room =
            smaller(params->inertia[i - 1] * per_tick_squared - params->spring[i - 1],
                    params->inertia[i] * per_tick_squared - params->spring[i]);
        const float wanted = 4.0f * (float)(n * n) * mean;
        params->coupling[i] = room > 0.0f ? smaller(wanted, 0.25f * room) : 0.0f;
    }
}

/* Springs k as in the rod, and one shape that swings: an arc, every joint bent alike. Its frequency is sqrt(sum k /
 * sum mu). The hand moves joint 1 alone, by what it goes aside over l: mu of joint 1 is such that a hand that
 * accelerates bends the arc as far as the rod; the other joints share the rest of sum mu. */
static void fill_contour(const rod_blank *blank, rod_params *params)
{
    const int n = params->links_n;
    params->model = ROD_MODEL_ELASTIC;
    fill_elastic(blank, params);
    const sway seen = sway_of(params);
    const float omega = 2.0f * TRIG_PI * rod_params_first_mode_hz(params);
    params->model = ROD_MODEL_CONTOUR;
    params->spring[0] *= 0.5f; /* bent like its neighbours, not for half a link */

    float spring = 0.0f, arm_m = 0.0f;
    for (int i = 0; i < n; i++) {
        spring += params->spring[i];
        arm_m += (float)(n - i) * params->length_m[i];
    }
    const float first = params->length_m[0] * spring * seen.tip_m / arm_m;
    const float rest = spring / (omega * omega) - first;
    for (int i = 0; i < n; i++) {
        params->inertia[i] =
            i == 0 ? first : rest * params->spring[i] / (spring - params->spring[0]);
        params->damper[i] = 2.0f * blank->damping_ratio * omega * params->inertia[i];
        params->drag[i] = seen.drag_per_s * params->inertia[i];
        params->smoothing[i] = 0.0f;
    }
    couple(params);
}

/* Links that come later are like the last. */
static void repeat_last(rod_params *params)
{
    const int last = params->links_n - 1;
    for (int i = params->links_n; i < ROD_MAX_LINKS; i++) {
        params->length_m[i] = params->length_m[last];
        params->inertia[i] = params->inertia[last];
        params->drag[i] = params->drag[last];
        params->coupling[i] = params->coupling[last];
        params->smoothing[i] = params->smoothing[last];
        params->spring[i] = params->spring[last];
        params->damper[i] = params->damper[last];
        params->mass_kg[i] = params->mass_kg[last];
    }
}

void rod_blank_fill(const rod_blank *blank, rod_params *params)
{
    if (params->model == ROD_MODEL_ELASTIC) {
        fill_elastic(blank, params);
    } else {
        fill_contour(blank, params);
    }
    repeat_last(params);
}
