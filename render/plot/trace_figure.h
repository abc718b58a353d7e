// Figures of recorded runs: panels, runs, and the figure made of them.
#pragma once

#include <glib.h>

#include "render/plot/plot.h"
#include "src/run/run.h"

enum { TRACE_SIGNALS = 4, TRACE_RUNS = 8 };

// A panel: signals of one unit over time.
typedef struct trace_panel {
    const char *label;                  // of the axis, markup; NULL: the first signal's own
    const char *signals[TRACE_SIGNALS]; // names in the signal table, unused ones NULL
    double weight;                      // share of the height, 0 counts as 1
    bool with_zero;                     // the axis includes 0
    bool impulses;                      // impulses of impacts in a strip above the panel
    bool inset;                         // the first pulse once more, if it is short
    bool wall;                          // the wall's angle as a line
    bool modes;                         // shade the controller's second mode instead of contact
} trace_panel;

// A run to draw. The first one gives marks, shading, impulses and caption; further ones are thin
// dashed lines in the same panels.
typedef struct trace_run {
    const scenario *scenario;
    const run_result *result; // with its trace
    const char *name;         // "corrected"; only shown if there are several runs
    bool brief;               // further runs only: of each panel the first signal, in grey
    bool steps;               // a small point at every row: the steps of the method
    bool points;              // further runs only: reference data, points where it has a number
    int rank;                 // 0: as said above; else a full line of its own colour, 1 to 8
} trace_run;

// A figure with everything it borrows, except for the runs.
typedef struct trace_figure {
    figure figure;
    figure_panel panels[FIGURE_PANELS];
    figure_series series[FIGURE_PANELS][TRACE_SIGNALS * TRACE_RUNS];
    figure_series residual; // in the panel behind the last, where there are reference data
    figure_level wall;
    GPtrArray *owned; // blocks
    figure_mark *marks;
    figure_interval *intervals;
    figure_impulse *impulses;
} trace_figure;

// A signal's symbol as markup, with the index of the body it has in the scenario. Free it with
// g_free.
char *trace_symbol(const scenario *s, int index);

// A signal of a run over time, the force with its peaks among the rows. What is made for it goes to
// `owned`.
figure_series trace_series(const trace_run *run, int index, GPtrArray *owned);

// The value of a signal at an instant of a run, straight lines between rows; NaN beyond its ends.
double trace_value_at(const trace *t, int index, double time);

// The stretches in contact; the array goes to `owned`.
figure_interval *trace_contact(const trace *rows, int *count, GPtrArray *owned);
