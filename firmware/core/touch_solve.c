/* touch_solve.c - see touch.h: the contacts' forces and the nodes' displacements, as one system. MODEL.md, "Touch".
 *
 * A contact that slides keeps its node from moving along the normal n, which couples x, y and z: to the diagonal
 * block of its node it adds grip n n'; one that sticks adds grip I. Everything else in the matrix is a
 * multiple of the unit matrix. So the factorisation is that of penta.c, with blocks of 3 x 3 where it has numbers. */
#include <float.h>
#include <string.h>

#include "touch.h"

/* How stiff a contact is across the surface and along it, so many times what its node is in the matrix. The force of the
 * last step does the rest, so that at rest nothing is missing. Found by trial: what goes along the surface must be
 * soft beside what goes across, or a node that sticks and a rod that is too long fight. */
static const float GRIP = 10.0f, RUB = 0.3f;
/* Another pass is worth it where what rubs changes by more than this. */
static const float SHARE_CHANGE = 0.05f;

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
static void add_outer(symmetric3 *block, vec3 v, float s)
{
    const vec3 sv = vec3_scale(v, s);
    block->xx += sv.x * v.x;
    block->xy += sv.x * v.y;
    block->xz += sv.x * v.z;
    block->yy += sv.y * v.y;
    block->yz += sv.y * v.z;
    block->zz += sv.z * v.z;
}

/* --- what a contact does --------------------------------------------------------------------------- */

/* What a displacement calls for: how hard the object presses, and the force along the surface that would make the node
 * stick. */
typedef struct {
    float press;
    vec3 along;
} touch_call;

static touch_call call_of(const touch_point *point, vec3 displacement_m)
{
    const vec3 n = point->normal;
    const float out = vec3_dot(n, displacement_m);
    const float held = vec3_dot(n, point->held);
    const vec3 slip = vec3_add(point->slip_m, vec3_add_scaled(displacement_m, n, -out));
    return (touch_call){
        .press = held - point->grip * (point->gap_m + out),
        .along = vec3_add_scaled(vec3_add_scaled(point->held, n, -held), slip, -point->rub),
    };
}

/* Is a neighbour further in the same object? Where several nodes have come into one, the deepest pushed out takes the
 * others with it; all pushed at once, some would have to be pulled. */
static bool is_beside_deeper(const touch_points *points, int i)
{
    const touch_point *p = points->point, *own = &points->point[i];
    for (int k = i - 1; k >= 0 && p[k].node + 1 >= own->node; k--) {
        if (p[k].object == own->object && p[k].end_m <= own->end_m) {
            return true;
        }
    }
    for (int k = i + 1; k < points->points_n && p[k].node <= own->node + 1; k++) {
        if (p[k].object == own->object && p[k].end_m < own->end_m) {
            return true;
        }
    }
    return false;
}

/* The state for the next solution: no object may pull, and along the surface it may use what lies within the cone. How hard
 * it presses is sure only where the last solution was with it; otherwise no harder than in the last step. Returns
 * whether the state is another than it was. */
static bool decide(touch_points *points, int i, vec3 displacement_m)
{
    touch_point *point = &points->point[i];
    const touch_call call = call_of(point, displacement_m);
    const float held = vec3_dot(point->normal, point->held);
    const float sure = point->state == TOUCH_OFF && held < call.press ? held : call.press;
    const float most = sure > 0.0f ? point->friction * sure : 0.0f;
    const float along_squared = vec3_dot(call.along, call.along);
    uint8_t state = TOUCH_OFF;
    float share = 0.0f;
    if (call.press > 0.0f &&
        (point->state != TOUCH_OFF || held > 0.0f || !is_beside_deeper(points, i))) {
        const bool sticks = along_squared <= most * most && most > 0.0f;
        state = sticks ? TOUCH_STICKS : TOUCH_SLIDES;
        share = sticks ? 1.0f : most > 0.0f ? most / trig_sqrt(along_squared) : 0.0f;
    }
    const bool changed = state != point->state || trig_abs(share - point->share) > SHARE_CHANGE;
    point->state = state;
    point->share = share;
    return changed;
}

/* All of them. */
static bool decide_all(touch_points *points, const vec3 *displacement_m)
{
    bool changed = false;
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        point->end_m = point->gap_m + vec3_dot(point->normal, displacement_m[point->node]);
    }
    for (int i = 0; i < points->points_n; i++) {
        changed = decide(points, i, displacement_m[points->point[i].node]) || changed;
    }
    return changed;
}

/* The force of the solution. A contact that would have pulled in it is none. */
static void conclude(touch_point *point, vec3 displacement_m)
{
    const touch_call call = call_of(point, displacement_m);
    if (call.press <= 0.0f) {
        point->state = TOUCH_OFF;
    }
    point->end_m = point->gap_m + vec3_dot(point->normal, displacement_m);
    point->force = vec3_add_scaled(vec3_scale(call.along, point->share), point->normal, call.press);
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
    block->xx += rub;
    block->yy += rub;
    block->zz += rub;
    add_outer(block, n, point->grip - rub);
    const float held = vec3_dot(n, point->held);
    const vec3 along =
        vec3_add_scaled(vec3_add_scaled(point->held, n, -held), point->slip_m, -point->rub);
    *force = vec3_add_scaled(vec3_add_scaled(*force, along, point->share), n,
                             held - point->grip * point->gap_m);
}

/* --- the system -------------------------------------------------------------------------------------- */

/* The links as they stand, each pulled back to its length: along its direction it is as stiff as `hold` says. */
typedef struct {
    vec3 unit[ROD_MAX_LINKS];
    float hold[ROD_MAX_LINKS], excess_m[ROD_MAX_LINKS];
} touch_links;

