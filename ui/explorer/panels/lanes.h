// The lanes below the curves, on the same time axis: contact of each run, the controller's mode,
// intervals in which the hub sticks or the command exceeds its limit, locks and changes. Above
// them, if the curves show only a part of the run, a map of the whole run.
#pragma once

#include "ui/explorer/panels/panel.h"

// Examines the rows that a run has gained since the last picture, so that empty lanes are omitted.
void lanes_survey(const explorer_state *st, lane_survey *known);

// The number of rows of the lanes below curves of a given height.
int lanes_rows(const explorer_state *st, const lane_survey *known, int height);

// Draws the lanes in the number of rows given by lanes_rows; the area has the same columns as the
// curves and their labels.
void draw_lanes(const explorer_state *st, layout *lay, screen *s, area a);

// The mouse on a lane moves the cursor, on the map it moves the visible part.
bool lanes_point(explorer_state *st, const panel_gesture *g);
