/* rod_params.c - see rod_params.h. */
#include "rod_params.h"

#include <string.h>

#include "trig.h"

static const char *const MODELS[] = {"contour", "elastic"};
static const char *const SCHEMES[] = {"midpoint", "paper"};

/* Which models read a field. */
enum {
    CONTOUR = 1 << ROD_MODEL_CONTOUR,
    ELASTIC = 1 << ROD_MODEL_ELASTIC,
    BOTH = CONTOUR | ELASTIC
};

// clang-format off
#define CHOICE(member, models, name, what, error, names, count)                                    \
    {                                                                                              \
        name, "", "", what, ROD_FIELD_CHOICE, error, 0.0f, (float)((count)-1), 0.0f, models,       \
            names, offsetof(rod_params, member)                                                    \
    }
#define COUNT_OF(member, models, name, symbol, what, error, min, max, initial)                     \
    {                                                                                              \
        name, symbol, "", what, ROD_FIELD_COUNT_OF, error, min, max, initial, models, NULL,        \
            offsetof(rod_params, member)                                                           \
    }
#define NUMBER(kind, member, models, name, symbol, unit, what, error, min, max, initial)           \
    {                                                                                              \
        name, symbol, unit, what, kind, error, min, max, initial, models, NULL,                    \
            offsetof(rod_params, member)                                                           \
    }
// clang-format on

const rod_field rod_fields[ROD_FIELDS_N] = {
    CHOICE(model, BOTH, "model", "which mathematics bends the rod", ROD_E_MODEL, MODELS,
           ROD_MODEL_COUNT),
    CHOICE(scheme, CONTOUR, "scheme", "time stepping: midpoint, or the paper's for comparison",
           ROD_E_SCHEME, SCHEMES, ROD_SCHEME_COUNT),
    COUNT_OF(links_n, BOTH, "links", "N", "number of links", ROD_E_LINKS, 1.0f,
             (float)ROD_MAX_LINKS, 4.0f),
    COUNT_OF(hold_n, CONTOUR, "hold", "", "link ends that stay behind when the base moves",
             ROD_E_HOLD, 1.0f, 2.0f, 1.0f),
    NUMBER(ROD_FIELD_SCALAR, tick_s, BOTH, "tick", "dt", "s", "time step", ROD_E_TICK, 5e-5f, 0.1f,
           0.001f),
    NUMBER(ROD_FIELD_PER_JOINT, length_m, BOTH, "length", "l", "m", "length of each link",
           ROD_E_LENGTH, 1e-3f, 10.0f, 0.03f),
    NUMBER(ROD_FIELD_PER_JOINT, inertia, CONTOUR, "inertia", "mu", "kg m^2",
           "resists turning in the world: more is slower and swings further", ROD_E_INERTIA, 1e-6f,
           1e3f, 0.2f),
    NUMBER(ROD_FIELD_PER_JOINT, drag, BOTH, "drag", "gamma", "N m s",
           "resists turning in the world, like air; elastic: N s/m, a node's motion", ROD_E_DRAG,
           0.0f, 1e4f, 0.0f),
    NUMBER(ROD_FIELD_PER_JOINT, coupling, CONTOUR, "coupling", "beta", "N m",
           "pulls neighbouring joints to one angle: spreads a bend along the rod", ROD_E_COUPLING,
           0.0f, 1e6f, 100.0f),
    NUMBER(ROD_FIELD_PER_JOINT, smoothing, CONTOUR, "smoothing", "eta", "N m",
           "pulls three joints onto a line: rounds the spread off", ROD_E_SMOOTHING, 0.0f, 1e6f,
           0.0f),
    NUMBER(ROD_FIELD_PER_JOINT, spring, BOTH, "spring", "k", "N m",
           "pulls each joint straight: stiffness", ROD_E_SPRING, 0.0f, 1e6f, 80.0f),
    NUMBER(ROD_FIELD_PER_JOINT, damper, BOTH, "damper", "c", "N m s",
           "resists bending: takes out ripples", ROD_E_DAMPER, 0.0f, 1e4f, 2.0f),
    NUMBER(ROD_FIELD_PER_JOINT, limit_rad, BOTH, "limit", "", "rad",
           "the joint's stop, either side", ROD_E_LIMIT, 1e-3f, 1.57f, 1.4f),
    NUMBER(ROD_FIELD_PER_JOINT, mass_kg, ELASTIC, "mass", "m", "kg",
           "of the node at each link's far end (elastic only)", ROD_E_MASS, 1e-6f, 1e3f, 0.02f),
    NUMBER(ROD_FIELD_SCALAR, gravity_m_s2, ELASTIC, "gravity", "g", "m/s^2",
           "along the world's -z; 0 switches it off (elastic only)", ROD_E_GRAVITY, 0.0f, 100.0f,
           9.81f),
};

