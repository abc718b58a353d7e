// Pictures of a sweep: one quantity over one or two varied parameters.
//
// One parameter: a line with markers (dots alone if the values were drawn at random or are words).
// Two: a map with contour lines and a colour bar (coloured dots if the values were drawn at
// random). A logarithmic range has a logarithmic axis.
#pragma once

#include "render/plot/owned_figure.h"
#include "src/study/sweep.h"

typedef struct sweep_picture {
    const sweep *sweep;
    const char *key;      // of the summary, "peak_force_N"
    const double *values; // of each run, NaN where there is none
} sweep_picture;

// Checks in advance whether a picture of the sweep can be written to path: STATUS_BAD_ARGUMENT if
// more than two parameters are varied or for an unknown extension, STATUS_CANNOT_WRITE if the path
// cannot be written, STATUS_CANNOT_READ if the font is missing.
status sweep_plot_check(const sweep *s, const char *path, fault *f);

// Describes the picture, to be freed with owned_figure_destroy. The sweep and the values are
// borrowed.
owned_figure *sweep_figure_create(const sweep_picture *p);
