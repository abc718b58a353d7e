// The mouse in the panes of curves: the cursor, zooming and panning, axes that are dragged.
#pragma once

#include "ui/explorer/panels/panel.h"

// Takes a gesture in the plot, on the time axis, on an axis of values; false if the gesture does
// nothing there.
bool curves_point_at_plot(explorer_state *st, const panel_gesture *g);
bool curves_point_at_time_axis(explorer_state *st, const panel_gesture *g);
bool curves_point_at_labels(explorer_state *st, const panel_gesture *g);
