// The contact force of a whole run, kept as a parabola over each step: when it has
// settled, and the largest mean over a window.
#include "src/run/run_result.h"

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
    if (added == NULL) {
        return STATUS_NO_MEMORY;
    }
    *added = step;
    return STATUS_OK;
}

// The last instant within a step at which the force equals `edge` [N], as a share of the
// step's length: the later root in [0, 1] of curve s^2 + slope s + first - edge. Negative
// if there is none.
static double last_crossing(const force_step *step, double edge)
{
    const step_parabola force = step_parabola_of(step);
    const double curve = force.curve, slope = force.slope, offset = force.first - edge;

    // the force is nearly a straight line
    if (fabs(curve) < 1e-12 * (fabs(slope) + fabs(offset))) {
        double s = slope != 0 ? -offset / slope : -1;
        if (s <= 1) {
            return s;
        }
        return -1;
    }

    // the later one of the parabola's two roots, which are NaN if it has none
    double latest = -1;
    double root = sqrt(slope * slope - 4 * curve * offset);
    for (int sign = -1; sign <= 1; sign += 2) {
        double s = (sign * root - slope) / (2 * curve);
        if (s <= 1) {
            latest = fmax(latest, s);
        }
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
        const double far = larger(fabs(step->first - final), fabs(step->last - final)) +
                           step_bulge(step);
        if (far < band) {
            continue; // well within it
        }
        double upper = last_crossing(step, final + band),
               lower = last_crossing(step, final - band);
        double left = fmax(upper, lower);

        if (fabs(step->last - final) > band) {
            // outside at its end: inside only from the next step's start on
            if (i + 1 == h->count) {
                return (double)NAN;
            }
            return step->end;
        }

        // it came into the band within this step
        if (left >= 0) {
            return step->start + left * (step->end - step->start);
        }
    }
    if (h->count > 0) {
        return steps[0].start;
    }
    return (double)NAN;
}

// --- the largest mean over a sliding window --------------------------------------------

// One end of the window, which moves through the run: its front, which is the later end,
// or its back.
typedef struct window_end {
    double time;     // of the window's front, for both ends [s]
    size_t step;     // the step that this end lies in
    double before;   // integral of the force up to the start of that step [N s]
    size_t event;    // the next event, whose impulse this end has not passed
    double impulses; // sum of the impulses that this end has passed [N s]
} window_end;

// Integral of the force from the start of a step to an instant [s] within it [N s]: with
// the share s of the step's length h, h (first s + slope s^2 / 2 + curve s^3 / 3).
static double integral_within(const force_step *step, double time)
{
    double length = step->end - step->start;
    double s = fmin(fmax((time - step->start) / length, 0), 1);
    step_parabola p = step_parabola_of(step);
    return length * s * (p.first + s * (p.slope / 2 + s * p.curve / 3));
}

// Whether an end of the window, moved to an instant, passes impulses that act right
// there.
typedef enum impulse_side { BEFORE_IMPULSES, PAST_IMPULSES } impulse_side;

// Moves an end of the window so that the front is at `time` [s]. `behind` is how far this
// end is behind the front [s]: zero, or the window's length. Instants are compared as
// times of the front, by the same sums as in next_change: with other rounding, the end
// could stay in a step that it has left.
static void advance(const run_result *r, window_end *w, double time, double behind,
                    impulse_side side)
{
    const force_step *steps = force_steps(&r->history.forces);
    const trace *t = &r->trace;

    // past whole steps
    while (w->step + 1 < r->history.forces.count && steps[w->step].end + behind <= time) {
        w->before += steps[w->step].mean * (steps[w->step].end - steps[w->step].start);
        w->step++;
    }

    // and past impulses
    for (; w->event < t->event_count; w->event++) {
        const event *e = &t->events[w->event];
        const double met = e->time + behind;
        if (!(met < time || (side == PAST_IMPULSES && met == time))) {
            break;
        }
        const bool strikes =
            e->kind == EVENT_IMPACT && e->impulse > 0 && !e->delivered_by_step;
        if (strikes) {
            w->impulses += e->impulse;
        }
    }
    w->time = time;
}

// Integral of force and impulses up to an end of the window, the end being moved to
// `time` within its step [N s].
static double integral_to(const run_result *r, const window_end *w, double time)
{
    return w->before + integral_within(&force_steps(&r->history.forces)[w->step], time) +
           w->impulses;
}

// The next instant of the window's front at which its front or back meets a step's end or
// an impulse [s].
static double next_change(const run_result *r, const window_end *front,
                          const window_end *back, double window)
{
    const force_step *steps = force_steps(&r->history.forces);
    double next = fmin(steps[front->step].end, steps[back->step].end + window);

    // the next event of each end; the back meets one a window's length after the front
    const trace *t = &r->trace;
    if (front->event < t->event_count) {
        next = fmin(next, t->events[front->event].time);
    }
    if (back->event < t->event_count) {
        next = fmin(next, t->events[back->event].time + window);
    }
    return next;
}

