// Watched functions within a stride of the chain's modes (modal_stride.h): what they are
// (modal_function.c), events and peaks (modal_watch.c).
//
// A function is represented by three terms: its value at the start; a linear functional of the
// modes, from its gradient there; and a polynomial through what remains of its exact values at the
// collocation points. Together they are a sum of vibrations and a power series (modal_sum.h). A
// walk along the stride leaps as far as an event can be excluded. Where the function comes near
// zero the walk evaluates it a few times in the shortest period of all modes that matter; those
// left out can move it by less than `slack`. There the exact function is evaluated as well, and a
// root is one of the exact function. So only a dip below zero by less than `slack` can be missed:
// 1e-10 m for the gap, a thousandth of the modes' contribution for the force.
#pragma once

#include "src/solve/modal_stride.h"
#include "src/solve/modal_sum.h"
#include "src/solve/motion.h"

typedef struct modal_function {
    watch kind;
    double value;             // at the start, in its unit
    double *place, *speed;    // functional of x and of v = x', by mode
    double rest[MODAL_NODES]; // polynomial sum rest[j] t^j / j!
    modal_sum sum;            // all of it
    double slack;
    double most_beyond; // how far beyond its edge an event may be, where it is no gap
    double edge;        // its value at a start on its edge, where it counts as zero
} modal_function;

// From a gap smaller than this at a stride's start on, the function is the growth of the gap,
// computed to full relative precision, since flights may be lower than the rounding of the gap
// itself [m]. Just after an event such a gap counts as zero: the arm is on the wall and leaves it,
// unless the gap closes.
#define MODAL_ON_WALL 1e-11

// Doubles needed by a function's arrays for n degrees of freedom; places the arrays in such
// storage.
size_t modal_function_size(int n);
void modal_function_place(modal_function *f, int n, double *storage);

// Prepares a function on the stride in hand.
void modal_function_fit(modal_function *f, watch kind, modal_stride *s, const arm *a, motion *m);

// What is watched of a value and a slope of the sum: friction counts by what is left of it.
glance modal_function_watched(const modal_function *f, const arm *a, glance g);

// Its value and slope at t within the stride.
glance modal_function_at(const modal_function *f, const arm *a, double t);

// The first instant in (0, *h] at which it leaves its admissible side; *h is then moved there.
bool modal_function_falls(modal_function *f, modal_stride *s, const arm *a, motion *m, double *h);

// The exact function of a state, less its edge.
double modal_function_of(const modal_function *f, const modal_stride *s, const arm *a,
                         const motion *m, double *state);

// The exact function at t, less its edge, of the state that a stride to there ends in; leaves that
// state in m->between.
double modal_function_exact(const modal_function *f, modal_stride *s, const arm *a, motion *m,
                            double t);

// Raises m->pulse_peak to the largest force in [0, h].
void modal_function_peak(modal_function *f, const arm *a, motion *m, double h);
