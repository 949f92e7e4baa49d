/* bending.c - see bending.h. */
#include "bending.h"

#include <stddef.h>

void bending_assemble(const bending_link *link, int links_n, const float *stiffness,
                      const float *tension, bending_bands *bands)
{
    float *const diagonal = &bands->diagonals[2], *const off1 = &bands->offs1[2];
    float *const off2 = bands->off2;
    diagonal[-1] = diagonal[-2] = off1[-1] = 0.0f;
    float before = link[0].per_length; /* the ghost link is as long as the first */
    for (int j = 0; j < links_n; j++) {
        const float here = link[j].per_length;
        const float both = here + before;
        const float far = stiffness[j] * here, near = stiffness[j] * before;
        diagonal[j] = link[j].own_kg + far * here;
        diagonal[j - 1] += (stiffness[j] * both) * both;
        diagonal[j - 2] += near * before;
        off1[j] = -(far * both);
        off1[j - 1] -= near * both;
        off2[j] = far * before;
        const float held = tension != NULL && tension[j] > 0.0f ? tension[j] * here : 0.0f;
        diagonal[j] += held;
        diagonal[j - 1] += held;
        off1[j] -= held;
        before = here;
    }
}
