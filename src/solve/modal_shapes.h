// The straight chain of equal links: its mass and stiffness, and its natural modes in a time that
// grows with the square of N.
//
// Between the ends the links' places across the chain obey a recurrence of constant coefficients,
//
//     kappa (d4 u)_i = w^2 (u_i + c (d2 u)_i),     kappa = k/(m l^2),     c = 1/4 - I/(m l^2),
//
// with d2 u_i = u_(i-1) - 2 u_i + u_(i+1). A mode's u is therefore a sum of cos(phi j), sin(phi j),
// e^(-psi j) and e^(-psi i), j = N - i links from the tip, with
//
//     w = 4 sqrt(kappa) s^2 / sqrt(1 - 4 c s^2),
//     s = sin(phi/2) = sinh(psi/2) sqrt(1 - 4 c s^2).
//
// Tip and hub give four equations for the four amplitudes; a mode is where their determinant is
// zero. The number of modes slower than a given w is the number of negative pivots when the angles
// are eliminated one after the other from the tip inwards. So each mode is bracketed separately.
// Modes so slow that they hardly bend, and those faster than phi = pi, which are confined to the
// hub, follow from the same elimination instead.
#pragma once

#include "src/arm/arm.h"

// y = M0 x for the straight chain, in O(N).
void modal_mass_times(const arm *a, const double *x, double *y);
// y = K x.
void modal_stiffness_times(const arm *a, const double *x, double *y);

// Doubles that computing them takes for n degrees of freedom.
static inline size_t modal_shapes_scratch(int n)
{
    return 7 * (size_t)n;
}

// How the ends of the chain are held.
typedef struct modal_ends {
    bool contact; // a wall holds the last link,
    double lever; // so many link lengths beyond its end
    bool stuck;   // the hub does not turn
} modal_ends;

// Rates [rad/s], in rising order, and angles of all modes: row k of shapes[dof * dof] is mode k, of
// unit length in the mass matrix M0. Returns how many there are, or -1 where the arm's constants
// leave none that can be told apart.
int modal_shapes(const arm *a, modal_ends ends, double *rate, double *shapes, double *scratch);

// Angles of the straight chain in static balance under a force where a wall would hold it: with a
// stuck hub its static deflection, else equal angles. Not normalised.
void modal_tip_shift(const arm *a, modal_ends ends, double *angles);
