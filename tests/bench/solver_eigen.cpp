// solver_eigen.cpp - see solvers.h. The rows are in their best order already: none is looked for.
#include "solvers.h"

#include <Eigen/SparseCholesky>

using Matrix = Eigen::SparseMatrix<float>;
static Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factor;
static Eigen::Matrix<float, Eigen::Dynamic, 2> b, x;

void eigen_prepare(const bench_system *s)
{
    const int n = s->rows_n;
    Matrix m(n, n);
    for (int i = 0; i < n; i++) {
        for (int j = i < 2 ? 0 : i - 2; j <= i + 2 && j < n; j++) {
            m.insert(i, j) = static_cast<float>(s->m[i][j]);
        }
    }
    m.makeCompressed();
    factor.compute(m);
    b.resize(n, 2);
    for (int i = 0; i < n; i++) {
        b.row(i) << s->b[0][i], s->b[1][i];
    }
    x = b;
}

void eigen_run(int times, float chain)
{
    const float first = b(0, 0);
    for (int i = 0; i < times; i++) {
        if (chain > 0.0f) {
            b(0, 0) = first + chain * x(0, 0);
        }
        x = factor.solve(b); // copies b into x and works there
        CONSUME();
    }
    b(0, 0) = first;
}

float eigen_x(int row, int side)
{
    return x(row, side);
}
