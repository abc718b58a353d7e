// A sweep in the lab: the present run with several values of one parameter from the start, each as
// a run of its own.
#pragma once

#include "src/run/run.h"
#include "src/study/sweep_axis.h"

enum { SWEPT_RUNS = 32 };

typedef struct swept_run {
    double value; // of the parameter
    run_result run;
    unsigned long id;
} swept_run;

typedef struct lab_sweep {
    sweep_axis axis; // axis.text NULL: no sweep
    swept_run runs[SWEPT_RUNS];
    int count;              // computed so far
    int selected;           // index of the selected one
    int metric;             // index in summary_table
    unsigned long computed; // number of runs ever computed
} lab_sweep;

// Whether there is a sweep, and whether it is complete.
bool lab_sweep_is_on(const lab_sweep *sweep);
bool lab_sweep_is_done(const lab_sweep *sweep);

// Begins a sweep given as "PATH=a:b:n", "PATH=a:b:n:log" or "PATH=v1,v2,..."; nothing is computed
// yet. On STATUS_BAD_ARGUMENT, with the reason in f, the previous sweep is kept.
status lab_sweep_begin(lab_sweep *sweep, const char *definition, fault *f);

// Computes the next run of a sweep from the scenario of the present run. A value that cannot be run
// ends the sweep, with the reason in f.
status lab_sweep_compute_next(lab_sweep *sweep, const scenario *base, fault *f);

void lab_sweep_end(lab_sweep *sweep);
