// Locates events, and peaks of the force, in steps whose engine knows the motion between
// its ends.

#include <math.h>

#include "src/contact/locate.h"

#define ROOT_RESOLUTION 1e-16 // [s]
#define SAME_PEAK       1e-13 // share of a peak that makes no difference

enum { MOST_CUTS = 40, MOST_ITERATIONS = 100 };

// A guess of where a function that falls from `lo` to `hi` is zero. Where it falls at
// both ends, time is a function of the value: the guess is that of Hermite's cubic
// through both ends, in which the slopes are the inverse ones. Otherwise, or where the
// cubic leaves the interval, it is the root of the chord.
static double guess_root(step_point lo, step_point hi)
{
    const double fall = lo.at.value - hi.at.value, length = hi.time - lo.time;
    const double s = lo.at.value / fall, chord = lo.time + length * s;
    if (!(lo.at.slope < 0 && hi.at.slope < 0)) {
        return chord;
    }

    // the cubic's values, s the fraction of the way to zero
    const double start = s * (1 - s) * (1 - s) / lo.at.slope,
                 end = s * s * (s - 1) / hi.at.slope;
    const double guess = lo.time + length * s * s * (3 - 2 * s) - fall * (start + end);
    if (guess > lo.time && guess < hi.time) {
        return guess;
    }
    return chord;
}

// The root of an event function that is positive at `lo` and negative at `hi`; `second`
// bounds its second derivative. Newton's method keeps a bracket around the root, and
// halves it where a step would leave it or narrows it too slowly.
static double root_between(const arm *a, const motion *m, event_function w, step_point lo,
                           step_point hi, double second)
{
    double from = lo.time, to = hi.time;
    double t = guess_root(lo, hi);
    double width = to - from;

    for (int i = 0; i < MOST_ITERATIONS; i++) {
        // the estimate replaces the end on its side of the root
        if (!(t > from && t < to)) {
            t = 0.5 * (from + to);
        }
        value_and_slope g = m->engine->event_function(a, m, w, t);
        if (g.value > 0) {
            from = t;
        } else {
            to = t;
        }

        // The end: the step, or the bracket, is below the resolution of time, or the next
        // step would be. That is at most second step^2 / |slope|.
        double next = t - g.value / g.slope;
        const double step = fabs(next - t),
                     resolution = ROOT_RESOLUTION + 2e-16 * hi.time;
        if (step <= resolution || second * step * step <= resolution * fabs(g.slope) ||
            to - from <= resolution) {
            return fmin(fmax(next, lo.time), hi.time);
        }

        // three steps that do not halve the bracket are followed by one that does
        if (i % 3 == 2) {
            if (to - from > 0.5 * width) {
                next = 0.5 * (from + to);
            }
            width = to - from;
        }
        t = next;
    }
    return t;
}

// The first instant from `lo` to `hi` at which an event function falls below zero;
// negative if there is none. `known` is a bound on its second derivative there, or
// infinite if none is known yet. With a bound B and the length h of the interval, the
// function is nowhere less than its smaller end value minus B h^2 / 8, and the slope
// nowhere more than that at an end plus B h / 2. So an interval can be skipped if the
// function cannot reach zero, and has exactly one root if the function falls throughout;
// all others are bisected, at most `cuts` times. Where the function is not finite nothing
// is found: the state at the step's end reports that.
static double first_zero_crossing(const arm *a, const motion *m, event_function w,
                                  step_point lo, step_point hi, int cuts, double known)
{
    // no root, if the bound leaves no room for one
    const double length = hi.time - lo.time;
    double second = known;
    if (!isfinite(known)) {
        second = m->engine->second_derivative(a, m, w, lo.time, hi.time);
    }
    const double room = second * length * length / 8;
    if (fmin(lo.at.value, hi.at.value) > room || !isfinite(room)) {
        return -1;
    }

    // at most one root, or no dip deeper than the tolerance
    const bool falls = hi.at.value < 0;
    const bool steady = fmax(lo.at.slope, hi.at.slope) + second * length / 2 < 0;
    const bool flat = cuts == 0 || room <= event_tolerance(w);
    if (steady || flat) {
        if (falls) {
            return root_between(a, m, w, lo, hi, second);
        }
        return -1;
    }

    // each half by itself, the earlier one first
    double time = 0.5 * (lo.time + hi.time);
    step_point middle = {time, m->engine->event_function(a, m, w, time)};
    if (middle.at.value < 0) {
        return first_zero_crossing(a, m, w, lo, middle, cuts - 1, second);
    }
    double first = first_zero_crossing(a, m, w, lo, middle, cuts - 1, second);
    if (first >= 0) {
        return first;
    }
    return first_zero_crossing(a, m, w, middle, hi, cuts - 1, second);
}

