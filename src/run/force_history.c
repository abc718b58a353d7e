#include "src/run/force_history.h"

#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"

force_step *force_history_extend(shared_array *h, size_t count)
{
    if (h->count + count > h->capacity && !shared_array_grow(h, h->count + count)) {
        return NULL;
    }
    force_step *added = (force_step *)h->base + h->count;
    h->count += count;
    return added;
}

status force_history_add(shared_array *h, force_step step)
{
    force_step *added = force_history_extend(h, 1);
    FAIL_IF(added == NULL, STATUS_NO_MEMORY);
    *added = step;
    return STATUS_OK;
}

// The last instant within a step at which the force is `edge`, as a share of it; negative if none.
static double last_crossing(const force_step *step, double edge)
{
    const step_parabola force = step_parabola_of(step);
    const double curve = force.curve, slope = force.slope, offset = force.first - edge;
    double latest = -1;

    // a straight line
    if (fabs(curve) < 1e-12 * (fabs(slope) + fabs(offset))) {
        double s = slope != 0 ? -offset / slope : -1;
        return s <= 1 ? s : -1;
    }

    // the later one of the parabola's two crossings, which are NaN if there are none
    double root = sqrt(slope * slope - 4 * curve * offset);
    for (int sign = -1; sign <= 1; sign += 2) {
        double s = (sign * root - slope) / (2 * curve);
        latest = s <= 1 ? fmax(latest, s) : latest;
    }
    return latest;
}

double force_settled_since(const shared_array *h, double final)
{
    assert(isfinite(final));
    const force_step *steps = force_steps(h);
    double band = SETTLED_BAND * fabs(final);

    // from the end backwards: where was the force outside for the last time?
    for (size_t i = h->count; i-- > 0;) {
        const force_step *step = &steps[i];
        const double far =
            larger(fabs(step->first - final), fabs(step->last - final)) + step_bulge(step);
        if (far < band) {
            continue; // well within it
        }
        double upper = last_crossing(step, final + band), lower = last_crossing(step, final - band);
        double left = fmax(upper, lower);

        if (fabs(step->last - final) > band) {
            // outside at its end: inside only from the next step's start on
            return i + 1 == h->count ? (double)NAN : step->end;
        }

        // it came into the band within this step
        if (left >= 0) {
            return step->start + left * (step->end - step->start);
        }
    }
    return h->count > 0 ? steps[0].start : (double)NAN;
}
