/* elastic_private.h - what the elastic_*.c share: the matrix, and the parts of a step.
 *
 * h = 2/3 tick, and "bar" is BDF2's memory of a quantity, (4 x - x_before) / 3 = x + step / 3:
 * x_next = bar x + h v_next. Forces and matrix are multiplied by h^2. */
#ifndef LIMBER_ELASTIC_PRIVATE_H
#define LIMBER_ELASTIC_PRIVATE_H

#include <float.h>

#include "elastic.h"
#include "penta.h"

#define THIRD (1.0f / 3.0f)

/* --- the matrix (elastic.c) ------------------------------------------------------------------------ */

/* The matrix of a step: m + h gamma, and the joints (bending.h) with stiffness h^2 k + h c, kg m^2. tension (or NULL):
 * h^2 times each link's pull, kg m, which left to the right-hand side alone would swing the links over. Returns what
 * penta_factor does. */
int elastic_factor(const elastic *model, const float *stiffness, const float *tension,
                   penta *system);

/* The stiffness of joints that are not bent. */
void elastic_straight_stiffness(const elastic *model, float *stiffness);

/* --- the forces (elastic_forces.c) ----------------------------------------------------------------- */

/* What a joint does beside its moment. */
typedef struct {
    float stiffness; /* h^2 k + h c, as a secant at the predicted angle */
    float torsion;   /* by how much less torsion the rod before it carries, h^2 times */
    vec3 fold;       /* along its axis, tan(alpha / 2) long */
} elastic_joint;

/* What comes of a step before the state takes it over. */
typedef struct {
    vec3 link[ROD_MAX_LINKS]; /* as predicted: bar + h bar v, in general not of unit length */
    vec3 unit[ROD_MAX_LINKS]; /* directions of unit length */
    vec3 node[ROD_MAX_LINKS]; /* h^2 force; then how far each node misses its prediction, m */
    float tension[ROD_MAX_LINKS];
    elastic_joint joint[ROD_MAX_LINKS];
} elastic_outcome;

/* A link at the end of a step in which nothing acts: as predicted, its direction, and h times how fast it
 * turns and how fast it spins about itself. */
typedef struct {
    vec3 link, unit, turn;
    float spin;
} elastic_motion;

/* Where the nodes go if nothing acts on them, and the forces on them there. base_turn_m: how far the base goes beyond
 * bar; base: its axis, as if it were a link; orientation: where it ends. */
void elastic_predict(const elastic *model, const elastic_state *state, vec3 base_turn_m,
                     elastic_motion base, quat orientation, const elastic_outside *outside,
                     elastic_outcome *o);

/* --- objects (elastic_touch.c) ---------------------------------------------------------------------- */

/* The points that may touch in a step from a state to its prediction; base from, base to. */
void elastic_touch_find(const elastic *model, const elastic_state *state, const elastic_outcome *o,
                        vec3 from_m, vec3 to_m, const elastic_outside *outside,
                        touch_points *points);

/* Forces to displacements among contacts; tensions gain what the links now pull. False, with the outcome as it was, where
 * float32 cannot. */
bool elastic_touch_solve(const elastic *model, const bending_bands *bands, touch_points *points,
                         elastic_outcome *o);

/* After a step. A blow, a node that has come to touch, ends the motion into what it hits all along the rod, and BDF2 starts
 * anew: it remembers how the nodes moved and how their speeds changed, and would have them rebound, in a stiff
 * rod with more than they came with. Points are spoilt. */
void elastic_touch_settle(const elastic *model, const bending_bands *bands, touch_points *points,
                          vec3 base_step_m, elastic_state *state);

/* The direction of v, and its length; `otherwise` where it has none to speak of, or is nowhere. */
static inline vec3 direction(vec3 v, vec3 otherwise, float *length)
{
    *length = trig_sqrt(vec3_dot(v, v));
    if (*length > 1e-3f && *length <= FLT_MAX) {
        return vec3_scale(v, 1.0f / *length);
    }
    *length = *length <= FLT_MAX ? *length : FLT_MAX;
    return otherwise;
}

#endif
