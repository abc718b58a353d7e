#include "src/run/flight.h"

#include <math.h>

#include "src/base/extremes.h"
#include "src/run/recording.h"
#include "src/solve/contact_machine.h"

// The fastest mode turns by no more in a piece of a step, in which the tip's speed then has one
// extreme at most but for little [rad].
#define RATE_REACH 0.5

enum { SEPARATION_BISECTIONS = 30, FASTEST_THIRDS = 24, MOST_PIECES = 16 };

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

// The rate of the gap at the ends of equal pieces of the step just made: `count` of them from its
// start on. What cannot be had is HUGE_VAL.
static void rates_of(const arm *a, motion *m, int count, double *rate)
{
    const double from = m->trial[SLOT_TIME], width = (m->state[SLOT_TIME] - from) / count;
    rate[0] = m->trial[SLOT_GAP_VELOCITY];
    rate[count] = m->state[SLOT_GAP_VELOCITY];
    for (int i = 1; i < count; i++) {
        glance gap;
        rate[i] = gap_within(a, m, from + i * width, &gap) ? gap.slope : HUGE_VAL;
    }
}

// The least rate of the gap between two instants [s], where it falls and then grows, of which one
// that is known is `least`.
static double least_rate(const arm *a, motion *m, double from, double to, double least)
{
    // thirds of what is left, of which the better two stay
    for (int i = 0; i < FASTEST_THIRDS; i++) {
        const double early = from + (to - from) / 3, late = to - (to - from) / 3;
        glance first, second;
        if (!gap_within(a, m, early, &first) || !gap_within(a, m, late, &second)) {
            break;
        }
        from = first.slope <= second.slope ? from : early;
        to = first.slope <= second.slope ? late : to;
        least = smaller(least, smaller(first.slope, second.slope));
    }
    return least;
}

double flight_closing_speed(const arm *a, motion *m)
{
    double rate[MOST_PIECES + 1];
    const double from = m->trial[SLOT_TIME], length = m->state[SLOT_TIME] - from;
    if (!wall_stands(&a->wall)) {
        return 0;
    }

    // the piece of the step at whose end the tip is fastest
    const double pieces =
        m->engine->gap_at != NULL ? length * a->highest_frequency / RATE_REACH : 1;
    const int count = pieces < MOST_PIECES ? (int)larger(ceil(pieces), 1) : MOST_PIECES;
    int fastest = 0;
    rates_of(a, m, count, rate);
    for (int i = 1; i <= count; i++) {
        fastest = rate[i] < rate[fastest] ? i : fastest;
    }

    // it may be faster to either side of there, but not before the step and after it
    const bool falls = fastest > 0 || m->trial[SLOT_GAP_ACCELERATION] < 0;
    const bool grows = fastest < count || m->state[SLOT_GAP_ACCELERATION] > 0;
    if (!falls || !grows) {
        return -rate[fastest];
    }
    const double before = from + length * (fastest > 0 ? fastest - 1 : 0) / count;
    const double after = from + length * (fastest < count ? fastest + 1 : count) / count;
    return -least_rate(a, m, before, after, rate[fastest]);
}
