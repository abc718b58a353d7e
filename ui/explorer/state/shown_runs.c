// The runs whose curves are shown, in their order: the present one, the pinned ones,
// those of a sweep, the one before an adjustment, and measured data.
#include "ui/explorer/state/state.h"

#include <assert.h>

// The highest bits of the identity of a run's rows: those of two kinds are never the
// same.
enum { ID_MEASURED = 1, ID_PINNED, ID_RESIDUAL, ID_SWEPT, ID_DIFFERENCE = 6 };

static unsigned long id_of(unsigned long kind, unsigned long number)
{
    return kind << 61 | number;
}

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

    // data minus the run, or the run minus the baseline, alone
    if (p != NULL && p->view == VIEW_RESIDUAL) {
        const run_difference *d = &model->residual;
        runs[0] = (shown_run){SHOWN_MEASURED, 0, &d->trace, id_of(ID_RESIDUAL, d->built)};
        return d->trace.row_count > 0;
    }
    if (model_subtracts(model)) {
        const run_difference *d = &model->difference;
        runs[0] =
            (shown_run){SHOWN_DIFFERENCE, 0, &d->trace, id_of(ID_DIFFERENCE, d->built)};
        return 1;
    }

    // the present one, the pinned ones, the sweep's
    int count = 0;
    runs[count++] = (shown_run){SHOWN_PRESENT, 0, &s->run.trace, model_run_id(model)};
    for (int i = 0; i < pins->count; i++) {
        const pinned_run *r = &pins->runs[i];
        if (!r->hidden) {
            runs[count++] =
                (shown_run){SHOWN_PINNED, i, &r->run.trace, id_of(ID_PINNED, r->id)};
        }
    }
    for (int i = 0; i < lab_sweep_curves(&model->sweep); i++) {
        const swept_run *r = &model->sweep.runs[i];
        runs[count++] =
            (shown_run){SHOWN_SWEPT, i, &r->run.trace, id_of(ID_SWEPT, r->id)};
    }

    // the one before an adjustment, and what was measured
    if (s->has_ghost) {
        runs[count++] =
            (shown_run){SHOWN_BEFORE, 0, &s->ghost.trace, model_run_id(model)};
    }
    if (model->measured.row_count > 0) {
        runs[count++] = (shown_run){SHOWN_MEASURED, 0, &model->measured,
                                    id_of(ID_MEASURED, model->measured_id)};
    }
    assert(count <= SHOWN_RUNS);
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
