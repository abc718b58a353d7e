// Scenarios run for figures, and figures of runs with options: signals, range of time, measured
// data.
#pragma once

#include "render/figures/figures.h"

// --- scenarios run for figures

// A run with its scenario; of measured data the trace alone.
typedef struct opened_run {
    scenario scenario;
    run_result result; // with its trace
} opened_run;

// Opens and runs a scenario, with one parameter changed if `change` ("arm.model=corrected") is not
// NULL. NULL with the reason if that fails. To be ended with run_close, which accepts NULL.
opened_run *run_open(const char *name, const char *change, fault *f);
void run_close(void *run);

// The same with several changes, each "PATH=VALUE". STATUS_STOPPED if `monitor` (may be NULL)
// requested it.
opened_run *run_open_changed(const char *name, const char *const *changes, int count,
                             run_monitor *monitor, fault *f);

// A figure of empty panels with an order's title and a run of its scenario, which it owns: *run.
// NULL with the reason if the run fails.
owned_figure *run_plot_create(const figure_order *order, const char *change, int panels,
                              const opened_run **run, fault *f);

// The recorded signal whose name is nearest to a misspelt one.
const char *nearest_signal(const char *name);

// --- their figures

// A figure of the runs, which it borrows: o->signals in place of `panels` (NULL: the usual ones of
// a run), o->overlay as points with a panel of residuals, o->from to o->to, and the look. NULL with
// the status of overlay_read, or STATUS_BAD_ARGUMENT for an unknown signal or too many runs.
owned_figure *run_figure_create(const char *title, const trace_panel *panels, int panel_count,
                                const trace_run *runs, int run_count, const figure_options *o,
                                fault *f);
