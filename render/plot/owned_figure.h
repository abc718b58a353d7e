// A figure of one panel that keeps what it borrows: texts, axes and numbers made for it alone.
#pragma once

#include <glib.h>

#include "render/plot/plot.h"

typedef struct owned_figure {
    figure figure;
    figure_panel panel;                 // the figure's only one
    figure_series series[PANEL_SERIES]; // the panel's
    GPtrArray *kept;                    // blocks
} owned_figure;

// An empty figure with its panel, which shows none of the series yet, and the program's name and
// version. Give it to owned_figure_destroy (which takes NULL, too).
owned_figure *owned_figure_create(void);
void owned_figure_destroy(owned_figure *o);

// Lets the figure own a block of g_malloc's, and returns it.
void *owned_figure_keep(owned_figure *o, void *block);