/* What the links add: to the block of a node, the two that meet there; to the block between two nodes, less the one. */
static void add_link(const touch_links *links, int i, symmetric3 *block, float sign)
{
    add_outer(block, links->unit[i], sign * links->hold[i]);
}

/* Row i's own block and the block to its right, before elimination. */
static void assemble_row(const touch_system *system, const touch_points *points,
                         const touch_links *links, int i, int *next_point, symmetric3 *pivot,
                         symmetric3 *right, vec3 *force)
{
    const float own = system->diagonal[i];
    *pivot = (symmetric3){.xx = own, .yy = own, .zz = own};
    *right = (symmetric3){0};
    for (; *next_point < points->points_n && points->point[*next_point].node == i; ++*next_point) {
        add_contact(&points->point[*next_point], pivot, force);
    }
    add_link(links, i, pivot, 1.0f);
    if (i + 1 < system->nodes_n) {
        const float off = system->off1[i + 1];
        *right = (symmetric3){.xx = off, .yy = off, .zz = off};
        add_link(links, i + 1, pivot, 1.0f);
        add_link(links, i + 1, right, -1.0f);
    }
}

/* Factors and solves in one sweep down and one up; b becomes the solution. */
static bool solve_blocks(const touch_system *system, const touch_points *points,
                         const touch_links *links, vec3 *b)
{
    const int n = system->nodes_n;
    block_row rows[ROD_MAX_LINKS];
    symmetric3 taken = {0},
               taken_next = {0}; /* by elimination, from this row's pivot and the next one's */
    matrix3 taken_right = {0};   /* and from the block to the right */
    int next_point = 0;
    for (int i = 0; i < n; i++) {
        symmetric3 p, r;
        assemble_row(system, points, links, i, &next_point, &p, &r, &b[i]);
        p = (symmetric3){p.xx - taken.xx, p.xy - taken.xy, p.xz - taken.xz,
                         p.yy - taken.yy, p.yz - taken.yz, p.zz - taken.zz};
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

/* The links' directions and what they have too much, linear about where the nodes stand; and the forces with their pulls. */
static void take_links(const touch_system *system, const vec3 *displacement_m, touch_links *links,
                       vec3 *force)
{
    static const vec3 Z = {0.0f, 0.0f, 1.0f};
    vec3 before = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < system->nodes_n; i++) {
        const vec3 gain = vec3_sub(displacement_m[i], before);
        const bending_link *own = &system->link[i];
        const vec3 link = vec3_add_scaled(system->along[i], gain, own->per_length);
        const float length = trig_sqrt(vec3_dot(link, link));
        const vec3 unit = length > 1e-3f ? vec3_scale(link, 1.0f / length) : Z;
        const float excess_m = (length - 1.0f) * own->length_m - vec3_dot(unit, gain);
        const vec3 pull = vec3_scale(unit, links->hold[i] * excess_m);
        force[i] = vec3_sub(system->force[i], pull);
        if (i > 0) {
            force[i - 1] = vec3_add(force[i - 1], pull);
        }
        links->unit[i] = unit;
        links->excess_m[i] = excess_m;
        before = displacement_m[i];
    }
}

bool touch_solve(const touch_system *system, touch_points *points, vec3 *displacement_m,
                 float *tension)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const int n = system->nodes_n;
    touch_links links;
    for (int i = 0; i < n; i++) {
        links.hold[i] = system->hold * system->diagonal[i];
        displacement_m[i] = NONE;
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        point->grip = GRIP * system->diagonal[point->node];
        point->rub = RUB * system->diagonal[point->node];
        point->state = point->touched ? TOUCH_SLIDES : TOUCH_OFF;
    }
    (void)decide_all(points, displacement_m);
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        if (point->touched && point->state == TOUCH_OFF) {
            point->state = TOUCH_SLIDES;
        }
    }
    bool again = true;
    for (int pass = 1; again; pass++) {
        vec3 b[ROD_MAX_LINKS];
        take_links(system, displacement_m, &links, b);
        if (!solve_blocks(system, points, &links, b)) {
            return false;
        }
        memcpy(displacement_m, b, (size_t)n * sizeof *b);
        again = pass < TOUCH_PASSES_MAX && decide_all(points, displacement_m);
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        conclude(point, displacement_m[point->node]);
    }
    vec3 before = NONE;
    for (int i = 0; i < n; i++) {
        const vec3 gain = vec3_sub(displacement_m[i], before);
        tension[i] += links.hold[i] * (links.excess_m[i] + vec3_dot(links.unit[i], gain));
        before = displacement_m[i];
    }
    return true;
}

bool touch_blow(const touch_system *system, touch_points *points, const vec3 *moving_m,
                vec3 *change_m)
{
    static const vec3 NONE = {0.0f, 0.0f, 0.0f};
    const int n = system->nodes_n;
    touch_links links;
    for (int i = 0; i < n; i++) {
        links.hold[i] = system->hold * system->diagonal[i];
        change_m[i] = NONE;
    }
    for (int i = 0; i < points->points_n; i++) {
        touch_point *point = &points->point[i];
        const vec3 moving = moving_m[point->node];
        point->held = NONE;
        point->gap_m = vec3_dot(point->normal, moving);
        point->slip_m = vec3_add_scaled(moving, point->normal, -point->gap_m);
    }
    vec3 b[ROD_MAX_LINKS];
    take_links(system, change_m, &links, b);
    memcpy(change_m, b, (size_t)n * sizeof *b);
    return solve_blocks(system, points, &links, change_m);
}
