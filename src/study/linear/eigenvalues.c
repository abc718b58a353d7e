// Poles and zeros, by LAPACK's eigenvalues of general matrices.
#include <assert.h>
#include <dlfcn.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "src/study/linear/linear.h"

// A direct path from the input that is below this share of what it does elsewhere is rounding.
#define ROUNDING 1e-11

// dgeev of LAPACK: the last two are the lengths of its texts, as Fortran passes them.
typedef void (*eigenvalue_routine)(const char *left, const char *right, const int *n, double *a,
                                   const int *lda, double *real, double *imaginary, double *vl,
                                   const int *ldvl, double *vr, const int *ldvr, double *work,
                                   const int *size, int *info, size_t, size_t);

static volatile sig_atomic_t loading;

bool linear_is_loading(void)
{
    return loading;
}

// Loads the routine, once; NULL without LAPACK.
static eigenvalue_routine find_routine(void)
{
    static eigenvalue_routine found;
    if (found == NULL) {
        loading = true;
        void *library = dlopen("liblapack.so.3", RTLD_NOW | RTLD_LOCAL);
        void *symbol = library != NULL ? dlsym(library, "dgeev_") : NULL;
        memcpy(&found, &symbol, sizeof found);
        loading = false;
    }
    return found;
}

// Slow before fast, the upper one of a pair first.
static int compare(const void *one, const void *other)
{
    double complex a, b;
    memcpy(&a, one, sizeof a);
    memcpy(&b, other, sizeof b);
    const double sizes = cabs(a) - cabs(b);
    if (fabs(sizes) > 1e-9 * cabs(a)) {
        return sizes < 0 ? -1 : 1;
    }
    return creal(a) != creal(b) && fabs(creal(a) - creal(b)) > 1e-9 * cabs(a)
               ? (creal(a) < creal(b) ? -1 : 1)
           : cimag(a) > cimag(b) ? -1
                                 : cimag(a) < cimag(b);
}

status linear_eigenvalues(int n, double *matrix, double complex *values, fault *f)
{
    assert(n >= 0 && matrix != NULL && values != NULL);
    const eigenvalue_routine dgeev = find_routine();
    if (dgeev == NULL) {
        return fault_set(f, STATUS_SINGULAR,
                         "poles and zeros need LAPACK, liblapack.so.3, which is not on this "
                         "machine (Debian: apt install liblapack3)");
    }
    if (n == 0) {
        return STATUS_OK;
    }

    // eigenvalues of the transpose, which Fortran sees, are the same
    const int size = 8 * n, one = 1;
    double *work = calloc((size_t)(size + 2 * n), sizeof *work), unused[1];
    if (work == NULL) {
        return fault_no_memory(f);
    }
    double *real = work + size, *imaginary = real + n;
    int info = 0;
    dgeev("N", "N", &n, matrix, &n, real, imaginary, unused, &one, unused, &one, work, &size, &info,
          1, 1);
    for (int i = 0; i < n; i++) {
        values[i] = complex_of(real[i], imaginary[i]);
    }
    free(work);
    if (info != 0) {
        return fault_set(f, STATUS_SINGULAR, "LAPACK found no eigenvalues of the linear arm");
    }
    qsort(values, (size_t)n, sizeof *values, compare);
    return STATUS_OK;
}

status linear_poles(const linear_system *s, double complex *values, fault *f)
{
    const size_t size = (size_t)s->states * (size_t)s->states;
    double *matrix = malloc((size + 1) * sizeof *matrix);
    if (matrix == NULL) {
        return fault_no_memory(f);
    }
    memcpy(matrix, s->a, size * sizeof *matrix);
    const status code = linear_eigenvalues(s->states, matrix, values, f);
    free(matrix);
    return code;
}

// --- zeros ------------------------------------------------------------------------------------

