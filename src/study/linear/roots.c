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

// A sum is rounding if its size is below this share of the sum of its terms' sizes.
#define ROUNDING 1e-11

// LAPACK's eigenvalues of a general matrix, and its solution of linear equations. The
// last two arguments of dgeev are the lengths of its texts, as Fortran passes them.
typedef void (*dgeev)(const char *left, const char *right, const int *n, double *a,
                      const int *lda, double *real, double *imaginary, double *vl,
                      const int *ldvl, double *vr, const int *ldvr, double *work,
                      const int *size, int *info, size_t, size_t);
typedef void (*zgesv)(const int *n, const int *columns, double complex *a, const int *lda,
                      int *pivots, double complex *b, const int *ldb, int *info);

static dgeev eigenvalues_of;
static zgesv solve_complex;

// Loads both functions at the first call; false without LAPACK.
static bool load_lapack(void)
{
    if (solve_complex == NULL) {
        void *library = dlopen("liblapack.so.3", RTLD_NOW | RTLD_LOCAL);
        void *dgeev_symbol = NULL, *zgesv_symbol = NULL;
        if (library != NULL) {
            dgeev_symbol = dlsym(library, "dgeev_");
        }
        if (dgeev_symbol != NULL) {
            zgesv_symbol = dlsym(library, "zgesv_");
        }

        // C has no conversion from an object pointer to a function pointer: copy the
        // bytes
        memcpy(&eigenvalues_of, &dgeev_symbol, sizeof dgeev_symbol);
        memcpy(&solve_complex, &zgesv_symbol, sizeof zgesv_symbol);
    }
    return solve_complex != NULL;
}

// Orders poles by size, then by real part; of a conjugate pair the upper one comes first.
// Differences below 1e-9 of the size are rounding and count as none.
static int compare_poles(const void *one, const void *other)
{
    double complex a, b;
    memcpy(&a, one, sizeof a);
    memcpy(&b, other, sizeof b);
    const double rounding = 1e-9 * cabs(a);
    const double size_difference = cabs(a) - cabs(b);
    const double real_difference = creal(a) - creal(b);

    double order = cimag(b) - cimag(a);
    if (fabs(size_difference) > rounding) {
        order = size_difference;
    } else if (fabs(real_difference) > rounding) {
        order = real_difference;
    }
    return (order > 0) - (order < 0);
}

// Eigenvalues of matrix[n * n], in the order of compare_poles.
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

    // Fortran takes the matrix for its transpose, which has the same eigenvalues
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

    // Differentiate the output until the input appears: its derivative of this order is
    //
    //     row x + direct u,    row = C A^order,    direct = C A^(order - 1) B or D
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

    // The input u = -row x/direct keeps the output at zero, with which the states move as
    // x' = (A - B row/direct) x. The eigenvalues of that matrix are `order` zeros of its
    // own making at the origin, which come first, and the zeros of the system.
    *count = 0;
    int size = 0;
    if (direct != 0) {
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                matrix[i * n + j] = s->a[i * n + j] - s->b[i] * row[j] / direct;
            }
        }
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
    double complex *matrix = scratch, *row = scratch + n * n;
    int *pivots = (int *)(row + n);
    int info = 1;

    // Fortran takes the matrix point - A for its transpose: it replaces the row by the
    // solution of row (point - A) = C
    for (int i = 0; i < n * n; i++) {
        const bool diagonal = i % (n + 1) == 0;
        matrix[i] = (diagonal ? point : 0) - s->a[i];
    }
    for (int i = 0; i < n; i++) {
        row[i] = s->c[output * n + i];
    }
    if (n > 0 && load_lapack()) {
        solve_complex(&n, &one, matrix, &n, pivots, row, &n, &info);
    }

    // with which the answer is row B + D
    double complex answer = s->d[output];
    for (int i = 0; i < n; i++) {
        answer += s->b[i] * row[i];
    }
    if (n == 0 || info == 0) {
        return answer;
    }
    return complex_of((double)NAN, 0);
}

// --- answers over frequency ------------------------------------------------------------

enum {
    EVEN_FREQUENCIES = 1500,    // in equal ratios
    RESONANCE_FREQUENCIES = 40, // about each vibration of a loop
    MOST_FREQUENCIES = 20000
};
#define LOOP_RANGE 1e4 // highest frequency of a loop over the lowest one

