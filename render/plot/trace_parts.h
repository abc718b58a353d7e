// Internal to figures of recorded runs: labels, marks and events.
#pragma once

#include "render/plot/trace_plot.h"

enum { TRACE_ACTIONS = 16, TRACE_MARKS = 3 + TRACE_ACTIONS };

// Adds a block, mostly a text, to those that are freed with the figure.
void *trace_keep(GPtrArray *owned, void *block);

// --- labels: trace_labels.c. Free the texts with g_free.

// Whether the run was on the rig, with a controller.
bool trace_on_the_rig(const scenario *s);

// Whether the hub is rigidly joined to the first link.
bool trace_hub_is_first_link(const scenario *s);

// Name of a mode of the scenario's controller, NULL if it is not known.
const char *trace_mode_name(const scenario *s, int mode);

// "θ1  hub" for a legend; with `joined` a hub that is part of the first link is named as both.
char *trace_series_label(const scenario *s, int index, bool joined);

// The same without words.
char *trace_series_symbol(const scenario *s, int index);

// "Contact force f", without the body, which the symbol names.
char *trace_axis_label(const scenario *s, const signal_info *signal);

// Model, links, drive, method and what is shaded in one line; of several runs, which of them the
// shading and the marks belong to.
char *trace_caption(const trace_run *runs, int run_count, const char *shaded);

// --- runs side by side: trace_figure.c

// Whether a run has a signal of a panel to show: not the first link's where it equals the hub's,
// and of data only what was measured.
bool trace_shows(const trace_run *run, const trace_panel *panel, int index);

// Slot of the colour of a run with a rank.
int trace_run_colour(const trace_run *run);

// Gives signals that stand in one panel different lines, and the figure one key for all panels of
// both runs and signals; does nothing where no run has a rank. Before the panels are described.
void trace_make_key(trace_figure *t, const trace_panel *panels, const trace_run *runs,
                    int run_count);

// The line of a signal by that key, solid of one that it does not have.
line_style trace_line(const trace_figure *t, int index);

// --- what happened: trace_series.c

// Marks contact, peak, release and changes by the script; on the rig changes of mode.
void trace_mark_events(trace_figure *t, const trace_run *run, GPtrArray *texts);

bool trace_in_contact(const sample *row);
bool trace_in_second_mode(const sample *row);

// Intervals from each first row with the property to the next one without it. Only counts them if
// `out` is NULL.
int trace_intervals(const trace *rows, bool (*is_so)(const sample *row), figure_interval *out);

// The impulses of all impacts. Only counts them if `out` is NULL.
int trace_impulses(const trace *rows, figure_impulse *out);
