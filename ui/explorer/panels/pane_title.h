// The first line of a pane: its number, unit and curves.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// The lines and colours of a pane's signals: those of the signal table, but no two the same.
typedef struct pane_look {
    ink colour[PANE_SIGNALS];
    line_style style[PANE_SIGNALS];
} pane_look;

// How the signals of a pane are drawn.
pane_look pane_look_of(const explorer_state *st, const pane *p);

// The pane's number, its unit, its signals with their values at the cursor as far as there is room,
// and the mode of its axis, in the first row of the pane's area.
void draw_pane_title(const explorer_state *st, screen *s, int index, area a);
