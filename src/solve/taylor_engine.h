// Strides of several two-link arms side by side: the series, which are most of a run's work, are
// computed for as many arms at once as the processor's vectors hold. Every arm gets the bits that
// it gets alone.
//
//     prepare each motion -> compute those of one form together -> motion_step each
#pragma once

#include "src/solve/motion.h"
#include "src/solve/taylor_series.h"

// A stride that is prepared: what its series start from, and where they go.
typedef struct taylor_request {
    taylor_form form;
    double *block; // the motion's own, TAYLOR_PLACES
} taylor_request;

// Prepares the stride that motion_step(a, m, until, ...) is going to begin, with `remaining` to go
// [s]. False if that stride asks for no series: another engine, or an arm that is held still.
bool taylor_prepare(const arm *a, motion *m, double remaining, taylor_request *request);

// Computes up to taylor_width() requests of one form; the motions take the series from there.
void taylor_compute(const taylor_request *requests, int count);

// Computes the series of one arm, in the widest vectors that help it; the same bits in all of them.
void taylor_compute_one(double *block, taylor_form form);

// Evaluates the series of one arm at `count` instants of the stride, up to taylor_width().
void taylor_evaluate(const arm *a, const double *block, taylor_form form, int count,
                     taylor_instants *at);

// How many arms the widest vectors of this processor hold, 1 to TAYLOR_WIDEST.
int taylor_width(void);

// Takes narrower vectors than the processor has, for tests and measurements: 1, 2, 4 or 8; 0 takes
// the widest again. Returns what is taken.
int taylor_limit_width(int width);
