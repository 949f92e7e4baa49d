/* rod_private.h - what rod.c and rod_step.c share. */
#ifndef LIMBER_ROD_PRIVATE_H
#define LIMBER_ROD_PRIVATE_H

#include "rod.h"

bool rod_is_elastic(const rod *r);

/* What both models have in common: where the joints are, and how they moved in the last tick. */
typedef struct {
    rod_joint angle_rad[ROD_MAX_LINKS], increment_rad[ROD_MAX_LINKS];
} rod_joints;

/* Joints beyond the last are straight and at rest. */
void rod_read_joints(const rod *r, rod_joints *j);

/* Into the state of the model, at the base's pose and motion. */
void rod_lay_joints(rod *r, const rod_joints *j);

#endif