static const char *const ERROR_TEXT[] = {
    "fine",
    "model is not one this build has",
    "scheme is neither midpoint nor paper",
    "links is out of bounds",
    "hold is neither 1 nor 2",
    "tick is out of bounds",
    "length is out of bounds",
    "inertia is out of bounds",
    "drag is out of bounds",
    "coupling is out of bounds",
    "smoothing is out of bounds",
    "spring is out of bounds",
    "damper is out of bounds",
    "limit is out of bounds",
    "(drag + damper) * tick exceeds 2 * inertia: raise the inertia or the tick rate, or damp less",
    "stiffness and inertia are too far apart for float32: raise the inertia or the tick rate",
    "base pose is not finite, is beyond 1000 m, or its quaternion is not of unit length",
    "an external force is not finite or far too large",
    "the step's result is not finite",
    "mass is out of bounds",
    "gravity is out of bounds",
    "an object is of no known kind, or one of its numbers is out of bounds",
    "a shape's angle, strength or blend is out of bounds",
};

const char *rod_error_text(rod_error error)
{
    const int index = -(int)error;
    const int known_n = (int)(sizeof ERROR_TEXT / sizeof ERROR_TEXT[0]);
    return index >= 0 && index < known_n ? ERROR_TEXT[index] : "unknown error";
}

const rod_field *rod_field_find(const char *name)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        if (strcmp(rod_fields[i].name, name) == 0) {
            return &rod_fields[i];
        }
    }
    return NULL;
}

bool rod_field_is_read(const rod_field *field, int32_t model)
{
    return (field->models >> model & 1u) != 0;
}

static bool is_integer(const rod_field *field)
{
    return field->kind == ROD_FIELD_CHOICE || field->kind == ROD_FIELD_COUNT_OF;
}

static size_t place(const rod_field *field, int joint)
{
    const size_t entry = field->kind == ROD_FIELD_PER_JOINT ? (size_t)joint * sizeof(float) : 0;
    return field->offset + entry;
}

float rod_field_get(const rod_field *field, const rod_params *params, int joint)
{
    const char *const from = (const char *)params + place(field, joint);
    if (is_integer(field)) {
        int32_t whole;
        memcpy(&whole, from, sizeof whole);
        return (float)whole;
    }
    float value;
    memcpy(&value, from, sizeof value);
    return value;
}

void rod_field_set(const rod_field *field, rod_params *params, int joint, float value)
{
    char *const to = (char *)params + place(field, joint);
    if (is_integer(field)) {
        /* a cast of what no int32 holds differs between machines: such values become -1, which
         * every integer field refuses */
        const int32_t whole = value >= -1e6f && value <= 1e6f ? (int32_t)value : -1;
        memcpy(to, &whole, sizeof whole);
    } else {
        memcpy(to, &value, sizeof value);
    }
}

void rod_params_defaults(rod_params *params)
{
    memset(params, 0, sizeof *params);
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        const int entries_n = field->kind == ROD_FIELD_PER_JOINT ? ROD_MAX_LINKS : 1;
        for (int joint = 0; joint < entries_n; joint++) {
            rod_field_set(field, params, joint, field->initial);
        }
    }
}

