// Colours and line patterns of figures.
#pragma once

#include <cairo.h>

#include "render/page/page.h"
#include "src/tables/signals.h"

typedef struct colour {
    double red, green, blue;
} colour;

// The colours of everything but the curves.
typedef struct palette {
    colour page, text, faint_text, axis, grid, shade, mark;
} palette;

const palette *palette_of(figure_theme theme);

// The colour of a slot, 0-7; in a mono figure by the series' place in its panel.
colour palette_series(figure_theme theme, int slot, int place);

// The slots in the order in which they differ most, again from the eighth on.
int palette_slot(int index);

// The colour at share 0 ... 1 of the colour scale. Mono: greys from dark to nearly white. Else
// viridis of van der Walt and Smith (2015, public domain), straight lines between nine of its
// colours. Perceptually uniform, from dark blue to yellow, with lightness increasing throughout, so
// that it is readable when printed in grey.
colour palette_shade(figure_theme theme, double share);

// The colour at a share of the way from a to b.
colour colour_between(colour a, colour b, double share);

void set_colour(cairo_t *cr, colour c);

// Sets the dash pattern for a line of the given width.
void set_line_style(cairo_t *cr, line_style style, double width);
