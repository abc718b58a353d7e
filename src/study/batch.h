// Many runs at once, summaries only: what sweeps, Monte Carlo studies and tuning are made
// of.
#pragma once

#include "src/run/run.h"
#include "src/study/pool.h"

typedef struct batch {
    void *context;
    size_t count; // runs 0 ... count - 1

    // Makes scenario number i, where another one of the batch or zeros were before;
    // called from several threads. One that cannot be made is a run that failed, as f
    // says.
    status (*make)(void *context, size_t i, scenario *made, fault *f);

    // Takes the summary of run i as pool_work.collect does; NULL: they go to
    // summaries[count].
    status (*take)(void *context, size_t i, const summary *s, fault *f);
    summary *summaries;

    size_t together; // runs that make a piece of work, at most; 0: RUN_TOGETHER
    status (*tick)(void *context, bool over, fault *f); // those of pool_work
    double tick_interval;                               //
    const volatile sig_atomic_t *stop;                  //
    const atomic_bool *abandon;                         // that of run_together
} batch;

// Runs them on `jobs` threads (as many as can be started, of 1 to POOL_MOST_THREADS).
// Each summary is the same to the last bit as that of a single run_scenario, but for its
// times, whatever the number of threads; a run that fails says so in its own summary.
// Returns what `take` or `tick` did, or STATUS_NO_MEMORY if there is no room for the
// threads' results.
status batch_run(const batch *b, int jobs, fault *f);
