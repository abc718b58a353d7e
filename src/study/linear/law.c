// The loop of a control law about the arm's place of rest, from the law's answers to
// pulses.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/rig/rig.h"
#include "src/study/linear/linear.h"

GIVEN_BACK(rig, rig_destroy)

// A pulse in a reading, in the reading's unit, and what a linear law's answers may lack.
#define PULSE      1e-3
#define NOT_LINEAR 1e-7

enum { ANSWERS = 64, MOST_ORDER = 6, MOST_SETTLING = 200000 };

// Periods of further delay of which all poles are found, and halvings of the step that is
// unstable.
enum { MOST_LATE = 32, BISECTIONS = 30 };

#define SETTLING 2.0 // that a law is left at rest, besides its own transition [s]

// The answers h_k to a unit pulse in each reading, and their recurrence: from k = 1 on
// h_k+order = sum of recurrence[i] h_k+i.
typedef struct linear_law {
    double h[LINEAR_READINGS][ANSWERS];
    double recurrence[MOST_ORDER];
    int order;
} linear_law;

// The readings at rest, with a pulse in one.
static controller_input rest_input(const linear_arm *arm, const parameters *p,
                                   int reading, double pulse)
{
    const sensor_parameters *fitted = &p->sensor;
    const double absent = (double)NAN;
    double at[LINEAR_READINGS] = {[READ_ENCODER] = arm->hub_angle,
                                  [READ_FORCE] = arm->force,
                                  [READ_VOLTAGE] = arm->voltage,
                                  [READ_PIEZO] = fitted->piezo ? arm->force : absent,
                                  [READ_FILM] = fitted->film ? arm->bending : absent,
                                  [READ_ACCELEROMETER] =
                                      fitted->accelerometer ? 0 : absent};
    if (reading >= 0) {
        at[reading] += pulse;
    }
    return (controller_input){.encoder = at[READ_ENCODER],
                              .tachometer = at[READ_TACHOMETER],
                              .force = at[READ_FORCE],
                              .voltage = at[READ_VOLTAGE],
                              .piezo_force = at[READ_PIEZO],
                              .film = at[READ_FILM],
                              .accelerometer = at[READ_ACCELEROMETER],
                              .predicted_force = (double)NAN};
}

// The law's commands after a pulse at the end of a time at rest.
static status pulse_response(const linear_arm *arm, const parameters *p, int reading,
                             double pulse, double *commands, fault *f)
{
    SCOPED(rig_destroy_kept) rig *r = NULL;
    TRY(rig_create(&r, p, NULL, f));
    FAULT_IF(r->withheld, f, STATUS_NOT_ALLOWED,
             "the loop of a program or plug-in needs --allow-code");
    const double settling = (p->control.transition_time + SETTLING) * p->control.rate;
    const int before = (int)fmin(settling, MOST_SETTLING);
    for (int k = 0; k < before + ANSWERS; k++) {
        const int pulsed = k == before ? reading : -1;
        controller_input in = rest_input(arm, p, pulsed, pulse);
        controller_output out = {.command = (double)NAN};
        in.time = k * r->period;
        in.wanted_mode = r->lock;
        r->law->sample(r->memory, &in, &out);
        if (k >= before) {
            commands[k - before] = out.command;
        }
    }
    return STATUS_OK;
}

static double largest(const double *numbers, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(numbers[i]));
    }
    return most;
}

// The answers to a pulse in one reading. STATUS_UNSTABLE if they do not scale.
static status learn_reading(linear_law *law, const linear_arm *arm, const parameters *p,
                            int reading, const double *rest, fault *f)
{
    double up[ANSWERS], down[ANSWERS], *h = law->h[reading], even = 0;
    status code = pulse_response(arm, p, reading, PULSE, up, f);
    if (code == STATUS_OK) {
        code = pulse_response(arm, p, reading, -PULSE, down, f);
    }
    for (int k = 0; k < ANSWERS && code == STATUS_OK; k++) {
        h[k] = (up[k] - down[k]) / (2 * PULSE);
        even = fmax(even, fabs(up[k] + down[k] - 2 * rest[k]) / (2 * PULSE));
    }
    if (code == STATUS_OK && !(even <= NOT_LINEAR * fmax(largest(h, ANSWERS), 1))) {
        code = STATUS_UNSTABLE;
    }

    // rounding of the commands is no answer
    const double rounding = 1e-11 * fmax(largest(rest, ANSWERS), 1) / PULSE;
    for (int k = 0; k < ANSWERS; k++) {
        if (fabs(h[k]) < rounding * 1e-2) {
            h[k] = 0;
        }
    }
    return code;
}

// The recurrence of an order by least squares; false if it leaves more than rounding.
static bool fit_recurrence(linear_law *law, int order)
{
    double matrix[MOST_ORDER * MOST_ORDER] = {0}, right[MOST_ORDER] = {0}, most = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < LINEAR_READINGS; j++) {
            const double *h = law->h[j], size = largest(h, ANSWERS), unit = size * size;
            for (int k = 1; k + order < ANSWERS && size > 0; k++) {
                double left = h[k + order];
                for (int i = 0; i < order; i++) {
                    left -= law->recurrence[i] * h[k + i];
                    right[i] += h[k + i] * h[k + order] / unit;
                    for (int m = 0; m < order; m++) {
                        matrix[i * order + m] += h[k + i] * h[k + m] / unit;
                    }
                }
                if (pass == 1) {
                    most = fmax(most, fabs(left) / size);
                }
            }
        }
        if (pass == 0 && order > 0 && !dense_solve(order, matrix, right)) {
            return false;
        }
        if (pass == 0) {
            memcpy(law->recurrence, right, sizeof right);
        }
    }
    law->order = order;
    return most < NOT_LINEAR;
}

