// The thesis's figures of simulated motion, drawn from the lab's own runs.
#pragma once

#include "render/trace_plot.h"

enum { THESIS_PANELS = 3 };

typedef struct thesis_figure {
    const char *id;       // "3.4"
    const char *file;     // name of its files without extension, "fig-3-4"
    const char *caption;  // plain, one line
    const char *scenario; // "thesis/fig-3-4"
    trace_panel panels[THESIS_PANELS];
    int panel_count;
} thesis_figure;

extern const thesis_figure thesis_figures[];
extern const int thesis_figure_count;

// A figure by its id or the name of its files, or NULL.
const thesis_figure *thesis_figure_find(const char *id);

// Runs the figure's scenario, and once more with the corrected model as a thin dashed line; draws
// FOLDER/fig-3-4.png and so on for every format in the list ("png,pdf,svg") and writes
// FOLDER/fig-3-4.csv. The folder is created if it is not there. STATUS_BAD_ARGUMENT for an unknown
// id or format, otherwise what the run or the writing returns.
status figure_draw(const char *id, const char *folder, const char *formats, fault *f);
