// A figure of one panel that owns what it borrows: texts, axes and numbers made for it.
#pragma once

#include <glib.h>

#include "render/plot/plot.h"

typedef struct owned_figure {
    figure figure;
    figure_panel panel;                 // the figure's only one
    figure_series series[PANEL_SERIES]; // the panel's
    GPtrArray *kept;                    // blocks
} owned_figure;

// An empty figure with its panel, which has no series yet, and the program's name and version. To
// be freed with owned_figure_destroy, which accepts NULL.
owned_figure *owned_figure_create(void);
void owned_figure_destroy(owned_figure *o);

// Gives a block from g_malloc to the figure, and returns it.
void *owned_figure_keep(owned_figure *o, void *block);
