// The visible part of the runs, the extremes of their values, and the axes of panes.
#include "ui/explorer/state/state.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/numbers.h"
#include "src/scenario/effect.h"

// --- the visible part ------------------------------------------------------------------

#define SHORTEST 1e-6 // visible part of a run [s]

static bool shows_all(const time_window *w)
{
    return w->to <= w->from;
}

void view_window(const explorer_model *model, const explorer_view *view, double *from,
                 double *to)
{
    const time_window *w = &view->window;
    if (shows_all(w)) {
        *from = 0;
        *to = model->session.effective.parameters.run.duration;
    } else {
        *from = w->from;
        *to = w->to;
    }
}

void view_show_part(const explorer_model *model, explorer_view *view, double from,
                    double to)
{
    time_window *w = &view->window;
    const double duration = model->session.effective.parameters.run.duration;
    const double width = fmax(to - from, SHORTEST);
    assert(isfinite(duration));
    if (width >= duration) {
        *w = (time_window){0};
        return;
    }
    w->from = fmax(0, fmin(duration - width, from));
    w->to = w->from + width;
}

// Moves the visible part so that the cursor is in it, unless it is adrift.
static void follow_cursor(const explorer_model *model, explorer_view *view)
{
    const time_window *w = &view->window;
    double from, to;
    view_window(model, view, &from, &to);
    const double now = model->session.now, width = to - from;

    // a shorter run may have ended before a part that was panned to
    if (shows_all(w) || w->adrift) {
        if (w->to > model->session.effective.parameters.run.duration) {
            view_show_part(model, view, from, to);
        }
        return;
    }

    // some of what comes is visible while it plays
    if (now > from + 0.8 * width) {
        from = now - 0.8 * width;
    } else if (now < from + 0.1 * width) {
        from = now - 0.1 * width;
    }
    view_show_part(model, view, from, from + width);
}

// --- extremes --------------------------------------------------------------------------

void extremes_forget(extremes *e)
{
    for (size_t i = 0; i < sizeof e->pairs / sizeof e->pairs[0]; i++) {
        g_free(e->pairs[i]);
    }
    *e = (extremes){0};
}

const double *extremes_pairs(const extremes *e, const shown_run *run, int signal)
{
    assert(signal >= 0 && signal < EXTREMES_SIGNALS);
    if (e->run != run->id || e->rows[signal] != run->trace->row_count) {
        return NULL;
    }
    return e->pairs[signal];
}

// The range of a signal in the rows from `first` to `last`, taken from whole blocks where
// they are known and lie within.
static value_range range_of_rows(const trace *t, int signal, const double *pairs,
                                 size_t first, size_t last)
{
    value_range found = value_range_empty;
    size_t row = first;
    while (row <= last && row < t->row_count) {
        if (pairs != NULL && row % EXTREMES_BLOCK == 0 &&
            row + EXTREMES_BLOCK <= last + 1) {
            const double *pair = pairs + 2 * (row / EXTREMES_BLOCK);
            value_range_widen(&found, (value_range){pair[0], pair[1]});
            row += EXTREMES_BLOCK;
        } else {
            value_range_add(&found, signal_value(&t->rows[row], signal));
            row++;
        }
    }
    return found;
}

// Extends the blocks of a signal to all rows of a run, including those that it has
// gained.
static void update_extremes(extremes *e, const shown_run *run, int signal)
{
    const trace *t = run->trace;
    assert(run->id != 0);

    // another run: the blocks of the old one are not valid
    if (e->run != run->id) {
        extremes_forget(e);
        e->run = run->id;
    }
    if (extremes_pairs(e, run, signal) != NULL) {
        return;
    }
    const size_t blocks = (t->row_count + EXTREMES_BLOCK - 1) / EXTREMES_BLOCK;
    double *pairs = g_renew(double, e->pairs[signal], 2 * blocks);

    // the last block may have been begun only: it is done again, and then what is new
    for (size_t b = e->rows[signal] / EXTREMES_BLOCK; b < blocks; b++) {
        const size_t begin = b * EXTREMES_BLOCK;
        const value_range found =
            range_of_rows(t, signal, NULL, begin, begin + EXTREMES_BLOCK - 1);
        pairs[2 * b] = found.low;
        pairs[2 * b + 1] = found.high;
    }
    e->pairs[signal] = pairs;
    e->rows[signal] = t->row_count;
}

