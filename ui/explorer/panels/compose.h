// The whole screen of the explorer: title, panels, page, status and prompt.
#pragma once

#include "ui/explorer/panels/panel.h"
#include "ui/terminal/screen.h"

// Whether a screen has room for the explorer; on a smaller one only a message is drawn.
bool compose_fits(screen_size size);

// Draws everything from an up-to-date state; the layout depends on the screen's size.
void compose_screen(const explorer_state *st, layout *lay, screen *s);
