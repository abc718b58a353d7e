// What a first-order sensor would read of a run's force at most.
#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"
#include "src/rig/first_order_lag.h"
#include "src/run/run_result.h"

// After so many time constants nothing is left of what a lag held, to the last digit.
#define FORGOTTEN 40

// The sensor on its way through the run. Of the steps that bring nothing larger it knows
// only that they do not: it follows them where its value is needed after all.
typedef struct sensor_passage {
    const force_step *steps;
    first_order_lag lag;
    size_t followed; // the steps before this one
    size_t event;    // the next one to look at
    double largest;  // value so far [N]
} sensor_passage;

// The force over a step, up to an instant [s] within or behind it.
static lag_input force_until(const force_step *step, double until)
{
    const double length = step->end - step->start;
    if (!(step->end > until)) {
        return (lag_input){length, step->first, step->last, step->mean};
    }
    const step_parabola f = step_parabola_of(step);
    const double u = (until - step->start) / length;
    return (lag_input){u * length, f.first, f.first + u * (f.slope + u * f.curve),
                       f.first + u * (f.slope / 2 + u * f.curve / 3)};
}

// Follows the force up to the beginning of a step, an instant [s].
static void follow_to_step(sensor_passage *s, size_t step, double begin)
{
    size_t from = step;
    const double remembered = begin - FORGOTTEN * s->lag.time_constant;
    while (from > s->followed && s->steps[from - 1].end > remembered) {
        from--;
    }
    if (from > s->followed) {
        s->lag.value = 0;
    }
    for (; from < step; from++) {
        const force_step *f = &s->steps[from];
        lag_follow(&s->lag, &(lag_input){f->end - f->start, f->first, f->last, f->mean});
    }
    s->followed = step;
}

// Takes the impulses up to an instant [s] that lies at the beginning of a step, or ends
// the run.
static void take_impulses(sensor_passage *s, const trace *t, size_t step, double until)
{
    for (; s->event < t->event_count && t->events[s->event].time <= until; s->event++) {
        const event *e = &t->events[s->event];
        if (e->kind == EVENT_IMPACT && !e->delivered_by_step) {
            follow_to_step(s, step, e->time);
            lag_strike(&s->lag, e->impulse);
            s->largest = larger(s->lag.value, s->largest);
        }
    }
}

// Takes a step that may bring a larger value: at its end, or where the lag turns in it.
static void take_step(sensor_passage *s, size_t step, double until)
{
    const lag_input force = force_until(&s->steps[step], until);
    double turns[LAG_MOST_TURNS];
    follow_to_step(s, step, s->steps[step].start);
    for (int i = lag_turns(&s->lag, &force, turns); i-- > 0;) {
        s->largest = larger(turns[i], s->largest);
    }
    lag_follow(&s->lag, &force);
    s->largest = larger(s->lag.value, s->largest);
    s->followed = step + 1;
}

// The step at whose beginning the next impulse acts, none: `count`, that of all steps.
static size_t next_struck_step(sensor_passage *s, const trace *t, size_t count)
{
    const event *e = t->events + s->event;
    for (; s->event < t->event_count && e->kind != EVENT_IMPACT; e++) {
        s->event++;
    }
    if (s->event == t->event_count) {
        return count;
    }

    // the first step that does not begin before it lies in [low, high]
    size_t low = s->followed, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (s->steps[middle].start < e->time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

// A force that no step of the run exceeds [N]: of one that delivers an impulse nothing is
// known.
static double largest_force(const run_result *result)
{
    const trace *t = &result->trace;
    double largest = result->summary.peak_force_N;
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].delivered_by_step) {
            largest = HUGE_VAL;
        }
    }
    return largest;
}

double force_largest_sensed(const run_result *result, double time_constant, double until)
{
    assert(time_constant > 0);
    const shared_array *h = &result->history.forces;
    const double most = largest_force(result);
    sensor_passage s = {.steps = force_steps(h), .lag = {.time_constant = time_constant}};
    size_t i = 0;
    while (i < h->count && s.steps[i].start < until) {
        // no sensor reads more than the force had at most, or than it read already
        take_impulses(&s, &result->trace, i, s.steps[i].start);
        if (s.largest >= most) {
            const size_t next = next_struck_step(&s, &result->trace, h->count);
            if (next > i) {
                i = next;
            } else {
                i = i + 1;
            }
            continue;
        }
        if (step_at_most(&s.steps[i]) > s.largest) {
            take_step(&s, i, until);
        }
        i++;
    }

    // an impact at the very end
    take_impulses(&s, &result->trace, i, until);
    return s.largest;
}
