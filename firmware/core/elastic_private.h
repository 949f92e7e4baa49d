/* elastic_private.h - what elastic.c and elastic_step.c share. */
#ifndef LIMBER_ELASTIC_PRIVATE_H
#define LIMBER_ELASTIC_PRIVATE_H

#include "elastic.h"
#include "penta.h"

/* Factors m + h gamma + D' diag(stiffness) D, where row j of D is the curvature at joint j:
 * P_j / l_j - P_{j-1} (1 / l_j + 1 / l_{j-1}) + P_{j-2} / l_{j-1}. stiffness: h^2 k + h c of each joint,
 * kg m^2. Returns what penta_factor does. */
int elastic_factor(const elastic *model, const float *stiffness, penta *system);

/* The stiffness of joints that are not bent. */
void elastic_straight_stiffness(const elastic *model, float *stiffness);

#endif
