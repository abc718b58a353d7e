// Internal to the drawing of recipes: a figure with everything it borrows.
#pragma once

#include "render/figures/recipe_model.h"
#include "render/figures/run_figure.h"
#include "src/study/store/sweep_store.h"

// A source with its run or data.
typedef struct opened_source {
    opened_run run;                       // of a run
    bool ran;                             // the run must be finished
    run_result data;                      // of data: its trace alone
    double *columns[SWEEP_TABLE_COLUMNS]; // of a table: x, y and z
    size_t count;                         // of their values
} opened_source;

// A figure with everything it borrows.
typedef struct recipe_figure {
    recipe recipe;
    char *path;
    opened_source sources[RECIPE_SOURCES];
    figure figure;
    figure_panel panels[FIGURE_PANELS];
    figure_series series[FIGURE_PANELS][PANEL_SERIES];
    figure_note notes[FIGURE_PANELS][RECIPE_NOTES];
    figure_mark marks[RECIPE_MARKS];
    figure_interval *intervals;
    figure_map maps[FIGURE_PANELS];
    figure_colours colours[FIGURE_PANELS];
    GPtrArray *owned;
} recipe_figure;

// Adds a block to those that are freed with the figure.
void *recipe_own(recipe_figure *fig, void *block);

// --- tables: recipe_table.c

// The legend text of a source, markup.
const char *recipe_label(recipe_figure *fig, const recipe_source *s);

// The colour of curve number `index` of a panel; the first ones differ most.
int recipe_colour(int index);

// The axis of a table's column: label and unit of a parameter or summary quantity, otherwise the
// key itself.
figure_axis recipe_column_axis(recipe_figure *fig, const char *key);

// Draws a table in a panel: a curve, or with a third column a map if the points form a grid,
// otherwise dots.
void recipe_add_table(recipe_figure *fig, int panel, int source);
