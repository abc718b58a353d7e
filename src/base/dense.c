#include "src/base/dense.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

static void swap_rows(int n, double *matrix, double *vector, int i, int j)
{
    for (int k = 0; k < n; k++) {
        double entry = matrix[i * n + k];
        matrix[i * n + k] = matrix[j * n + k];
        matrix[j * n + k] = entry;
    }
    double entry = vector[i];
    vector[i] = vector[j];
    vector[j] = entry;
}

bool dense_solve(int n, double *matrix, double *vector)
{
    assert(n > 0 && matrix != NULL && vector != NULL);

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
            swap_rows(n, matrix, vector, pivot, column);
        }

        // the column vanishes in the rows below
        for (int row = column + 1; row < n; row++) {
            double factor = matrix[row * n + column] / divisor;
            for (int k = column; k < n; k++) {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            vector[row] -= factor * vector[column];
        }
    }

    // back substitution
    for (int row = n - 1; row >= 0; row--) {
        for (int k = row + 1; k < n; k++) {
            vector[row] -= matrix[row * n + k] * vector[k];
        }
        vector[row] /= matrix[row * n + row];
    }
    return true;
}
