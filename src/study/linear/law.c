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

#define PULSE      1e-3 // of a reading, in the reading's unit
#define NOT_LINEAR 1e-7 // relative error above which a law is not linear
#define SETTLING   2.0  // time at rest before a pulse, besides the law's transition [s]

enum {
    ANSWERS = 64,           // commands that are kept after a pulse
    MOST_ORDER = 6,         // of a law's recurrence
    MOST_SETTLING = 200000, // samples at rest before a pulse
    MOST_LATE = 32,         // largest further delay that is tried, in periods
    BISECTIONS = 30         // of the delay at which the loop turns unstable
};

// The answers h_k to a unit pulse in each reading, and their recurrence: from k = 1 on
// h_k+order = sum of recurrence[i] h_k+i.
typedef struct linear_law {
    double h[LINEAR_READINGS][ANSWERS];
    double recurrence[MOST_ORDER];
    int order;
} linear_law;

// The readings at rest, with a pulse added to one of them (-1: to none). A sensor that is
// not fitted reads NaN.
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

// The law's commands from a pulse in one reading on (-1: no pulse). The law is first
// given the readings at rest until it has settled.
static status pulse_response(const linear_arm *arm, const parameters *p, int reading,
                             double pulse, double *commands, fault *f)
{
    SCOPED(rig_destroy_kept) rig *r = NULL;
    TRY(rig_create(&r, p, NULL, f));
    FAULT_IF(r->withheld, f, STATUS_NOT_ALLOWED,
             "the loop of a program or plug-in needs --allow-code");

    const double settling = (p->control.transition_time + SETTLING) * p->control.rate;
    const int pulse_sample = (int)fmin(settling, MOST_SETTLING);
    for (int k = 0; k < pulse_sample + ANSWERS; k++) {
        const int pulsed_reading = k == pulse_sample ? reading : -1;
        controller_input in = rest_input(arm, p, pulsed_reading, pulse);
        controller_output out = {.command = (double)NAN};
        in.time = k * r->period;
        in.wanted_mode = r->lock;
        r->law->sample(r->memory, &in, &out);
        if (k >= pulse_sample) {
            commands[k - pulse_sample] = out.command;
        }
    }
    return STATUS_OK;
}

static double largest_magnitude(const double *numbers, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(numbers[i]));
    }
    return most;
}

// Finds the law's answers h to a unit pulse in one reading, from its commands after
// pulses up and down: half their difference. Half their sum is what they have in common;
// it has to be the command at rest, else the answers do not scale with the pulse:
// STATUS_UNSTABLE.
static status learn_reading(linear_law *law, const linear_arm *arm, const parameters *p,
                            int reading, const double *rest, fault *f)
{
    double up[ANSWERS], down[ANSWERS], *h = law->h[reading], nonlinear = 0;
    status code = pulse_response(arm, p, reading, PULSE, up, f);
    if (code == STATUS_OK) {
        code = pulse_response(arm, p, reading, -PULSE, down, f);
    }
    for (int k = 0; k < ANSWERS && code == STATUS_OK; k++) {
        h[k] = (up[k] - down[k]) / (2 * PULSE);
        nonlinear = fmax(nonlinear, fabs(up[k] + down[k] - 2 * rest[k]) / (2 * PULSE));
    }
    const double answer_size = fmax(largest_magnitude(h, ANSWERS), 1);
    if (code == STATUS_OK && !(nonlinear <= NOT_LINEAR * answer_size)) {
        code = STATUS_UNSTABLE;
    }

    // the rounding of commands is no answer
    const double rounding = 1e-11 * fmax(largest_magnitude(rest, ANSWERS), 1) / PULSE;
    for (int k = 0; k < ANSWERS; k++) {
        if (fabs(h[k]) < rounding * 1e-2) {
            h[k] = 0;
        }
    }
    return code;
}

// The largest error of the law's recurrence over all readings, relative to the size of
// the answers to the reading.
static double recurrence_error(const linear_law *law, int order)
{
    double most = 0;
    for (int j = 0; j < LINEAR_READINGS; j++) {
        const double *h = law->h[j], size = largest_magnitude(h, ANSWERS);
        for (int k = 1; k + order < ANSWERS && size > 0; k++) {
            double error = h[k + order];
            for (int i = 0; i < order; i++) {
                error -= law->recurrence[i] * h[k + i];
            }
            most = fmax(most, fabs(error) / size);
        }
    }
    return most;
}

