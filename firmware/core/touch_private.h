/* touch_private.h - what touch_solve.c and touch_blocks.c share. */
#ifndef LIMBER_TOUCH_PRIVATE_H
#define LIMBER_TOUCH_PRIVATE_H

#include "touch.h"

/* The links as they stand, each pulled back to its length: along its direction it is as stiff as `hold` says. */
typedef struct {
    vec3 unit[ROD_MAX_LINKS];
    float hold[ROD_MAX_LINKS], excess_m[ROD_MAX_LINKS];
} touch_links;

/* Factors A + contacts + links and solves in one sweep down and one up; b becomes the solution. About 480 instructions a
 * node, 75 more for each contact. Returns false where a pivot is not positive definite in float32. */
bool touch_solve_blocks(const touch_system *system, const touch_points *points,
                        const touch_links *links, vec3 *b);

#endif
