// The linear arm between samples.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/predict/exponential.h"
#include "src/rig/sensors.h"
#include "src/study/linear/linear.h"

enum { MOST_LAGS = 5 };

// A sensor's lag: value' = (input - value)/time.
typedef struct lag {
    int output; // of the arm that it follows
    double time;
} lag;

// The arm, and behind its states the sensors' lags.
typedef struct lagged_arm {
    const linear_system *arm;
    int count;
    lag lags[MOST_LAGS];
    linear_system system; // of all readings
} lagged_arm;

// Adds `share` times an output of the arm to a reading.
static void see(lagged_arm *l, int reading, int output, double share)
{
    const int n = l->arm->states;
    for (int j = 0; j < n; j++) {
        l->system.c[reading * l->system.states + j] += share * l->arm->c[output * n + j];
    }
    l->system.d[reading] += share * l->arm->d[output];
}

// Adds `share` times an output behind a lag; one without a lag is seen at once.
static void see_late(lagged_arm *l, int reading, int output, double share, double time)
{
    if (time > 0) {
        const int n = l->arm->states;
        l->system.c[reading * l->system.states + n + l->count] += share;
        l->lags[l->count++] = (lag){output, time};
    } else {
        see(l, reading, output, share);
    }
}

// Rise and leak of the piezoelectric sensor, as the difference of two lags (sensors.c).
static void see_piezo(lagged_arm *l, int reading, const sensors *s)
{
    const double rise = s->piezo_rise.time_constant, leak = s->piezo_leak.time_constant;
    const double share = leak > 0 ? leak / (leak - rise) : 1;
    see_late(l, reading, LINEAR_FORCE, share, rise);
    if (leak > 0) {
        see_late(l, reading, LINEAR_FORCE, -share, leak);
    }
}

static void see_all(lagged_arm *l, const parameters *p)
{
    sensors s;
    sensors_init(&s, &p->sensor, p->control.seed);
    see(l, LINEAR_READ_ENCODER, LINEAR_HUB_ANGLE, 1);
    see(l, LINEAR_READ_TACHOMETER, LINEAR_HUB_VELOCITY, 1);
    if (p->sensor.force == FORCE_BY_PIEZO) {
        see_piezo(l, LINEAR_READ_FORCE, &s);
    } else {
        see_late(l, LINEAR_READ_FORCE, LINEAR_FORCE, 1, s.fsr.time_constant);
    }
    l->system.d[LINEAR_READ_VOLTAGE] = 1;
    if (p->sensor.piezo) {
        see_piezo(l, LINEAR_READ_PIEZO, &s);
    }
    if (p->sensor.film) {
        see(l, LINEAR_READ_FILM, LINEAR_BENDING, 1);
        if (s.film_leak.time_constant > 0) {
            see_late(l, LINEAR_READ_FILM, LINEAR_BENDING, -1, s.film_leak.time_constant);
        }
    }
    if (p->sensor.accelerometer) {
        see_late(l, LINEAR_READ_ACCELEROMETER, LINEAR_HUB_ACCELERATION, 1,
                 s.acceleration.time_constant);
    }

    // the equations of arm and lags
    const int n = l->arm->states, states = l->system.states;
    for (int i = 0; i < n; i++) {
        memcpy(l->system.a + i * states, l->arm->a + i * n, (size_t)n * sizeof(double));
        l->system.b[i] = l->arm->b[i];
    }
    for (int i = 0; i < l->count; i++) {
        double *row = l->system.a + (n + i) * states;
        const lag *of = &l->lags[i];
        for (int j = 0; j < n; j++) {
            row[j] = l->arm->c[of->output * n + j] / of->time;
        }
        row[n + i] = -1 / of->time;
        l->system.b[n + i] = l->arm->d[of->output] / of->time;
    }
}

// exp(A h) and the integral of exp(A t) B over h, as the exponential of (A, B; 0, 0).
static status follow(const linear_system *s, int n, double h, double *propagator, double *gained)
{
    const int size = n + 1;
    const size_t square = (size_t)size * (size_t)size;
    double *block = calloc(4 * square, sizeof *block);
    if (block == NULL) {
        return STATUS_NO_MEMORY;
    }
    double *both = block + square;
    for (int i = 0; i < n; i++) {
        memcpy(block + i * size, s->a + i * s->states, (size_t)n * sizeof *block);
        block[i * size + n] = s->b[i];
    }
    matrix_exponential(block, size, h, both, both + square, both + 2 * square);
    for (int i = 0; i < n; i++) {
        memcpy(propagator + i * n, both + i * size, (size_t)n * sizeof *both);
        gained[i] = both[i * size + n];
    }
    free(block);
    return STATUS_OK;
}

