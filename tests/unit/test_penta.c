/* test_penta.c - the five-band solver against dense elimination with pivoting, in double.
 *
 * The matrices are those of the model, diag + D1' beta D1 + D2' eta D2, with magnitudes that reach from
 * well conditioned to 1e6. The reference shares nothing with the solver: no bands, no symmetry. */
#include "penta.h"
#include "test_support.h"
#include "unity.h"

#include <stdio.h>

enum { N_MAX = ROD_MAX_LINKS };

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    int rows_n;
    float band[3][N_MAX]; /* the diagonal, and one and two to its left */
} bands;

/* Coupling and smoothing spread over the decades up to `stiffest`; the diagonal, about 1, bounds the
 * smallest eigenvalue from below, so `stiffest` is about the condition number. What the solver is not
 * to read is poison. */
static void random_bands(bands *a, uint32_t *seed, int rows_n, double stiffest, int smoothed)
{
    a->rows_n = rows_n;
    static double beta[N_MAX + 1], eta[N_MAX + 1];
    for (int i = 0; i < rows_n; i++) {
        beta[i] = random_magnitude(seed, 1e-3, stiffest / 4.0);
        eta[i] = smoothed && i + 1 < rows_n ? random_magnitude(seed, 1e-3, stiffest / 16.0) : 0.0;
    }
    beta[rows_n] = eta[rows_n] = 0.0;
    for (int i = 0; i < rows_n; i++) {
        const double eta_left = i >= 1 ? eta[i - 1] : 0.0;
        a->band[0][i] = (float)(random_between(seed, 0.5, 2.0) + beta[i] + beta[i + 1] + eta_left +
                                4.0 * eta[i] + eta[i + 1]);
        a->band[1][i] = i >= 1 ? (float)-(beta[i] + 2.0 * eta[i] + 2.0 * eta_left) : NAN;
        a->band[2][i] = i >= 2 ? (float)eta_left : NAN;
    }
}

/* Into memory full of NaN: what the factor does not write, a solve must not read. */
static int factor_bands(penta *factor, const bands *a)
{
    memset(factor, 0xff, sizeof *factor);
    return penta_factor(factor, a->rows_n, a->band[0], a->band[1], a->band[2]);
}

static double entry(const bands *a, int row, int column)
{
    const int lower = row > column ? row : column, apart = 2 * lower - row - column;
    return apart <= 2 ? (double)a->band[apart][lower] : 0.0;
}

/* Gauss with partial pivoting; b becomes the solution. */
static void solve_dense(const bands *a, double *b)
{
    static double m[N_MAX][N_MAX + 1]; /* A, and b at its right */
    const int n = a->rows_n;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) {
            m[i][k] = entry(a, i, k);
        }
        m[i][n] = b[i];
    }
    for (int column = 0; column < n; column++) {
        int pivot = column;
        for (int i = column + 1; i < n; i++) {
            pivot = fabs(m[i][column]) > fabs(m[pivot][column]) ? i : pivot;
        }
        for (int k = column; k <= n; k++) {
            const double swap = m[column][k];
            m[column][k] = m[pivot][k];
            m[pivot][k] = swap;
        }
        for (int i = column + 1; i < n; i++) {
            const double factor = m[i][column] / m[column][column];
            for (int k = column; k <= n; k++) {
                m[i][k] -= factor * m[column][k];
            }
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = m[i][n];
        for (int k = i + 1; k < n; k++) {
            sum -= m[i][k] * b[k];
        }
        b[i] = sum / m[i][i];
    }
}

static double norm_of_matrix(const bands *a)
{
    double norm = 0.0;
    for (int i = 0; i < a->rows_n; i++) {
        double sum = 0.0;
        for (int k = 0; k < a->rows_n; k++) {
            sum += fabs(entry(a, i, k));
        }
        norm = worse(norm, sum);
    }
    return norm;
}

static double norm_of_vector(const double *v, int rows_n)
{
    double norm = 0.0;
    for (int i = 0; i < rows_n; i++) {
        norm = worse(norm, fabs(v[i]));
    }
    return norm;
}

/* The norm of the inverse from below, by the power method: a few rounds come well within 2. */
static double norm_of_inverse(const bands *a, double *start)
{
    double norm = 0.0;
    for (int round = 0; round < 3; round++) {
        const double before = norm_of_vector(start, a->rows_n);
        solve_dense(a, start);
        norm = worse(norm, norm_of_vector(start, a->rows_n) / before);
    }
    return norm;
}

