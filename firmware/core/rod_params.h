/* rod_params.h - what a rod is made of: parameters, their units and bounds, and every error.
 *
 * One table, rod_fields, describes each parameter; the INI reader, the command line and the wire
 * all use it, so that a name or a bound is written once.
 *
 * Symbols are the paper's (Symmetry 2018, 10(3), 57); the equations are in MODEL.md. Joint i joins
 * link i to link i-1; index 0 here is joint 1 there. Entries at and beyond links_n are ignored.
 * Plain data on caller-owned memory: no function here keeps a pointer. Safe in an interrupt.
 */
#ifndef LIMBER_ROD_PARAMS_H
#define LIMBER_ROD_PARAMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rod_config.h"

typedef enum {
    ROD_OK = 0,
    ROD_E_MODEL = -1,
    ROD_E_SCHEME = -2,
    ROD_E_LINKS = -3,
    ROD_E_HOLD = -4,
    ROD_E_TICK = -5,
    ROD_E_LENGTH = -6,
    ROD_E_INERTIA = -7,
    ROD_E_DRAG = -8,
    ROD_E_COUPLING = -9,
    ROD_E_SMOOTHING = -10,
    ROD_E_SPRING = -11,
    ROD_E_DAMPER = -12,
    ROD_E_LIMIT = -13,
    ROD_E_OVERDAMPED = -14, /* (drag + damper) * tick > 2 * inertia: the centred damper would saw */
    ROD_E_PIVOT = -15,      /* the system is not positive definite in float32 */
    ROD_E_POSE = -16,  /* base pose not finite, beyond 1000 m, or quaternion not of unit length */
    ROD_E_FORCE = -17, /* an external force is not finite, or its torque beyond 1e9 N m */
    ROD_E_NOT_FINITE = -18, /* the step's result is not finite */
    ROD_E_MASS = -19,
    ROD_E_GRAVITY = -20,
    ROD_E_OBJECT = -21, /* of a scene: see scene_refusal */
    ROD_E_SHAPE = -22,
} rod_error;

/* One clear sentence for each error; never NULL. */
const char *rod_error_text(rod_error error);

enum { ROD_MODEL_CONTOUR = 0, ROD_MODEL_ELASTIC, ROD_MODEL_COUNT };
enum { ROD_SCHEME_MIDPOINT = 0, ROD_SCHEME_PAPER, ROD_SCHEME_COUNT };

typedef struct {
    int32_t model;   /* ROD_MODEL_... */
    int32_t scheme;  /* ROD_SCHEME_...: paper is kept for comparison only (MODEL.md) */
    int32_t links_n; /* N */
    int32_t
        hold_n;   /* how many link ends stay in the world while the base moves: 1 or 2 (Fig. 6b) */
    float tick_s; /* dt */
    float length_m[ROD_MAX_LINKS]; /* l: link i reaches from node i-1 to node i */
    float inertia[ROD_MAX_LINKS];  /* mu, kg m^2: resists turning of joint i in the world */
    float drag[ROD_MAX_LINKS];     /* gamma, N m s: resists turning of joint i in the world
                                      (elastic: N s/m, motion of node i through it) */
    float coupling[ROD_MAX_LINKS]; /* beta, N m: pulls joint i and joint i-1 to one angle (Eq. 7) */
    float smoothing[ROD_MAX_LINKS]; /* eta, N m: pulls joints i-1, i, i+1 onto a line (Eq. 2) */
    float spring[ROD_MAX_LINKS];    /* k, N m: pulls joint i straight (Eq. 8) */
    float damper[ROD_MAX_LINKS];    /* c, N m s: resists bending of joint i (Eq. 8) */
    float limit_rad[ROD_MAX_LINKS]; /* the joint's stop, either side, for theta and phi alike
                                       (elastic: the rod has none; what it drives may) */
    float mass_kg[ROD_MAX_LINKS];   /* m: of the node at the far end of link i (elastic) */
    float gravity_m_s2;             /* g: along the world's -z (elastic) */
} rod_params;

typedef enum {
    ROD_FIELD_CHOICE,
    ROD_FIELD_COUNT_OF,
    ROD_FIELD_SCALAR,
    ROD_FIELD_PER_JOINT
} rod_field_kind;

typedef struct {
    const char *name; /* the key in INI files, on the command line and on the wire */
    const char *symbol;
    const char *unit; /* "" where there is none */
    const char *what; /* half a sentence for people */
    rod_field_kind kind;
    rod_error error; /* what rod_params_check returns when this field is out of bounds */
    float min, max, initial;
    uint32_t models;            /* which read it: 1 << ROD_MODEL_... */
    const char *const *choices; /* names of the values of a CHOICE, max + 1 of them */
    size_t offset;              /* into rod_params: int32_t, or float, or float[ROD_MAX_LINKS] */
} rod_field;

enum { ROD_FIELDS_N = 15 };
extern const rod_field rod_fields[ROD_FIELDS_N];

/* The field of that name, or NULL. */
const rod_field *rod_field_find(const char *name);

/* Does the model (ROD_MODEL_...) read the field at all? */
bool rod_field_is_read(const rod_field *field, int32_t model);

/* One value, as a number whatever the kind; joint counts from 0 and is ignored unless PER_JOINT.
 * rod_field_set writes without checking (rod_params_check does); a PER_JOINT field takes one entry. */
float rod_field_get(const rod_field *field, const rod_params *params, int joint);
void rod_field_set(const rod_field *field, rod_params *params, int joint, float value);

/* Every field at its initial value, in all ROD_MAX_LINKS entries: the paper's four 30 mm links. */
void rod_params_defaults(rod_params *params);

/* Where and why a set of parameters was refused. */
typedef struct {
    rod_error error;
    const rod_field *field; /* NULL for ROD_OK and ROD_E_PIVOT; the damper for ROD_E_OVERDAMPED */
    int joint;              /* from 0; -1 where the field is not per joint */
    float value, min, max;  /* what was given and what is allowed there */
} rod_refusal;

/* Checks every field, first the bounds one by one, then (drag + damper) * tick <= 2 * inertia.
 * Returns ROD_OK or the first error; fills *refusal if that is not NULL. Cost: about 20 N compares. */
rod_error rod_params_check(const rod_params *params, rod_refusal *refusal);

/* The lowest natural frequency of an elastic rod in a still hand, as its spring, mass and length make it
 * (gravity adds a little to a rod that hangs and takes a little from one that stands). 0 where a joint has no
 * spring, and for contour, which has no such thing. Hz. */
float rod_params_first_mode_hz(const rod_params *params);

/* The rate of steps from which on the motion is resolved by about six steps a period (2 pi), Hz. contour, a step a
 * tick: every joint's fastest period, sqrt(max (k + 4 beta + 16 eta) / mu). elastic, of steps within 1 ms
 * (elastic_steps_n): that of the first mode; modes too fast for that are damped away by BDF2. Below it either rod is
 * stable, but under-resolved. */
float rod_params_resolving_rate_hz(const rod_params *params);

#endif
