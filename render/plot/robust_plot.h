// Picture of the result of impactlab robust: the distribution of the overshoot, a curve for each
// law.
#pragma once

#include "render/plot/owned_figure.h"
#include "src/study/robust.h"

// The largest number of laws in a picture.
enum { ROBUST_MOST_CURVES = 8 };

// Describes the picture: the share of runs (upwards) whose overshoot is at most x. Its title
// ends with what was changed of the scenario. The table is borrowed; at most ROBUST_MOST_CURVES
// laws. To be freed with owned_figure_destroy.
owned_figure *robust_figure_create(const robust_table *t, const char *changes);
