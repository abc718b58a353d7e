// What a first-order sensor would read of a run's force at most.
#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"
#include "src/rig/first_order_lag.h"
#include "src/run/run_result.h"

// After this many time constants the value that a lag had before makes no difference in
// the last digit (exp(-40) = 4e-18).
#define FORGOTTEN 40

// How far the sensor has come through the run. Steps whose force cannot raise the largest
// reading are skipped, and followed later if the sensor's value is needed after them.
typedef struct sensor_passage {
    const force_step *steps;
    first_order_lag lag;
    size_t followed; // the first step that the lag has not followed
    size_t event;    // the next event to look at
    double largest;  // reading so far [N]
} sensor_passage;

// The force over a step from its start to an instant [s], or to its end if that is
// earlier, as the lag takes it: length, both ends and mean.
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

// Lets the lag follow the force over the steps that were skipped, up to the beginning of
// a step at `begin` [s]. Of a long way only the last FORGOTTEN time constants count.
static void follow_to_step(sensor_passage *s, size_t step, double begin)
{
    // where to start: at the first step that is not forgotten, with any value
    size_t from = step;
    const double remembered = begin - FORGOTTEN * s->lag.time_constant;
    while (from > s->followed && s->steps[from - 1].end > remembered) {
        from--;
    }
    if (from > s->followed) {
        s->lag.value = 0;
    }

    // from there on
    for (; from < step; from++) {
        const force_step *f = &s->steps[from];
        lag_follow(&s->lag, &(lag_input){f->end - f->start, f->first, f->last, f->mean});
    }
    s->followed = step;
}

// Lets the lag take the impulses of impacts up to an instant [s], at which `step` begins
// or the run ends.
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

// Follows a step in which the reading may become the largest: where it turns, or at the
// step's end.
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

// The step at whose beginning the next impulse acts; `count`, the number of all steps, if
// there is none.
static size_t next_struck_step(sensor_passage *s, const trace *t, size_t count)
{
    // the next impact
    const event *e = t->events + s->event;
    for (; s->event < t->event_count && e->kind != EVENT_IMPACT; e++) {
        s->event++;
    }
    if (s->event == t->event_count) {
        return count;
    }

    // bisection: the first step that does not begin before the impact lies in [low, high]
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

// A force that no step of the run exceeds [N]. Of a step that delivers an impulse nothing
// is known.
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
