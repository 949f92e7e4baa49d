/* penta.h - symmetric positive definite systems with five bands: factor once, solve often.
 *
 * A = L D L^T, L unit lower triangular with two sub-diagonals; the reciprocal pivots are kept, so
 * that solving needs no division. There is no pivoting, and none is needed: the matrices are
 * positive definite, and one that is not (to float32) is reported, never divided by.
 *
 * Order of operations in a solve (it fixes the bits, and shortens the dependency chain):
 *     y_i = (b_i - l2_i y_{i-2}) - l1_i y_{i-1},  then the same backwards from y_i / d_i.
 *
 * Cost for n rows: factor n divisions, 6 n multiplications, 4 n subtractions; solve, per right-hand
 * side, 5 n multiplications and 4 n subtractions (less 6 of each at the ends), nothing else.
 * Works for n = 1, 2, 3 as for any other. Pure functions on caller-owned memory; safe in an interrupt.
 */
#ifndef LIMBER_PENTA_H
#define LIMBER_PENTA_H

#include "rod_config.h"

typedef struct {
    float below1;        /* L[i][i-1]; 0 in row 0 */
    float below2;        /* L[i][i-2]; 0 in rows 0 and 1 */
    float inverse_pivot; /* 1 / D[i] */
} penta_row;

typedef struct {
    int rows_n;
    penta_row row[ROD_MAX_LINKS + 2]; /* two rows of zeros end the matrix */
} penta;

/* The matrix: diagonal[i] = A[i][i], off1[i] = A[i][i-1], off2[i] = A[i][i-2]; off1[0], off2[0] and
 * off2[1] are not read. rows_n in 1 ... ROD_MAX_LINKS. Returns 0, or the 1-based number of the first
 * row whose pivot is not finite or not positive; the factor is then not to be used. */
int penta_factor(penta *factor, int rows_n, const float *diagonal, const float *off1,
                 const float *off2);

/* Solve in place for 2 or 3 right-hand sides, one row of b per row of the matrix. */
void penta_solve2(const penta *factor, float (*b)[2]);
void penta_solve3(const penta *factor, float (*b)[3]);

#endif
