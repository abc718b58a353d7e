// What a run in flight is made of at the beginning of a stride: enough to go on from there.
#pragma once

#include "src/run/run.h"

#define STEADY_WINDOW 0.1 // steady force: mean over the last of the run [s]

// The force over a stride: at its ends, and its mean.
typedef struct force_stride {
    double start, end;        // [s]
    double first, last, mean; // [N]
} force_stride;

// An element of run_history.snapshots; its size there includes the state.
typedef struct run_snapshot {
    double time; // [s]
    size_t rows, events, strides;
    int next_action;
    long grid_row;
    bool separated, pulse_open, touched;
    double integral_at_window;
    summary summary;
    // of the motion
    long steps;
    double start_energy, pulse_peak, pulse_peak_time, largest_penetration;
    double state[];
} run_snapshot;

// The snapshot of a number, oldest first.
static inline run_snapshot *run_snapshot_at(const run_history *h, size_t index)
{
    return (run_snapshot *)((char *)h->snapshots.base + index * h->snapshots.size);
}

// Address space for a resumable run's rows, and for what there is one of for many rows.
static inline size_t rows_at_most(size_t expected)
{
    return 16 * expected + 1000000;
}
