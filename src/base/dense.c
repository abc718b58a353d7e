#include "src/base/dense.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/base/fault.h"

static void swap_rows(int length, double *matrix, int i, int j)
{
    for (int k = 0; k < length; k++) {
        double entry = matrix[i * length + k];
        matrix[i * length + k] = matrix[j * length + k];
        matrix[j * length + k] = entry;
    }
}

// Gaussian elimination with partial pivoting: `right` becomes the solution. False if the
// matrix is singular.
static inline bool solve_columns(int n, int columns, double *matrix, double *right)
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
    assert(n > 0);
    return solve_columns(n, 1, matrix, vector);
}

bool dense_solve_columns(int n, int columns, double *matrix, double *right)
{
    assert(n > 0 && columns > 0);
    return solve_columns(n, columns, matrix, right);
}

// The largest sum of a row's absolute values, times h.
static double largest_row_sum(const double *matrix, int size, double h)
{
    double norm = 0;
    for (int i = 0; i < size; i++) {
        double row = 0;
        for (int j = 0; j < size; j++) {
            row += fabs(matrix[i * size + j]) * h;
        }
        norm = fmax(norm, row);
    }
    return norm;
}

// How often a number must be halved to be at most 0.5.
static int halvings_to_half(double number)
{
    int octave;
    const double mantissa = frexp(number, &octave);
    if (!(number > 0.5)) {
        return 0;
    }
    if (mantissa > 0.5) {
        return octave + 1;
    }
    return octave;
}

// factor times the product of two square matrices.
static void matrix_product(const double *left, const double *right, int size,
                           double factor, double *product)
{
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < size; j++) {
            double sum = 0;
            for (int k = 0; k < size; k++) {
                sum += left[i * size + k] * right[k * size + j];
            }
            product[i * size + j] = sum * factor;
        }
    }
}

// exp(h A) by scaling and squaring of its Taylor series.
void matrix_exponential(const double *matrix, int size, double h, double *result,
                        double *power, double *product)
{
    const size_t bytes = (size_t)(size * size) * sizeof(double);

    // halved until the series converges fast
    const int squarings = halvings_to_half(largest_row_sum(matrix, size, h));
    const double scale = h / ldexp(1, squarings);
    memset(result, 0, bytes);
    memset(power, 0, bytes);
    for (int i = 0; i < size; i++) {
        result[i * size + i] = power[i * size + i] = 1;
    }

    // first the terms of the series, then the squarings
    enum { TERMS = 14 };
    for (int term = 1; term <= TERMS + squarings; term++) {
        // a term of the series, or the square of what there is so far
        const double *left = result, *right = result;
        double factor = 1;
        if (term <= TERMS) {
            left = matrix;
            right = power;
            factor = scale / term;
        }
        matrix_product(left, right, size, factor, product);

        if (term > TERMS) {
            memcpy(result, product, bytes);
            continue;
        }
        memcpy(power, product, bytes);
        for (int i = 0; i < size * size; i++) {
            result[i] += product[i];
        }
    }
}

// --- symmetric matrices ----------------------------------------------------------------

enum { MOST_SHIFTS = 60 };

