// Dash patterns of curves, so that signals and runs can be distinguished without colours.
#pragma once

#include "src/tables/signals.h"
#include "ui/terminal/screen.h"

// Sixteen dots, repeated: bit i is dot i.
unsigned style_pattern(line_style style);
// The line of a pinned run, different for each.
unsigned run_pattern(int index);

// Whether a line has a dot at a column of dots.
bool line_has_dot(unsigned pattern, long across);

// A short piece of a line for a legend, `cells` wide.
void draw_line_sample(screen *s, int x, int y, int cells, unsigned pattern, ink colour);
