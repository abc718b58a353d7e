// The first line of a pane: its number and unit, and what its curves are.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// How a pane's signals are drawn: as their table says, but no two alike.
typedef struct pane_look {
    ink colour[PANE_SIGNALS];
    line_style style[PANE_SIGNALS];
} pane_look;

// How the signals of a pane are drawn.
pane_look pane_look_of(const explorer_state *st, const pane *p);

// The pane's number, its unit, its signals with their values at the cursor as far as there is room,
// and what its axis does, in the first row of the pane's area.
void draw_pane_title(const explorer_state *st, screen *s, int index, area a);
