// Sliders of parameters: what they span, and the one that the mouse holds. A value that is dragged
// takes effect with the next picture: the run follows the mouse.
#pragma once

#include <stdbool.h>

// What a slider spans.
typedef struct slider_scale {
    double low, high; // in the parameter's unit
    bool logarithmic;
} slider_scale;

// The slider that the mouse holds.
typedef struct slider_grip {
    bool held;
    int parameter;
    double value;
    slider_scale scale;
} slider_grip;

// What a slider of a parameter spans round a value; false if it is no number.
bool slider_scale_of(int parameter, double value, slider_scale *scale);

// Where on a scale a value lies, 0 to 1.
double slider_share(const slider_scale *scale, double value);

// The value at a share of a scale, rounded to what a cell of `cells` can tell and kept within the
// parameter's range.
double slider_value(const slider_scale *scale, int parameter, double share, int cells);
