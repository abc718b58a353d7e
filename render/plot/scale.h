// Scales: from values to positions between the two ends of an axis.
#pragma once

#include <stdbool.h>

typedef enum scale_kind { SCALE_LINEAR, SCALE_LOGARITHMIC } scale_kind;

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

// Separates equal ends (0 and 1 if there are none; at least half a decade on a logarithmic scale)
// and then moves them outwards by a share of the range.
void scale_widen(axis_scale *s, double share);
