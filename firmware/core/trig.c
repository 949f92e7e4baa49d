/* trig.c - see trig.h. Coefficients: Cephes sinf.c, atanf.c, asinf.c (S. Moshier). */
#include "trig.h"

/* pi/2 in three parts (Cody and Waite): the first two have so few bits that n times them is exact. */
static const float HALF_PI_HIGH = 1.5703125f;
static const float HALF_PI_MIDDLE = 4.837512969970703125e-4f;
static const float HALF_PI_LOW = 7.54978995489188216e-8f;

/* Adding and taking away 1.5 * 2^23 rounds to the nearest integer without a cast, whose result
 * would differ between machines when out of range. */
static const float ROUNDER = 12582912.0f;

trig_pair trig_sincos(float angle_rad)
{
    const float turns = (angle_rad * (1.0f / TRIG_HALF_PI) + ROUNDER) - ROUNDER;
    const float r =
        ((angle_rad - turns * HALF_PI_HIGH) - turns * HALF_PI_MIDDLE) - turns * HALF_PI_LOW;
    const float z = r * r;

    const float s = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * r + r;
    const float c =
        ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z -
        0.5f * z + 1.0f;

    if (!(trig_abs(turns) <= 8192.0f)) { /* far outside, or NaN: the quadrant is unknown */
        return (trig_pair){s, c};
    }
    switch ((int)turns & 3) {
    case 0:
        return (trig_pair){s, c};
    case 1:
        return (trig_pair){c, -s};
    case 2:
        return (trig_pair){-s, -c};
    default:
        return (trig_pair){-c, s};
    }
}

/* One division for any point: the octant is chosen before dividing, so that the polynomial sees
 * |t| <= tan(pi/8). */
float trig_atan2(float y, float x)
{
    const float ay = trig_abs(y);
    const float ax = trig_abs(x);
    float above, below, offset;
    if (ay <= 0.41421356f * ax) {
        above = ay;
        below = ax;
        offset = 0.0f;
    } else if (ay <= 2.41421356f * ax) {
        above = ay - ax;
        below = ay + ax;
        offset = 0.5f * TRIG_HALF_PI;
    } else {
        above = -ax;
        below = ay;
        offset = TRIG_HALF_PI;
    }
    if (below <= 0.0f) { /* only where both are zero */
        return 0.0f;
    }
    const float t = above / below;
    const float z = t * t;
    const float p = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                     3.33329491539e-1f) *
                        z * t +
                    t;
    const float first_quadrant = offset + p;
    const float right_or_left = x < 0.0f ? TRIG_PI - first_quadrant : first_quadrant;
    return y < 0.0f ? -right_or_left : right_or_left;
}

float trig_asin(float x)
{
    float a = trig_abs(x);
    if (a > 1.0f) {
        a = 1.0f;
    }
    const int steep = a > 0.5f; /* asin a = pi/2 - 2 asin sqrt((1 - a)/2) */
    const float z = steep ? 0.5f * (1.0f - a) : a * a;
    const float s = steep ? trig_sqrt(z) : a;
    const float p = ((((4.2163199048e-2f * z + 2.4181311049e-2f) * z + 4.5470025998e-2f) * z +
                      7.4953002686e-2f) *
                         z +
                     1.6666752422e-1f) *
                        z * s +
                    s;
    const float positive = steep ? TRIG_HALF_PI - (p + p) : p;
    return x < 0.0f ? -positive : positive;
}
