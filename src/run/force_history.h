// The contact force of a whole run, a shared array of force_step: what its settling time is found
// from.
#pragma once

#include "src/base/shared_array.h"
#include "src/base/fault.h"

#define SETTLED_BAND 0.05 // a force has settled within this share of its final value

// The force over one step: at its ends, and its mean.
typedef struct force_step {
    double start, end;        // [s]
    double first, last, mean; // [N]
} force_step;

// The force within a step as a parabola of its share s of the step: first + slope s + curve s^2.
typedef struct step_parabola {
    double first, slope, curve; // [N]
} step_parabola;

// The parabola through the ends of a step that has its mean.
static inline step_parabola step_parabola_of(const force_step *step)
{
    double curve = 3 * (step->first + step->last) - 6 * step->mean;
    return (step_parabola){step->first, step->last - step->first - curve, curve};
}

// The force goes no further than this beyond the larger, or below the smaller, of the ends of such
// a step [N]: a parabola bends by a quarter of its curve at most.
static inline double step_bulge(const force_step *step)
{
    const double curve = 3 * (step->first + step->last) - 6 * step->mean;
    return (curve < 0 ? -curve : curve) / 4;
}

// The steps, oldest first; good until the next one is added to a plain array.
static inline const force_step *force_steps(const shared_array *h)
{
    return h->base;
}

// Appends a step. STATUS_NO_MEMORY.
status force_history_add(shared_array *h, force_step step) __attribute__((warn_unused_result));

// Appends `count` steps that the caller fills in at once. NULL without memory.
force_step *force_history_extend(shared_array *h, size_t count);

// The instant [s] after which the force stays for good within SETTLED_BAND (a share) of `final`
// [N], each step taken as the parabola through its ends that has its mean; NaN if the run ends
// outside, or has no step.
double force_settled_since(const shared_array *h, double final);
