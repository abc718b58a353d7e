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

// The last instant within a step at which the force is `edge`, as a share of it; negative
// if none.
static double last_crossing(const force_step *step, double edge)
{
    const step_parabola force = step_parabola_of(step);
    const double curve = force.curve, slope = force.slope, offset = force.first - edge;
    double latest = -1;

    // a straight line
    if (fabs(curve) < 1e-12 * (fabs(slope) + fabs(offset))) {
        double s = slope != 0 ? -offset / slope : -1;
        if (s <= 1) {
            return s;
        }
        return -1;
    }

    // the later one of the parabola's two crossings, which are NaN if there are none
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

// One end of the window, on its way through the run.
typedef struct window_end {
    double time;     // of the window's front [s]
    size_t step;     // that it lies in
    double before;   // integral of the force up to that step [N s]
    size_t event;    // next one whose impulse it has not passed
    double impulses; // of those that it has passed [N s]
} window_end;

// Integral of the force from the step's start to an instant within it [N s]; zero over no
// length.
static double integral_within(const force_step *step, double time)
{
    double length = step->end - step->start;
    double s = fmin(fmax((time - step->start) / length, 0), 1);
    step_parabola p = step_parabola_of(step);
    return length * s * (p.first + s * (p.slope / 2 + s * p.curve / 3));
}

// Moves an end of the window on, which stands `behind` the front's time [s]. Impulses at
// the instant itself are passed or not. Instants are compared where the front meets them,
// by the same sums as in next_change: rounded otherwise, the end could stay in a step
// that it has left.
static void advance(const run_result *r, window_end *w, double time, double behind,
                    bool past_impulses)
{
    const force_step *steps = force_steps(&r->history.forces);
    const trace *t = &r->trace;
    while (w->step + 1 < r->history.forces.count && steps[w->step].end + behind <= time) {
        w->before += steps[w->step].mean * (steps[w->step].end - steps[w->step].start);
        w->step++;
    }

    // and past impulses
    for (; w->event < t->event_count; w->event++) {
        const event *e = &t->events[w->event];
        const double met = e->time + behind;
        if (!(met < time || (past_impulses && met == time))) {
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

    // events of both ends, the back's as the front meets them later
    const trace *t = &r->trace;
    if (front->event < t->event_count) {
        next = fmin(next, t->events[front->event].time);
    }
    if (back->event < t->event_count) {
        next = fmin(next, t->events[back->event].time + window);
    }
    return next;
}

// Adds the parabola a + b u + c u^2 of a step's force to the sums of such, u being the
// time since `from` [s].
static void add_parabola(double *sums, const force_step *step, double from, double sign)
{
    const double length = step->end - step->start, s = (from - step->start) / length;
    const step_parabola p = step_parabola_of(step);
    sums[0] += sign * (p.first + s * (p.slope + s * p.curve));
    sums[1] += sign * (p.slope + 2 * s * p.curve) / length;
    sums[2] += sign * p.curve / (length * length);
}

// The largest integral over the window with its front strictly between `from` and `to`,
// where the forces at front and back are equal; -HUGE_VAL if they are nowhere.
static double largest_between(const run_result *r, const window_end *front,
                              const window_end *back, double window, double to)
{
    // both parabolas as ones of the time since `from`: difference a + b u + c u^2
    const force_step *steps = force_steps(&r->history.forces);
    double from = front->time, sums[3] = {0}, largest = -HUGE_VAL;
    add_parabola(sums, &steps[front->step], from, 1);
    add_parabola(sums, &steps[back->step], from - window, -1);

    // its roots, of which those that are none are no numbers: between them the integral
    // only grows or only falls
    double root = sqrt(sums[1] * sums[1] - 4 * sums[2] * sums[0]);
    for (int sign = -1; sign <= 1; sign += 2) {
        double u =
            2 * sums[0] / (sign * root - sums[1]); // 2 a / (...) stands c = 0 as well
        if (u > 0 && from + u < to) {
            largest = fmax(largest, integral_to(r, front, from + u) -
                                        integral_to(r, back, from + u - window));
        }
    }
    return largest;
}

// The instant [s] up to which no window that ends in the front's step or a later one can
// hold more than `largest` [N s]; -HUGE_VAL if one that ends in the front's step can. It
// goes from the back's step on over steps without an event and without a force large
// enough for more. Steps before
// *bounded were checked already.
static double holds_no_more(const run_result *r, const window_end *front,
                            const window_end *back, double window, double largest,
                            size_t *bounded)
{
    const shared_array *h = &r->history.forces;
    const force_step *steps = force_steps(h);
    const trace *t = &r->trace;
    const double met =
        back->event < t->event_count ? t->events[back->event].time : HUGE_VAL;
    size_t i = *bounded > back->step ? *bounded : back->step;
    while (i < h->count && steps[i].end < met &&
           step_at_most(&steps[i]) * window <= largest) {
        i++;
    }
    *bounded = i;
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

    window_end front = {0}, back = {0};
    double largest = -HUGE_VAL;
    size_t bounded = 0;
    for (double time = from + window;;) {
        // at the instant itself, impulses on both edges counting
        advance(result, &front, time, 0, true);
        advance(result, &back, time, window, false);
        if (time < end) {
            const double passed =
                holds_no_more(result, &front, &back, window, largest, &bounded);
            if (passed > time) {
                time = fmin(passed, end);
                continue;
            }
        }
        largest = fmax(largest, integral_to(result, &front, time) -
                                    integral_to(result, &back, time - window));
        if (time >= end) {
            return largest / window;
        }

        // behind it, up to the next one
        advance(result, &back, time, window, true);
        double next = fmin(next_change(result, &front, &back, window), end);
        largest = fmax(largest, largest_between(result, &front, &back, window, next));
        if (next > time) {
            time = next;
        } else {
            time = end;
        }
    }
}