// Reduces the matrix to tridiagonal form: `diagonal`, and `beside` it from index 1 on. On
// return row k of `matrix` from k + 1 on holds the k-th reflection's vector and `norms`
// its 2 / v'v.
static void tridiagonalise(int n, double *matrix, double *diagonal, double *beside,
                           double *norms)
{
    for (int k = 0; k < n - 1; k++) {
        double *v = matrix + (long)k * n; // row k is column k
        double size = 0;
        for (int i = k + 1; i < n; i++) {
            size += v[i] * v[i];
        }

        // the reflection that leaves only the first of these entries
        size = sqrt(size);
        diagonal[k] = v[k];
        if (v[k + 1] > 0) {
            beside[k + 1] = -size;
        } else {
            beside[k + 1] = size;
        }
        v[k + 1] -= beside[k + 1];

        // 2 / v'v without forming v'v, which might cancel
        double square = size * (size + fabs(v[k + 1] + beside[k + 1]));
        if (square > 0) {
            norms[k] = 1 / square;
        } else {
            norms[k] = 0;
        }
        if (square == 0) {
            continue;
        }

        // p = A v / (v'v / 2), then A -= v w' + w v' with w = p - (p'v / v'v) v
        double *w = diagonal + k + 1; // free until its entries are known
        double along = 0;
        for (int i = k + 1; i < n; i++) {
            const double *row = matrix + (long)i * n;
            double sum = 0;
            for (int j = k + 1; j < n; j++) {
                sum += row[j] * v[j];
            }
            w[i - k - 1] = sum * norms[k];
            along += w[i - k - 1] * v[i];
        }

        // w, and both rank-one terms at once
        along *= norms[k] / 2;
        for (int i = k + 1; i < n; i++) {
            w[i - k - 1] -= along * v[i];
        }
        for (int i = k + 1; i < n; i++) {
            double *row = matrix + (long)i * n;
            const double vi = v[i], wi = w[i - k - 1];
            for (int j = k + 1; j < n; j++) {
                row[j] -= vi * w[j - k - 1] + wi * v[j];
            }
        }
    }
    diagonal[n - 1] = matrix[(long)n * n - 1];
}

// Turns the rows that hold the reflections into the rows of Q', Q = H_0 H_1 ...
static void accumulate(int n, double *matrix, const double *norms, double *v)
{
    matrix[(long)n * n - 1] = 1;
    for (int k = n - 2; k >= 0; k--) {
        memcpy(v, matrix + (long)k * n, (size_t)n * sizeof *v);

        // row and column k + 1 onwards hold Q' of the later ones: Q' H_k, row by row
        for (int i = k + 1; i < n; i++) {
            double *row = matrix + (long)i * n;
            double sum = 0;
            for (int j = k + 1; j < n; j++) {
                sum += row[j] * v[j];
            }
            sum *= norms[k];
            for (int j = k + 1; j < n; j++) {
                row[j] -= sum * v[j];
            }
            row[k] = 0;
        }

        // row k itself has only its diagonal so far
        memset(matrix + (long)k * n, 0, (size_t)n * sizeof *matrix);
        matrix[(long)k * n + k] = 1;
    }
}

// One sweep of the QL method over the block l..m.
static void ql_sweep(int n, int l, int m, double *d, double *e, double *rows)
{
    double g = (d[l + 1] - d[l]) / (2 * e[l]), r = sqrt(g * g + 1);
    g = d[m] - d[l] + e[l] / (g + copysign(r, g));
    double s = 1, c = 1, p = 0;

    // rotations chase the bulge from the bottom of the block to its top
    for (int i = m - 1; i >= l; i--) {
        double f = s * e[i], b = c * e[i];

        // the rotation that removes it here; none is needed where it has vanished
        r = sqrt(f * f + g * g);
        e[i + 1] = r;
        if (r == 0) {
            d[i + 1] -= p;
            e[m] = 0;
            return;
        }

        // both diagonal entries follow the rotation
        s = f / r;
        c = g / r;
        g = d[i + 1] - p;
        r = (d[i] - g) * s + 2 * c * b;
        p = s * r;
        d[i + 1] = g + p;
        g = c * r - b;

        // and so do the eigenvectors
        double *lower = rows + (long)i * n, *upper = lower + n;
        for (int k = 0; k < n; k++) {
            double u = upper[k], w = lower[k];
            upper[k] = s * w + c * u;
            lower[k] = c * w - s * u;
        }
    }
    d[l] -= p;
    e[l] = g;
    e[m] = 0;
}

// Sorts eigenvalues and the rows that belong to them.
static void sort_rows(int n, double *values, double *rows)
{
    for (int i = 0; i < n - 1; i++) {
        int least = i;
        for (int j = i + 1; j < n; j++) {
            if (values[j] < values[least]) {
                least = j;
            }
        }

        if (least != i) {
            swap_rows(1, values, i, least);
            swap_rows(n, rows, i, least);
        }
    }
}

