// Picture of what impactlab robust finds: the distribution of the overshoot, a curve for each law.
#pragma once

#include "render/plot/plot.h"
#include "src/study/robust.h"

// A picture of a table with everything it borrows.
typedef struct robust_figure robust_figure;

// The most laws that a picture shows.
enum { ROBUST_MOST_CURVES = 8 };

// Describes the picture: the share of runs (upwards) whose overshoot is at most x. The table is
// borrowed; at most ROBUST_MOST_CURVES laws. Give it to robust_figure_destroy.
robust_figure *robust_figure_create(const robust_table *t);
const figure *robust_figure_of(const robust_figure *r);
void robust_figure_destroy(robust_figure *r);
