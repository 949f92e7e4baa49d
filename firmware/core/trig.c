/* trig.c - see trig.h. */
#include "trig.h"

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
