/* touch_blocks.c - see touch_private.h: the matrix of a rod that touches, factored and solved. MODEL.md, "Touch".
 *
 * What keeps a node from moving along a direction n couples x, y and z: a contact adds a multiple of n n' to the diagonal
 * block of its node, one that sticks of the unit matrix too, a link that keeps its length of u u' to those of its two nodes
 * and to the block between. So the factorisation is that of penta.c, with blocks of 3 x 3 where it has numbers. */
#include <float.h>

#include "touch_private.h"

typedef struct {
    float xx, xy, xz, yy, yz, zz;
} symmetric3;

typedef struct {
    vec3 x, y, z; /* rows */
} matrix3;

/* Row i of the factor: the inverse of its pivot block P, P^-1 A[i][i+1], and the number that A[i][i+2] is. */
typedef struct {
    symmetric3 per_pivot;
    matrix3 above;
    float off2;
} block_row;

static vec3 symmetric_times(const symmetric3 *s, vec3 v)
{
    return (vec3){s->xx * v.x + s->xy * v.y + s->xz * v.z, s->xy * v.x + s->yy * v.y + s->yz * v.z,
                  s->xz * v.x + s->yz * v.y + s->zz * v.z};
}

static vec3 matrix_times(const matrix3 *m, vec3 v)
{
    return (vec3){vec3_dot(m->x, v), vec3_dot(m->y, v), vec3_dot(m->z, v)};
}

static vec3 transpose_times(const matrix3 *m, vec3 v)
{
    return vec3_add_scaled(vec3_add_scaled(vec3_scale(m->x, v.x), m->y, v.y), m->z, v.z);
}

/* By cofactors; blocks are positive definite but for rounding. */
static bool invert(const symmetric3 *s, symmetric3 *inverse)
{
    const symmetric3 cofactor = {
        .xx = s->yy * s->zz - s->yz * s->yz,
        .xy = s->xz * s->yz - s->xy * s->zz,
        .xz = s->xy * s->yz - s->xz * s->yy,
        .yy = s->xx * s->zz - s->xz * s->xz,
        .yz = s->xy * s->xz - s->xx * s->yz,
        .zz = s->xx * s->yy - s->xy * s->xy,
    };
    const float determinant = s->xx * cofactor.xx + s->xy * cofactor.xy + s->xz * cofactor.xz;
    const float per = 1.0f / determinant;
    *inverse = (symmetric3){cofactor.xx * per, cofactor.xy * per, cofactor.xz * per,
                            cofactor.yy * per, cofactor.yz * per, cofactor.zz * per};
    return determinant > 0.0f && per <= FLT_MAX && s->xx > 0.0f;
}

/* s v v' */
static symmetric3 outer(vec3 v, float s)
{
    const vec3 sv = vec3_scale(v, s);
    return (symmetric3){sv.x * v.x, sv.x * v.y, sv.x * v.z, sv.y * v.y, sv.y * v.z, sv.z * v.z};
}

/* What it adds to its node's block and right-hand side. What rubs is a share of what would make it stick, with the slip
 * that is yet to be found: so it goes against that. */
static void add_contact(const touch_point *point, symmetric3 *block, vec3 *force)
{
    if (point->state == TOUCH_OFF) {
        return;
    }
    const vec3 n = point->normal;
    const float rub = point->share * point->rub;
    const symmetric3 across = outer(n, point->grip - rub);
    *block = (symmetric3){block->xx + rub + across.xx, block->xy + across.xy,
                          block->xz + across.xz,       block->yy + rub + across.yy,
                          block->yz + across.yz,       block->zz + rub + across.zz};
    const float held = vec3_dot(n, point->force);
    const vec3 along =
        vec3_add_scaled(vec3_add_scaled(point->force, n, -held), point->slip_m, -point->rub);
    *force = vec3_add_scaled(vec3_add_scaled(*force, along, point->share), n,
                             held - point->grip * point->gap_m);
}