// Householder's tridiagonal form, then the QL method with implicit shifts.
bool symmetric_eigen(int n, double *matrix, double *values, double *scratch)
{
    assert(n > 0 && n <= SYMMETRIC_MOST);

    // tridiagonal form, and the rotation that leads there
    double *e = scratch, *norms = scratch + n;
    tridiagonalise(n, matrix, values, e, norms);
    for (int i = 1; i < n; i++) { // e[i] couples i and i + 1 from here on
        e[i - 1] = e[i];
    }
    e[n - 1] = 0;
    double first[SYMMETRIC_MOST];
    accumulate(n, matrix, norms, first);

    // eigenvalue by eigenvalue: sweeps over the block that still couples with it
    for (int l = 0; l < n; l++) {
        for (int shifts = 0;; shifts++) {
            int m = l;
            while (m < n - 1 &&
                   fabs(e[m]) > 1e-16 * (fabs(values[m]) + fabs(values[m + 1]))) {
                m++;
            }
            if (m == l) {
                break;
            }
            if (shifts == MOST_SHIFTS) {
                return false;
            }
            ql_sweep(n, l, m, values, e, matrix);
        }
    }
    sort_rows(n, values, matrix);
    return true;
}

// Cholesky's factor L, the matrix being L L', in its lower half.
bool symmetric_factor(int n, double *matrix)
{
    for (int i = 0; i < n; i++) {
        double *row = matrix + (long)i * n;
        for (int j = 0; j <= i; j++) {
            const double *other = matrix + (long)j * n;
            double sum = row[j];

            // what the columns before have taken already
            for (int k = 0; k < j; k++) {
                sum -= row[k] * other[k];
            }

            // a pivot that is not positive: the matrix is not positive definite
            if (i == j && !(sum > 0)) {
                return false;
            }
            if (i == j) {
                row[j] = sqrt(sum);
            } else {
                row[j] = sum / other[j];
            }
        }
    }
    return true;
}

// Solves L x = b, L being symmetric_factor's.
void symmetric_forward(int n, const double *factor, double *vector)
{
    for (int i = 0; i < n; i++) {
        const double *row = factor + (long)i * n;
        double sum = vector[i];
        for (int k = 0; k < i; k++) {
            sum -= row[k] * vector[k];
        }
        vector[i] = sum / row[i];
    }
}

// Solves L' x = b.
void symmetric_backward(int n, const double *factor, double *vector)
{
    for (int i = n - 1; i >= 0; i--) {
        const double *row = factor + (long)i * n;
        vector[i] /= row[i];
        for (int k = 0; k < i; k++) {
            vector[k] -= row[k] * vector[i];
        }
    }
}

// A x = lambda M x as an ordinary problem, by the Cholesky factor of M.
bool symmetric_eigen_pair(int n, double *matrix, double *mass, double *values,
                          double *scratch)
{
    assert(n > 0);
    const size_t side = (size_t)n;
    if (!symmetric_factor(n, mass)) {
        return false;
    }

    // L^-1 A L^-T with mass = L L': symmetric, so that rows may stand for columns
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < side; i++) {
            symmetric_forward(n, mass, matrix + i * side);
        }
        for (size_t i = 0; i < side; i++) {
            for (size_t j = 0; j < i; j++) {
                double entry = matrix[i * side + j];
                matrix[i * side + j] = matrix[j * side + i];
                matrix[j * side + i] = entry;
            }
        }
    }
    for (size_t i = 0; i < side; i++) {
        for (size_t j = 0; j < i; j++) {
            matrix[i * side + j] = matrix[j * side + i];
        }
    }
    if (!symmetric_eigen(n, matrix, values, scratch)) {
        return false;
    }

    // back to the coordinates of both matrices
    for (size_t k = 0; k < side; k++) {
        symmetric_backward(n, mass, matrix + k * side);
    }
    return true;
}
