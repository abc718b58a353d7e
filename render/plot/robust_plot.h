// Picture of what impactlab robust finds: the distribution of the overshoot, a curve for each law.
#pragma once

#include "render/plot/owned_figure.h"
#include "src/study/robust.h"

// The most laws that a picture shows.
enum { ROBUST_MOST_CURVES = 8 };

// Describes the picture: the share of runs (upwards) whose overshoot is at most x. The table is
// borrowed; at most ROBUST_MOST_CURVES laws. Give it to owned_figure_destroy.
owned_figure *robust_figure_create(const robust_table *t);