// Fills in the sampled system of n states and `held` commands on their way: u_k-held first.
static status fill(linear_system *out, const linear_system *s, int n, int held, double period,
                   double late)
{
    const size_t square = (size_t)n * (size_t)n;
    double *block = calloc(2 * square + 2 * (size_t)n + 1, sizeof *block);
    if (block == NULL) {
        return STATUS_NO_MEMORY;
    }
    double *rest = block + square, *older = rest + square, *newer = older + n;
    status code = follow(s, n, late, block, older);
    code = code == STATUS_OK ? follow(s, n, period - late, rest, newer) : code;

    // over `late` the older command, then the newer one
    const int states = out->states;
    for (int i = 0; i < n && code == STATUS_OK; i++) {
        double from_older = 0;
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) {
                sum += rest[i * n + k] * block[k * n + j];
            }
            out->a[i * states + j] = sum;
            from_older += rest[i * n + j] * older[j];
        }
        if (held > 0) {
            out->a[i * states + n] = from_older;
        }
        *(held > 1 ? &out->a[i * states + n + 1] : &out->b[i]) = newer[i];
    }
    free(block);

    // commands move up; what is read sees the oldest
    for (int i = 0; i + 1 < held; i++) {
        out->a[(n + i) * states + n + i + 1] = 1;
    }
    if (held > 0) {
        out->b[states - 1] = 1;
    }
    for (int i = 0; i < LINEAR_READINGS; i++) {
        memcpy(out->c + i * states, s->c + i * s->states, (size_t)n * sizeof *out->c);
        if (held > 0) {
            out->c[i * states + n] = s->d[i];
        }
    }
    return code;
}

status linear_sample(linear_system *sampled, const linear_arm *arm, const parameters *p, fault *f)
{
    assert(sampled != NULL && arm != NULL && p != NULL && p->control.rate > 0);
    lagged_arm l = {.arm = &arm->system};
    *sampled = (linear_system){0};
    status code = linear_system_init(&l.system, arm->system.states + MOST_LAGS, LINEAR_READINGS, f);
    if (code != STATUS_OK) {
        return code;
    }
    see_all(&l, p);

    // the delay: whole periods, and the rest, in which the command before is still in effect; a
    // reading at a sample sees the command before the one that comes with it
    const double period = 1 / p->control.rate,
                 delay = p->control.delay / period + p->control.delay_periods;
    const double whole = floor(delay + 1e-12), part = fmax(0, delay - whole);
    const int held = (int)whole + 1;
    const int n = arm->system.states + l.count;
    code = linear_system_init(sampled, n + held, LINEAR_READINGS, f);
    if (code == STATUS_OK &&
        fill(sampled, &l.system, n, held, period, part * period) != STATUS_OK) {
        code = fault_no_memory(f);
    }
    linear_system_finish(&l.system);
    return code;
}

// --- answers to sines -------------------------------------------------------------------------

double complex linear_answer(const linear_system *s, int output, double complex point,
                             double complex *scratch)
{
    // (point - A, B), by elimination with the largest pivots
    const int n = s->states, columns = n + 1;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            scratch[i * columns + j] = (i == j ? point : 0) - s->a[i * n + j];
        }
        scratch[i * columns + n] = s->b[i];
    }
    for (int i = 0; i < n; i++) {
        int best = i;
        for (int k = i + 1; k < n; k++) {
            best = cabs(scratch[k * columns + i]) > cabs(scratch[best * columns + i]) ? k : best;
        }
        for (int j = i; j < columns; j++) {
            const double complex kept = scratch[i * columns + j];
            scratch[i * columns + j] = scratch[best * columns + j];
            scratch[best * columns + j] = kept;
        }
        for (int k = i + 1; k < n; k++) {
            const double complex share = scratch[k * columns + i] / scratch[i * columns + i];
            for (int j = i; j < columns && share != 0; j++) {
                scratch[k * columns + j] -= share * scratch[i * columns + j];
            }
        }
    }

    // back from the last, and what the output sees of it
    double complex sum = s->d[output];
    for (int i = n - 1; i >= 0; i--) {
        double complex x = scratch[i * columns + n];
        for (int j = i + 1; j < n; j++) {
            x -= scratch[i * columns + j] * scratch[j * columns + n];
        }
        scratch[i * columns + n] = x / scratch[i * columns + i];
        sum += s->c[output * n + i] * scratch[i * columns + n];
    }
    return sum;
}
