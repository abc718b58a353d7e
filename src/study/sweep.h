// A sweep: many runs derived from one scenario, each with its own values of some parameters.
//
// Run i of a sweep (from 0) is defined by the sweep alone, so results depend neither on the number
// of threads nor on the order in which they were computed, and any part can be computed later.
#pragma once

#include <signal.h>
#include <stdint.h>

#include "src/run/run.h"

enum { SWEEP_MOST_AXES = 8, SWEEP_MOST_RUNS = 10000000, SWEEP_MOST_JOBS = 256 };

// How the values are chosen: every combination, independently at random, or so that each of as many
// equal parts of every range as there are runs is met exactly once (Latin hypercube).
typedef enum sweep_sampling { SWEEP_GRID, SWEEP_RANDOM, SWEEP_LATIN } sweep_sampling;

// "grid", "random", "latin"
const char *sweep_sampling_name(sweep_sampling sampling);

// One varied parameter. Words and truth values are numbers here, as in parameter_get.
typedef struct sweep_axis {
    int parameter;    // index in parameter_table
    double *values;   // those of a list, or of a range in a grid; NULL for a range to draw from
    size_t count;     // of values
    double low, high; // of a range, as given; low may be the larger one
    bool is_range;
    bool logarithmic; // a range spaced evenly in the logarithm
    char *text;       // what is varied, in one way of writing: "1:10:5", "0.1:10:3:log", "a,b"
} sweep_axis;

typedef struct sweep {
    const scenario *base; // borrowed
    sweep_axis axes[SWEEP_MOST_AXES];
    int axis_count;
    sweep_sampling sampling;
    uint64_t seed;
    size_t run_count;
    double *drawn; // random, latin: axis_count values a run; NULL for a grid
} sweep;

// What is asked for.
typedef struct sweep_request {
    char *const
        *vary; // "PATH=a:b:n", "PATH=a:b:n:log", "PATH=v1,v2,v3"; n may be left out if drawn
    int vary_count;
    sweep_sampling sampling;
    size_t runs; // random, latin: number of runs; 0 for a grid, which is as large as it is
    uint64_t seed;
} sweep_request;

// Reads a request and checks every value and combination of values. The last parameter of a grid
// changes fastest. A range of a whole-number parameter gives whole numbers, a list is drawn from
// with equal chances. `base` has to live as long as the sweep. On failure (STATUS_BAD_ARGUMENT,
// STATUS_NO_MEMORY) f says why and nothing is to be freed.
status sweep_init(sweep *s, const scenario *base, const sweep_request *request, fault *f);
void sweep_finish(sweep *s);

// Value of parameter axes[axis] in run `run`.
double sweep_value(const sweep *s, size_t run, int axis);

// The same as a scenario file would give it ("newmark", "0.1").
void sweep_value_text(const sweep *s, size_t run, int axis, char *text, size_t size);

// The scenario of one run. It borrows everything but its parameters from the base: do not call
// scenario_finish. Fails, with the reason in f, if the values do not go together.
status sweep_scenario(const sweep *s, size_t run, scenario *derived, fault *f);

// Splits a summary's key into name and unit: "contact_impulse_Ns" gives "contact_impulse", "N s";
// "impacts" has the unit "". name has `size` bytes.
void quantity_name(const char *key, char *name, size_t size, const char **unit);

// How far a sweep has come.
typedef struct sweep_progress {
    size_t done, total; // runs in the store, and of the sweep
    size_t failed;      // of those done now: runs that failed
    size_t done_now;    // since sweep_run began
    double elapsed_s;   // since sweep_run began
} sweep_progress;

typedef struct sweep_options {
    int jobs;                          // threads that compute, 1 ... SWEEP_MOST_JOBS
    const volatile sig_atomic_t *stop; // becomes true to end early; NULL if nothing does
    void (*report)(void *context, const sweep_progress *p); // about ten times a second, or NULL
    void *context;
} sweep_options;

struct sweep_store;

// Computes the runs that are missing in the store. Rows are committed at least every second (as
// soon as the runs themselves let it). If *stop becomes true the runs in hand are finished and
// committed, and STATUS_OK is returned with progress->done < progress->total. On failure of the
// store, or without memory, what was committed stays and f says why.
status sweep_run(const sweep *s, struct sweep_store *store, const sweep_options *options,
                 sweep_progress *progress, fault *f);
