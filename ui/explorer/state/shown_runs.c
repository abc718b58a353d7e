// The runs whose curves are shown, in their order: the present one, that as opened, the
// pinned ones, those of a sweep, the one before an adjustment, and measured data. And the
// run that the present one is compared with.
#include "ui/explorer/state/state.h"

#include <assert.h>

#include "render/plot/run_style.h"
#include "src/run/resume.h"

// The highest bits of the identity of a run's rows: those of two kinds are never the
// same.
enum { ID_MEASURED = 1, ID_PINNED, ID_RESIDUAL, ID_SWEPT, ID_OPENED, ID_DIFFERENCE };

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

bool model_shows_others(const explorer_model *model)
{
    bool others = model->opened_run.shown;
    for (int i = 0; i < model->pinned.count; i++) {
        others = others || !model->pinned.runs[i].hidden;
    }
    return others && !model_subtracts(model);
}

int shown_run_rank(const shown_run *run)
{
    switch (run->kind) {
    case SHOWN_PRESENT:
        return 1;
    case SHOWN_OPENED:
        return 2;
    case SHOWN_PINNED:
        return 3 + run->index;
    default:
        return 0;
    }
}

ink run_ink(int rank)
{
    assert(rank > 0);
    return (ink)(INK_SERIES_0 + run_style_of(rank).slot);
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

    // the present one, that as opened, the pinned ones, the sweep's
    int count = 0;
    const reference_run *o = &model->opened_run;
    runs[count++] = (shown_run){SHOWN_PRESENT, 0, &s->run.trace, model_run_id(model)};
    if (o->shown) {
        runs[count++] =
            (shown_run){SHOWN_OPENED, 0, &o->run.trace, id_of(ID_OPENED, o->id)};
    }
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

    // what was measured
    if (model->measured.row_count > 0) {
        runs[count++] = (shown_run){SHOWN_MEASURED, 0, &model->measured,
                                    id_of(ID_MEASURED, model->measured_id)};
    }
    assert(count <= SHOWN_RUNS);
    return count;
}

int shown_signal(const shown_run *run, const pane *p, int k)
{
    const int reading = SIGNAL_INDEX(force_reading);
    const bool of_force = p->signals[k] == SIGNAL_INDEX(force) && p->view == VIEW_TIME;
    if (run->kind != SHOWN_MEASURED || !of_force ||
        trace_has(run->trace, p->signals[k])) {
        return p->signals[k];
    }
    for (int i = 0; i < p->count; i++) {
        if (p->signals[i] == reading) {
            return p->signals[k]; // it has a curve of its own
        }
    }
    return reading;
}

const pinned_run *model_kept_run(const explorer_model *model)
{
    const session *s = &model->session;
    const run_list *pins = &model->pinned;
    if (!s->has_other || pins->baseline < 0 ||
        !run_origin_is_of(&pins->runs[pins->baseline].from, s)) {
        return NULL;
    }
    return &pins->runs[pins->baseline];
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

// --- the run for comparison ------------------------------------------------------------

// Finds out whether a pinned run is the one as opened, where runs were pinned or dropped
// since that was done last.
static void find_opened_run_pinned(explorer_model *model)
{
    const run_list *pins = &model->pinned;
    reference_run *o = &model->opened_run;
    const unsigned long pins_now = pins->pinned * (PINNED_RUNS + 1) + pins->count + 1;
    if (o->pins_seen == pins_now) {
        return;
    }
    o->pins_seen = pins_now;
    o->pinned = false;
    for (int i = 0; i < pins->count; i++) {
        const run_origin *from = &pins->runs[i].from;
        o->pinned = o->pinned || (from->input_count == 0 &&
                                  same_base(&from->base, &model->session.base));
    }
}

void model_forget_opened_run(explorer_model *model)
{
    reference_run *o = &model->opened_run;
    if (o->kept) {
        run_finish(&o->run);
    }
    *o = (reference_run){0};
}

// Keeps the present run as the one as opened, if it is that and complete.
static status keep_opened_run(explorer_model *model, fault *f)
{
    const session *s = &model->session;
    reference_run *o = &model->opened_run;
    const unsigned long id = model_run_id(model);
    if (s->input_count > 0 || s->computing != NULL || (o->kept && o->id == id)) {
        return STATUS_OK;
    }
    model_forget_opened_run(model);
    o->id = id;
    if (run_share(&s->run, &o->run) != STATUS_OK) {
        return fault_no_memory(f);
    }
    o->kept = true;
    return STATUS_OK;
}

status model_follow_reference(explorer_model *model, fault *f)
{
    session *s = &model->session;
    reference_run *o = &model->opened_run;
    const run_list *pins = &model->pinned;
    TRY(keep_opened_run(model, f));
    find_opened_run_pinned(model);
    o->shown = o->kept && s->input_count > 0 && !o->pinned;

    // the baseline, else the run as opened once there is a change
    const run_result *run = NULL;
    unsigned long id = 0;
    if (pins->baseline >= 0) {
        run = &pins->runs[pins->baseline].run;
        id = id_of(ID_PINNED, pins->runs[pins->baseline].id);
    } else if (o->kept && s->input_count > 0) {
        run = &o->run;
        id = id_of(ID_OPENED, o->id);
    }

    // kept beside the session as long as it stays the same
    if (run == NULL) {
        session_forget_other(s);
    } else if (!s->has_other || model->reference != id) {
        TRY(session_keep_beside(s, run, f));
    }
    model->reference = id;
    return STATUS_OK;
}

const char *model_reference_name(const explorer_model *model)
{
    const run_list *pins = &model->pinned;
    if (!model->session.has_other) {
        return "";
    }
    return pins->baseline >= 0 ? pins->runs[pins->baseline].name : AS_OPENED;
}

int model_reference_rank(const explorer_model *model)
{
    const int baseline = model->pinned.baseline;
    const shown_run pinned = {.kind = SHOWN_PINNED, .index = baseline};
    const shown_run opened = {.kind = SHOWN_OPENED};
    return shown_run_rank(baseline >= 0 ? &pinned : &opened);
}
