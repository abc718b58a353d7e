// What a run in flight is made of at the beginning of a step: enough to go on from there.
#pragma once

#include "src/run/run.h"

#define STEADY_WINDOW 0.1 // steady force: mean over the last of the run [s]

// The force over a step: at its ends, and its mean.
typedef struct force_step {
    double start, end;        // [s]
    double first, last, mean; // [N]
} force_step;

// An element of run_history.checkpoints; its size there includes the state.
typedef struct checkpoint {
    double time; // [s]
    size_t rows, events, force_steps;
    int next_action;
    long grid_row;
    bool separated, pulse_open, impacted;
    double integral_at_window;
    summary summary;
    // of the motion
    long steps;
    double start_energy, pulse_peak, pulse_peak_time, largest_penetration;
    double state[];
} checkpoint;

// The checkpoint of a number, oldest first.
static inline checkpoint *checkpoint_at(const run_history *h, size_t index)
{
    return (checkpoint *)((char *)h->checkpoints.base + index * h->checkpoints.size);
}

// Address space for a resumable run's rows, and for what there is one of for many rows.
static inline size_t rows_at_most(size_t expected)
{
    return 16 * expected + 1000000;
}
