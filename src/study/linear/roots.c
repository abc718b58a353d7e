// Poles, zeros and answers of linear systems, by LAPACK; how far a loop gain stays from
// -1.
#include <assert.h>
#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/study/linear/linear.h"

// What is below this share of the terms it is the sum of is rounding.
#define ROUNDING 1e-11

// Eigenvalues of a general matrix, and linear equations. The last two of dgeev are the
// lengths of its texts, as Fortran passes them.
typedef void (*dgeev)(const char *left, const char *right, const int *n, double *a,
                      const int *lda, double *real, double *imaginary, double *vl,
                      const int *ldvl, double *vr, const int *ldvr, double *work,
                      const int *size, int *info, size_t, size_t);
typedef void (*zgesv)(const int *n, const int *columns, double complex *a, const int *lda,
                      int *pivots, double complex *b, const int *ldb, int *info);

static dgeev eigenvalues_of;
static zgesv solve_complex;

// Loads both, once; false without LAPACK.
static bool load_lapack(void)
{
    if (solve_complex == NULL) {
        void *library = dlopen("liblapack.so.3", RTLD_NOW | RTLD_LOCAL);
        void *one = NULL, *other = NULL;
        if (library != NULL) {
            one = dlsym(library, "dgeev_");
        }
        if (one != NULL) {
            other = dlsym(library, "zgesv_");
        }
        memcpy(&eigenvalues_of, &one, sizeof one);
        memcpy(&solve_complex, &other, sizeof other);
    }
    return solve_complex != NULL;
}

// Slow before fast, the upper one of a pair first.
static int compare_poles(const void *one, const void *other)
{
    double complex a, b;
    memcpy(&a, one, sizeof a);
    memcpy(&b, other, sizeof b);
    const double alike = 1e-9 * cabs(a), sizes = cabs(a) - cabs(b),
                 parts = creal(a) - creal(b);
    double by;
    if (fabs(sizes) > alike) {
        by = sizes;
    } else if (fabs(parts) > alike) {
        by = parts;
    } else {
        by = cimag(b) - cimag(a);
    }
    return (by > 0) - (by < 0);
}

// Of matrix[n * n], in the order of poles.
static status eigenvalues(int n, const double *matrix, double complex *values, fault *f)
{
    FAULT_IF(!load_lapack(), f, STATUS_SINGULAR,
             "poles and zeros need LAPACK, liblapack.so.3, which is not on this "
             "machine (Debian: apt install liblapack3)");
    const size_t square = (size_t)n * (size_t)n;
    const int size = 8 * n, one = 1;
    SCOPED(free_kept)
    double *work = calloc(square + (size_t)(size + 2 * n) + 1, sizeof *work);
    double unused[1];
    if (work == NULL) {
        return fault_no_memory(f);
    }

    // those of the transpose, which Fortran sees, are the same
    double *copy = work + size, *real = copy + square, *imaginary = real + n;
    int info = 0;
    memcpy(copy, matrix, square * sizeof *copy);
    if (n > 0) {
        eigenvalues_of("N", "N", &n, copy, &n, real, imaginary, unused, &one, unused,
                       &one, work, &size, &info, 1, 1);
    }
    for (int i = 0; i < n; i++) {
        values[i] = complex_of(real[i], imaginary[i]);
    }
    qsort(values, (size_t)n, sizeof *values, compare_poles);
    if (info != 0) {
        return fault_set(f, STATUS_SINGULAR,
                         "LAPACK found no eigenvalues of the linear arm");
    }
    return STATUS_OK;
}

status linear_poles(const linear_system *s, double complex *values, fault *f)
{
    return eigenvalues(s->states, s->a, values, f);
}

status linear_zeros(const linear_system *s, int output, int *count,
                    double complex *values, fault *f)
{
    assert(output >= 0 && output < s->outputs);
    const int n = s->states;
    SCOPED(free_kept) double *row = calloc((size_t)(n * n + 2 * n) + 1, sizeof *row);
    if (row == NULL) {
        return fault_no_memory(f);
    }
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
        if (!(fabs(direct) > ROUNDING * terms)) {
            direct = 0;
        }
    }

    // the command that keeps it at zero leaves the zeros, and that many poles at the
    // origin
    for (int i = 0; i < n * n && direct != 0; i++) {
        matrix[i] = s->a[i] - s->b[i / n] * row[i % n] / direct;
    }
    *count = 0;
    int size = 0;
    if (direct != 0) {
        *count = n - order;
        size = n;
    }
    const status code = eigenvalues(size, matrix, values, f);
    memmove(values, values + order, (size_t)*count * sizeof *values);
    return code;
}

double linear_damping(double complex s)
{
    if (cabs(s) > 0) {
        return -creal(s) / cabs(s);
    }
    return (double)NAN;
}

double complex linear_answer(const linear_system *s, int output, double complex point,
                             double complex *scratch)
{
    const int n = s->states, one = 1;
    double complex *x = scratch + n * n, sum = s->d[output];
    int info = 1;

    // Fortran sees the transpose of point - A, whose x gives C (point - A)^-1 B as x'B
    for (int i = 0; i < n * n; i++) {
        const bool diagonal = i % (n + 1) == 0;
        scratch[i] = (diagonal ? point : 0) - s->a[i];
    }
    for (int i = 0; i < n; i++) {
        x[i] = s->c[output * n + i];
    }
    if (n > 0 && load_lapack()) {
        solve_complex(&n, &one, scratch, &n, (int *)(x + n), x, &n, &info);
    }
    for (int i = 0; i < n; i++) {
        sum += s->b[i] * x[i];
    }
    if (n == 0 || info == 0) {
        return sum;
    }
    return complex_of((double)NAN, 0);
}

