/* shape_text.h - a shape for the rod to take, as people write it.
 *
 *     arc:90           bent by 90 degrees in all, evenly, towards the base's x; -90: away from it
 *     coil:2           two turns of a helix
 *     bow.csv          a table whose header says what its rows are:
 *
 *         theta,phi            of each joint from the base, rad
 *         theta_deg,phi_deg    the same in degrees
 *         x,y,z                of each node, the base's own first; in the base's axes, of any scale
 */
#ifndef LIMBER_SHAPE_TEXT_H
#define LIMBER_SHAPE_TEXT_H

#include "kinematics.h"

/* For a rod of so many links. Returns SIM_OK, or SIM_BAD_INPUT after one line with place, value and bounds. */
int shape_text_read(const char *shape, int links_n, rod_joint *angles_rad);

#endif
