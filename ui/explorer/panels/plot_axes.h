// The axes of the curves: values on the left of each pane, time below all of them.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// An axis of values in its column, its line at the right; the area's rows are the axis.
void draw_value_axis(screen *s, area a, value_range axis);

// The time axis below the curves: contact as a bar, impacts and changes as marks, seconds. Returns
// the area of its line and numbers.
area draw_time_axis(const explorer_state *st, screen *s, area a);
