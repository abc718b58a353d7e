#include "src/base/dense.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

static void swap_rows(int length, double *matrix, int i, int j)
{
    for (int k = 0; k < length; k++) {
        double entry = matrix[i * length + k];
        matrix[i * length + k] = matrix[j * length + k];
        matrix[j * length + k] = entry;
    }
}

static inline bool solve(int n, int columns, double *matrix, double *right)
{

    // elimination
    for (int column = 0; column < n; column++) {
        // the largest entry left in the column becomes the pivot
        int pivot = column;
        for (int row = column + 1; row < n; row++) {
            if (fabs(matrix[row * n + column]) > fabs(matrix[pivot * n + column])) {
                pivot = row;
            }
        }
        double divisor = matrix[pivot * n + column];
        if (divisor == 0 || !isfinite(divisor)) {
            return false;
        }
        if (pivot != column) {
            swap_rows(n, matrix, pivot, column);
            swap_rows(columns, right, pivot, column);
        }

        // the column vanishes in the rows below
        for (int row = column + 1; row < n; row++) {
            double factor = matrix[row * n + column] / divisor;
            for (int k = column; k < n; k++) {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            for (int k = 0; k < columns; k++) {
                right[row * columns + k] -= factor * right[column * columns + k];
            }
        }
    }

    // back substitution
    for (int row = n - 1; row >= 0; row--) {
        for (int c = 0; c < columns; c++) {
            double *x = right + row * columns + c;
            for (int k = row + 1; k < n; k++) {
                *x -= matrix[row * n + k] * right[k * columns + c];
            }
            *x /= matrix[row * n + row];
        }
    }
    return true;
}

bool dense_solve(int n, double *matrix, double *vector)
{
    assert(n > 0 && matrix != NULL && vector != NULL);
    return solve(n, 1, matrix, vector);
}

bool dense_solve_columns(int n, int columns, double *matrix, double *right)
{
    assert(n > 0 && columns > 0 && matrix != NULL && right != NULL);
    return solve(n, columns, matrix, right);
}
