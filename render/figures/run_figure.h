// Figures of runs with options: signals, range of time, measured data.
#pragma once

#include "render/figures/artwork.h"
#include "render/plot/trace_plot.h"

// A figure of runs with what it owns. The runs are borrowed.
typedef struct run_figure {
    trace_figure traces;
    run_result overlay; // its trace alone
    char *overlay_name;
    char *title; // NULL: the scenario's
    trace_panel panels[FIGURE_PANELS];
    int panel_count;
    char **names; // of the requested signals
} run_figure;

// Describes a figure of the runs: o->signals in place of `panels` (NULL: the usual ones of a run),
// o->overlay as points with a panel of residuals, o->from to o->to, and the look. Returns the
// status of trace_figure_init and overlay_read, STATUS_BAD_ARGUMENT for an unknown signal; on
// failure nothing has to be finished.
status run_figure_init(run_figure *r, const char *title, const trace_panel *panels, int panel_count,
                       const trace_run *runs, int run_count, const figure_options *o, fault *f);
void run_figure_finish(run_figure *r);
