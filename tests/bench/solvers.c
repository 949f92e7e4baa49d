/* solvers.c - see solvers.h. */
#include "solvers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "penta.h"
#ifdef HAVE_LAPACK
#include <lapacke.h>
#endif

/* b and x of the solvers in C: row after row in ours, side after side in the others. */
static int n;
static float b_rows[ROWS_MAX][2], x_rows[ROWS_MAX][2];
static float b_sides[2 * ROWS_MAX], x_sides[2 * ROWS_MAX];

/* Adds weight times d d', d a first (1, -1) or second (1, -2, 1) difference from that row on. */
static void add_difference(bench_system *s, int row, int width, double weight)
{
    static const double D[2][3] = {{1.0, -1.0, 0.0}, {1.0, -2.0, 1.0}};
    for (int i = 0; i < width; i++) {
        for (int j = 0; j < width; j++) {
            s->m[row + i][row + j] += weight * D[width - 2][i] * D[width - 2][j];
        }
    }
}

void bench_system_make(bench_system *s, int rows_n)
{
    const double dt = 0.01; /* mu 0.2, c 2, k 80, beta 20000, eta 10000: see MODEL.md */
    *s = (bench_system){.rows_n = n = rows_n};
    for (int i = 0; i < n; i++) {
        s->m[i][i] += 0.2 + dt + 0.25 * dt * dt * 80.0;
        b_rows[i][0] = b_sides[i] = s->b[0][i] = (float)sin(1.0 + 0.7 * i);
        b_rows[i][1] = b_sides[n + i] = s->b[1][i] = (float)cos(0.3 * i);
    }
    for (int i = 0; i + 1 < n; i++) {
        add_difference(s, i, 2, 0.25 * dt * dt * 20000.0);
    }
    for (int i = 0; i + 2 < n; i++) {
        add_difference(s, i, 3, 0.25 * dt * dt * 10000.0);
    }
}

static inline void copy_fresh(float *x, const float *b, float chain)
{
    const float last = x[0];
    memcpy(x, b, (size_t)(2 * n) * sizeof *x);
    if (chain > 0.0f) {
        x[0] += chain * last;
    }
}

static float x_by_sides(int row, int side)
{
    return x_sides[side * n + row];
}

static penta factor;

static void penta_prepare(const bench_system *s)
{
    float diagonal[ROWS_MAX], off1[ROWS_MAX] = {0.0f}, off2[ROWS_MAX] = {0.0f};
    for (int i = 0; i < n; i++) {
        diagonal[i] = (float)s->m[i][i];
        off1[i] = i >= 1 ? (float)s->m[i][i - 1] : 0.0f;
        off2[i] = i >= 2 ? (float)s->m[i][i - 2] : 0.0f;
    }
    if (penta_factor(&factor, n, diagonal, off1, off2) != 0) {
        abort();
    }
}

static void penta_run(int times, float chain)
{
    for (int i = 0; i < times; i++) {
        copy_fresh(x_rows[0], b_rows[0], chain);
        penta_solve2(&factor, x_rows);
        CONSUME();
    }
}

static float penta_x(int row, int side)
{
    return x_rows[row][side];
}

static float inverse[ROWS_MAX][ROWS_MAX];

/* By Gauss and Jordan in double, rounded once at the end. */
static void dense_prepare(const bench_system *s)
{
    static double a[ROWS_MAX][2 * ROWS_MAX];
    memset(a, 0, sizeof a);
    for (int i = 0; i < n; i++) {
        memcpy(a[i], s->m[i], (size_t)n * sizeof(double));
        a[i][n + i] = 1.0;
    }
    for (int pivot = 0; pivot < n; pivot++) {
        for (int i = 0; i < n; i++) {
            const double factor_i = a[i][pivot] / a[pivot][pivot];
            for (int j = 0; j < 2 * n && i != pivot; j++) {
                a[i][j] -= factor_i * a[pivot][j];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            inverse[i][j] = (float)(a[i][n + j] / a[i][i]);
        }
    }
}

/* Column by column (it is symmetric), which the compiler may vectorise; sums of rows it may not. */
static void multiply(const float *restrict b, float *restrict x0, float *restrict x1)
{
    memset(x0, 0, (size_t)n * sizeof *x0);
    memset(x1, 0, (size_t)n * sizeof *x1);
    for (int j = 0; j < n; j++) {
        const float b0 = b[j], b1 = b[n + j];
        for (int i = 0; i < n; i++) {
            x0[i] += inverse[j][i] * b0;
            x1[i] += inverse[j][i] * b1;
        }
    }
}

static void dense_run(int times, float chain)
{
    const float first = b_sides[0];
    for (int i = 0; i < times; i++) {
        if (chain > 0.0f) {
            b_sides[0] = first + chain * x_sides[0];
        }
        multiply(b_sides, x_sides, x_sides + n);
        CONSUME();
    }
    b_sides[0] = first;
}

#ifdef HAVE_LAPACK
static const int TWO = 2, THREE = 3, SEVEN = 7;
static float general[7 * ROWS_MAX], definite[3 * ROWS_MAX]; /* LAPACK's band storage, by columns */
static int pivots[ROWS_MAX], info;

static void general_prepare(const bench_system *s)
{
    memset(general, 0, sizeof general);
    for (int j = 0; j < n; j++) {
        for (int i = j < 2 ? 0 : j - 2; i <= j + 2 && i < n; i++) {
            general[7 * j + 4 + i - j] = (float)s->m[i][j];
        }
    }
    LAPACK_sgbtrf(&n, &n, &TWO, &TWO, general, &SEVEN, pivots, &info);
}

static void general_run(int times, float chain)
{
    for (int i = 0; i < times; i++) {
        copy_fresh(x_sides, b_sides, chain);
        LAPACK_sgbtrs("N", &n, &TWO, &TWO, &TWO, general, &SEVEN, pivots, x_sides, &n, &info);
        CONSUME();
    }
}

static void definite_prepare(const bench_system *s)
{
    for (int j = 0; j < n; j++) {
        for (int i = j; i <= j + 2 && i < n; i++) {
            definite[3 * j + i - j] = (float)s->m[i][j];
        }
    }
    LAPACK_spbtrf("L", &n, &TWO, definite, &THREE, &info);
}

static void definite_run(int times, float chain)
{
    for (int i = 0; i < times; i++) {
        copy_fresh(x_sides, b_sides, chain);
        LAPACK_spbtrs("L", &n, &TWO, &TWO, definite, &THREE, x_sides, &n, &info);
        CONSUME();
    }
}
#endif

const solver solvers[SOLVERS_N] = {
    {"limber penta_solve2", penta_prepare, penta_run, penta_x},
#ifdef HAVE_LAPACK
    {"LAPACK spbtrs", definite_prepare, definite_run, x_by_sides},
    {"LAPACK sgbtrs", general_prepare, general_run, x_by_sides},
#else
    {.name = "LAPACK spbtrs"},
    {.name = "LAPACK sgbtrs"},
#endif
#ifdef HAVE_EIGEN
    {"Eigen SimplicialLDLT", eigen_prepare, eigen_run, eigen_x},
#else
    {.name = "Eigen SimplicialLDLT"},
#endif
    {"dense inverse", dense_prepare, dense_run, x_by_sides},
};
