// Sliders of parameters: their ranges, and the one that is being dragged. A dragged value takes
// effect with the next picture.
#pragma once

#include <stdbool.h>

// The range of a slider.
typedef struct slider_scale {
    double low, high; // in the parameter's unit
    bool logarithmic;
} slider_scale;

// The slider that is being dragged.
typedef struct slider_grip {
    bool held;
    int parameter;
    double value;
    slider_scale scale;
} slider_grip;

// The range of a parameter's slider about a value; false if the parameter is not a number.
bool slider_scale_of(int parameter, double value, slider_scale *scale);

// The position of a value on a scale, 0 to 1.
double slider_share(const slider_scale *scale, double value);

// The value at a share of a scale, rounded to the resolution of a scale of `cells` cells and
// limited to the parameter's range.
double slider_value(const slider_scale *scale, int parameter, double share, int cells);
