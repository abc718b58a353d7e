// Computes the runs of a sweep on several threads and stores them as they finish.
#pragma once

#include <stdatomic.h>

#include "src/tables/summary.h"
#include "src/study/pool.h"
#include "src/study/sweep.h"

enum { SWEEP_MOST_JOBS = POOL_MOST_THREADS };

// Takes a number of a run, from 0: NaN where the run failed or the quantity did not
// occur. False: no other one is wanted.
typedef bool sweep_value_taker(void *context, size_t run, double value);

// Where the rows of a sweep are kept, one for each run that was computed: what a store
// can do. Its functions are given itself; their faults are sentences.
typedef struct sweep_store {
    size_t count; // of runs that it has; `put` goes on with it

    // Adds the result of run `run`; `commit` makes permanent what was put since the last
    // one.
    status (*put)(struct sweep_store *store, size_t run, const summary *result, fault *f);
    status (*commit)(struct sweep_store *store, fault *f);

    // Hands on one quantity, by its key, of every run of a share that it has, in order.
    // `failed` (may be NULL) receives the number of failed runs among them. It takes as
    // long as the share is large.
    status (*values)(struct sweep_store *store, sweep_share share, const char *key,
                     sweep_value_taker *take, void *context, size_t *failed, fault *f);
} sweep_store;

// The same of a share of a sweep's run_count runs as values[sweep_share_count], NaN where
// a run is missing, too.
status sweep_quantity(sweep_store *store, size_t run_count, sweep_share share,
                      const char *key, double *values, size_t *failed, fault *f);

// How far a sweep has come.
typedef struct sweep_progress {
    size_t done, total;  // runs in the store, and in all, of this share of the sweep
    size_t failed;       // of those done now: runs that failed
    size_t done_now;     // since sweep_run began
    double elapsed_s;    // since sweep_run began
    size_t first_failed; // of those failed the run with the lowest number, from 0
    char first_failure[sizeof(((summary *)0)->message)]; // and what it says
} sweep_progress;

typedef struct sweep_options {
    sweep_share share;
    int jobs;                          // threads that compute, 1 ... SWEEP_MOST_JOBS
    const volatile sig_atomic_t *stop; // becomes true to end early; NULL if nothing does
    const atomic_bool
        *abandon; // the same for the runs in hand, which are not stored then
    void (*report)(void *context,
                   const sweep_progress *p); // about ten times a second, or NULL
    void *context;
} sweep_options;

// Computes the runs that are missing in the store, runs of two links side by side in the
// processor's vectors (run_together): what each gives does not depend on that. Rows are
// committed at least every second, or, with longer runs, as each finishes. If *stop
// becomes true the runs in hand are finished and committed, unless *abandon is true, and
// STATUS_OK is returned with progress->done < progress->total. On failure of the store,
// or without memory, what was committed stays and f says why.
status sweep_run(const sweep *s, sweep_store *store, const sweep_options *options,
                 sweep_progress *progress, fault *f);
