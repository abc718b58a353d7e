// Figures of recorded runs.
#pragma once

#include "render/plot/trace_figure.h"

// Describes the panels (at most FIGURE_PANELS) of the runs (at most TRACE_RUNS). `title` is plain,
// NULL for the first scenario's. The runs must outlive the figure. STATUS_BAD_ARGUMENT for an
// unknown signal, STATUS_NO_MEMORY; on failure nothing has to be finished.
status trace_figure_init(trace_figure *t, const char *title, const trace_panel *panels,
                         int panel_count, const trace_run *runs, int run_count, fault *f);
void trace_figure_finish(trace_figure *t);

// The default panels of a run.
enum { USUAL_PANELS = 4 };
extern const trace_panel usual_panels[USUAL_PANELS];

// The picture of `run --plot`: contact force with the impulses, angles, angular velocities and the
// voltage over time, together with an older run of the scenario (`old`, may be NULL), written to
// path by figure_write.
status plot_run(const scenario *s, const run_result *result, const run_result *old,
                const char *path, fault *f);
