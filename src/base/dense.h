// Small dense systems of linear equations, a handful of unknowns.
#pragma once

#include <stdbool.h>

// Solves A x = b by Gaussian elimination with partial pivoting. matrix: n x n, row by row,
// overwritten; vector: b on entry, x on return. Returns false, with both arguments in an unusable
// state, if a pivot is zero or not finite.
bool dense_solve(int n, double *matrix, double *vector);

// The same for several right-hand sides at once. right: n x columns, row by row; a column is one b.
bool dense_solve_columns(int n, int columns, double *matrix, double *right);
