#include "src/base/dense.h"

#include <math.h>

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
    for (int column = 0; column < n; column++) {
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
        for (int row = column + 1; row < n; row++) {
            double factor = matrix[row * n + column] / divisor;
            for (int k = column; k < n; k++) {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            vector[row] -= factor * vector[column];
        }
    }
    for (int row = n - 1; row >= 0; row--) {
        for (int k = row + 1; k < n; k++) {
            vector[row] -= matrix[row * n + k] * vector[k];
        }
        vector[row] /= matrix[row * n + row];
    }
    return true;
}
