// The step in hand of the two-link engine (taylor_engine.c), and what it tells
// (taylor_output.c).
#pragma once

#include "src/contact/motion.h"
#include "src/engines/pair/taylor_lanes.h"
#include "src/engines/pair/taylor_polynomial.h"

typedef struct taylor_integrator {
    taylor_lane lane; // the series
    polynomial function[EVENT_OF_STICTION +
                        1];  // as far as they were asked for; stiction: nearer limit
    polynomial far_limit;    // of stiction
    unsigned known;          // which of them are, a bit each
    bool ready;              // the series of the next step were computed apart
    double kept[KEPT_COUNT]; // the step that the series are of
    double used;             // of it before the step in hand [s]
    bool own;                // the lane's block has all of them
} taylor_integrator;

// The engine's functions of these names (engine.h).
status taylor_state_at(const arm *a, motion *m, double h, state_extent extent);
void taylor_states_at(const arm *a, motion *m, const double *h, int count,
                      double *const *states, state_energy *energies);
void taylor_dense_output(const arm *a, motion *m, output_quantity of, double from,
                         double to, int count, value_and_slope *at);

value_and_slope taylor_event_function(const arm *a, const motion *m, event_function w,
                                      double h);
double taylor_second_derivative(const arm *a, const motion *m, event_function w,
                                double from, double to);
bool taylor_excludes_event(const motion *m, event_function w);
void taylor_first_event(const arm *a, motion *m, step_end *end);
