#include "render/plot/drawing.h"

#include <math.h>
#include <string.h>

static int column_of(const placement *g, double x)
{
    return (int)floor((x - g->box.x) / g->box.width * PLACEMENT_COLUMNS);
}

static int row_of(const placement *g, double y)
{
    return (int)floor((y - g->box.y) / g->box.height * PLACEMENT_ROWS);
}

static void mark(placement *g, int row, int column, int weight)
{
    if (row >= 0 && row < PLACEMENT_ROWS && column >= 0 && column < PLACEMENT_COLUMNS) {
        g->ink[row + 1][column + 1] = fmax(g->ink[row + 1][column + 1], weight);
    }
}

void placement_line(placement *g, double x0, double y0, double x1, double y1, int weight)
{
    double across = fabs(x1 - x0) / g->box.width * PLACEMENT_COLUMNS;
    double down = fabs(y1 - y0) / g->box.height * PLACEMENT_ROWS;
    int steps = 1 + (int)fmin(2 * fmax(across, down), 4 * PLACEMENT_COLUMNS);
    for (int i = 0; i <= steps; i++) {
        double t = (double)i / steps;
        mark(g, row_of(g, y0 + t * (y1 - y0)), column_of(g, x0 + t * (x1 - x0)), weight);
    }
}

void placement_block(placement *g, figure_rect r, int weight)
{
    int last_row = row_of(g, r.y + r.height), last_column = column_of(g, r.x + r.width);
    for (int row = row_of(g, r.y); row <= last_row; row++) {
        for (int column = column_of(g, r.x); column <= last_column; column++) {
            mark(g, row, column, weight);
        }
    }
}

double placement_ink(const placement *g, figure_rect r)
{
    double sum = 0;
    int last_row = row_of(g, r.y + r.height), last_column = column_of(g, r.x + r.width);
    for (int row = row_of(g, r.y); row <= last_row; row++) {
        for (int column = column_of(g, r.x); column <= last_column; column++) {
            bool inside =
                row >= 0 && row < PLACEMENT_ROWS && column >= 0 && column < PLACEMENT_COLUMNS;
            sum += inside ? g->ink[row + 1][column + 1] : 0;
        }
    }
    return sum;
}

// The small cost of being away from the corners, below one unit of ink.
static double corner_cost(const placement *g, const figure_rect *r, double margin)
{
    double left = r->x - g->box.x - margin, above = r->y - g->box.y - margin;
    double right = g->box.x + g->box.width - margin - r->x - r->width;
    double below = g->box.y + g->box.height - margin - r->y - r->height;
    double across = fmin(right, left + 0.02 * g->box.width) / g->box.width;
    double down = fmin(above, below + 0.1 * g->box.height) / g->box.height;
    return 0.4 * across + 0.4 * down;
}

double placement_find(const placement *g, double width, double height, double margin,
                      figure_rect *found)
{
    placement sums = *g;
    // sums over everything above and left of each cell
    for (int r = 1; r <= PLACEMENT_ROWS; r++) {
        for (int c = 1; c <= PLACEMENT_COLUMNS; c++) {
            sums.ink[r][c] += sums.ink[r - 1][c] + sums.ink[r][c - 1] - sums.ink[r - 1][c - 1];
        }
    }

    // its size in whole cells, with the margin on both sides
    double cell_width = g->box.width / PLACEMENT_COLUMNS;
    double cell_height = g->box.height / PLACEMENT_ROWS;
    int columns = (int)ceil((width + 2 * margin) / cell_width);
    int rows = (int)ceil((height + 2 * margin) / cell_height);

    // every place where it fits, with the ink within from the sums up to its corners
    double best = (double)INFINITY, best_ink = (double)INFINITY;
    for (int r = 0; r + rows <= PLACEMENT_ROWS; r++) {
        for (int c = 0; c + columns <= PLACEMENT_COLUMNS; c++) {
            double ink = sums.ink[r + rows][c + columns] - sums.ink[r][c + columns] -
                         sums.ink[r + rows][c] + sums.ink[r][c];
            double slack_x = columns * cell_width - width - 2 * margin;
            double slack_y = rows * cell_height - height - 2 * margin;

            // against the nearer edge what rounding to cells left over is not wasted
            bool right = 2 * c > PLACEMENT_COLUMNS - columns, low = 2 * r > PLACEMENT_ROWS - rows;
            figure_rect place = {g->box.x + c * cell_width + margin + (right ? slack_x : 0),
                                 g->box.y + r * cell_height + margin + (low ? slack_y : 0), width,
                                 height};
            double cost = ink + corner_cost(g, &place, margin);
            if (cost < best) {
                best = cost;
                best_ink = ink;
                *found = place;
            }
        }
    }
    return best_ink;
}
