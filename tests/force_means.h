// Means of a wall's force lie within what the force is, in any run.
#pragma once

#include <math.h>

#include "src/run/run_result.h"

#define MEAN_ROUNDING 1e-6 // by which a mean may be out of its range, a share and [N]
#define MEAN_WINDOW   5e-3 // [s]

// Whether a force between zero and its peak [N], with impulses [N s], can have that mean
// [N] over a time [s]. Where a number is NaN nothing is said.
static inline bool mean_is_within(double mean, double peak, double impulses, double time)
{
    const double most = peak + impulses / time, slack = MEAN_ROUNDING * (1 + fabs(most));
    return !(mean < -slack) && !(mean > most + slack);
}

// What of a run's means is impossible; NULL if nothing is.
static inline const char *impossible_mean(const run_result *r)
{
    const summary *of = &r->summary;
    double impulses = 0;
    for (size_t i = 0; i < r->trace.event_count; i++) {
        const double impulse = r->trace.events[i].impulse;
        impulses += isnan(impulse) ? 0 : impulse;
    }
    if (!mean_is_within(of->steady_force_N, of->peak_force_N, 0, 1)) {
        return "a steady force that the force never was";
    }
    const bool touched = of->status == STATUS_OK && !isnan(of->first_contact_s);
    const double smoothed =
        touched ? force_largest_mean(r, of->first_contact_s, MEAN_WINDOW) : (double)NAN;
    return mean_is_within(smoothed, of->peak_force_N, impulses, MEAN_WINDOW)
               ? NULL
               : "a mean over 5 ms that the force never was";
}
