// What an arm sweeps over in a run, so that a plan shows all of it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/run/trace.h"
#include "src/tables/parameters.h"

// What an arm sweeps over in a run.
typedef struct plan_extent {
    double lowest, highest; // of all its points [m]
    double most_angle;      // [rad]
} plan_extent;

// Widens an extent by the rows from `first` on, of many by some `samples` of them.
void plan_extent_add(plan_extent *e, const trace *t, const arm_parameters *beam,
                     size_t first, size_t samples);

// Whether the arm goes so far that the whole circle is shown.
bool plan_is_circle(const plan_extent *e);