/* The residual over the size of what it is the residual of: by how much, relative to A and b, one
 * would have to change the question for the float answer to be exact. */
static double backward_error(const bands *a, const double *x, const double *b)
{
    static double residual[N_MAX];
    for (int i = 0; i < a->rows_n; i++) {
        residual[i] = b[i];
        for (int k = 0; k < a->rows_n; k++) {
            residual[i] -= entry(a, i, k) * x[k];
        }
    }
    return norm_of_vector(residual, a->rows_n) /
           (norm_of_matrix(a) * norm_of_vector(x, a->rows_n) + norm_of_vector(b, a->rows_n));
}

typedef struct {
    double backward, forward; /* in roundoffs, and in roundoffs times the condition number */
    double condition_min, condition_max;
} accuracy;

/* One column will do: that the others get the same bits is the next test's matter. */
static void measure(const bands *a, uint32_t *seed, accuracy *worst)
{
    static float solved[N_MAX][2];
    static double x[N_MAX], b[N_MAX], wanted[N_MAX], wrong_by[N_MAX];
    static penta factor;
    const int n = a->rows_n;
    for (int i = 0; i < n; i++) {
        solved[i][0] = (float)random_between(seed, -1.0, 1.0);
        b[i] = wanted[i] = (double)solved[i][0];
    }
    TEST_ASSERT_EQUAL_INT(0, factor_bands(&factor, a));
    penta_solve2(&factor, solved);
    solve_dense(a, wanted);
    for (int i = 0; i < n; i++) {
        x[i] = (double)solved[i][0];
        wrong_by[i] = x[i] - wanted[i];
    }

    const double forward = norm_of_vector(wrong_by, n) / norm_of_vector(wanted, n);
    const double condition = norm_of_matrix(a) * norm_of_inverse(a, wanted);
    worst->backward = worse(worst->backward, backward_error(a, x, b) / UNIT_ROUNDOFF);
    worst->forward = worse(worst->forward, forward / (condition * UNIT_ROUNDOFF));
    worst->condition_min = fmin(worst->condition_min, condition);
    worst->condition_max = fmax(worst->condition_max, condition);
}

/* Theory's worst case: 12 roundings from A to x in each entry, and |L| D |L'| up to 5 times as large as
 * A (five bands, each entry bounded by the diagonal): 60 roundoffs. Roundings do not all conspire: the
 * worst measured is under 2. Allowing 3, nothing passes that loses another bit. */
static void test_accuracy(void)
{
    static const char *const NAME[2] = {"tridiagonal", "pentadiagonal"};
    static bands a;
    uint32_t seed = 10;
    for (int smoothed = 0; smoothed < 2; smoothed++) {
        accuracy worst = {0.0, 0.0, 1e99, 0.0};
        for (int rows_n = 1; rows_n <= N_MAX; rows_n += HOST_OR_BOARD(1, rows_n < 8 ? 1 : 4)) {
            for (int i = 0; i < HOST_OR_BOARD(48, 4); i++) {
                random_bands(&a, &seed, rows_n, random_magnitude(&seed, 1.0, 1e6), smoothed);
                measure(&a, &seed, &worst);
            }
        }
        printf("%s: condition %.2g to %.2g, backward error %.2f roundoffs, forward "
               "error %.2f roundoffs times the condition\n",
               NAME[smoothed], worst.condition_min, worst.condition_max, worst.backward,
               worst.forward);
        TEST_ASSERT_TRUE(worst.backward < 3.0);
        TEST_ASSERT_TRUE(worst.forward < 3.0);
        TEST_ASSERT_TRUE_MESSAGE(worst.condition_max > 1e5, "the systems are too easy");
    }
}

/* The order of operations that penta.h promises, spelled out. */
static void solve_as_promised(const penta *factor, float *b)
{
    const penta_row *row = factor->row;
    const int n = factor->rows_n;
    for (int i = 0; i < n; i++) {
        const float near = i >= 1 ? row[i].below1 * b[i - 1] : 0.0f;
        const float far = i >= 2 ? row[i].below2 * b[i - 2] : 0.0f;
        b[i] = (b[i] - far) - near;
    }
    for (int i = n - 1; i >= 0; i--) {
        const float near = i + 1 < n ? row[i + 1].below1 * b[i + 1] : 0.0f;
        const float far = i + 2 < n ? row[i + 2].below2 * b[i + 2] : 0.0f;
        b[i] = (b[i] * row[i].inverse_pivot - far) - near;
    }
}

