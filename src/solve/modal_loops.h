// The loops over all modes that a stride's sweeps and losses are made with, in the widest vectors
// of the processor; the same bits in all of them. Arrays by mode go on to a whole number of vectors
// (modal_stride.row); behind the last mode stand modes that do nothing.
#pragma once

#include "src/solve/modal_stride.h"

enum { MODAL_LANES = 8 };

// Coefficients of the polynomial through values at the points: row j gives that of (t/length)^j.
extern const double modal_to_powers[MODAL_NODES][MODAL_NODES];

// Weights of products of two polynomials' coefficients in an integral until t:
// t^(i+j+1) / ((i+j+1) i! j!).
typedef double modal_weights[MODAL_NODES][MODAL_NODES];

// The ingredients of the losses until some instant, by mode.
typedef struct modal_mode_losses {
    double time; // [s]
    modal_weights weights;
    double *all; // [row]: 2 a times the integral of v^2
} modal_mode_losses;

typedef struct modal_loops {
    // modal_momenta_at without what there is across a constraint
    void (*momenta)(const modal_stride *s, const modal_table *at, double *x, double *y);
    // the polynomials of r and s from their values, and s->followed; returns the square of what
    // changed, as the momenta and, times their rates, coordinates that it makes in the stride
    double (*fit)(modal_stride *s);
    // removes the vibrations of fast modes from x and y at t: what remains is the quasi-static
    // response
    void (*leave_out)(const modal_stride *s, double t, double *x, double *y);
    // r and s of a point from x, y and what the sweeps say there, brought to the modes
    void (*take)(const modal_stride *s, int point, const double *x, const double *y,
                 const double *modal);
    void (*losses)(const modal_stride *s, modal_mode_losses *l);
    // integrals of the products of transients and a power series of so many terms, by its
    // derivatives at both ends
    double (*series)(const modal_transients *v, const double *start, const double *end, int terms);
    // integrals of the products of all pairs of different transients
    double (*overlap)(const modal_transients *v);
} modal_loops;

// Those for this processor, or for vectors as narrow as taylor_limit_width (taylor_lanes.h) takes.
const modal_loops *modal_loops_here(void);

// Those built for each width (by_width.h).
extern const modal_loops modal_loops_1, modal_loops_2, modal_loops_4, modal_loops_8;
