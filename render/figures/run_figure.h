// Scenarios run for figures, and figures of runs with options: signals, range of time, measured
// data.
#pragma once

#include "render/figures/artwork.h"
#include "render/plot/trace_plot.h"

// --- scenarios run for figures

// A run with its scenario, finished by run_end.
typedef struct opened_run {
    scenario scenario;
    run_result result; // with its trace
} opened_run;

// Opens and runs a scenario, with one parameter changed if `change` ("arm.model=corrected") is not
// NULL. On failure nothing has to be finished.
status run_begin(opened_run *r, const char *name, const char *change, fault *f);
void run_end(opened_run *r);

// The recorded signal whose name is nearest to a misspelt one.
const char *nearest_signal(const char *name);

// The same with several changes, each "PATH=VALUE". STATUS_STOPPED if `monitor` (may be NULL)
// requested it.
status run_begin_changed(opened_run *r, const char *name, const char *const *changes, int count,
                         run_monitor *monitor, fault *f);

// --- their figures

// A figure of runs with what it owns. The runs are borrowed.
typedef struct run_figure {
    trace_figure traces;
    run_result overlay; // its trace alone
    char *overlay_name;
} run_figure;

// Describes a figure of the runs: o->signals in place of `panels` (NULL: the usual ones of a run),
// o->overlay as points with a panel of residuals, o->from to o->to, and the look. Returns the
// status of trace_figure_init and overlay_read, STATUS_BAD_ARGUMENT for an unknown signal; on
// failure nothing has to be finished.
status run_figure_init(run_figure *r, const char *title, const trace_panel *panels, int panel_count,
                       const trace_run *runs, int run_count, const figure_options *o, fault *f);
void run_figure_finish(run_figure *r);
