// The whole screen of the explorer: title, panels, page, status and prompt.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// Whether a screen has room for the explorer; what is drawn on a smaller one says so.
bool compose_fits(screen_size size);

// Draws everything, from a state that is up to date. The screen's size decides the layout.
void compose_screen(const explorer_state *st, layout *lay, screen *s);
