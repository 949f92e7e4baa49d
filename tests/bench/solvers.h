/* solvers.h - a system M x = b with five bands and two right-hand sides, and the ways a user might
 * solve it: ours, LAPACK's two for bands, Eigen's for sparse matrices, the dense inverse. All are
 * float32, with M prepared beforehand. One system at a time: the state is in the module.
 */
#ifndef LIMBER_SOLVERS_H
#define LIMBER_SOLVERS_H

#ifdef __cplusplus
extern "C" {
#endif

enum { SOLVERS_N = 5, ROWS_MAX = 64 };

typedef struct {
    int rows_n;
    double m[ROWS_MAX][ROWS_MAX];
    float b[2][ROWS_MAX];
} bench_system;

typedef struct {
    const char *name;
    void (*prepare)(const bench_system *s); /* NULL: not installed */
    /* Solves so many times, each time from a fresh copy of b. With chain > 0 its first entry has chain
     * times the last x added, so that each solve waits for the one before; with 0 none needs to. */
    void (*run)(int times, float chain);
    float (*x)(int row, int side); /* after a run */
} solver;

extern const solver solvers[SOLVERS_N]; /* ours comes first */

/* M of a rod coupled so stiffly that its inverse has no subnormal entries, which are slow. */
void bench_system_make(bench_system *s, int rows_n);

void eigen_prepare(const bench_system *s);
void eigen_run(int times, float chain);
float eigen_x(int row, int side);

/* Makes the compiler believe that all memory is read and written here: no solve can be left out. */
#define CONSUME() __asm__ volatile("" ::: "memory")

#ifdef __cplusplus
}
#endif

#endif
