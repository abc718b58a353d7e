// The lines above and below the panels, and the message on a screen that is too small for panels.
#pragma once

#include "ui/explorer/state/state.h"
#include "ui/terminal/screen.h"

void draw_title(const explorer_state *st, screen *s);
void draw_status(const explorer_state *st, screen *s, int y);

// Draws the prompt, the message or hints in the last rows and returns how many it took.
int draw_bottom(const explorer_state *st, screen *s);

// Shows that the screen is too small, in the longest text that fits.
void draw_too_small(screen *s);
