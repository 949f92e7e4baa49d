/* shape.h - a shape for the rod to take: joint angles, how strongly they are wanted, and the way there.
 *
 * Used through rod.h (rod_set_shape). Plain data on caller-owned memory; all zero is no shape. */
#ifndef LIMBER_SHAPE_H
#define LIMBER_SHAPE_H

#include "kinematics.h"
#include "rod_params.h"

/* Bounds: angles within +-pi, and these. */
#define ROD_SHAPE_STRENGTH_MAX_NM 1e6f
#define ROD_SHAPE_BLEND_MAX_S 60.0f

typedef struct {
    float strength_nm, goal_nm; /* in force, and where it is going */
    int ticks_left;             /* until it is there */
    rod_joint angle_rad[ROD_MAX_LINKS], goal_rad[ROD_MAX_LINKS];
} shape;

/* From what is in force (where that is none, from the joints as they stand) to another shape, evenly over blend_s; NULL or
 * 0 N m: to none. Errors: ROD_E_SHAPE. */
rod_error shape_set(shape *s, const rod_joint *angle_rad, const rod_joint *standing_rad,
                    int links_n, float strength_nm, float blend_s, float tick_s);

/* One tick of the way. Returns whether the strength has changed. */
bool shape_advance(shape *s, int links_n);

/* The unit directions of the links in the base's axes. About 75 instructions a link. */
void shape_links(const shape *s, int links_n, vec3 *link);

#endif
