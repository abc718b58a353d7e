// Free places in a panel, found by the ink in each cell of a grid.
#include <math.h>

#include "render/plot/drawing.h"

static int cell_column(const placement *g, double x)
{
    return (int)floor((x - g->box.x) / g->box.width * PLACEMENT_COLUMNS);
}

static int cell_row(const placement *g, double y)
{
    return (int)floor((y - g->box.y) / g->box.height * PLACEMENT_ROWS);
}

// Gives a cell of the grid at least a weight of ink.
static void add_ink(placement *g, int row, int column, int weight)
{
    if (row >= 0 && row < PLACEMENT_ROWS && column >= 0 && column < PLACEMENT_COLUMNS) {
        g->ink[row + 1][column + 1] = fmax(g->ink[row + 1][column + 1], weight);
    }
}

// Adds ink to the cells along a line, in steps of at most half a cell.
void placement_line(placement *g, double x0, double y0, double x1, double y1, int weight)
{
    double across = fabs(x1 - x0) / g->box.width * PLACEMENT_COLUMNS;
    double down = fabs(y1 - y0) / g->box.height * PLACEMENT_ROWS;
    int steps = 1 + (int)fmin(2 * fmax(across, down), 4 * PLACEMENT_COLUMNS);
    for (int i = 0; i <= steps; i++) {
        double t = (double)i / steps;
        add_ink(g, cell_row(g, y0 + t * (y1 - y0)), cell_column(g, x0 + t * (x1 - x0)),
                weight);
    }
}

// Adds ink to every cell that a rectangle touches.
void placement_block(placement *g, figure_rect r, int weight)
{
    int last_row = cell_row(g, r.y + r.height),
        last_column = cell_column(g, r.x + r.width);
    for (int row = cell_row(g, r.y); row <= last_row; row++) {
        for (int column = cell_column(g, r.x); column <= last_column; column++) {
            add_ink(g, row, column, weight);
        }
    }
}

// The sum of the ink in all cells that a rectangle touches.
double placement_ink(const placement *g, figure_rect r)
{
    double sum = 0;
    int last_row = cell_row(g, r.y + r.height),
        last_column = cell_column(g, r.x + r.width);
    for (int row = cell_row(g, r.y); row <= last_row; row++) {
        for (int column = cell_column(g, r.x); column <= last_column; column++) {
            bool inside = row >= 0 && row < PLACEMENT_ROWS && column >= 0 &&
                          column < PLACEMENT_COLUMNS;
            if (inside) {
                sum += g->ink[row + 1][column + 1];
            }
        }
    }
    return sum;
}
