// Scales, from values to positions between the two ends of an axis; axes ready to be
// drawn, with their ticks; and the lines of a series between them.
#pragma once

#include <stdbool.h>

#include "render/plot/figure_description.h"
#include "render/plot/ticks.h"

// A scale's ends are coordinates: values, or their decimal logarithms.
typedef struct axis_scale {
    scale_kind kind;
    double low, high;
} axis_scale;

// The coordinate of a value; not finite if the scale cannot show it.
double scale_coordinate(scale_kind kind, double value);
// The value at a coordinate.
double scale_value(scale_kind kind, double coordinate);

// The position of a value, 0 at the low end and 1 at the high end.
double scale_share(const axis_scale *s, double value);

// Whether a value lies between the ends.
bool scale_holds(const axis_scale *s, double value);

// An empty scale; and widening a scale to include a value that it can show.
axis_scale scale_empty(scale_kind kind);
void scale_include(axis_scale *s, double value);
bool scale_is_empty(const axis_scale *s);

// An axis' own ends; false if it takes those of the data, with an empty scale.
bool scale_take_ends(axis_scale *s, const figure_axis *from);

// Separates equal ends (0 and 1 if there are none; at least half a decade on a
// logarithmic scale) and then moves them outwards by a share of the range.
void scale_widen(axis_scale *s, double share);

// --- axes

enum { AXIS_LABEL = 48, AXIS_MINOR = 512 };

typedef struct axis {
    const figure_axis *from;
    axis_scale scale;
    ticks even;                       // of a linear axis, otherwise empty
    int count;                        // of ticks
    double at[TICKS_MOST];            // values, ascending
    const char *text[TICKS_MOST];     // labels; "" for none
    char own[TICKS_MOST][AXIS_LABEL]; // storage of generated labels
} axis;

// Chooses about `wanted` ticks for the axis' scale.
void axis_choose_ticks(axis *a, const figure_axis *from, int wanted);

// The number of ticks of an axis of the given length, one every `spacing` [pt].
int axis_tick_count(double length, double spacing, int least, int most);

// Values of the minor ticks of an axis of the given length [pt]; none if they would be
// too close.
int axis_minor_ticks(const axis *a, double length, double at[AXIS_MINOR]);

// Label, unit and factor of the axis, as markup. To be freed with g_free.
char *axis_title(const axis *a);

// A label with its unit and a factor of 10^exponent, as markup. To be freed with g_free.
char *axis_label_text(const char *label, const char *unit, int exponent);

// --- from a series' numbers to lines: gaps, decimation and clipping: curve.c

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

// The line style of series `index` of a panel: its own, or where an earlier series has
// that one, the plainest that is free.
line_style untaken_style(const figure_series *series, int index);
double series_shade(const figure_series *s, size_t index);

// Widens a scale to include every y of a series at an x inside *within.
void series_include_y(const figure_series *s, const axis_scale *within, axis_scale *y);

// Passes the series' line to the sink, in page coordinates, clipped to the plane with a
// small margin. Where many points fall on one column of 1/600 inch, the first, lowest,
// highest and last of them are kept, so that no spike is lost.
void curve_trace(const plane *p, const figure_series *s, stroke_sink sink, void *context);