// Fits the recurrence of an order to the answers to all readings by least squares, from
// the normal equations; false if it leaves more than rounding.
static bool fit_recurrence(linear_law *law, int order)
{
    // each reading's answers weigh alike, in units of the largest of them
    double matrix[MOST_ORDER * MOST_ORDER] = {0}, right_side[MOST_ORDER] = {0};
    for (int j = 0; j < LINEAR_READINGS; j++) {
        const double *h = law->h[j], size = largest_magnitude(h, ANSWERS);
        const double unit = size * size;
        for (int k = 1; k + order < ANSWERS && size > 0; k++) {
            for (int i = 0; i < order; i++) {
                right_side[i] += h[k + i] * h[k + order] / unit;
                for (int m = 0; m < order; m++) {
                    matrix[i * order + m] += h[k + i] * h[k + m] / unit;
                }
            }
        }
    }
    if (order > 0 && !dense_solve(order, matrix, right_side)) {
        return false;
    }

    memcpy(law->recurrence, right_side, sizeof right_side);
    law->order = order;
    return recurrence_error(law, order) < NOT_LINEAR;
}

// Finds the law's answers to a pulse in each reading and the recurrence of least order
// that they all obey. STATUS_UNSTABLE, with a sentence in f, if there is no such form.
static status learn(linear_law *law, const linear_arm *arm, const parameters *p, fault *f)
{
    // a law whose command moves without a pulse has not settled
    double rest[ANSWERS], drift = 0;
    status code = pulse_response(arm, p, -1, 0, rest, f);
    for (int k = 1; k < ANSWERS && code == STATUS_OK; k++) {
        drift = fmax(drift, fabs(rest[k] - rest[0]));
    }
    if (code == STATUS_OK && !(drift < 1e-9 * fmax(1, fabs(rest[0])))) {
        code = STATUS_UNSTABLE;
    }
    for (int j = 0; j < LINEAR_READINGS && code == STATUS_OK; j++) {
        code = learn_reading(law, arm, p, j, rest, f);
    }

    // a law that answers no reading at all is asleep at rest, or feeds nothing back
    const bool silent = largest_magnitude(law->h[0], LINEAR_READINGS * ANSWERS) == 0;
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

// Puts a law and the sampled arm, under the delay of p, in series: the loop cut at the
// command. Its states are the arm's n, then those of the law, q_1 ... q_order: the
// answers of the next samples to the readings so far. With the readings y of this sample
//
//     answer = q_1 + sum of h_0 y,    q_k' = q_k+1 + sum of h_k y
//     q_order' = sum of recurrence[i] q_i+1 + sum of h_order y
static status assemble(linear_system *loop, const linear_law *law, const linear_arm *arm,
                       const parameters *p, fault *f)
{
    SCOPED(linear_system_finish) linear_system plant = {0};
    TRY(linear_sample(&plant, arm, p, f));
    const int n = plant.states, states = n + law->order;
    TRY(linear_system_init(loop, states, 1, f));

    // the arm's own rows, and the sums over readings, y = C x
    for (int i = 0; i < n; i++) {
        memcpy(loop->a + i * states, plant.a + i * n, (size_t)n * sizeof *loop->a);
        loop->b[i] = plant.b[i];
        for (int k = 0; k <= law->order; k++) {
            double *row = loop->c;
            if (k > 0) {
                row = loop->a + (n + k - 1) * states;
            }
            for (int j = 0; j < LINEAR_READINGS; j++) {
                row[i] += law->h[j][k] * plant.c[j * n + i];
            }
        }
    }

    // the law's states among themselves
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

// The size of the largest pole of the closed loop with a further delay [s].
static status radius_with_delay(const linear_law *law, const linear_arm *arm,
                                const parameters *p, double delay, double *radius,
                                fault *f)
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
    const double longest = fmin(*delay, MOST_LATE * period) + 2 * period;
    double stable = 0, unstable = 0, radius = 0;
    linear_law law = {.order = 0};
    TRY(learn(&law, arm, p, f));

    // Raise the delay until a pole reaches the unit circle. The steps may grow: the
    // longer the delay is, the lower are the frequencies that can still turn unstable.
    while (radius < 1 && unstable < longest) {
        stable = unstable;
        unstable += fmax(period / 8, unstable / 32);
        TRY(radius_with_delay(&law, arm, p, unstable, &radius, f));
    }
    if (radius < 1) {
        return STATUS_OK;
    }

    // bisect the step in which it does
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (stable + unstable) / 2;
        TRY(radius_with_delay(&law, arm, p, middle, &radius, f));
        if (radius < 1) {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    *delay = unstable;
    return STATUS_OK;
}