// --- axes of values --------------------------------------------------------------------

// Whether a signal of a pane counts for its range. Beside the force readings do not: they
// answer an impulse with a spike that would flatten all else, those measured, too, if the
// force itself was.
static bool signal_counts(const pane *p, int k, const shown_run *run)
{
    const int force = SIGNAL_INDEX(force);
    const bool has_force = p->signals[0] == force && (p->hidden & 1u) == 0;
    if (p->hidden >> k & 1) {
        return false;
    }
    return !has_force || p->signals[k] == force ||
           (run->kind == SHOWN_MEASURED && !trace_has(run->trace, force));
}

// The range of a pane's signals in one of the runs shown, between two instants.
static value_range range_in_run(const pane *p, const extremes *e, const shown_run *run,
                                double from, double to)
{
    // one more row at the end, to which the line continues
    const trace *t = run->trace;
    const size_t first = trace_row_at(t, from), last = trace_row_at(t, to) + 1;
    value_range found = value_range_empty;
    for (int k = 0; k < p->count; k++) {
        const int signal = shown_signal(run, p, k);
        if (!signal_counts(p, k, run)) {
            continue;
        }
        const double *pairs = extremes_pairs(e, run, signal);
        value_range_widen(&found, range_of_rows(t, signal, pairs, first, last));
    }
    return found;
}

// The same in all of the runs shown.
static value_range range_between(const explorer_model *model, const pane *p, double from,
                                 double to)
{
    shown_run runs[SHOWN_RUNS];
    const int count = model_runs(model, p, runs);
    value_range found = value_range_empty;
    for (int i = 0; i < count; i++) {
        value_range_widen(&found,
                          range_in_run(p, &model->extremes[i], &runs[i], from, to));
    }
    return found;
}

value_range view_force_band(const explorer_model *model)
{
    const double band = 0.05;
    const session *s = &model->session;
    if (effect_none(&s->effective, PARAMETER_INDEX(control.force)) != NULL) {
        return value_range_empty;
    }
    const double command = session_parameters_at(s, s->now).control.force;
    return (value_range){(1 - band) * command, (1 + band) * command};
}

bool view_pane_axis(const explorer_model *model, const explorer_view *view, int index,
                    value_range *axis)
{
    assert(index >= 0 && index < PANES);
    const pane *p = &view->panes.pane[index];
    const bool subtracts = model_subtracts(model) || p->view == VIEW_RESIDUAL;
    if (!pane_is_over_time(p) || (subtracts && pane_is_derived(p))) {
        return false;
    }

    // the range of what is visible, and of what the law is to hold
    double from, to;
    view_window(model, view, &from, &to);
    value_range seen = range_between(model, p, from, to);
    if (!(seen.high >= seen.low)) {
        return false;
    }
    if (p->signals[0] == SIGNAL_INDEX(force) && !subtracts) {
        value_range_widen(&seen, view_force_band(model));
    }

    // it counts unless the axis is fixed
    *axis = p->is_fixed ? p->fixed : value_range_opened(seen);
    return true;
}

void state_update_axes(explorer_model *model, explorer_view *view)
{
    // the blocks of all signals that are shown
    shown_run runs[SHOWN_RUNS];
    const int count = model_runs(model, NULL, runs);
    for (int run = 0; run < count; run++) {
        for (int i = 0; i < PANES; i++) {
            const pane *p = &view->panes.pane[i];
            for (int k = 0; p->shown && k < p->count; k++) {
                update_extremes(&model->extremes[run], &runs[run],
                                shown_signal(&runs[run], p, k));
            }
        }
    }
    follow_cursor(model, view);
}
