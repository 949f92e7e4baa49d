/* test_support.h - what several of the core's tests need: seeded random numbers, floats as bits, and
 * the rod's geometry a second time, in double and from explicit matrix products. */
#ifndef LIMBER_TEST_SUPPORT_H
#define LIMBER_TEST_SUPPORT_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "kinematics.h"

/* Half a float's last place, relative: what one rounding may cost. */
#define UNIT_ROUNDOFF 0x1p-24

#define PI 3.14159265358979323846

/* The emulated board counts every instruction and does double in software. */
#ifdef __arm__
#define HOST_OR_BOARD(host, board) (board)
#else
#define HOST_OR_BOARD(host, board) (host)
#endif

static inline float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Marsaglia's xorshift: the same numbers on every machine. The seed must not be 0. */
static inline uint32_t random_bits(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

static inline int random_below(uint32_t *seed, int bound)
{
    return (int)(random_bits(seed) % (uint32_t)bound);
}

static inline double random_between(uint32_t *seed, double low, double high)
{
    return low + (high - low) * ((double)random_bits(seed) * 0x1p-32);
}

/* Every order of magnitude between two positive numbers as likely as every other. */
static inline double random_magnitude(uint32_t *seed, double low, double high)
{
    return low * pow(high / low, random_between(seed, 0.0, 1.0));
}

static inline vec3 random_vec3(uint32_t *seed, double reach)
{
    const float x = (float)random_between(seed, -reach, reach);
    const float y = (float)random_between(seed, -reach, reach);
    const float z = (float)random_between(seed, -reach, reach);
    return (vec3){x, y, z};
}

/* A turn by `angle_rad` about any axis; its length is 1 to the last place of a float. */
static inline quat quat_about(vec3 axis, double angle_rad)
{
    const double x = (double)axis.x, y = (double)axis.y, z = (double)axis.z;
    const double scale = sin(0.5 * angle_rad) / sqrt(x * x + y * y + z * z);
    return (quat){(float)(x * scale), (float)(y * scale), (float)(z * scale),
                  (float)cos(0.5 * angle_rad)};
}

static inline quat random_quat(uint32_t *seed)
{
    const vec3 axis = vec3_add(random_vec3(seed, 1.0), (vec3){0.0f, 0.0f, 1e-3f});
    return quat_about(axis, random_between(seed, -PI, PI));
}

static inline rod_pose random_pose(uint32_t *seed, double reach)
{
    const vec3 position = random_vec3(seed, reach);
    return (rod_pose){position, random_quat(seed)};
}

/* A hand that never rests: where it is at a time. */
static inline rod_pose hand_at(double t)
{
    const vec3 place = {(float)(0.15 * sin(9.0 * t)), (float)(0.1 * cos(7.0 * t)),
                        (float)(0.2 * t)};
    const vec3 axis = {1.0f, (float)cos(3.0 * t), 0.5f};
    return (rod_pose){place, quat_about(axis, 0.8 * sin(8.0 * t))};
}

/* The larger of two errors; NaN is the largest of all, where fmax would forget it. */
static inline double worse(double a, double b)
{
    return isnan(a) || b <= a ? a : b;
}

/* --- geometry in double ------------------------------------------------------------------------ */

typedef struct {
    double at[3][3]; /* [row][column] */
} matrix3;

static inline matrix3 matrix3_product(const matrix3 *a, const matrix3 *b)
{
    matrix3 c;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            c.at[i][j] =
                a->at[i][0] * b->at[0][j] + a->at[i][1] * b->at[1][j] + a->at[i][2] * b->at[2][j];
        }
    }
    return c;
}

static inline matrix3 matrix3_about_x(double angle)
{
    const double c = cos(angle), s = sin(angle);
    return (matrix3){{{1.0, 0.0, 0.0}, {0.0, c, -s}, {0.0, s, c}}};
}

static inline matrix3 matrix3_about_y(double angle)
{
    const double c = cos(angle), s = sin(angle);
    return (matrix3){{{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}}};
}

/* The textbook's rotation matrix, of the quaternion brought to unit length first. */
static inline matrix3 matrix3_of(quat q)
{
    double x = (double)q.x, y = (double)q.y, z = (double)q.z, w = (double)q.w;
    const double norm = sqrt(x * x + y * y + z * z + w * w);
    x /= norm, y /= norm, z /= norm, w /= norm;
    return (matrix3){{
        {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)},
        {2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)},
        {2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)},
    }};
}

/* R_i = R_{i-1} rot_y(theta) rot_x(-phi). */
static inline matrix3 matrix3_turned(const matrix3 *parent, double theta, double phi)
{
    const matrix3 about_y = matrix3_about_y(theta), about_x = matrix3_about_x(-phi);
    const matrix3 first = matrix3_product(parent, &about_y);
    return matrix3_product(&first, &about_x);
}

typedef double joint_double[2];
typedef double point_double[3];

static inline double distance_double(const double *a, const double *b)
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

static inline double length_double(vec3 v)
{
    const double x = (double)v.x, y = (double)v.y, z = (double)v.z;
    return sqrt(x * x + y * y + z * z);
}

/* Nodes 0 ... links_n: each link runs along its own frame's z. */
static inline void nodes_double(const rod_pose *base, const joint_double *angles_rad,
                                const float *length_m, int links_n, point_double *nodes_m)
{
    matrix3 link = matrix3_of(base->orientation);
    nodes_m[0][0] = (double)base->position_m.x;
    nodes_m[0][1] = (double)base->position_m.y;
    nodes_m[0][2] = (double)base->position_m.z;
    for (int i = 0; i < links_n; i++) {
        link = matrix3_turned(&link, angles_rad[i][ROD_THETA], angles_rad[i][ROD_PHI]);
        for (int axis = 0; axis < 3; axis++) {
            nodes_m[i + 1][axis] = nodes_m[i][axis] + (double)length_m[i] * link.at[axis][2];
        }
    }
}

#endif