// Adds the coefficients of a step's force, times `sign`, to `sums`: the force is the
// parabola a + b u + c u^2 of the time u since `from` [s], to which step_parabola is
// expanded from the share s of the step.
static void add_parabola(double sums[3], const force_step *step, double from, double sign)
{
    const double length = step->end - step->start, s = (from - step->start) / length;
    const step_parabola p = step_parabola_of(step);
    sums[0] += sign * (p.first + s * (p.slope + s * p.curve));
    sums[1] += sign * (p.slope + 2 * s * p.curve) / length;
    sums[2] += sign * p.curve / (length * length);
}

// The largest integral [N s] over a window whose front lies strictly between the present
// one and `to` [s], both ends staying in their steps. Its derivative is the force at the
// front less that at the back, so that the maximum is where both are equal; -HUGE_VAL if
// they are equal nowhere.
static double largest_between(const run_result *r, const window_end *front,
                              const window_end *back, double window, double to)
{
    // the difference of both forces as a parabola a + b u + c u^2 of the time u since now
    const force_step *steps = force_steps(&r->history.forces);
    double from = front->time, sums[3] = {0}, largest = -HUGE_VAL;
    add_parabola(sums, &steps[front->step], from, 1);
    add_parabola(sums, &steps[back->step], from - window, -1);

    // its real roots in the form 2 a / (-b +- sqrt(b^2 - 4 a c)), which also serves c =
    // 0; without real roots u is NaN, and no comparison holds
    double root = sqrt(sums[1] * sums[1] - 4 * sums[2] * sums[0]);
    for (int sign = -1; sign <= 1; sign += 2) {
        double u = 2 * sums[0] / (sign * root - sums[1]);
        if (u > 0 && from + u < to) {
            largest = fmax(largest, integral_to(r, front, from + u) -
                                        integral_to(r, back, from + u - window));
        }
    }
    return largest;
}

// The instant [s] up to which the window may be moved because no window on the way can
// have an integral above `largest` [N s]; -HUGE_VAL if that is not certain even within
// the front's step. A window that lies within steps without an event has at most the
// integral (largest force) x (window), so steps are checked from the back's on until one
// exceeds that. *bounded is the first step that has not passed the check.
static double holds_no_more(const run_result *r, const window_end *front,
                            const window_end *back, double window, double largest,
                            size_t *bounded)
{
    const shared_array *h = &r->history.forces;
    const force_step *steps = force_steps(h);
    const trace *t = &r->trace;

    // steps that are weak enough, up to the back's next event
    const double next_event =
        back->event < t->event_count ? t->events[back->event].time : HUGE_VAL;
    size_t i = *bounded > back->step ? *bounded : back->step;
    while (i < h->count && steps[i].end < next_event &&
           step_at_most(&steps[i]) * window <= largest) {
        i++;
    }
    *bounded = i;

    // they reach at least past the front's step
    if (i > front->step) {
        return steps[i - 1].end;
    }
    return -HUGE_VAL;
}

double force_largest_mean(const run_result *result, double from, double window)
{
    assert(isfinite(from) && window > 0);
    const shared_array *h = &result->history.forces;
    double end = h->count > 0 ? force_steps(h)[h->count - 1].end : -HUGE_VAL;
    if (!(from + window <= end)) {
        return (double)NAN;
    }

    // the window slides over the run, from one instant to the next at which an end of it
    // meets a step's end or an impulse
    window_end front = {0}, back = {0};
    double largest = -HUGE_VAL;
    size_t bounded = 0;
    for (double time = from + window;;) {
        // the window at this instant, with the impulses on both of its edges
        advance(result, &front, time, 0, PAST_IMPULSES);
        advance(result, &back, time, window, BEFORE_IMPULSES);

        // windows that cannot be the largest are skipped
        if (time < end) {
            const double passed =
                holds_no_more(result, &front, &back, window, largest, &bounded);
            if (passed > time) {
                time = fmin(passed, end);
                continue;
            }
        }

        // its integral
        largest = fmax(largest, integral_to(result, &front, time) -
                                    integral_to(result, &back, time - window));
        if (time >= end) {
            return largest / window;
        }

        // windows between this instant and the next change of a step or an impulse
        advance(result, &back, time, window, PAST_IMPULSES);
        double next = fmin(next_change(result, &front, &back, window), end);
        largest = fmax(largest, largest_between(result, &front, &back, window, next));
        if (next > time) {
            time = next;
        } else {
            time = end;
        }
    }
}
