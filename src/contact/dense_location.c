// Locates events, and peaks of the force, in steps whose engine knows the motion between
// its ends.

#include <math.h>

#include "src/contact/locate.h"

#define ROOT_RESOLUTION 1e-16 // [s]
#define SAME_PEAK       1e-13 // share of a peak that makes no difference

enum { MOST_CUTS = 40, MOST_ITERATIONS = 100 };

// Where the cubic through both ends' values and slopes, the time over the value, is zero:
// for a function that falls all the way; else the root of the chord.
static double guess_root(step_point lo, step_point hi)
{
    const double fall = lo.at.value - hi.at.value, length = hi.time - lo.time;
    const double s = lo.at.value / fall, chord = lo.time + length * s;
    if (!(lo.at.slope < 0 && hi.at.slope < 0)) {
        return chord;
    }
    const double start = s * (1 - s) * (1 - s) / lo.at.slope,
                 end = s * s * (s - 1) / hi.at.slope;
    const double guess = lo.time + length * s * s * (3 - 2 * s) - fall * (start + end);
    if (guess > lo.time && guess < hi.time) {
        return guess;
    }
    return chord;
}

// The root of an event function that falls from `lo` to `hi`, `second` a bound on its
// second derivative: Newton's method within the bracket, halved where that leaves it or
// gains too little.
static double root_between(const arm *a, const motion *m, event_function w, step_point lo,
                           step_point hi, double second)
{
    double from = lo.time, to = hi.time;
    double t = guess_root(lo, hi);
    double width = to - from;

    for (int i = 0; i < MOST_ITERATIONS; i++) {
        if (!(t > from && t < to)) {
            t = 0.5 * (from + to);
        }
        value_and_slope g = m->engine->event_function(a, m, w, t);
        if (g.value > 0) {
            from = t;
        } else {
            to = t;
        }

        // end where the estimate has settled, the next correction would be below the
        // resolution of time, or the bracket has closed
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

// The first fall below zero from `lo` to `hi`, at both of which the function is known, as
// `known` is a bound on its second derivative, or infinite; negative if there is none.
// Intervals in which the bound on the second derivative excludes a fall are skipped;
// those in which it excludes a rising slope have exactly one root; all others are
// bisected. Where the function is not finite nothing is found: the state at the step's
// end reports that.
static double first_zero_crossing(const arm *a, const motion *m, event_function w,
                                  step_point lo, step_point hi, int cuts, double known)
{
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

    // each function that is watched, as far as the first fall so far
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

static void note_force(motion *m, step_point p)
{
    motion_note_force(m, m->state[SLOT_TIME] + p.time, p.at.value);
}

// Where the force stops growing between `lo`, where it grows, and `hi`, where it falls:
// secants of the slope within the bracket, halved where they gain too little.
static step_point summit(const arm *a, motion *m, step_point lo, step_point hi)
{
    step_point top = lo.at.value > hi.at.value ? lo : hi;

    double resolution = 1e-9 * (hi.time - lo.time);

    for (int i = 0; i < MOST_ITERATIONS && hi.time - lo.time > resolution; i++) {
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        if (i % 3 == 2) {
            share = 0.5;
        } else {
            share = fmin(fmax(share, 1e-3), 1 - 1e-3);
        }

        // which side of the summit it is on
        double time = lo.time + share * (hi.time - lo.time);
        double last = top.time;
        top = (step_point){time, motion_output(a, m, OUTPUT_FORCE, time)};
        if (fabs(time - last) <= resolution) {
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

static void raise_peak(const arm *a, motion *m, step_point lo, step_point hi, int cuts,
                       double known)
{
    // no larger force is possible here, or the slope keeps its sign
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