// --- answers over frequency ------------------------------------------------------------

// Frequencies: so many in equal ratios, of a loop over so many decades below half its
// rate, and so many about each vibration, out to where it no longer shows.
enum { EVEN = 1500, ABOUT = 40, MOST_FREQUENCIES = 20000 };
#define DECADES 1e4

// Puts frequencies for a system with the given poles in order; returns how many.
static int choose_frequencies(const double complex *poles, int states, double period,
                              double *w)
{
    double low = M_PI / period / DECADES, high = M_PI / period;
    int count = 0;
    if (period == 0) {
        low = high = 1;
        for (int i = states - 1; i >= 0; i--) { // the fastest first
            if (cabs(poles[i]) > 1e-6) {
                low = cabs(poles[i]);
            }
        }
        if (states > 0) {
            high = fmax(high, cabs(poles[states - 1]));
        }
        high *= 10;
        low *= 0.01;
    }
    for (int i = 0; i < EVEN; i++) {
        w[count++] = high * plain_pow(low / high, (EVEN - 1 - i) / (EVEN - 1.0));
    }
    for (int i = 0; i < states && period > 0; i++) {
        const double size = cabs(poles[i]);
        double at = 0, width = 0; // of the vibration [rad/s]
        if (size > 0) {
            at = carg(poles[i]) / period;
            width = fabs(plain_log(size)) / period;
        }
        for (int k = -ABOUT / 2; k <= ABOUT / 2 && at > 0 && count < MOST_FREQUENCIES;
             k++) {
            const double off = fmax(width, 1e-9 * at) * (plain_exp(0.3 * abs(k)) - 1);
            const double near = k < 0 ? at - off : at + off;
            if (near > 0 && near < high) {
                w[count++] = near;
            }
        }
    }
    qsort(w, (size_t)count, sizeof *w, compare_numbers);
    return count;
}

status linear_respond(const linear_system *s, int output, double period,
                      linear_response *r, fault *f)
{
    assert(period >= 0);
    const size_t n = (size_t)s->states;
    *r = (linear_response){0};
    double *block = calloc(3 * MOST_FREQUENCIES, sizeof *block);
    SCOPED(free_kept) double complex *scratch = calloc(n * (n + 2) + 1, sizeof *scratch);
    status code;
    if (block != NULL && scratch != NULL) {
        code = linear_poles(s, scratch, f);
    } else {
        code = fault_no_memory(f);
    }
    if (code != STATUS_OK) {
        free(block);
        return code;
    }
    *r = (linear_response){choose_frequencies(scratch, s->states, period, block), block,
                           (double complex *)(block + MOST_FREQUENCIES)};
    for (int i = 0; i < r->count; i++) {
        double sine, cosine;
        inline_sincos(r->frequency[i] * period, &sine, &cosine);
        if (period > 0) {
            r->gain[i] = -linear_answer(s, output, complex_of(cosine, sine), scratch);
        } else {
            r->gain[i] = linear_answer(s, output, complex_of(0, block[i]), scratch);
        }
    }
    return STATUS_OK;
}

// --- margins ---------------------------------------------------------------------------

#define MOST_GAIN_DB 120.0 // no law is off by a factor of a million; beyond is rounding

// Takes in a place at which the loop gain is real and negative.
static void cross_phase(linear_margins *m, double gain)
{
    const double db = 20 * plain_log(1 / gain) / plain_log(10);
    if (fabs(db) > MOST_GAIN_DB) {
        return;
    }
    double *least = db >= 0 ? &m->gain_db : &m->gain_down_db;
    *least = fmin(*least, fabs(db));
}

linear_margins linear_margins_of(const linear_response *r)
{
    linear_margins m = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < r->count; i++) {
        const double complex here = r->gain[i];
        m.disk = fmin(m.disk, 2 * cabs(1 + here) / cabs(1 - here));

        // at both ends a sampled loop gain is real, up to rounding
        const bool real = fabs(cimag(here)) < 1e-9 * cabs(here);
        if ((i + 1 == r->count || i == 0) && real && creal(here) < 0) {
            cross_phase(&m, -creal(here));
        }
        if (i + 1 == r->count) {
            break;
        }

        const double complex next = r->gain[i + 1];
        const double size = cabs(here), then = cabs(next);
        if ((size - 1) * (then - 1) <= 0 && size != then) {
            const double share = plain_log(size) / (plain_log(size) - plain_log(then));
            const double complex one = here + share * (next - here);
            const double w =
                r->frequency[i] + share * (r->frequency[i + 1] - r->frequency[i]);
            const double left =
                plain_atan2(-cimag(one), -creal(one)); // beyond -180 degrees
            m.phase_deg = fmin(m.phase_deg, fabs(left) * 180 / M_PI);
            const double turn = left >= 0 ? left : left + 2 * M_PI;
            m.delay_s = fmin(m.delay_s, turn / w);
        }
        if (cimag(here) * cimag(next) <= 0 && cimag(here) != cimag(next)) {
            const double share = cimag(here) / (cimag(here) - cimag(next));
            const double at = creal(here) + share * (creal(next) - creal(here));
            if (at < 0) {
                cross_phase(&m, -at);
            }
        }
    }
    return m;
}
