// The result of a run: summary, rows and history; and the options of a run.
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

#include "src/tables/summary.h"
#include "src/run/force_history.h"
#include "src/run/trace.h"

// What a run that can be resumed (src/run/resume.h) keeps besides its rows.
typedef struct run_history {
    shared_array forces;      // over every step (src/run/force_history.h)
    shared_array checkpoints; // of the run, every few hundred rows (src/run/resume.h)
} run_history;

// The first contact that ends a free flight, and its pulse: it is the run's first contact, but of
// an arm that starts on the wall.
typedef struct landing {
    double time;         // [s]; 0: there was none
    double impulse;      // of its impact [N s]
    double peak;         // of its pulse [N], NaN if there was none
    double time_to_peak; // after it [s]
} landing;

typedef struct run_result {
    summary summary;
    trace trace; // rows at every step and on both sides of every event; empty if not asked for
    landing landing;
    double *before_impact;     // corrected model: angles[dof], then velocities[dof], at the instant
                               // before the landing [rad], [rad/s]; NULL if there was none
    size_t before_impact_size; // [bytes]
    run_history history;       // empty unless asked for
} run_result;

// What another thread may know about a run, and tell it. All zero at the start.
typedef struct run_monitor {
    atomic_bool stop;     // set from outside: the run ends as soon as it sees that
    atomic_size_t rows;   // of the trace that can be read
    atomic_size_t events; // the same
    _Atomic double time;  // how far the run has come [s]
    atomic_int pieces;    // of work that consists of several runs, those that are over
} run_monitor;

// Whether somebody asked for the end; monitor may be NULL: nobody looks on.
static inline bool run_monitor_stops(const run_monitor *monitor)
{
    return monitor != NULL && atomic_load_explicit(&monitor->stop, memory_order_relaxed);
}

// A piece of the work is over; monitor may be NULL.
void run_monitor_count(run_monitor *monitor);

typedef struct run_options {
    bool keep_trace;            // false keeps no rows (events and summary only)
    run_monitor *monitor;       // NULL: nobody looks on
    const atomic_bool *abandon; // becomes true where the run is to end at once; NULL: it is not
    size_t rows_expected; // if not 0, rows and events stay where they are and can be shared, and
                          // the result has a history; needs keep_trace
    const struct given_law *law; // that a program gives in the place of control.law; NULL: none
    struct process_transcript
        *transcript;  // of a process that is the controller; NULL: none is kept
    bool resume;      // *result was prepared by run_resume: continue from there
    bool keep_forces; // result->history has the force over every step, without more of a history
} run_options;

// Frees what the result holds; one of zeroes is allowed.
void run_finish(run_result *result);
