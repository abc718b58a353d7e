// Figures of studies: curves over logarithmic axes, panels side by side.
//
// The description is that of render/plot/plot.h, of which these parts count: title, caption,
// x_label, x_unit, size, theme, and of every panel its label, unit and series. All axes are
// logarithmic; a point that is not above zero is left out. The legend is that of the first panel,
// in a row above. A `secondary` series is a guide: thin, dashed and without markers.
#pragma once

#include "render/plot/plot.h"

// Draws the figure with the page's top left corner at the origin of cr, in points.
// STATUS_BAD_ARGUMENT if a panel has nothing to show, STATUS_CANNOT_READ if the font is missing.
status study_plot_paint(cairo_t *cr, const figure *fig, fault *f);

// Draws it into a file, whose ending says of which kind, and writes what it shows as CSV beside it.
// Files are written whole or not at all.
status study_plot_write(const figure *fig, const char *path, fault *f);
