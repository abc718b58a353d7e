// Internal to figures of recorded runs: labels, marks and events.
#pragma once

#include "render/plot/trace_plot.h"

// --- labels: trace_labels.c. Free the texts with g_free.

// Whether the hub is rigidly joined to the first link.
bool trace_hub_is_first_link(const scenario *s);

// Name of a mode of the scenario's controller, NULL if it is not known.
const char *trace_mode_name(const scenario *s, int mode);

// "θ1  hub" for a legend; with `joined` a hub that is part of the first link is named as both.
char *trace_series_label(const scenario *s, int index, bool joined);

// The same without words.
char *trace_series_symbol(const scenario *s, int index);

// Model, links, drive, method and what is shaded in one line; of several runs, which of them the
// shading and the marks belong to.
char *trace_caption(const trace_run *runs, int run_count, const char *shaded);

// --- what happened: trace_series.c

// Marks contact, peak, release and changes by the script; on the rig changes of mode.
void trace_mark_events(owned_figure *o, const trace_run *run);

// The impulses of all impacts, kept by the figure.
figure_impulse *trace_impulses(const trace *rows, int *count, owned_figure *o);
