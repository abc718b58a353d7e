// The contact force of a whole run, step by step: what its settling time is found from.
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

// The array is plain (after force_history_init) or shared between runs (after
// force_history_reserve); all zero is an empty one that may be finished.
typedef struct force_history {
    shared_array array; // of force_step
    size_t count;
} force_history;

// An empty history of a run that is not resumed.
void force_history_init(force_history *h);

// An empty history that other runs can share: for `least` steps, and up to `most` if there is
// address space. False if it cannot be had.
bool force_history_reserve(force_history *h, size_t least, size_t most);

// Lets an empty plain history use the memory of another one that is not needed any more, which is
// empty then.
void force_history_take(force_history *h, force_history *used);

void force_history_finish(force_history *h);

// The steps, oldest first; good until the next one is added to a plain history.
static inline const force_step *force_steps(const force_history *h)
{
    return h->array.base;
}

// Appends a step. STATUS_NO_MEMORY.
status force_history_add(force_history *h, force_step step) __attribute__((warn_unused_result));

// Appends `count` steps that the caller fills in at once. NULL without memory.
force_step *force_history_extend(force_history *h, size_t count);

// The instant [s] after which the force stays for good within SETTLED_BAND (a share) of `final`
// [N], each step taken as the parabola through its ends that has its mean; NaN if the run ends
// outside, or has no step.
double force_settled_since(const force_history *h, double final);
