/* trig.h - sine, cosine, arc tangent and arc sine in float32, the same bits on every target.
 *
 * No libm: its functions differ between C libraries. Here there is only + - * / and a square root,
 * each correctly rounded by IEEE 754, in one fixed order (build with -ffp-contract=off). Polynomials:
 * S. Moshier's Cephes single-precision set. Pure, re-entrant, no tables; NaN in, NaN out.
 *
 * Worst errors, measured against long double over every float of the range (tests: `trig`, and
 * `trig_exhaustive` under the label slow):
 *
 *   trig_sincos   |x| <= pi        0.98 ulp below 1, and never more than 7.5e-8
 *                 |x| <= 8192 rad  1.0e-7 absolute; beyond that the result is not meaningful
 *   trig_atan2    all quadrants    2.4e-7 rad, 1.7 ulp   (one division)
 *   trig_asin     |x| <= 1         1.3e-7 rad, 1.9 ulp   (one square root where |x| > 0.5)
 */
#ifndef LIMBER_TRIG_H
#define LIMBER_TRIG_H

#define TRIG_PI 3.14159265358979323846f
#define TRIG_HALF_PI 1.57079632679489661923f

typedef struct {
    float sin, cos;
} trig_pair;

trig_pair trig_sincos(float angle_rad);

/* The angle of the point (x, y) in (-pi, pi]; atan2(0, 0) is 0, and -0 counts as 0. */
float trig_atan2(float y, float x);

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

#endif