static rod_error refuse(rod_refusal *refusal, rod_refusal why)
{
    if (refusal != NULL) {
        *refusal = why;
    }
    return why.error;
}

rod_error rod_params_check(const rod_params *params, rod_refusal *refusal)
{
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        const bool per_joint = field->kind == ROD_FIELD_PER_JOINT;
        /* links comes before every list in the table, so it has been found good by now */
        const int entries_n = per_joint ? params->links_n : 1;
        for (int joint = 0; joint < entries_n; joint++) {
            const float value = rod_field_get(field, params, joint);
            if (!(value >= field->min && value <= field->max)) { /* NaN fails as well */
                return refuse(refusal, (rod_refusal){field->error, field, per_joint ? joint : -1,
                                                     value, field->min, field->max});
            }
        }
    }
    for (int joint = 0; params->model == ROD_MODEL_CONTOUR && joint < params->links_n; joint++) {
        const float damper_max =
            2.0f * params->inertia[joint] / params->tick_s - params->drag[joint];
        if (params->damper[joint] > damper_max) {
            return refuse(refusal, (rod_refusal){ROD_E_OVERDAMPED, rod_field_find("damper"), joint,
                                                 params->damper[joint], 0.0f, damper_max});
        }
    }
    return refuse(refusal, (rod_refusal){ROD_OK, NULL, -1, 0.0f, 0.0f, 0.0f});
}

/* The lowest natural frequency squared, rad^2/s^2, by inverse iteration: the rod is loaded sideways by its
 * masses times the shape it took before, at first the same everywhere. Rayleigh's quotient is exact to
 * second order in what the shape still lacks. Shapes are kept at 1 at the tip, within float32's range. */
static float first_mode_squared(const rod_params *params)
{
    enum { PASSES_N = 4 };
    const int n = params->links_n;
    float shape[ROD_MAX_LINKS], bend[ROD_MAX_LINKS], squared = 0.0f;
    for (int i = 0; i < n; i++) {
        shape[i] = 1.0f;
    }
    for (int pass = 0; pass < PASSES_N; pass++) {
        float force = 0.0f, moment = 0.0f;
        for (int i = n - 1; i >= 0; i--) {
            force += params->mass_kg[i] * shape[i];
            moment += force * params->length_m[i];
            bend[i] = moment / params->spring[i];
        }
        float slope = 0.0f, place = 0.0f;
        for (int i = 0; i < n; i++) {
            slope += bend[i];
            place += slope * params->length_m[i];
            bend[i] = place; /* where the node goes: no longer needed otherwise */
        }
        const float per_place = 1.0f / place;
        float work = 0.0f, kinetic = 0.0f;
        for (int i = 0; i < n; i++) {
            const float now = bend[i] * per_place;
            work += params->mass_kg[i] * shape[i] * now;
            kinetic += params->mass_kg[i] * now * now;
            shape[i] = now;
        }
        squared = work / kinetic * per_place;
    }
    return squared > 0.0f ? squared : 0.0f;
}

float rod_params_first_mode_hz(const rod_params *params)
{
    const bool elastic = params->model == ROD_MODEL_ELASTIC;
    return elastic ? trig_sqrt(first_mode_squared(params)) * (0.5f / TRIG_PI) : 0.0f;
}

float rod_params_resolving_rate_hz(const rod_params *params)
{
    if (params->model == ROD_MODEL_ELASTIC) {
        return trig_sqrt(first_mode_squared(params));
    }
    float fastest = 0.0f; /* rad^2/s^2 */
    for (int i = 0; i < params->links_n; i++) {
        const float stiffness =
            params->spring[i] + 4.0f * params->coupling[i] + 16.0f * params->smoothing[i];
        const float squared = stiffness / params->inertia[i];
        fastest = squared > fastest ? squared : fastest;
    }
    return trig_sqrt(fastest);
}