bool touch_solve_blocks(const touch_system *system, const touch_points *points,
                        const touch_links *links, vec3 *b)
{
    const int n = system->nodes_n;
    block_row rows[ROD_MAX_LINKS];
    /* what elimination takes: from this row's pivot, from the next one's, from the block to the right */
    symmetric3 taken = {0}, taken_next = {0};
    matrix3 taken_right = {0};
    symmetric3 link = outer(links->unit[0], links->hold[0]); /* to the node before */
    int next_point = 0;
    for (int i = 0; i < n; i++) {
        const float own = system->diagonal[i], off1 = i + 1 < n ? system->off1[i + 1] : 0.0f;
        const symmetric3 on =
            i + 1 < n ? outer(links->unit[i + 1], links->hold[i + 1]) : (symmetric3){0};
        symmetric3 p = {own + link.xx + on.xx - taken.xx, link.xy + on.xy - taken.xy,
                        link.xz + on.xz - taken.xz,       own + link.yy + on.yy - taken.yy,
                        link.yz + on.yz - taken.yz,       own + link.zz + on.zz - taken.zz};
        const symmetric3 r = {off1 - on.xx, -on.xy, -on.xz, off1 - on.yy, -on.yz, off1 - on.zz};
        for (; next_point < points->points_n && points->point[next_point].node == i; next_point++) {
            add_contact(&points->point[next_point], &p, &b[i]);
        }
        link = on;
        /* the columns of the block to the right, and of what the pivot makes of it */
        const vec3 ex = {r.xx - taken_right.x.x, r.xy - taken_right.y.x, r.xz - taken_right.z.x};
        const vec3 ey = {r.xy - taken_right.x.y, r.yy - taken_right.y.y, r.yz - taken_right.z.y};
        const vec3 ez = {r.xz - taken_right.x.z, r.yz - taken_right.y.z, r.zz - taken_right.z.z};
        block_row *row = &rows[i];
        if (!invert(&p, &row->per_pivot)) {
            return false;
        }
        const symmetric3 *inverse = &row->per_pivot;
        const vec3 gx = symmetric_times(inverse, ex);
        const vec3 gy = symmetric_times(inverse, ey);
        const vec3 gz = symmetric_times(inverse, ez);
        row->above = (matrix3){{gx.x, gy.x, gz.x}, {gx.y, gy.y, gz.y}, {gx.z, gy.z, gz.z}};
        row->off2 = i + 2 < n ? system->off2[i + 2] : 0.0f;

        taken = (symmetric3){taken_next.xx + vec3_dot(ex, gx), taken_next.xy + vec3_dot(ex, gy),
                             taken_next.xz + vec3_dot(ex, gz), taken_next.yy + vec3_dot(ey, gy),
                             taken_next.yz + vec3_dot(ey, gz), taken_next.zz + vec3_dot(ez, gz)};
        const float off2 = row->off2, square = off2 * off2;
        taken_next = (symmetric3){inverse->xx * square, inverse->xy * square, inverse->xz * square,
                                  inverse->yy * square, inverse->yz * square, inverse->zz * square};
        taken_right = (matrix3){vec3_scale(gx, off2), vec3_scale(gy, off2), vec3_scale(gz, off2)};

        const vec3 force = b[i];
        b[i] = symmetric_times(inverse, force);
        if (i + 1 < n) {
            b[i + 1] = vec3_sub(b[i + 1], transpose_times(&row->above, force));
        }
        if (i + 2 < n) {
            b[i + 2] = vec3_add_scaled(b[i + 2], b[i], -off2);
        }
    }
    vec3 after = {0.0f, 0.0f, 0.0f}, second = {0.0f, 0.0f, 0.0f};
    for (int i = n - 1; i >= 0; i--) {
        const block_row *row = &rows[i];
        const vec3 far = symmetric_times(&row->per_pivot, vec3_scale(second, row->off2));
        b[i] = vec3_sub(vec3_sub(b[i], far), matrix_times(&row->above, after));
        second = after;
        after = b[i];
    }
    return true;
}
