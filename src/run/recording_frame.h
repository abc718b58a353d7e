// What begins and ends every run, whatever the model and whoever steps it.
#pragma once

#include "src/run/recording.h"

// Computing time of the thread and time by the clock [s].
typedef struct time_used {
    double cpu, wall;
} time_used;

time_used time_now(void);
time_used time_since(time_used start);

// Begins to record a run of the scenario into result: an empty summary, and the rig if a law is
// chosen or given. f holds no fault or why it cannot begin; STATUS_STOPPED where options->abandon
// is true already. recording_end is due in any case.
status recording_begin(recording *r, const scenario *s, const run_options *options,
                       run_result *result, fault *f);

// Ends it: the rig is gone, and the summary says what stopped the run and what it took.
void recording_end(recording *r, status code, const fault *f, time_used used);

// Writes into the summary what stopped the run.
void recording_tell_fault(summary *s, status code, const fault *f);
