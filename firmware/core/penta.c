/* penta.c - see penta.h. */
#include "penta.h"

#include <float.h>

int penta_factor(penta *factor, int rows_n, const float *diagonal, const float *off1,
                 const float *off2)
{
    /* The two rows above, as A's entries left of their pivots become L's times D. */
    float pivot_1 = 1.0f, pivot_2 = 1.0f; /* D[i-1], D[i-2] */
    float below1_1 = 0.0f;                /* L[i-1][i-2] */
    factor->rows_n = rows_n;
    for (int i = 0; i < rows_n; i++) {
        penta_row *row = &factor->row[i];
        const float a2 = i >= 2 ? off2[i] : 0.0f;
        const float a1 = i >= 1 ? off1[i] - a2 * below1_1 : 0.0f;
        row->below2 = i >= 2 ? a2 * factor->row[i - 2].inverse_pivot : 0.0f;
        row->below1 = i >= 1 ? a1 * factor->row[i - 1].inverse_pivot : 0.0f;
        const float pivot = (diagonal[i] - row->below2 * row->below2 * pivot_2) -
                            row->below1 * row->below1 * pivot_1;
        if (!(pivot >= FLT_MIN && pivot <= FLT_MAX)) {
            return i + 1;
        }
        row->inverse_pivot = 1.0f / pivot;
        below1_1 = row->below1;
        pivot_2 = pivot_1;
        pivot_1 = pivot;
    }
    return 0;
}

/* One body for both widths: `width` is a constant where this is inlined, so the inner loops vanish. */
static inline __attribute__((always_inline)) void solve(const penta *factor, float *b, int width)
{
    const penta_row *row = factor->row;
    const int last = factor->rows_n - 1;
    float near[3] = {0.0f, 0.0f, 0.0f}; /* the row just done */
    float far[3] = {0.0f, 0.0f, 0.0f};  /* the one before it */

    for (int i = 0; i <= last; i++, b += width) {
        for (int r = 0; r < width; r++) {
            const float y = (b[r] - row[i].below2 * far[r]) - row[i].below1 * near[r];
            far[r] = near[r];
            near[r] = y;
            b[r] = y;
        }
    }

    float above1 = 0.0f, above2 = 0.0f; /* L[i+1][i], L[i+2][i] */
    float above2_next = 0.0f;           /* L[i+1][i-1], met one row later */
    for (int r = 0; r < width; r++) {
        near[r] = far[r] = 0.0f;
    }
    for (int i = last; i >= 0; i--) {
        b -= width;
        for (int r = 0; r < width; r++) {
            const float x = (b[r] * row[i].inverse_pivot - above2 * far[r]) - above1 * near[r];
            far[r] = near[r];
            near[r] = x;
            b[r] = x;
        }
        above1 = row[i].below1;
        above2 = above2_next;
        above2_next = row[i].below2;
    }
}

void penta_solve2(const penta *factor, float (*b)[2])
{
    solve(factor, &b[0][0], 2);
}

void penta_solve3(const penta *factor, float (*b)[3])
{
    solve(factor, &b[0][0], 3);
}
