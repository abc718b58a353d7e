// Pictures of a sweep: one quantity over one or two varied parameters.
//
// One parameter: a line with markers (dots alone if the values were drawn at random or are words).
// Two: a heat map with contour lines and a colour bar (coloured dots if the values were drawn at
// random). A logarithmic range has a logarithmic axis.
#pragma once

#include <cairo.h>

#include "render/plot/plot.h"
#include "src/study/sweep.h"

typedef struct sweep_picture {
    const sweep *sweep;
    const char *key;      // of the summary, "peak_force_N"
    const double *values; // of each run, NaN where there is none
    figure_theme theme;
} sweep_picture;

// Tells before long work whether a picture of the sweep can be drawn into path: STATUS_BAD_ARGUMENT
// if more than two parameters are varied or for an unknown extension, STATUS_CANNOT_WRITE if the
// path cannot be written, STATUS_CANNOT_READ if the font is missing.
status sweep_plot_check(const sweep *s, const char *path, fault *f);

// Draws the picture with the page's top left corner at the origin of cr, in points; the
// page has 150 by 100 mm. STATUS_CANNOT_READ if the font is missing.
status sweep_plot_paint(cairo_t *cr, const sweep_picture *p, fault *f);

// Draws the picture into a file, whole or not at all; the ending of its name says which kind.
status sweep_plot_write(const sweep_picture *p, const char *path, fault *f);

// The colour at share 0 ... 1 of the colour scale, each component 0 ... 1: viridis of van der Walt
// and Smith (2015, public domain), straight lines between nine of its colours. Perceptually even,
// from dark blue to yellow, and its lightness grows all the way, so that it survives a grey
// printer.
void sweep_plot_colour(double share, double rgb[3]);

// A piece of a contour line. Coordinates count grid points: x from 0 to columns - 1.
typedef struct contour_piece {
    double x0, y0, x1, y1;
} contour_piece;

// The contour of z = level within the square of four neighbouring grid points, by marching squares
// with straight lines: z[0] at (0, 0), z[1] at (1, 0), z[2] at (0, 1), z[3] at (1, 1). A saddle is
// decided by the mean of the four. Returns the number of pieces, 0 to 2; 0 if a corner is not
// finite.
int contour_square(const double z[4], double level, contour_piece pieces[2]);
