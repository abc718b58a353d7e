// Colours and line patterns of figures.
#pragma once

#include <cairo.h>

#include "render/plot/plot.h"

typedef struct colour {
    double red, green, blue;
} colour;

// What everything but the curves is drawn in.
typedef struct palette {
    colour page, text, faint_text, axis, grid, shade, mark;
} palette;

const palette *palette_of(figure_theme theme);

// The colour of a slot, 0-7; in a mono figure by the series' place in its panel.
colour palette_series(figure_theme theme, int slot, int place);

// The style of the series `index` among a panel's: its own, or the next that no earlier one has.
line_style palette_style(const figure_series *series, int index);

void set_colour(cairo_t *cr, colour c);

// Sets the dash pattern for a line of the given width.
void set_line_style(cairo_t *cr, line_style style, double width);
