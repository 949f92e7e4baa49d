/* mount.h - where on the tracker the rod's base is.
 *
 *     base position = tracker position + R(tracker) (x, y, z)        base = tracker * yaw * pitch * roll
 *
 * x y z in m along the tracker's own axes; then the base's axes are the tracker's, turned about their own z
 * by yaw, about the new y by pitch, about the new x by roll, degrees: R = Rz(yaw) Ry(pitch) Rx(roll). Applies
 * after --up, --left-handed and --scale. All in double.
 */
#ifndef LIMBER_MOUNT_H
#define LIMBER_MOUNT_H

#include "track.h"

typedef struct {
    double position_m[3];
    double turn[4]; /* x y z w */
} mount;

/* The tracker is the base. */
mount mount_none(void);

/* "X,Y,Z" or "X,Y,Z,ROLL,PITCH,YAW". SIM_OK, or SIM_BAD_INPUT after complaining. */
int mount_parse(const char *text, mount *m);

/* Replaces the tracker's pose by the base's. */
void mount_apply(const mount *m, track_sample *s);

#endif
