// Writes cells to the terminal without ncurses, in colours that ncurses cannot address.
#pragma once

#include <stddef.h>

#include "ui/terminal/screen.h"

// Sends all bytes to the terminal, however slowly it accepts them.
void terminal_send(const char *bytes, size_t count);

// Writes the cells that differ from `shown` (all of them if `whole`; the terminal is empty then)
// and copies them to it. Both screens have the same size.
void paint_cells(const screen *s, screen *shown, glyph_set glyphs, colour_theme theme,
                 colour_depth depth, bool whole);
