// The displayed list of parameters, in groups, and filtered; their sliders.
#pragma once

#include <stdbool.h>

#include "src/scenario/scenario.h"

enum { PARAMETER_LINES = 256, PARAMETER_NAME = 80, MOST_KNOBS = 9 };

typedef struct parameter_list {
    bool all;              // all groups are shown, and not the knobs alone
    int knobs[MOST_KNOBS]; // the few parameters that the run is about
    int knob_count;
    int parameter; // selected, index in parameter_table
} parameter_list;

// A line: a parameter, or the heading of the group whose first parameter it is.
typedef struct parameter_line {
    int parameter;
    bool heading;
} parameter_line;

// The group of a parameter, which is the index of the first one in it, and its name
// ("motor").
int parameter_group(int parameter);
void parameter_group_name(int parameter, char *name, size_t size);

// Whether the knobs are shown and not all parameters: as long as nothing is filtered.
bool parameter_list_is_brief(const parameter_list *list, const char *filter);

// Fills the lines that are shown and returns how many: the knobs with the selected
// parameter, or those of all groups that pass a filter. *selected is the index of the
// selected parameter's line, else of its group's heading, else 0.
int parameter_list_lines(const parameter_list *list, const char *filter,
                         parameter_line lines[PARAMETER_LINES], int *selected);

// The parameter of a path, of its last part or of a beginning of either, if only one has
// it; -1 if none has, -2 if several have.
int parameter_of_name(const char *name);

// --- sliders ---------------------------------------------------------------------------
// Their ranges, and the one that is being dragged. A dragged value takes
// effect with the next picture.

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

// The range of a parameter's slider about a value; false if the parameter is not a
// number.
bool slider_scale_of(int parameter, double value, slider_scale *scale);

// The position of a value on a scale, 0 to 1.
double slider_share(const slider_scale *scale, double value);

// The value at a share of a scale, rounded to the resolution of a scale of `cells` cells
// and limited to the parameter's range.
double slider_value(const slider_scale *scale, int parameter, double share, int cells);
