// Small dense matrices: systems of linear equations, exponentials, eigenvalues.
#pragma once

#include <stdbool.h>

// Solves A x = b by Gaussian elimination with partial pivoting. matrix: n x n, row by
// row, overwritten; vector: b on entry, x on return. Returns false, with both arguments
// in an unusable state, if a pivot is zero or not finite.
bool dense_solve(int n, double *matrix, double *vector);

// The same for several right-hand sides at once. right: n x columns, row by row; a column
// is one b.
bool dense_solve_columns(int n, int columns, double *matrix, double *right);

// result = exp(matrix h) for matrices of size x size, row by row, by Taylor's series of
// the scaled matrix, squared back. power, product: scratch of the same size.
void matrix_exponential(const double *matrix, int size, double h, double *result,
                        double *power, double *product);

// --- symmetric matrices ----------------------------------------------------------------

// Eigenvalues and eigenvectors of symmetric matrices, from nothing but IEEE operations in
// a fixed order: the same bits whatever libraries are installed. Dense, cost n^3. n is at
// most SYMMETRIC_MOST.

enum { SYMMETRIC_MOST = 1032 };

// Decomposes the symmetric matrix[n * n] (row-major, both triangles given). On return row
// k of it is the unit eigenvector of values[k], values in rising order. scratch: 2 n
// doubles. False if the iteration does not end.
//
// Householder's reduction to tridiagonal form, then the QL method with implicit shifts
// (Bowdler, Martin, Reinsch, Wilkinson, Numerische Mathematik 11 (1968), 293-306).
bool symmetric_eigen(int n, double *matrix, double *values, double *scratch);

// The same for matrix x = value mass x, mass positive definite; row k of `matrix` is then
// scaled to x' mass x = 1. Overwrites `mass`. False also if mass is not positive
// definite.
bool symmetric_eigen_pair(int n, double *matrix, double *mass, double *values,
                          double *scratch);

// Cholesky's factor of the positive definite matrix[n * n] into its lower triangle; the
// upper one is left as it was. False if it is not positive definite.
bool symmetric_factor(int n, double *matrix);

// vector <- L^-1 vector and vector <- L^-T vector, L from symmetric_factor.
void symmetric_forward(int n, const double *factor, double *vector);
void symmetric_backward(int n, const double *factor, double *vector);
