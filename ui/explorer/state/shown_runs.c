// The runs whose curves are shown, in their order: the present one, the pinned ones,
// those of a sweep, the one before an adjustment, and measured data.
#include "ui/explorer/state/state.h"

#include <assert.h>

unsigned long state_run_id(const explorer_state *st)
{
    return ((unsigned long)st->opened << 32) | st->session.version;
}

bool state_subtracts(const explorer_state *st)
{
    return st->difference.on && st->session.has_other;
}

int state_visible_pins(const explorer_state *st)
{
    int count = 0;
    for (int i = 0; i < st->pinned.count; i++) {
        if (!st->pinned.runs[i].hidden) {
            count++;
        }
    }
    return count;
}

int state_runs(const explorer_state *st, const pane *p, shown_run runs[SHOWN_RUNS])
{
    const session *s = &st->session;
    const run_list *pins = &st->pinned;
    const unsigned long pinned_id = 1ul << 62, swept_id = 1ul << 63;
    int count = 0;

    // data minus the run, or the run minus the baseline, alone
    if (p != NULL && p->view == VIEW_RESIDUAL) {
        runs[0] = (shown_run){SHOWN_MEASURED, 0, &st->residual.trace,
                              3ul << 61 | st->residual.built};
        return st->residual.trace.row_count > 0;
    }
    if (state_subtracts(st)) {
        runs[0] = (shown_run){SHOWN_DIFFERENCE, 0, &st->difference.trace,
                              pinned_id | swept_id | st->difference.built};
        return 1;
    }

    // the present one, the pinned ones, the sweep's, the one before, what was measured
    runs[count++] = (shown_run){SHOWN_PRESENT, 0, &s->run.trace, state_run_id(st)};
    for (int i = 0; i < pins->count; i++) {
        const pinned_run *r = &pins->runs[i];
        if (!r->hidden) {
            runs[count++] =
                (shown_run){SHOWN_PINNED, i, &r->run.trace, pinned_id | r->id};
        }
    }
    for (int i = 0; i < lab_sweep_curves(&st->sweep); i++) {
        const swept_run *r = &st->sweep.runs[i];
        runs[count++] = (shown_run){SHOWN_SWEPT, i, &r->run.trace, swept_id | r->id};
    }
    if (s->has_ghost) {
        runs[count++] = (shown_run){SHOWN_BEFORE, 0, &s->ghost.trace, state_run_id(st)};
    }
    if (st->measured.row_count > 0) {
        runs[count++] = (shown_run){SHOWN_MEASURED, 0, &st->measured,
                                    pinned_id >> 1 | st->measured_id};
    }
    return count;
}

int state_run_count(const explorer_state *st)
{
    shown_run runs[SHOWN_RUNS];
    return state_runs(st, NULL, runs);
}

shown_run state_run(const explorer_state *st, int index)
{
    shown_run runs[SHOWN_RUNS];
    const int count = state_runs(st, NULL, runs);
    assert(index >= 0 && index < count);
    return runs[index];
}

size_t state_row(const explorer_state *st, const trace *t)
{
    const session *s = &st->session;
    return trace_row_on_side(t, s->now, trace_side(&s->run.trace, s->row));
}

const char *state_run_name(const explorer_state *st, int index)
{
    const shown_run r = state_run(st, index);
    if (r.kind == SHOWN_PINNED) {
        return st->pinned.runs[r.index].name;
    }
    return "";
}
