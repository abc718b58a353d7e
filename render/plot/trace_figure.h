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
    bool inset;                         // the first pulse enlarged, if it is short
    bool wall;                          // the wall's angle as a line
    bool modes;                         // shade the controller's second mode instead of contact
} trace_panel;

// A run to draw. The first one gives marks, shading, impulses and caption; further ones are thin
// dashed lines in the same panels.
typedef struct trace_run {
    const scenario *scenario;
    const run_result *result; // with its trace
    const char *name;         // "corrected"; shown only if there are several runs
    bool brief;               // further runs only: the first signal of each panel, in grey
    bool steps;               // a small point at every row: the steps of the method
    bool points;              // further runs only: reference data, points where it has a number
    int rank; // 0: as above; otherwise a colour of its own, 1 to 8, and lines tell signals
} trace_run;

enum { TRACE_KEY = TRACE_RUNS + FIGURE_PANELS * TRACE_SIGNALS };

// A figure with everything it borrows, except for the runs.
typedef struct trace_figure {
    figure figure;
    figure_panel panels[FIGURE_PANELS];
    figure_series series[FIGURE_PANELS][TRACE_SIGNALS * TRACE_RUNS];
    figure_series residual; // in an additional last panel, if there are reference data
    figure_panel key;       // of runs side by side: their colours, then lines, then data
    figure_series key_series[TRACE_KEY];
    int key_signals[TRACE_KEY]; // what the entry is a line of, see trace_key.c; 0: no signal
    figure_level wall;
    GPtrArray *owned; // blocks
    figure_mark *marks;
    figure_interval *intervals;
    figure_impulse *impulses;
} trace_figure;

// A signal's symbol as markup, with the index of its body in the scenario. To be freed with g_free.
char *trace_symbol(const scenario *s, int index);

// A signal of a run over time; for the force the peaks are added to the rows. Storage made for it
// is added to `owned`.
figure_series trace_series(const trace_run *run, int index, GPtrArray *owned);

// The value of a signal at an instant of a run, interpolated linearly between rows; NaN outside the
// run.
double trace_value_at(const trace *t, int index, double time);

// The intervals of contact; the array is added to `owned`.
figure_interval *trace_contact(const trace *rows, int *count, GPtrArray *owned);
