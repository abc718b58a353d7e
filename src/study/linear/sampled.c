// The linear arm between samples.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/rig/sensors.h"
#include "src/study/linear/linear.h"

enum { MOST_LAGS = 6 };

// The arm, and behind its states the lags of sensors, value' = (input - value)/time.
typedef struct lagged_arm {
    const linear_system *arm;
    int states;           // in use
    linear_system system; // of all readings
} lagged_arm;

// Adds `share` times an output of the arm, behind a lag [s] if there is one, to a reading.
static void see(lagged_arm *l, int reading, int output, double share, double time)
{
    const int n = l->arm->states, edge = l->system.states;
    const double *c = l->arm->c + output * n, d = l->arm->d[output];
    double *row = l->system.c + reading * edge, *direct = &l->system.d[reading], scale = share;
    if (time > 0) {
        row[l->states] += share;
        row = l->system.a + l->states * edge;
        row[l->states] = -1 / time;
        direct = &l->system.b[l->states++];
        scale = 1 / time;
    }
    for (int j = 0; j < n; j++) {
        row[j] += scale * c[j];
    }
    *direct += scale * d;
}

// Rise and leak of the piezoelectric sensor, as the difference of two lags (sensors.c).
static void see_piezo(lagged_arm *l, int reading, const sensors *s)
{
    const double rise = s->piezo_rise.time_constant, leak = s->piezo_leak.time_constant;
    const double share = leak > 0 ? leak / (leak - rise) : 1;
    see(l, reading, LINEAR_FORCE, share, rise);
    if (leak > 0) {
        see(l, reading, LINEAR_FORCE, -share, leak);
    }
}

static void see_all(lagged_arm *l, const parameters *p)
{
    const int n = l->arm->states;
    sensors s;
    sensors_init(&s, &p->sensor, p->control.seed);
    for (int i = 0; i < n; i++) {
        memcpy(l->system.a + i * l->system.states, l->arm->a + i * n, (size_t)n * sizeof(double));
        l->system.b[i] = l->arm->b[i];
    }
    see(l, READ_ENCODER, LINEAR_HUB_ANGLE, 1, 0);
    see(l, READ_TACHOMETER, LINEAR_HUB_VELOCITY, 1, 0);
    l->system.d[READ_VOLTAGE] = 1;
    if (p->sensor.force == FORCE_BY_PIEZO) {
        see_piezo(l, READ_FORCE, &s);
    } else {
        see(l, READ_FORCE, LINEAR_FORCE, 1, s.fsr.time_constant);
    }
    if (p->sensor.piezo) {
        see_piezo(l, READ_PIEZO, &s);
    }
    if (p->sensor.film) {
        see(l, READ_FILM, LINEAR_BENDING, 1, 0);
        if (s.film_leak.time_constant > 0) {
            see(l, READ_FILM, LINEAR_BENDING, -1, s.film_leak.time_constant);
        }
    }
    if (p->sensor.accelerometer) {
        see(l, READ_ACCELEROMETER, LINEAR_HUB_ACCELERATION, 1, s.acceleration.time_constant);
    }
}

// Fills in the sampled system of n states and `held` commands on their way, u_k-held first. From
// exp((A, B; 0, 0) h) = (exp(A h), integral of exp(A t) B; 0, 1): over `late` the older command,
// then the newer one.
static status fill(linear_system *out, const linear_system *s, int n, int held, double period,
                   double late, fault *f)
{
    const int size = n + 1, states = out->states;
    const size_t square = (size_t)size * (size_t)size;
    double *both = calloc(5 * square, sizeof *both);
    TRY_MEMORY(both != NULL, f);
    double *before = both + square, *after = before + square, *power = after + square,
           *product = power + square;
    for (int i = 0; i < n; i++) {
        memcpy(both + i * size, s->a + i * s->states, (size_t)n * sizeof *both);
        both[i * size + n] = s->b[i];
    }
    matrix_exponential(both, size, late, before, power, product);
    matrix_exponential(both, size, period - late, after, power, product);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= n; j++) {
            for (int k = 0; k < n; k++) {
                out->a[i * states + j] += after[i * size + k] * before[k * size + j];
            }
        }
        *(held > 1 ? &out->a[i * states + n + 1] : &out->b[i]) = after[i * size + n];
    }
    free(both);

    // commands move up; what is read sees the oldest
    for (int i = 0; i + 1 < held; i++) {
        out->a[(n + i) * states + n + i + 1] = 1;
    }
    out->b[states - 1] = 1;
    for (int i = 0; i < LINEAR_READINGS; i++) {
        memcpy(out->c + i * states, s->c + i * s->states, (size_t)n * sizeof *out->c);
        out->c[i * states + n] = s->d[i];
    }
    return STATUS_OK;
}

status linear_sample(linear_system *sampled, const linear_arm *arm, const parameters *p, fault *f)
{
    assert(p->control.rate > 0);
    lagged_arm l = {.arm = &arm->system, .states = arm->system.states};
    *sampled = (linear_system){0};
    TRY(linear_system_init(&l.system, l.states + MOST_LAGS, LINEAR_READINGS, f));
    see_all(&l, p);

    // the delay: whole periods, and the rest, in which the command before is still in effect; a
    // reading at a sample sees the command before the one that comes with it
    const double period = 1 / p->control.rate,
                 delay = p->control.delay / period + p->control.delay_periods;
    const double whole = floor(delay + 1e-12), part = fmax(0, delay - whole);
    const int held = (int)whole + 1;
    status code = linear_system_init(sampled, l.states + held, LINEAR_READINGS, f);
    code = code == STATUS_OK ? fill(sampled, &l.system, l.states, held, period, part * period, f)
                             : code;
    linear_system_finish(&l.system);
    if (code != STATUS_OK) {
        linear_system_finish(sampled);
    }
    return code;
}
