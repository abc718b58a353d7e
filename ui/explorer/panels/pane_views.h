// Panes whose axis is not time: one signal over another, and the spectrum of a signal.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// Draws a pane's inside; its signals are those of a view that is not over time. *axis is the range
// of its axis of values. False, with nothing drawn, if there are no values.
bool draw_pane_view(const explorer_state *st, screen *s, const pane *p, area a, value_range *axis);