// Turns the first n states by Householder's reflection so that the output c sees the last of them
// alone: A, b and c change, rows of A lie `stride` apart.
static void turn_output(int n, int stride, double *a, double *b, double *c, double *v)
{
    // v along c - |c| e_n
    double norm = 0, square = 0;
    for (int i = 0; i < n; i++) {
        norm += c[i] * c[i];
    }
    norm = copysign(sqrt(norm), -c[n - 1]);
    for (int i = 0; i < n; i++) {
        v[i] = c[i] - (i == n - 1 ? norm : 0);
        square += v[i] * v[i];
    }

    // (1 - 2 v v'/v'v) from the left on A and b, from the right on A
    double along = 0;
    for (int i = 0; i < n; i++) {
        along += v[i] * b[i];
        c[i] = i == n - 1 ? norm : 0;
    }
    for (int i = 0; i < n; i++) {
        b[i] -= 2 * along / square * v[i];
    }
    for (int side = 0; side < 2; side++) {
        const int step = side == 0 ? stride : 1, other = side == 0 ? 1 : stride;
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += v[i] * a[i * step + j * other];
            }
            for (int i = 0; i < n; i++) {
                a[i * step + j * other] -= 2 * sum / square * v[i];
            }
        }
    }
}

// The largest size in a row of numbers.
static double largest(const double *numbers, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(numbers[i]));
    }
    return most;
}

// Measures states in units in which rows and columns of A are alike (Osborne, Journal of the ACM 7
// (1960)): angles and rates, which differ by a frequency, then compare.
static void balance(int n, double *a, double *b, double *c)
{
    enum { ROUNDS = 20 };
    for (int i = 0; i < n * ROUNDS; i++) {
        const int k = i % n;
        double row = 0, column = 0;
        for (int j = 0; j < n; j++) {
            row += j == k ? 0 : fabs(a[k * n + j]);
            column += j == k ? 0 : fabs(a[j * n + k]);
        }
        const double unit = row > 0 && column > 0 ? sqrt(row / column) : 1;
        for (int j = 0; j < n; j++) {
            a[k * n + j] /= unit;
            a[j * n + k] *= unit;
        }
        b[k] /= unit;
        c[k] *= unit;
    }
}

// y = c x = 0 without a direct path holds the one state that c sees at zero, and its equation is
// the next output: so on until the input is met (Emami-Naeini, Van Dooren, Automatica 18 (1982)).
// Then the zeros are the eigenvalues of A - b c/d.
static status reduce(int n, double *a, double *b, double *c, double d, int *count,
                     double complex *values, double *v, fault *f)
{
    const int stride = n;
    balance(n, a, b, c);
    d = fabs(d) * largest(a, n * n) > ROUNDING * largest(b, n) * largest(c, n) ? d : 0;
    while (d == 0) {
        if (n == 0 || largest(c, n) == 0) {
            *count = 0;
            return STATUS_OK;
        }
        turn_output(n, stride, a, b, c, v);
        n--;
        memcpy(c, a + n * stride, (size_t)n * sizeof *c);
        d = fabs(b[n]) > ROUNDING * largest(b, n + 1) ? b[n] : 0;
    }

    // packed
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            v[i * n + j] = a[i * stride + j] - b[i] * c[j] / d;
        }
    }
    *count = n;
    return linear_eigenvalues(n, v, values, f);
}

status linear_zeros(const linear_system *s, int output, int *count, double complex *values,
                    fault *f)
{
    assert(s != NULL && output >= 0 && output < s->outputs && count != NULL);
    const size_t n = (size_t)s->states, square = n * n;
    double *block = malloc((2 * square + 3 * n + 1) * sizeof *block);
    if (block == NULL) {
        return fault_no_memory(f);
    }
    double *a = block, *b = a + square, *c = b + n, *v = c + n;
    memcpy(a, s->a, square * sizeof *a);
    memcpy(b, s->b, n * sizeof *b);
    memcpy(c, s->c + (size_t)output * n, n * sizeof *c);
    const status code = reduce(s->states, a, b, c, s->d[output], count, values, v, f);
    free(block);
    return code;
}

double linear_damping(double complex s)
{
    return cabs(s) > 0 ? -creal(s) / cabs(s) : (double)NAN;
}
