// Figures of recorded runs.
#pragma once

#include <glib.h>

#include "render/plot/figure_description.h"
#include "src/base/fault.h"
#include "src/run/run.h"

enum { TRACE_SIGNALS = 4, TRACE_RUNS = 8 };

// A panel: signals of one unit over time.
typedef struct trace_panel {
    const char *label; // of the axis, markup; NULL: the first signal's own
    const char *signals[TRACE_SIGNALS]; // names in the signal table, unused ones NULL
    double weight;                      // share of the height, 0 counts as 1
    bool with_zero;                     // the axis includes 0
    bool impulses;                      // impulses of impacts in a strip above the panel
    bool inset;                         // the first pulse enlarged, if it is short
    bool wall;                          // the wall's angle as a line
    bool modes; // shade the controller's second mode instead of contact
} trace_panel;

// A run to draw. The first one gives marks, shading, impulses and caption; further ones
// are thin dashed lines in the same panels.
typedef struct trace_run {
    const scenario *scenario;
    const run_result *result; // with its trace
    const char *name;         // "corrected"; shown only if there are several runs
    bool brief;  // further runs only: the first signal of each panel, in grey
    bool steps;  // a small point at every row: the steps of the method
    bool points; // further runs only: reference data, points where it has a number
    int rank;    // 0: as above; otherwise one of runs side by side, which has the look
                 // run_style_of(rank), 1 to TRACE_RUNS
} trace_run;

// A figure of runs while it is made.
typedef struct trace_figure {
    owned_figure *drawn;
    const trace_panel *panels;
    const trace_run *runs;
    int run_count;
} trace_figure;

// The scenario's title, and what was changed of what it speaks of. Free with g_free.
char *scenario_title(const scenario *s);

// The scenario's name and every parameter in one line, for a file's metadata. Free with
// g_free.
char *parameters_line(const scenario *s);

// A signal's symbol as markup, with the index of its body in the scenario. To be freed
// with g_free.
char *trace_symbol(const scenario *s, int index);

// A signal of a run over time; for the force the peaks are added to the rows. Storage
// made for it, and for the following, is kept by the figure.
figure_series trace_series(const trace_run *run, int index, owned_figure *o);

// A signal of a run over another one, both recorded or derived, between two instants [s].
figure_series trace_series_over(const trace_run *run, int index, int over, double from,
                                double to, owned_figure *o);

// The value of a signal at an instant of a run, on a side of an event there (trace_side),
// interpolated linearly between rows; NaN outside the run.
double trace_value(const trace *t, int index, double time, size_t side);

// A signal at the instants of one run less that of another, interpolated linearly between
// its rows.
figure_series trace_difference(const trace *of, const trace *less, int index,
                               owned_figure *o);

// Adds a panel of measured data less the first run, or less each of runs side by side,
// for the first signal that has data; nothing without data or without room.
void trace_add_residuals(const trace_figure *t);

// Shades a run's contact, or where the controller was in its second mode.
void trace_shade(owned_figure *o, const trace *rows, bool modes);

// A figure of panels (1 to FIGURE_PANELS, of known signals) of runs (1 to TRACE_RUNS),
// which must outlive it, with an additional last panel of residuals if there are
// reference data. `title` is plain, NULL for the first scenario's. Runs with ranks are
// those of trace_compare_create.
owned_figure *trace_figure_create(const char *title, const trace_panel *panels,
                                  int panel_count, const trace_run *runs, int run_count);

// Runs side by side, each with its rank, then reference data without one. Each signal of
// the panels has a panel of its own; beyond RUNS_TOGETHER runs each run has a row of them
// with the first run in grey behind it. The caption says what the runs share, the key
// what differs. Marks, shading and insets, which would be those of one run, are left out.
owned_figure *trace_compare_create(const char *title, const trace_panel *panels,
                                   int panel_count, const trace_run *runs, int run_count);

// The panels that such a figure needs without residuals; it has room for FIGURE_PANELS.
int trace_compare_panels(const trace_panel *panels, int panel_count,
                         const trace_run *runs, int run_count);

// The default panels of a run, of runs side by side, and of runs in small multiples.
enum { USUAL_PANELS = 4 };
extern const trace_panel usual_panels[USUAL_PANELS];
extern const trace_panel together_panels[USUAL_PANELS];
enum { MULTIPLE_PANELS = 2 };
extern const trace_panel multiple_panels[MULTIPLE_PANELS];

// The picture of `run --plot`: contact force with the impulses, angles, angular
// velocities and the voltage over time, together with an older run of the scenario
// (`old`, may be NULL) and with notes, marks with plain texts, written to path by
// figure_write.
status plot_run(const scenario *s, const run_result *result, const run_result *old,
                const figure_mark *notes, int note_count, const char *path, fault *f);

// --- reference data: trace_series.c

// Reads measured data, FILE.csv[:COLUMN][@SHIFT]. The file's first line names its
// columns, with or without unit ("time[s],force[N]"): "time" and at least one more. A
// column with the name of a recorded signal is drawn over that signal. COLUMN selects a
// single column; if its name is not a signal, it is drawn over the first signal of the
// panels with its unit. SHIFT [s] is added to every time; times that are ten times later
// than the data are long, such as the time of day, count from the first row. Empty cells
// are not drawn,
// columns with other names are ignored. Fills an empty trace, to be freed with
// trace_finish also on failure, and a name for the legend, to be freed with g_free.
// STATUS_CANNOT_READ for the file, STATUS_BAD_ARGUMENT with path and line for its
// contents.
status overlay_read(trace *t, const char *spec, const trace_panel *panels,
                    int panel_count, char **name, fault *f);

// The same with separate path, column (NULL: all that are signals) and shift.
status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name,
                           fault *f);

// --- internal to these figures: curves, labels, marks and events

// Whether a run has a signal of a panel to show: not the first link's where it equals the
// hub's, and of data only what was measured: trace_series.c
bool trace_shows(const trace_run *run, const trace_panel *panel, int index);

// --- labels: trace_labels.c. Free the texts with g_free.

// Whether the hub is rigidly joined to the first link.
bool trace_hub_is_first_link(const scenario *s);

// Name of a mode of the scenario's controller, NULL if it is not known.
const char *trace_mode_name(const scenario *s, int mode);

// "θ1  hub" for a legend; with `joined` a hub that is part of the first link is named as
// both.
char *trace_series_label(const scenario *s, int index, bool joined);

// The same without words.
char *trace_series_symbol(const scenario *s, int index);

// The vertical axis of a panel, named after its first signal, whose symbol names the
// body.
figure_axis trace_signal_axis(const trace_figure *t, const trace_panel *from);

// Model, links, drive and method as far as all runs share them, in one line without a
// full stop, in lower case.
char *trace_shared(const trace_run *runs, int run_count);

// Adds the version and, of each run that failed, why.
void trace_add_ending(GString *out, const trace_run *runs, int run_count);

// What the first run is and what is shaded in one line; of several runs, which of them
// the shading and the marks belong to.
char *trace_caption(const trace_run *runs, int run_count, const char *shaded);

// --- what happened: trace_series.c

// Marks contact, peak, release and changes by the script; on the rig changes of mode.
void trace_mark_events(owned_figure *o, const trace_run *run);

// The impulses of all impacts, kept by the figure.
figure_impulse *trace_impulses(const trace *rows, int *count, owned_figure *o);

// Adds the impulses of a run in its colour to those that a panel has: trace_compare.c
void trace_add_impulses(owned_figure *o, figure_panel *panel, const trace_run *run);
