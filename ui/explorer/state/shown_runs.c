// The runs whose curves are shown, in their order: the present one, the pinned ones,
// those of a sweep, the one before an adjustment, and measured data.
#include "ui/explorer/state/state.h"

#include <assert.h>

unsigned long model_run_id(const explorer_model *model)
{
    return ((unsigned long)model->opened << 32) | model->session.version;
}

bool model_subtracts(const explorer_model *model)
{
    return model->difference.on && model->session.has_other;
}

int model_visible_pins(const explorer_model *model)
{
    int count = 0;
    for (int i = 0; i < model->pinned.count; i++) {
        if (!model->pinned.runs[i].hidden) {
            count++;
        }
    }
    return count;
}

int model_runs(const explorer_model *model, const pane *p, shown_run runs[SHOWN_RUNS])
{
    const session *s = &model->session;
    const run_list *pins = &model->pinned;
    const unsigned long pinned_id = 1ul << 62, swept_id = 1ul << 63;
    int count = 0;

    // data minus the run, or the run minus the baseline, alone
    if (p != NULL && p->view == VIEW_RESIDUAL) {
        runs[0] = (shown_run){SHOWN_MEASURED, 0, &model->residual.trace,
                              3ul << 61 | model->residual.built};
        return model->residual.trace.row_count > 0;
    }
    if (model_subtracts(model)) {
        runs[0] = (shown_run){SHOWN_DIFFERENCE, 0, &model->difference.trace,
                              pinned_id | swept_id | model->difference.built};
        return 1;
    }

    // the present one, the pinned ones, the sweep's, the one before, what was measured
    runs[count++] = (shown_run){SHOWN_PRESENT, 0, &s->run.trace, model_run_id(model)};
    for (int i = 0; i < pins->count; i++) {
        const pinned_run *r = &pins->runs[i];
        if (!r->hidden) {
            runs[count++] =
                (shown_run){SHOWN_PINNED, i, &r->run.trace, pinned_id | r->id};
        }
    }
    for (int i = 0; i < lab_sweep_curves(&model->sweep); i++) {
        const swept_run *r = &model->sweep.runs[i];
        runs[count++] = (shown_run){SHOWN_SWEPT, i, &r->run.trace, swept_id | r->id};
    }
    if (s->has_ghost) {
        runs[count++] =
            (shown_run){SHOWN_BEFORE, 0, &s->ghost.trace, model_run_id(model)};
    }
    if (model->measured.row_count > 0) {
        runs[count++] = (shown_run){SHOWN_MEASURED, 0, &model->measured,
                                    pinned_id >> 1 | model->measured_id};
    }
    return count;
}

int model_run_count(const explorer_model *model)
{
    shown_run runs[SHOWN_RUNS];
    return model_runs(model, NULL, runs);
}

shown_run model_run(const explorer_model *model, int index)
{
    shown_run runs[SHOWN_RUNS];
    const int count = model_runs(model, NULL, runs);
    assert(index >= 0 && index < count);
    return runs[index];
}

size_t model_row(const explorer_model *model, const trace *t)
{
    const session *s = &model->session;
    return trace_row_on_side(t, s->now, trace_side(&s->run.trace, s->row));
}

const char *model_run_name(const explorer_model *model, int index)
{
    const shown_run r = model_run(model, index);
    if (r.kind == SHOWN_PINNED) {
        return model->pinned.runs[r.index].name;
    }
    return "";
}
