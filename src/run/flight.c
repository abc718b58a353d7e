#include "src/run/flight.h"

#include "src/base/extremes.h"
#include "src/run/recording.h"
#include "src/solve/contact_machine.h"

enum { SEPARATION_BISECTIONS = 30, FASTEST_THIRDS = 24 };

// The gap at an instant [s] within the step just made, a step in free flight; false, and none, if
// that fails.
static bool gap_within(const arm *a, motion *m, double time, glance *gap)
{
    *gap = (glance){0, 0};
    if (m->engine->gap_at != NULL && !state_is_held_still(m, m->trial)) {
        *gap = m->engine->gap_at(a, m, time - m->trial[SLOT_TIME]);
        return true;
    }
    const double *state = motion_between(a, m, time);
    if (state != NULL) {
        *gap = (glance){state[SLOT_GAP], state[SLOT_GAP_VELOCITY]};
    }
    return state != NULL;
}

// A whole flight may lie within one step, so the end says little: look where the gap stops growing.
bool flight_separated(const arm *a, motion *m)
{
    double from = m->trial[SLOT_TIME], to = m->state[SLOT_TIME];

    // the ends of the step decide nearly always; in contact the gap is that to the wall at rest,
    // beyond which a face with a mass may swing
    if (m->state[SLOT_CONTACT] != 0) {
        return false;
    }
    if (m->state[SLOT_GAP] > SEPARATION_GAP) {
        return true;
    }
    if (m->state[SLOT_GAP_VELOCITY] >= 0) {
        return false;
    }

    // the gap closes at the step's end: bisect for the instant at which it was the largest
    for (int i = 0; i < SEPARATION_BISECTIONS; i++) {
        const double middle = 0.5 * (from + to);
        glance gap;
        if (!gap_within(a, m, middle, &gap) || gap.value > SEPARATION_GAP) {
            return gap.value > SEPARATION_GAP;
        }
        if (gap.slope > 0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    return false;
}

double flight_closing_speed(const arm *a, motion *m)
{
    const double *start = m->trial, *end = m->state;
    double from = start[SLOT_TIME], to = end[SLOT_TIME];
    double fastest = larger(-start[SLOT_GAP_VELOCITY], -end[SLOT_GAP_VELOCITY]);
    if (!(start[SLOT_GAP_ACCELERATION] < 0 && end[SLOT_GAP_ACCELERATION] > 0)) {
        return fastest;
    }

    // thirds of what is left, of which the better two stay
    for (int i = 0; i < FASTEST_THIRDS; i++) {
        const double early = from + (to - from) / 3, late = to - (to - from) / 3;
        glance first, second;
        if (!gap_within(a, m, early, &first) || !gap_within(a, m, late, &second)) {
            break;
        }
        from = first.slope <= second.slope ? from : early;
        to = first.slope <= second.slope ? late : to;
        fastest = larger(fastest, larger(-first.slope, -second.slope));
    }
    return fastest;
}
