/* replay_touch.h - the objects of a replay, and what touched them. For replay.c. */
#ifndef LIMBER_REPLAY_TOUCH_H
#define LIMBER_REPLAY_TOUCH_H

#include "replay.h"

/* Puts the objects where the rod of this replay meets them. Returns SIM_OK, or an exit code after complaining. */
int replay_touch_place(replay *r);

/* Keeps what touched in a tick's step; ticks one after the other from 0. False: out of memory. */
bool replay_touch_keep(replay *r, const rod *rod, long tick);

#endif
