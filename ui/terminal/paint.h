// Cells written to the terminal without ncurses, in colours that it has no numbers for.
#pragma once

#include <stddef.h>

#include "ui/terminal/screen.h"

// Sends bytes to the terminal, all of them, however slowly it takes them.
void terminal_send(const char *bytes, size_t count);

// Writes the cells that differ from `shown` (all of them if `whole`; the terminal is empty then)
// and takes them into it. Both screens have the same size.
void paint_cells(const screen *s, screen *shown, glyph_set glyphs, colour_theme theme,
                 colour_depth depth, bool whole);
