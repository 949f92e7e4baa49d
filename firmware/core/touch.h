/* touch.h - nodes against objects: which touch, how hard, and what that does to a step.
 *
 * Used through rod.h; this header is for readers of the mathematics. The derivation is in MODEL.md, "Touch".
 *
 * A contact is a node that an object keeps out. Its force is an unknown of the same linear system as the displacements,
 * held within Coulomb's cone, and handed from step to step as the next one's first guess: so at rest it is exact,
 * and a node that sticks does not creep. Caller-owned memory; safe in an interrupt.
 *
 * Work is bounded: every node asks every object; at most two touch a node, one where there would be more than
 * TOUCH_CONTACTS_MAX in all; at most TOUCH_PASSES_MAX factorisations a step, one more at a blow.
 */
#ifndef LIMBER_TOUCH_H
#define LIMBER_TOUCH_H

#include "bending.h"
#include "scene.h"

enum { TOUCH_CONTACTS_MAX = ROD_MAX_LINKS + 16, TOUCH_PASSES_MAX = 3 };

/* A node that finds itself inside an object comes out this fast, m/s: at once would be a kick. */
#define TOUCH_ESCAPE_M_S 0.5f

/* What touched in the last step. */
typedef struct {
    vec3 force_newton; /* on the node, in the world */
    float gap_m;       /* of the node after the step, to first order; negative: inside */
    uint8_t node;      /* 1 ... links_n */
    uint8_t object;    /* its place in the scene */
} touch_contact;

typedef struct {
    int contacts_n;
    touch_contact contact[TOUCH_CONTACTS_MAX]; /* by node */
} touch_contacts;

/* --- for the models ------------------------------------------------------------------------------ */

typedef enum { TOUCH_OFF, TOUCH_SLIDES, TOUCH_STICKS } touch_state;

/* A node near enough to an object to touch it in this step. Forces are h^2 N, i.e. kg m. */
typedef struct {
    vec3 normal;
    float gap_m;   /* that the prediction leaves it, less what it is let be inside for now */
    float let_m;   /* that: 0 or less */
    float end_m;   /* gap_m after the step */
    vec3 slip_m;   /* along the surface, in this step, as predicted */
    bool touched;  /* in the last step, */
    float pressed; /* as hard as that, */
    vec3 force;    /* with that force to begin with; touch_solve makes it this step's */
    /* kg: force per metre by which a displacement misses, across the surface and along it */
    float grip, rub;
    float friction;
    float share;  /* of what would make it stick, that the cone lets be: 1 where it sticks */
    uint8_t node; /* from 0: the far end of link 1 */
    uint8_t object;
    uint8_t state; /* touch_state */
} touch_point;

typedef struct {
    int points_n;
    touch_point point[TOUCH_CONTACTS_MAX];
} touch_points;

/* What a step knows of its nodes before it touches anything; nodes from the far end of link 1 on. */
typedef struct {
    int nodes_n;
    float step_s;
    float h_squared_s2;   /* what forces are multiplied by */
    vec3 base_m;          /* where the step ends; in the world, as all that follows */
    const vec3 *before_m; /* where the step began */
    const vec3 *after_m;  /* where it would end if nothing touched */
    const bending_link *link;
} touch_nodes;

/* The points that may touch: within a link's length of an object, of the nearest two. Contacts of the last step give
 * them their first force. Objects are touched by nodes alone, so a rod may get through one, and a hand into one.
 * That nothing is threaded for good, a node is let go where the one before it (node 0: the base) is deep inside the
 * object, or on another side of it: so a rod comes out from the base on. */
void touch_find(const scene *objects, const touch_contacts *last, const touch_nodes *nodes,
                touch_points *points);

/* A step of the rod to which contacts are added. Its links keep their lengths to first order. */
typedef struct {
    int nodes_n;
    const float *diagonal, *off1, *off2; /* A as penta_factor takes it, for x, y and z; kg */
    const bending_link *link;
    const vec3 *along; /* the links as predicted: of unit length, nearly */
    const vec3 *force; /* h^2 N */
    float hold;        /* how stiff a link is along itself, so many times what its node is in A */
} touch_system;

/* Displacements d of the nodes from where they would go: A d = force + contacts + pulls of the links. Each point gets its
 * state and its force; tension gains what the links now pull, h^2 N. Returns false where float32 finds A not
 * positive definite; nothing is then to be used. One to TOUCH_PASSES_MAX passes of about 700 instructions a node. */
bool touch_solve(const touch_system *system, touch_points *points, vec3 *displacement_m,
                 float *tension);

/* The change of a motion by which nothing moves into what it touches: as touch_solve, with moving_m (h times the nodes'
 * speeds) for what the step would do, in one pass with the states it has found. Points are spoilt. */
bool touch_blow(const touch_system *system, touch_points *points, const vec3 *moving_m,
                vec3 *change_m);

/* What touches after the step. */
void touch_remember(const touch_points *points, float h_squared_s2, touch_contacts *contacts);

#endif
