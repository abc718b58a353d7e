// A function of time as a power series and a sum of decaying vibrations,
//
//     f(t) = sum p_j (t/L)^j + sum_e e^(-a_e t) (A_e cos v_e t + B_e sin v_e t),
//
// and walks along it. What the modes of a stride do to anything linear in them has this form:
// modes that turn little in the stride, and what the others follow without vibrating, are the
// series; an overdamped mode is two decays.
//
// The amplitudes give bounds. From an instant on, the vibrations above a chosen rate together
// change f by no more than the sum T of their amplitudes, and the second derivative of the slower
// ones is at most sum A rate^2. So a walk leaps as far as f > 0 is certain,
//
//     f_slow + f_slow' h - bend h^2 / 2 - T > 0,
//
// at the rate that makes the leap longest, and takes fine steps only where f comes near zero.
//
// Steps are powers of two of a second, so what a step of that length does to every vibration is
// computed once (modal_turns) and serves every walk after that.
#pragma once

#include <stdbool.h>

#include "src/solve/engine.h"
#include "src/solve/modal_basis.h"

enum {
    MODAL_SERIES = 34,  // terms of the power series
    MODAL_OCTAVES = 40, // bins of vibrations by rate
    MODAL_LEVELS = 36   // lengths of steps: 2^-level s
};

// A mode is that far from critical damping at least: a share of its rate.
#define MODAL_NEAR_CRITICAL 1e-4

// The vibrations of a basis with its damping: one an entry, or two of an overdamped mode. Entries
// of vibrating modes come first, then the slow decays, then the fast ones, each by rising mode.
typedef struct modal_vibrations {
    int count, vibrating, overdamped; // count = vibrating + 2 overdamped
    int *entry; // of a mode, the slow one of an overdamped mode, whose fast one is `overdamped` on;
                // -1 of a mode without a spring
    double *decay, *turn;  // a, v [1/s], [rad/s]
    double *square;        // a^2 + v^2
    int *octave;           // of its rate
    double *cosine, *sine; // by level and entry: what a step of 2^-level does
    bool known[MODAL_LEVELS];
    int limit; // entries there is room for
} modal_vibrations;

// Doubles needed by the vibrations of n modes; places the arrays in such storage.
size_t modal_vibrations_size(int n);
void modal_vibrations_place(modal_vibrations *v, int n, double *storage);

// The vibrations of the modes of b with damping a, by mode; the vector across a constraint is none.
void modal_vibrations_compute(modal_vibrations *v, const modal_basis *b, const double *damping);

// f at an instant, with the amplitudes there.
typedef struct modal_sum {
    modal_vibrations *vibrations;
    int first, last;             // entries [first, last) of them take part
    double length;               // L [s]
    double series[MODAL_SERIES]; // p, in the function's unit
    int terms;                   // of it that matter
    double bend;                 // bound on |third derivative| of the series in [0, L]
    double *cosine, *sine;       // A, B, by entry
    double time;                 // of the walk [s]
    double *a, *b;               // the same at that time
    glance now;                  // f there
} modal_sum;

// f and its slope at t, whatever the walk does.
glance modal_sum_at(const modal_sum *f, double t);

// Puts the walk at the start; takes a step of 2^-level s.
void modal_sum_begin(modal_sum *f);
void modal_sum_step(modal_sum *f, int level);

// Bound on the change of f by all vibrations together from here on [unit of f].
double modal_sum_reach(const modal_sum *f);

// The level of the longest step after which sign * (f - edge) is certain to have been positive all
// along; MODAL_LEVELS if there is none. *fine: that of steps fine enough to see anything that moves
// f by `slack`.
int modal_sum_leap(const modal_sum *f, double sign, double edge, double slack, int *fine);
