/* replay_files.h - a replay's numbers as files. Each returns SIM_OK, or an exit code after complaining. */
#ifndef LIMBER_REPLAY_FILES_H
#define LIMBER_REPLAY_FILES_H

#include "replay.h"

/* CSV `t,theta1,phi1,theta2,phi2,...` (s since the first sample, rad), 9 significant digits, so that
 * float32 survives the round trip. */
int replay_write_angles(const replay *r, const char *path);

/* CSV `t,x0,y0,z0,x1,...` (s, m; the track's own place). */
int replay_write_nodes(const replay *r, const char *path);

/* CSV `t,node,object,name,fx,fy,fz`: a row for each node that touches something in a tick; the object counts from 1, the
 * force (N) is on the rod. */
int replay_write_contacts(const replay *r, const char *path);

/* All a board needs to repeat the run bit for bit (tests/target): capsule.h tells the layout. */
int replay_write_capsule(const replay *r, const char *path);

#endif