static status learn(linear_law *law, const linear_arm *arm, const parameters *p, fault *f)
{
    double rest[ANSWERS], moves = 0;
    status code = pulse_response(arm, p, -1, 0, rest, f);
    for (int k = 1; k < ANSWERS && code == STATUS_OK; k++) {
        moves = fmax(moves, fabs(rest[k] - rest[0]));
    }
    if (code == STATUS_OK && !(moves < 1e-9 * fmax(1, fabs(rest[0])))) {
        code = STATUS_UNSTABLE;
    }
    for (int j = 0; j < LINEAR_READINGS && code == STATUS_OK; j++) {
        code = learn_reading(law, arm, p, j, rest, f);
    }

    // one that answers nothing at all is asleep at rest, or feeds nothing back
    const bool silent = largest(law->h[0], LINEAR_READINGS * ANSWERS) == 0;
    int order = 0;
    while (code == STATUS_OK && order <= MOST_ORDER && !fit_recurrence(law, order)) {
        order++;
    }
    FAULT_IF(code == STATUS_UNSTABLE || order > MOST_ORDER ||
                 (code == STATUS_OK && arm->force > 0 && silent),
             f, STATUS_UNSTABLE,
             "the law '%s' has no linear form where the arm rests: its answers to "
             "small readings do not scale or settle, or there are none",
             control_law_table[p->control.law].word);
    return code;
}

// The loop of a law that was learned and an arm under the delay of p.
static status assemble(linear_system *loop, const linear_law *law, const linear_arm *arm,
                       const parameters *p, fault *f)
{
    SCOPED(linear_system_finish) linear_system plant = {0};
    TRY(linear_sample(&plant, arm, p, f));
    const int n = plant.states, states = n + law->order;
    TRY(linear_system_init(loop, states, 1, f));

    // the law's states are the answers that are still to come
    for (int i = 0; i < n; i++) {
        memcpy(loop->a + i * states, plant.a + i * n, (size_t)n * sizeof *loop->a);
        loop->b[i] = plant.b[i];
        for (int k = 0; k <= law->order; k++) {
            double *to = loop->c;
            if (k > 0) {
                to = loop->a + (n + k - 1) * states;
            }
            for (int j = 0; j < LINEAR_READINGS; j++) {
                to[i] += law->h[j][k] * plant.c[j * n + i];
            }
        }
    }
    for (int k = 0; k < law->order; k++) {
        loop->a[(states - 1) * states + n + k] = law->recurrence[k];
        if (k + 1 < law->order) {
            loop->a[(n + k) * states + n + k + 1] = 1;
        }
    }
    if (law->order > 0) {
        loop->c[n] = 1;
    }
    return STATUS_OK;
}

status linear_loop(linear_system *loop, const linear_arm *arm, const parameters *p,
                   fault *f)
{
    assert(p->control.law != LAW_NONE);
    linear_law law = {.order = 0};
    *loop = (linear_system){0};
    TRY(learn(&law, arm, p, f));
    return assemble(loop, &law, arm, p, f);
}

void linear_close(linear_system *loop)
{
    for (int i = 0; i < loop->states; i++) {
        for (int j = 0; j < loop->states; j++) {
            loop->a[i * loop->states + j] += loop->b[i] * loop->c[j];
        }
    }
}

// The largest pole of the closed loop with a further delay.
static status radius_with(const linear_law *law, const linear_arm *arm,
                          const parameters *p, double delay, double *radius, fault *f)
{
    SCOPED(linear_system_finish) linear_system loop = {0};
    parameters later = *p;
    later.control.delay += delay;
    TRY(assemble(&loop, law, arm, &later, f));
    linear_close(&loop);
    SCOPED(free_kept)
    double complex *poles = calloc((size_t)loop.states + 1, sizeof *poles);
    if (poles == NULL) {
        return fault_no_memory(f);
    }
    TRY(linear_poles(&loop, poles, f));
    *radius = cabs(poles[loop.states - 1]);
    return STATUS_OK;
}

status linear_delay_margin(const linear_arm *arm, const parameters *p, double *delay,
                           fault *f)
{
    const double period = 1 / p->control.rate;
    const double last = fmin(*delay, MOST_LATE * period) + 2 * period;
    double from = 0, to = 0, radius = 0;
    linear_law law = {.order = 0};
    TRY(learn(&law, arm, p, f));

    // steps that grow: a frequency that has gone through all phases is a danger no more
    while (radius < 1 && to < last) {
        from = to;
        to += fmax(period / 8, to / 32);
        TRY(radius_with(&law, arm, p, to, &radius, f));
    }
    if (radius < 1) {
        return STATUS_OK;
    }

    // the step that reaches the circle
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (from + to) / 2;
        TRY(radius_with(&law, arm, p, middle, &radius, f));
        if (radius < 1) {
            from = middle;
        } else {
            to = middle;
        }
    }
    *delay = to;
    return STATUS_OK;
}