static void test_both_widths_give_the_promised_bits(void)
{
    static bands a;
    static penta factor;
    static float one[3][N_MAX], two[N_MAX][2], three[N_MAX][3];
    uint32_t seed = 3;
    for (int rows_n = 1; rows_n <= N_MAX; rows_n++) {
        random_bands(&a, &seed, rows_n, 1e4, 1);
        TEST_ASSERT_EQUAL_INT(0, factor_bands(&factor, &a));
        for (int i = 0; i < rows_n; i++) {
            for (int c = 0; c < 3; c++) {
                one[c][i] = three[i][c] = (float)random_between(&seed, -1.0, 1.0);
            }
            two[i][0] = three[i][2]; /* the same columns, elsewhere and beside others */
            two[i][1] = three[i][0];
        }
        for (int c = 0; c < 3; c++) {
            solve_as_promised(&factor, one[c]);
        }
        penta_solve2(&factor, two);
        penta_solve3(&factor, three);
        for (int i = 0; i < rows_n; i++) {
            for (int c = 0; c < 3; c++) {
                TEST_ASSERT_EQUAL_HEX32(bits_of(one[c][i]), bits_of(three[i][c]));
            }
            TEST_ASSERT_EQUAL_HEX32(bits_of(one[2][i]), bits_of(two[i][0]));
            TEST_ASSERT_EQUAL_HEX32(bits_of(one[0][i]), bits_of(two[i][1]));
        }
    }
}

/* Spoils one entry of a good matrix: which row is blamed, from 1? */
static int row_blamed(bands *a, int band, int row, float value)
{
    static penta factor;
    const float good = a->band[band][row];
    a->band[band][row] = value;
    const int blamed = factor_bands(&factor, a);
    a->band[band][row] = good;
    return blamed;
}

static void test_a_bad_pivot_is_refused_by_its_row(void)
{
    static const float BAD_DIAGONAL[] = {0.0f, -0.0f, -1.0f, 1e-40f, NAN, INFINITY, -INFINITY};
    /* too large for the diagonal of their row, so found there */
    static const float BAD_LEFT[] = {1e4f, -1e4f, 3e38f, NAN, INFINITY, -INFINITY};
    static bands a;
    uint32_t seed = 5;
    random_bands(&a, &seed, 9, 100.0, 1);
    for (int row = 0; row < a.rows_n; row++) {
        for (size_t i = 0; i < sizeof BAD_DIAGONAL / sizeof BAD_DIAGONAL[0]; i++) {
            TEST_ASSERT_EQUAL_INT(row + 1, row_blamed(&a, 0, row, BAD_DIAGONAL[i]));
        }
        for (size_t i = 0; i < sizeof BAD_LEFT / sizeof BAD_LEFT[0]; i++) {
            for (int band = 1; band <= 2; band++) { /* what lies outside the matrix is not read */
                const int expected = row >= band ? row + 1 : 0;
                TEST_ASSERT_EQUAL_INT(expected, row_blamed(&a, band, row, BAD_LEFT[i]));
            }
        }
    }
}

/* A diagonal of ones, yet not positive definite: only the elimination can tell. */
static void test_an_indefinite_matrix_is_refused(void)
{
    static penta factor;
    static bands a = {3, {{1.0f, 1.0f, 1.0f}, {NAN, 0.5f, 1.0f}, {NAN, NAN, 0.0f}}};
    TEST_ASSERT_EQUAL_INT(3, factor_bands(&factor, &a));
    static bands singular = {3, {{1.0f, 1.0f, 1.0f}, {NAN, 0.0f, 0.0f}, {NAN, NAN, 1.0f}}};
    TEST_ASSERT_EQUAL_INT(3, factor_bands(&factor, &singular));
    a.rows_n = 2;
    TEST_ASSERT_EQUAL_INT(0, factor_bands(&factor, &a));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_accuracy);
    RUN_TEST(test_both_widths_give_the_promised_bits);
    RUN_TEST(test_a_bad_pivot_is_refused_by_its_row);
    RUN_TEST(test_an_indefinite_matrix_is_refused);
    return UNITY_END();
}
