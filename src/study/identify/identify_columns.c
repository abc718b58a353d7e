// Sums over residuals and over columns of their Jacobian.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/study/identify/identify.h"

#define NO_SAY 1e-12 // eigenvalue, over the largest one, that counts as zero

double identify_dot(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

void identify_add_scaled(double *to, double factor, const double *a, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += factor * a[i];
    }
}

// The space of the traces' own columns has an orthogonal basis from the eigenvectors of
// their matrix of products; eigenvalues that are zero but for rounding have none.
bool identify_leave_own(const identification *id, const double *jacobian, double *columns,
                        int count)
{
    const size_t m = id->residuals;
    const int p = id->count, q = id->unknowns - p;
    const double *own_columns = jacobian + (size_t)p * m;
    double size[IDENTIFY_UNKNOWNS], vectors[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS],
        values[IDENTIFY_UNKNOWNS], scratch[2 * IDENTIFY_UNKNOWNS];

    // products of the traces' own columns, each of size 1, and their eigenvectors
    for (int i = 0; i < q; i++) {
        const double *column = own_columns + (size_t)i * m;
        const double square = identify_dot(column, column, m);
        if (square > 0) {
            size[i] = sqrt(square);
        } else {
            size[i] = 1;
        }
        for (int j = 0; j <= i; j++) {
            vectors[i * q + j] = vectors[j * q + i] =
                identify_dot(column, own_columns + (size_t)j * m, m) /
                (size[i] * size[j]);
        }
    }
    SCOPED(free_kept) double *basis = calloc(m, sizeof *basis);
    if (basis == NULL || (q > 0 && !symmetric_eigen(q, vectors, values, scratch))) {
        return false;
    }

    // take the projection on each basis vector, whose square is the eigenvalue, off every
    // column
    for (int k = 0; k < q; k++) {
        if (values[k] < NO_SAY * values[q - 1]) {
            continue;
        }
        memset(basis, 0, m * sizeof *basis);
        for (int j = 0; j < q; j++) {
            identify_add_scaled(basis, vectors[k * q + j] / size[j],
                                own_columns + (size_t)j * m, m);
        }
        for (int i = 0; i < count; i++) {
            double *column = columns + (size_t)i * m;
            identify_add_scaled(column, -identify_dot(column, basis, m) / values[k],
                                basis, m);
        }
    }
    return true;
}
