// From a series' numbers to what can be drawn: gaps, decimation and clipping.
#pragma once

#include "render/plot/plot.h"

// A rectangle on the page and what its edges stand for.
typedef struct plane {
    figure_rect box;      // [pt]
    double x_low, x_high; // left and right edge
    double y_low, y_high; // bottom and top edge
} plane;

double plane_x(const plane *p, double x);
double plane_y(const plane *p, double y);

typedef enum stroke_kind {
    STROKE_MOVE, // a new line begins
    STROKE_LINE, // the line goes on to
    STROKE_DOT   // a point without neighbours
} stroke_kind;

typedef void (*stroke_sink)(void *context, stroke_kind kind, double x, double y);

// Value number `index` of a series' x or y.
double series_x(const figure_series *s, size_t index);
double series_y(const figure_series *s, size_t index);

// Smallest and largest finite x, or finite y at an x within [x_low, x_high], widening low and high.
void series_x_range(const figure_series *s, double *low, double *high);
void series_y_range(const figure_series *s, double x_low, double x_high, double *low, double *high);

// Gives the series' line to the sink, in page coordinates, clipped to the plane and a little more.
// Where many points fall on one column of 1/600 inch, the first, lowest, highest and last of them
// are kept, so that no spike is lost.
void curve_trace(const plane *p, const figure_series *s, stroke_sink sink, void *context);
