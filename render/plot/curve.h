// From a series' numbers to lines: gaps, decimation and clipping.
#pragma once

#include "render/plot/axis.h"

// A rectangle on the page and the values at its edges.
typedef struct plane {
    figure_rect box; // [pt]
    axis_scale x, y; // from left to right, from bottom to top
} plane;

double plane_x(const plane *p, double x);
double plane_y(const plane *p, double y);

typedef enum stroke_kind {
    STROKE_MOVE, // a new line begins
    STROKE_LINE, // the line continues to
    STROKE_DOT   // a point without neighbours
} stroke_kind;

typedef void (*stroke_sink)(void *context, stroke_kind kind, double x, double y);

// Value number `index` of a series' x, y or shade.
double series_x(const figure_series *s, size_t index);
double series_y(const figure_series *s, size_t index);
double series_shade(const figure_series *s, size_t index);

// Widens a scale to include every y of a series at an x inside *within.
void series_include_y(const figure_series *s, const axis_scale *within, axis_scale *y);

// Passes the series' line to the sink, in page coordinates, clipped to the plane with a small
// margin. Where many points fall on one column of 1/600 inch, the first, lowest, highest and last
// of them are kept, so that no spike is lost.
void curve_trace(const plane *p, const figure_series *s, stroke_sink sink, void *context);
