/* servo_round.h - from rad to the whole units that servos take. */
#ifndef LIMBER_SERVO_ROUND_H
#define LIMBER_SERVO_ROUND_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The whole number nearest to x, |x| < 2^22; halves go to the even one. 1.5 * 2^23 is so large that adding it rounds
 * to whole numbers and leaves them in the low bits: 3 instructions, the same on every processor. */
static inline int32_t servo_nearest(float x)
{
    const float shifted = x + 12582912.0f;
    int32_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    return bits - 0x4B400000;
}

/* Neither NaN nor infinite. */
static inline bool servo_is_number(float x)
{
    return __builtin_fabsf(x) < 3.0e38f;
}

#endif
