/* bending.h - joints that resist bending, as a matrix on node positions: five bands, the same for x, y and z.
 *
 * Row j of D is the curvature at joint j, with nodes P and lengths l:
 *     P_j / l_j - P_{j-1} (1 / l_j + 1 / l_{j-1}) + P_{j-2} / l_{j-1}
 * and the matrix is D' diag(stiffness) D and something of each node's own. Node 0 and the ghost node before it, which
 * clamps the base, are given. Caller-owned memory, no failure. MODEL.md, Section 5.
 */
#ifndef LIMBER_BENDING_H
#define LIMBER_BENDING_H

#include "rod_config.h"

/* A link and the node at its far end. */
typedef struct {
    float length_m, per_length; /* l, 1 / l */
    float own_kg;               /* on the diagonal: what the node resists with by itself */
} bending_link;

/* As penta_factor takes it; the two rows before the first take what is the base's. */
typedef struct {
    float diagonals[ROD_MAX_LINKS + 2], offs1[ROD_MAX_LINKS + 2], off2[ROD_MAX_LINKS];
} bending_bands;

static inline const float *bending_diagonal(const bending_bands *bands)
{
    return bands->diagonals + 2;
}

static inline const float *bending_off1(const bending_bands *bands)
{
    return bands->offs1 + 2;
}

/* stiffness: of each joint, kg m^2. tension (or NULL): each link's pull, kg m; one that pulls holds its ends in line like
 * a string's. About 45 instructions a link. */
void bending_assemble(const bending_link *link, int links_n, const float *stiffness,
                      const float *tension, bending_bands *bands);

#endif
