// What the files of a stride of the modes (modal_stride.h) share: its parts that nothing else
// wants.
//
//     modal_storage.c      where everything is
//     modal_parts.c        bases, the start, the modes' own answer, states
//     modal_collocation.c  r and s by Picard's sweeps
//     modal_points.c       the chain at all points of a stride side by side (modal_points.h)
//     modal_loops_kernel.h all modes in the lanes of vectors (modal_loops.h)
//     modal_losses.c       energy lost in it
#pragma once

#include "src/solve/modal_stride.h"

// How many powers of time are needed at a collocation point: all of them at the stride's end.
static inline int modal_kept_powers(int point)
{
    return point < MODAL_NODES - 1 ? MODAL_NODES + 1 : MODAL_POWERS;
}

// Responses of the first `count` modes at t [s] to an impulse and to `powers` powers of time.
void modal_fill_table(const modal_stride *s, double t, int powers, int count,
                      const modal_table *at);

// x[count] and y[count] of all modes at the instant of the responses `at`.
void modal_momenta_at(const modal_stride *s, const modal_table *at, double *x, double *y);

// From x and y to what stands for angles and momenta: in `y` the change of V' P, zero of e; returns
// that of lambda (modal_basis.h) [N m s].
double modal_to_momenta(const modal_stride *s, const arm *a, const double *x, double *y);

// r and s of one instant, into s->drifts[point] and s->forces[point]. x, y: of the modes; modal[2
// row]: the velocities' momenta there and the forces that are left, brought to the modes.
void modal_take_remainders(const modal_stride *s, int point, const double *x, const double *y,
                           const double *modal);

// A mode's turn in a stride, or its decay, up to which a power series takes it [rad].
#define MODAL_SLOW_TURN 1

// A decay u' + rate u = n(t) = sum n[j] t^j / j! over a stride, from u = start.
typedef struct modal_decay_course {
    double rate, length; // [1/s], of the stride [s]
    double start;
    const double *n; // MODAL_NODES of them
} modal_decay_course;

// Adds `weight` times it to the derivatives at the start, total[MODAL_SERIES], and what decays to
// *amplitude. Where it hardly decays in the stride the series has all of it: what it settles at and
// what decays would be large and of opposite sign. Returns whether something decays.
bool modal_add_decay(const modal_decay_course *u, double weight, double *amplitude, double *total);

// Torque of motor and friction on the hub [N m].
static inline double modal_hub_torque(const modal_stride *s, const arm *a)
{
    return a->motor.torque - s->mode.friction * a->motor.stiction;
}
