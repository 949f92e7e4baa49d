/* trig.h - sine, cosine, arc tangent and arc sine in float32, the same bits on every target.
 *
 * No libm: its functions differ between C libraries. Here there is only + - * / and a square root,
 * each correctly rounded by IEEE 754, in one fixed order (build with -ffp-contract=off). Polynomials:
 * S. Moshier's Cephes single-precision set (sinf.c, atanf.c, asinf.c). Pure, re-entrant, no tables; NaN
 * in, NaN out. What a step calls is inline: a pair returned from a call goes through memory.
 *
 * Worst errors against long double (tests: unit.trig, and over every float slow.trig_exhaustive). Each is
 * within 2 ulp or 2e-7 rad of the truth, whichever is more:
 *
 *   trig_sincos   |x| <= pi/4      5.9e-8, 0.99 ulp
 *                 |x| <= pi        7.8e-8, 1.5 ulp
 *                 |x| <= 8192 rad  7.9e-8; beyond that the result is not meaningful
 *   trig_atan2    all quadrants    2.7e-7 rad (1.2 ulp, near pi), 3.0 ulp (8e-8 rad, near 0.4)
 *   trig_asin     |x| <= 0.5       3.6e-8 rad, 0.68 ulp
 *                 |x| <= 1         1.7e-7 rad, 2.5 ulp
 *
 * Arguments of atan2 stay below 1e38. It costs one division, asin one square root where |x| > 0.5.
 */
#ifndef LIMBER_TRIG_H
#define LIMBER_TRIG_H

#define TRIG_PI 3.14159265358979323846f
#define TRIG_HALF_PI 1.57079632679489661923f

typedef struct {
    float sin, cos;
} trig_pair;

/* x is clamped to [-1, 1]. */
float trig_asin(float x);

/* The square root as the instruction: correctly rounded, so the same everywhere. */
static inline float trig_sqrt(float x)
{
    return __builtin_sqrtf(x);
}

static inline float trig_abs(float x)
{
    return __builtin_fabsf(x);
}

static inline trig_pair trig_sincos(float angle_rad)
{
    /* Adding and taking away 1.5 * 2^23 rounds to the nearest integer without a cast, whose result
     * would differ between machines when out of range. */
    const float rounder = 12582912.0f;
    const float turns = (angle_rad * (1.0f / TRIG_HALF_PI) + rounder) - rounder;
    /* pi/2 in three parts (Cody and Waite): the first two have so few bits that n times them is exact */
    const float r = ((angle_rad - turns * 1.5703125f) - turns * 4.837512969970703125e-4f) -
                    turns * 7.54978995489188216e-8f;
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

/* The angle of the point (x, y) in (-pi, pi]; atan2(0, 0) is 0, and -0 counts as 0. One division for
 * any point: the octant is chosen before dividing, so that the polynomial sees |t| <= tan(pi/8). */
static inline float trig_atan2(float y, float x)
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
    if (!(below > 0.0f)) { /* both are zero, or one is not a number */
        return above + below;
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

#endif
