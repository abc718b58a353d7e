// The largest mean of the contact force over a sliding window, impulses of impacts included.
#pragma once

#include "src/run/run_result.h"

// The largest mean [N] of the force over any window of the given length [s] that begins at `from`
// [s] or later and ends within the run; an impulse on a window's edge counts. Each step is the
// parabola through its ends that has its mean, so the extremes are found to rounding. NaN if no
// such window fits into the run.
double force_largest_mean(const run_result *result, double from, double window);
