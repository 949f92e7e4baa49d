/* picture.h - a replay as one small SVG that moves: the rod from the side, over its own shadows. */
#ifndef LIMBER_PICTURE_H
#define LIMBER_PICTURE_H

#include "replay.h"

/* Shows in a browser and in a README; where nothing moves, the fan of positions is left. Returns
 * SIM_OK, or an exit code after complaining. */
int picture_write(const replay *r, const char *path);

#endif
