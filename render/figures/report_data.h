// What the web page of a report needs of a figure besides its drawing.
#pragma once

#include "render/figures/figures.h"

// True if a script can draw the figure from its data: curves over one axis, no maps and
// no curves in a plane.
bool report_is_of_curves(const figure *fig);

// Appends the attributes data-panels and data-marks: panels with curves, impulses and
// levels, and what crosses all of them, as JSON. `seen` is what painting reported.
void report_add_data(GString *html, const figure *fig, const figure_report *seen);

// Appends a style by which drawings have the dark theme's colours on a dark screen.
void report_add_dark_colours(GString *css);