// Adds frequencies about a pole of a sampled system, z = exp((-decay + i w) period): on
// both sides of w, at distances that grow exponentially and are measured in the decay. A
// real pole gets none. Returns the count with those that were added.
static int add_about_resonance(double complex pole, double period, double high, double *w,
                               int count)
{
    const double size = cabs(pole);
    double resonance = 0, decay = 0; // [rad/s], [1/s]
    if (size > 0) {
        resonance = carg(pole) / period;
        decay = fabs(plain_log(size)) / period;
    }
    if (resonance <= 0) {
        return count;
    }
    const int half = RESONANCE_FREQUENCIES / 2;
    for (int k = -half; k <= half && count < MOST_FREQUENCIES; k++) {
        const double distance =
            fmax(decay, 1e-9 * resonance) * (plain_exp(0.3 * abs(k)) - 1);
        const double frequency = k < 0 ? resonance - distance : resonance + distance;
        if (frequency > 0 && frequency < high) {
            w[count++] = frequency;
        }
    }
    return count;
}

// Chooses the frequencies w [rad/s], rising, at which a system with these poles is looked
// at, and returns how many there are.
static int choose_frequencies(const double complex *poles, int states, double period,
                              double *w)
{
    // a loop up to half its rate; an arm alone from its slowest pole but those at the
    // origin to its fastest one
    double low = M_PI / period / LOOP_RANGE, high = M_PI / period;
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

    for (int i = 0; i < EVEN_FREQUENCIES; i++) {
        const double share = (EVEN_FREQUENCIES - 1 - i) / (EVEN_FREQUENCIES - 1.0);
        w[count++] = high * plain_pow(low / high, share);
    }
    for (int i = 0; i < states && period > 0; i++) {
        count = add_about_resonance(poles[i], period, high, w, count);
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

// Lowers the gain margins for a crossing of the negative real axis at L = -size and the
// frequency w: the gain may grow by 1/size, or fall by that much where size exceeds 1.
static void cross_negative_axis(linear_margins *m, double size, double w)
{
    const double db = 20 * plain_log(1 / size) / plain_log(10);
    if (fabs(db) > MOST_GAIN_DB) {
        return;
    }
    if (db >= 0 && db < m->gain_db) {
        m->gain_at = w;
    }
    double *margin = db >= 0 ? &m->gain_db : &m->gain_down_db;
    *margin = fmin(*margin, fabs(db));
}

// Lowers the phase and delay margins for the crossing of |L| = 1, if there is one,
// between points i and i + 1. The crossing is interpolated in log |L|.
static void cross_unit_circle(linear_margins *m, const linear_response *r, int i)
{
    const double complex gain = r->gain[i], next = r->gain[i + 1];
    const double size = cabs(gain), next_size = cabs(next);
    if (!((size - 1) * (next_size - 1) <= 0 && size != next_size)) {
        return;
    }
    const double share = plain_log(size) / (plain_log(size) - plain_log(next_size));
    const double complex crossing = gain + share * (next - gain);
    const double w = r->frequency[i] + share * (r->frequency[i + 1] - r->frequency[i]);

    // the angle from -1 to the crossing: a delay turns L back by it and reaches -1
    const double angle = plain_atan2(-cimag(crossing), -creal(crossing));
    if (fabs(angle) * 180 / M_PI < m->phase_deg) {
        m->phase_deg = fabs(angle) * 180 / M_PI;
        m->phase_at = w;
    }
    const double turned_back = angle >= 0 ? angle : angle + 2 * M_PI;
    m->delay_s = fmin(m->delay_s, turned_back / w);
}

linear_margins linear_margins_of(const linear_response *r)
{
    linear_margins m = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < r->count; i++) {
        const double complex gain = r->gain[i];
        const bool is_last = i + 1 == r->count;
        m.disk = fmin(m.disk, 2 * cabs(1 + gain) / cabs(1 - gain));

        // at both ends a sampled loop gain is real, up to rounding
        const bool real = fabs(cimag(gain)) < 1e-9 * cabs(gain);
        if ((is_last || i == 0) && real && creal(gain) < 0) {
            cross_negative_axis(&m, -creal(gain), r->frequency[i]);
        }
        if (is_last) {
            break;
        }

        // what is crossed between this point and the next one
        cross_unit_circle(&m, r, i);
        const double complex next = r->gain[i + 1];
        if (cimag(gain) * cimag(next) <= 0 && cimag(gain) != cimag(next)) {
            const double share = cimag(gain) / (cimag(gain) - cimag(next));
            const double crossing = creal(gain) + share * (creal(next) - creal(gain));
            const double step = r->frequency[i + 1] - r->frequency[i];
            if (crossing < 0) {
                cross_negative_axis(&m, -crossing, r->frequency[i] + share * step);
            }
        }
    }
    return m;
}