void dense_search_event(const arm *a, motion *m, step_end *end)
{
    *end = (step_end){.length = end->length};

    // each function that is watched, up to the earliest fall found so far
    for (event_function w = EVENT_OF_GAP; w < EVENT_FUNCTION_COUNT; w++) {
        if (!event_function_active(a, m, w) || m->engine->excludes_event(m, w)) {
            continue;
        }
        step_point lo = {0, m->engine->event_function(a, m, w, 0)},
                   hi = {end->length, m->engine->event_function(a, m, w, end->length)};
        double fall = 0;
        if (!(lo.at.value < 0)) {
            fall = first_zero_crossing(a, m, w, lo, hi, MOST_CUTS, HUGE_VAL);
        }
        if (fall >= 0) {
            *end = (step_end){fall, true, w};
        }
    }
}

// --- the largest force -----------------------------------------------------------------

// Records the force at a point of the step as the pulse's peak if none was larger.
static void note_force(motion *m, step_point p)
{
    motion_note_force(m, m->state[SLOT_TIME] + p.time, p.at.value);
}

// The point of greatest force between `lo`, where the force grows, and `hi`, where it
// falls: the root of its slope, by false position within a bracket that every third
// iteration halves.
static step_point summit(const arm *a, motion *m, step_point lo, step_point hi)
{
    step_point top = lo.at.value > hi.at.value ? lo : hi;
    const double resolution = 1e-9 * (hi.time - lo.time);
    for (int i = 0; i < MOST_ITERATIONS && hi.time - lo.time > resolution; i++) {
        // the next point
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        if (i % 3 == 2) {
            share = 0.5;
        } else {
            share = fmin(fmax(share, 1e-3), 1 - 1e-3);
        }

        // the end if it hardly moved, else it replaces the end on its side of the summit
        const double time = lo.time + share * (hi.time - lo.time);
        const double moved = time - top.time;
        top = (step_point){time, motion_output(a, m, OUTPUT_FORCE, time)};
        if (fabs(moved) <= resolution) {
            break;
        }
        if (top.at.slope > 0) {
            lo = top;
        } else {
            hi = top;
        }
    }
    return top;
}

// Raises the recorded peak to the largest force between `lo` and `hi`, with the bounds of
// first_zero_crossing: an interval that cannot have a larger force than the one recorded,
// or in which the force only grows or only falls, is skipped; others are bisected, and
// after the last cut the summit is located.
static void raise_peak(const arm *a, motion *m, step_point lo, step_point hi, int cuts,
                       double known)
{
    // skipped: no larger force is possible, or the slope keeps its sign
    const double length = hi.time - lo.time;
    double second = known;
    if (!isfinite(known)) {
        second = m->engine->second_derivative(a, m, EVENT_OF_FORCE, lo.time, hi.time);
    }
    const double most = fmax(lo.at.value, hi.at.value) + second * length * length / 8;
    const double change = second * length / 2; // of the slope from the nearer end
    if (most <= m->record.pulse_peak * (1 + SAME_PEAK) ||
        fmin(lo.at.slope, hi.at.slope) > change ||
        fmax(lo.at.slope, hi.at.slope) < -change) {
        return;
    }

    // short enough
    if (cuts == 0) {
        if (lo.at.slope > 0 && hi.at.slope < 0) {
            note_force(m, summit(a, m, lo, hi));
        }
        return;
    }

    // each half by itself
    double time = 0.5 * (lo.time + hi.time);
    step_point middle = {time, motion_output(a, m, OUTPUT_FORCE, time)};
    note_force(m, middle);
    raise_peak(a, m, lo, middle, cuts - 1, second);
    raise_peak(a, m, middle, hi, cuts - 1, second);
}

// The gap to the wall at rest and its rate at h in the internal step.
static value_and_slope rest_gap_at(const arm *a, motion *m, double h)
{
    value_and_slope gap = motion_output(a, m, OUTPUT_GAP, h);
    if (state_face_swings(m, m->state)) {
        const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
        const wall_face face = wall_face_after(&wall, state_face(m->state), h);
        gap.value -= face.position;
        gap.slope -= face.velocity;
    }
    return gap;
}

void dense_deepest(const arm *a, motion *m, double h)
{
    enum { PIECES = 8 };
    step_point lo = {0, rest_gap_at(a, m, 0)};
    for (int i = 1; i <= PIECES; i++) {
        const double time = i * h / PIECES;
        const step_point hi = {time, rest_gap_at(a, m, time)};
        locate_deepest(a, m, lo, hi, 1e-9 * h, rest_gap_at);
        lo = hi;
    }
}

void dense_peak(const arm *a, motion *m, double h)
{
    enum { CUTS = 4 };
    if (m->most_force <= m->record.pulse_peak) {
        return;
    }

    // both ends, and what may rise between them
    step_point start = {0, motion_output(a, m, OUTPUT_FORCE, 0)},
               end = {h, motion_output(a, m, OUTPUT_FORCE, h)};
    note_force(m, start);
    note_force(m, end);
    raise_peak(a, m, start, end, CUTS, HUGE_VAL);
}
