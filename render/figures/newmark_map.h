// Maps over Newmark's two parameters: one number of a run for every pair, at three settings side by
// side.
#pragma once

#include "render/figures/artwork.h"

enum { MAP_PANELS = 3, MAP_LAYERS = 4, MAP_COLUMNS = 40, MAP_ROWS = 30, MAP_RINGS = 3 };

// A map with everything its figure borrows. Fill the first block, then compute and open.
typedef struct newmark_map {
    int columns, rows;                  // of cells, up to MAP_COLUMNS and MAP_ROWS
    const char *headings[MAP_PANELS];   // markup
    figure_axis scale;                  // of the numbers
    bool reversed;                      // low values are bright
    char *title, *caption, *parameters; // owned
    // the number of a pair in a panel, from a run of its own on any thread; not finite if the run
    // failed
    double (*value)(const void *context, int panel, double beta, double gamma);
    void *context; // for value
    void (*release)(void *context);

    figure figure;
    figure_panel panels[MAP_PANELS];
    figure_series layers[MAP_PANELS][MAP_LAYERS];
    int layer_count;
    figure_map maps[MAP_PANELS];
    figure_colours colours[MAP_PANELS];
    double beta[MAP_COLUMNS], gamma[MAP_ROWS]; // middles of the cells
    double values[MAP_PANELS][MAP_COLUMNS * MAP_ROWS];
    double ring_beta[MAP_RINGS], ring_gamma[MAP_RINGS];
    double ring_value[MAP_PANELS][MAP_RINGS];
    int next; // next cell to be computed
} newmark_map;

// Computes all cells, on two threads, and draws the bounds of Table 3.1 and the thesis's pair on
// them.
void newmark_map_compute(newmark_map *m);

// Adds markers coloured by values of their own: `ring_value` at `ring_beta`, `ring_gamma`, which
// must be filled. label is markup.
void newmark_map_add_rings(newmark_map *m, const char *name, const char *label);

// Describes the figure, which then owns the map.
artwork newmark_map_open(newmark_map *m, const figure_options *o);
