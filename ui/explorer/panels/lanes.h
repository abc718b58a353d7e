// The lanes below the curves, one timeline with them: contact of each run, the controller's mode,
// where the hub sticks, where the command is beyond its limit, locks and changes; and above them,
// where the curves show a part of the run, a map of the whole.
#pragma once

#include "ui/explorer/panels/panel.h"

// Looks at what a run has come to since the last picture, so that lanes without anything in them
// are left out.
void lanes_survey(const explorer_state *st, lane_survey *known);

// Rows that they take below curves of a height.
int lanes_rows(const explorer_state *st, const lane_survey *known, int height);

// Draws them, as many rows as lanes_rows said; the area has the columns of the curves with their
// labels.
void draw_lanes(const explorer_state *st, layout *lay, screen *s, area a);

// The mouse on a lane moves the cursor, on the map it moves the visible part.
bool lanes_point(explorer_state *st, const panel_gesture *g);
