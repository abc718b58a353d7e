// Figures as files.
#pragma once

#include "render/page/picture_file.h"
#include "render/plot/plot.h"

// Draws the figure into a file as picture_write does. Title, software and parameters go into the
// file's metadata.
status figure_write(const figure *fig, const char *path, fault *f);

// Writes what the figure shows as CSV in long form: the panel with its unit (its heading where all
// panels show one quantity), the series, and two
// columns headed by the axes' names and units ("time[s]", "force[N]"; "value" where the panels show
// different quantities, whose units stand beside the panels' names). Every point of every curve (y
// empty where the curve has a gap), cells of maps as the series "map", impulses as the series
// impulse[unit], then marks and shaded intervals with an empty y. Where there is a colour scale its
// value stands in a last column.
status figure_write_csv(const figure *fig, const char *path, fault *f);
