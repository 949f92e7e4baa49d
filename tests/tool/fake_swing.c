/* fake_swing.c - the fake device as if somebody else moved it: poses come, joints swing, one limit acts in every
 * fourth ANGLES, and one pose a second is too late. */
#include <math.h>

#include "fake_device.h"

enum { POSE_US = 10000, SECOND_US = 1000000 };

void fake_swing(fake_device *d, uint32_t now_us)
{
    const uint32_t since_us = now_us - d->start_us, pose_n = since_us / POSE_US;
    const uint32_t before_us = d->any_pose ? d->newest_us - d->start_us : 0;
    d->any_pose = true;
    d->newest_seq = (uint16_t)pose_n;
    d->newest_us = d->start_us + pose_n * POSE_US;
    d->stats.poses_accepted = pose_n;
    d->stats.poses_late = since_us / SECOND_US;
    if (before_us / SECOND_US != pose_n * POSE_US / SECOND_US) {
        fake_tell_stats(d, 0);
    }
}

/* theta: a wave along the rod. phi: 10 mrad more from joint to joint, left and right in turn: it stands still, so
 * that each joint can be told from its number. */
void fake_swing_angles(const fake_device *d, message_angles *angles)
{
    static const float PI = 3.14159265f;
    const float turns = (float)(d->tick % 2000) / 2000.0f;
    angles->angles_n = (uint16_t)d->ways.swing;
    for (int joint = 0; joint < d->ways.swing; joint++) {
        const float wave = sinf(2.0f * PI * turns - 0.3f * (float)joint);
        angles->angles_tenth_mrad[joint][0] = (int16_t)lroundf(5000.0f * wave);
        angles->angles_tenth_mrad[joint][1] =
            (int16_t)(joint % 2 == 0 ? 100 * joint : -100 * joint);
    }
    if (d->seq[MESSAGE_ANGLES] % 4 == 0) {
        angles->flags |= ANGLES_LIMITED_RATE;
    }
}
