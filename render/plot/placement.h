// Finds free places in a panel: a grid of cells that knows where ink is.
#pragma once

#include "render/plot/plot.h"

enum { PLACEMENT_COLUMNS = 160, PLACEMENT_ROWS = 96 };

// How much a cell minds being covered.
enum { INK_FAINT = 1, INK_CURVE = 1000 };

typedef struct placement {
    figure_rect box; // what the cells divide [pt]
    // ink[r + 1][c + 1] belongs to cell (r, c)
    double ink[PLACEMENT_ROWS + 1][PLACEMENT_COLUMNS + 1];
} placement;

void placement_init(placement *g, figure_rect box);

// Marks a line, or a filled rectangle.
void placement_line(placement *g, double x0, double y0, double x1, double y1, int weight);
void placement_block(placement *g, figure_rect r, int weight);

// The ink under a rectangle.
double placement_ink(const placement *g, figure_rect r);

// The place of a width x height rectangle, `margin` from the box's edges, with the least ink under
// it; among equal ones the nearest to a corner, at the right rather than the left, above rather
// than below. Returns the ink under it (INFINITY if the box is too small).
double placement_find(const placement *g, double width, double height, double margin,
                      figure_rect *found);
