#include "src/run/recording.h"

#include <assert.h>
#include <math.h>

// Room for rows is made in advance up to so many of them, some of them for events.
enum { MOST_ROWS_AHEAD = 100000, ROWS_OF_EVENTS = 64 };

size_t recording_most_rows(size_t expected)
{
    return 16 * expected + 1000000;
}

status recording_open_trace(recording *r, int angle_count, fault *f)
{
    assert(r != NULL && angle_count > 0);
    size_t expected = r->options->rows_expected;
    if (expected == 0) {
        // a row for each step, and two for an event; where there is no memory, rows will say so
        const parameters *p = &r->scenario->parameters;
        const double rows = ROWS_OF_EVENTS + p->run.duration / p->method.step;
        trace_init(&r->result->trace, angle_count);
        if (r->options->keep_trace && rows < MOST_ROWS_AHEAD) {
            trace_expect(&r->result->trace, (size_t)rows);
        }
        return STATUS_OK;
    }
    size_t most = recording_most_rows(expected);
    status s = trace_reserve(&r->result->trace, angle_count, expected, most);
    return s == STATUS_OK ? s : fault_set(f, s, "no address space for %zu rows", expected);
}

void recording_publish(const recording *r, double time)
{
    run_monitor *m = r->options->monitor;
    if (m != NULL) {
        // rows last: whoever sees them sees the events before them
        const trace *t = &r->result->trace;
        atomic_store_explicit(&m->time, time, memory_order_relaxed);
        atomic_store_explicit(&m->events, t->event_count, memory_order_release);
        atomic_store_explicit(&m->rows, t->row_count, memory_order_release);
    }
}

status recording_set(recording *r, const action *todo, double time, fault *f)
{
    assert(r != NULL && todo != NULL && todo->kind == ACTION_SET);
    status failed = action_apply(todo, &r->now, f);
    if (failed != STATUS_OK || r->rig == NULL) {
        return failed;
    }

    // the rig has its own view of the parameters
    failed = rig_lock(r->rig, r->now.control.lock, f);
    return failed == STATUS_OK ? rig_retune(r->rig, &r->now, time, f) : failed;
}

status recording_add_row(recording *r, const sample *row, const double *angles,
                         const double *velocities)
{
    status s = trace_add_row(&r->result->trace, row, angles, velocities);
    recording_publish(r, row->time);
    return s;
}

status recording_add_step(recording *r, force_step step)
{
    return force_history_add(&r->result->history.forces, step);
}

force_step *recording_add_steps(recording *r, int count)
{
    return force_history_extend(&r->result->history.forces, (size_t)count);
}

void recording_finish_summary(recording *r, double force_integral)
{
    assert(r != NULL);
    summary *s = &r->result->summary;
    double duration = r->scenario->parameters.run.duration;
    if (isnan(s->first_contact_s)) {
        s->steady_force_N = (double)NAN;
        return;
    }

    // overshoot and settling are relative to a force that stays
    s->steady_force_N = force_integral / fmin(STEADY_WINDOW, duration);
    if (s->steady_force_N > 0) {
        s->force_overshoot_percent = 100 * (s->peak_force_N / s->steady_force_N - 1);
        double settled = force_settled_since(&r->result->history.forces, s->steady_force_N);
        s->settling_time_s = isnan(settled) ? (double)NAN : fmax(0, settled - s->first_contact_s);
    }
}
