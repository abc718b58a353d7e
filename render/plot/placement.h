// Finds free places in a panel by a grid of cells with the amount of ink in each.
#pragma once

#include "render/plot/plot.h"

enum { PLACEMENT_COLUMNS = 160, PLACEMENT_ROWS = 96 };

// The cost of covering a cell.
enum { INK_FAINT = 1, INK_CURVE = 1000 };

typedef struct placement {
    figure_rect box; // the area divided into cells [pt]
    // ink[r + 1][c + 1] belongs to cell (r, c)
    double ink[PLACEMENT_ROWS + 1][PLACEMENT_COLUMNS + 1];
} placement;

void placement_init(placement *g, figure_rect box);

// Adds the ink of a line, or of a filled rectangle.
void placement_line(placement *g, double x0, double y0, double x1, double y1, int weight);
void placement_block(placement *g, figure_rect r, int weight);

// The ink under a rectangle.
double placement_ink(const placement *g, figure_rect r);

// The place of a width x height rectangle, `margin` from the box's edges, with the least ink under
// it; among equal ones the nearest to a corner, preferring the right to the left and the top to the
// bottom. Returns the ink under it (INFINITY if the box is too small).
double placement_find(const placement *g, double width, double height, double margin,
                      figure_rect *found);
