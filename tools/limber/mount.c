/* mount.c - see mount.h. */
#include "mount.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "limber.h"

mount mount_none(void)
{
    return (mount){{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
}

/* Hamilton: first b, then a. */
static void multiply(const double a[4], const double b[4], double product[4])
{
    const double p[4] = {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
                         a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
                         a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
                         a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
    memcpy(product, p, sizeof p);
}

static void turn_about(int axis, double degrees, double q[4])
{
    const double half_rad = degrees * acos(-1.0) / 360.0;
    memset(q, 0, 4 * sizeof *q);
    q[axis] = sin(half_rad);
    q[3] = cos(half_rad);
}

int mount_parse(const char *text, mount *m)
{
    double values[6] = {0.0};
    int values_n = 0;
    const char *rest = text;
    for (; values_n < 6; values_n++) {
        char *end;
        values[values_n] = strtod(rest, &end);
        const double most = values_n < 3 ? 10.0 : 360.0;
        if (end == rest || !(fabs(values[values_n]) <= most) || (*end != ',' && *end != '\0')) {
            values_n = -1;
            break;
        }
        rest = end + 1;
        if (*end == '\0') {
            values_n++;
            break;
        }
    }
    if ((values_n != 3 && values_n != 6) || rest[-1] != '\0') {
        return sim_complain("--mount %.60s: must be X,Y,Z or X,Y,Z,ROLL,PITCH,YAW: from the "
                            "tracker to the rod's base, at most 10 m and 360 degrees",
                            text);
    }
    double roll[4], pitch[4], yaw[4];
    memcpy(m->position_m, values, sizeof m->position_m);
    turn_about(0, values[3], roll);
    turn_about(1, values[4], pitch);
    turn_about(2, values[5], yaw);
    multiply(pitch, roll, m->turn);
    multiply(yaw, m->turn, m->turn);
    return SIM_OK;
}

void mount_apply(const mount *m, track_sample *s)
{
    const double *const q = s->orientation, *const v = m->position_m;
    /* v + 2 w (u x v) + 2 u x (u x v) */
    const double cross[3] = {q[1] * v[2] - q[2] * v[1], q[2] * v[0] - q[0] * v[2],
                             q[0] * v[1] - q[1] * v[0]};
    const double twice[3] = {q[1] * cross[2] - q[2] * cross[1], q[2] * cross[0] - q[0] * cross[2],
                             q[0] * cross[1] - q[1] * cross[0]};
    for (int axis = 0; axis < 3; axis++) {
        s->position_m[axis] += v[axis] + 2.0 * (q[3] * cross[axis] + twice[axis]);
    }
    multiply(s->orientation, m->turn, s->orientation);
    double norm = 0.0;
    for (int i = 0; i < 4; i++) {
        norm += s->orientation[i] * s->orientation[i];
    }
    for (int i = 0; i < 4; i++) {
        s->orientation[i] /= sqrt(norm);
    }
}
