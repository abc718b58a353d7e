// Poles, zeros and answers of linear systems, by LAPACK.
#include <assert.h>
#include <dlfcn.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "src/study/linear/linear.h"

// What is below this share of the terms it is the sum of is rounding.
#define ROUNDING 1e-11

// Eigenvalues of a general matrix, and linear equations. The last two of dgeev are the lengths of
// its texts, as Fortran passes them.
typedef void (*dgeev)(const char *left, const char *right, const int *n, double *a, const int *lda,
                      double *real, double *imaginary, double *vl, const int *ldvl, double *vr,
                      const int *ldvr, double *work, const int *size, int *info, size_t, size_t);
typedef void (*zgesv)(const int *n, const int *columns, double complex *a, const int *lda,
                      int *pivots, double complex *b, const int *ldb, int *info);

static volatile sig_atomic_t loading;
static dgeev eigenvalues_of;
static zgesv solve_complex;

bool linear_is_loading(void)
{
    return loading;
}

// Loads both, once; false without LAPACK.
static bool load(void)
{
    if (solve_complex == NULL) {
        loading = true;
        void *library = dlopen("liblapack.so.3", RTLD_NOW | RTLD_LOCAL);
        void *one = library != NULL ? dlsym(library, "dgeev_") : NULL;
        void *other = one != NULL ? dlsym(library, "zgesv_") : NULL;
        memcpy(&eigenvalues_of, &one, sizeof one);
        memcpy(&solve_complex, &other, sizeof other);
        loading = false;
    }
    return solve_complex != NULL;
}

// Slow before fast, the upper one of a pair first.
static int compare(const void *one, const void *other)
{
    double complex a, b;
    memcpy(&a, one, sizeof a);
    memcpy(&b, other, sizeof b);
    const double alike = 1e-9 * cabs(a), sizes = cabs(a) - cabs(b), parts = creal(a) - creal(b);
    const double by = fabs(sizes) > alike   ? sizes
                      : fabs(parts) > alike ? parts
                                            : cimag(b) - cimag(a);
    return (by > 0) - (by < 0);
}

// Of matrix[n * n], in the order of poles.
static status eigenvalues(int n, const double *matrix, double complex *values, fault *f)
{
    FAIL_IF(!load(), fault_set(f, STATUS_SINGULAR,
                               "poles and zeros need LAPACK, liblapack.so.3, which is not on this "
                               "machine (Debian: apt install liblapack3)"));
    const size_t square = (size_t)n * (size_t)n;
    const int size = 8 * n, one = 1;
    double *work = calloc(square + (size_t)(size + 2 * n) + 1, sizeof *work), unused[1];
    TRY_MEMORY(work != NULL, f);

    // those of the transpose, which Fortran sees, are the same
    double *copy = work + size, *real = copy + square, *imaginary = real + n;
    int info = 0;
    memcpy(copy, matrix, square * sizeof *copy);
    if (n > 0) {
        eigenvalues_of("N", "N", &n, copy, &n, real, imaginary, unused, &one, unused, &one, work,
                       &size, &info, 1, 1);
    }
    for (int i = 0; i < n; i++) {
        values[i] = complex_of(real[i], imaginary[i]);
    }
    free(work);
    qsort(values, (size_t)n, sizeof *values, compare);
    return info == 0
               ? STATUS_OK
               : fault_set(f, STATUS_SINGULAR, "LAPACK found no eigenvalues of the linear arm");
}

status linear_poles(const linear_system *s, double complex *values, fault *f)
{
    return eigenvalues(s->states, s->a, values, f);
}

status linear_zeros(const linear_system *s, int output, int *count, double complex *values,
                    fault *f)
{
    assert(output >= 0 && output < s->outputs);
    const int n = s->states;
    double *row = calloc((size_t)(n * n + 2 * n) + 1, sizeof *row);
    TRY_MEMORY(row != NULL, f);
    double *next = row + n, *matrix = next + n;

    // the output's derivative, row x + direct u, that sees the input first
    double direct = s->d[output];
    int order = 0;
    memcpy(row, s->c + output * n, (size_t)n * sizeof *row);
    for (; direct == 0 && order < n; order++) {
        double terms = 0;
        memset(next, 0, (size_t)n * sizeof *next);
        for (int i = 0; i < n; i++) {
            direct += row[i] * s->b[i];
            terms += fabs(row[i] * s->b[i]);
            for (int j = 0; j < n; j++) {
                next[j] += row[i] * s->a[i * n + j];
            }
        }
        memcpy(row, next, (size_t)n * sizeof *row);
        direct = fabs(direct) > ROUNDING * terms ? direct : 0;
    }

    // the command that keeps it at zero leaves the zeros, and that many poles at the origin
    for (int i = 0; i < n * n && direct != 0; i++) {
        matrix[i] = s->a[i] - s->b[i / n] * row[i % n] / direct;
    }
    *count = direct != 0 ? n - order : 0;
    const status code = eigenvalues(direct != 0 ? n : 0, matrix, values, f);
    memmove(values, values + order, (size_t)*count * sizeof *values);
    free(row);
    return code;
}

double linear_damping(double complex s)
{
    return cabs(s) > 0 ? -creal(s) / cabs(s) : (double)NAN;
}

double complex linear_answer(const linear_system *s, int output, double complex point,
                             double complex *scratch)
{
    const int n = s->states, one = 1;
    double complex *x = scratch + n * n, sum = s->d[output];
    int info = 1;

    // Fortran sees the transpose of point - A, whose x gives C (point - A)^-1 B as x'B
    for (int i = 0; i < n * n; i++) {
        scratch[i] = (i % (n + 1) == 0 ? point : 0) - s->a[i];
    }
    for (int i = 0; i < n; i++) {
        x[i] = s->c[output * n + i];
    }
    if (n > 0 && load()) {
        solve_complex(&n, &one, scratch, &n, (int *)(x + n), x, &n, &info);
    }
    for (int i = 0; i < n; i++) {
        sum += s->b[i] * x[i];
    }
    return n == 0 || info == 0 ? sum : complex_of((double)NAN, 0);
}
