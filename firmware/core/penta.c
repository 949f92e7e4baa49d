/* penta.c - see penta.h. */
#include "penta.h"

#include <float.h>
#include <stdbool.h>

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
    factor->row[rows_n] = factor->row[rows_n + 1] = (penta_row){0.0f, 0.0f, 0.0f};
    return 0;
}

/* One row of the forward pass. `older` is y of the row before last, `newer` of the last; this row's
 * overwrites the older, so that the caller passes the two crosswise from row to row and nothing is
 * moved about. Coefficients are read before b is written: the compiler cannot know they are apart. */
static inline __attribute__((always_inline)) void
forward_row(const penta_row *row, float *b, float *older, const float *newer, int width)
{
    const float below1 = row[0].below1, below2 = row[0].below2;
    for (int r = 0; r < width; r++) {
        older[r] = (b[r] - below2 * older[r]) - below1 * newer[r];
    }
    for (int r = 0; r < width; r++) {
        b[r] = older[r];
    }
}

/* The same for the backward pass, with the rows below. */
static inline __attribute__((always_inline)) void
backward_row(const penta_row *row, float *b, float *older, const float *newer, int width)
{
    const float above1 = row[1].below1, above2 = row[2].below2;
    const float inverse_pivot = row[0].inverse_pivot;
    for (int r = 0; r < width; r++) {
        older[r] = (b[r] * inverse_pivot - above2 * older[r]) - above1 * newer[r];
    }
    for (int r = 0; r < width; r++) {
        b[r] = older[r];
    }
}

/* One body for both widths: `width` is a constant where this is inlined, so its loops vanish. */
static inline __attribute__((always_inline)) void solve(const penta *factor, float *b, int width)
{
    const int rows_n = factor->rows_n;
    const bool odd = (rows_n & 1) != 0;
    const penta_row *row = factor->row;
    float one[3] = {0.0f, 0.0f, 0.0f}, other[3] = {0.0f, 0.0f, 0.0f};

    for (int pairs = rows_n / 2; pairs > 0; pairs--) {
        forward_row(row, b, one, other, width);
        forward_row(row + 1, b + width, other, one, width);
        row += 2;
        b += 2 * width;
    }
    if (odd) {
        forward_row(row, b, one, other, width);
        row++;
        b += width;
    }

    for (int r = 0; r < width; r++) {
        one[r] = other[r] = 0.0f;
    }
    for (int pairs = rows_n / 2; pairs > 0; pairs--) {
        row -= 2;
        b -= 2 * width;
        backward_row(row + 1, b + width, one, other, width);
        backward_row(row, b, other, one, width);
    }
    if (odd) {
        backward_row(row - 1, b - width, one, other, width);
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
