#include "ui/explorer/state/state.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/resume.h"
#include "src/rig/rig.h"
#include "src/scenario/effect.h"

// --- opening and closing ---------------------------------------------------------------

// Fills the panes for the present run on the present screen.
static void define_panes(const explorer_model *model, explorer_view *view)
{
    // one beside that of force, also beside what a scenario wants, and another one for
    // every so many rows more
    enum { FEWEST = 2, HEAD = 12, ROWS = 12 };
    const scenario *base = &model->session.base;
    int room = FEWEST;
    if (base->pane_count > 0 && !model->lesson.on) {
        room++;
    }
    if (view->size.height > HEAD) {
        room += (view->size.height - HEAD) * 3 / 5 / ROWS;
    }
    const pane_wishes wishes = {model_has_law(model), base->panes, base->pane_count,
                                model->lesson.on, room};
    panes_define(&view->panes, &wishes);
}

// Begins the scenario's lesson, if it has one, with the parameter that matters most to
// it.
static void begin_lesson(explorer_model *model, explorer_view *view)
{
    const lesson *l = &model->session.base.lesson;
    model->lesson = (lesson_progress){.on = l->step_count > 0};
    if (l->parameter_count > 0) {
        view->parameters.parameter = l->parameters[0];
    }
}

// The run of a session's scenario without its changes becomes the one as opened, if it
// can be had within the patience of a change.
static status compute_opened_run(explorer_model *model, fault *f)
{
    const session *s = &model->session;
    const run_origin from = {.base = s->base};
    reference_run *o = &model->opened_run;
    session plain;
    TRY(session_reopen(&plain, &from, s->patience, f));
    const bool complete = plain.computing == NULL;
    status code = STATUS_OK;
    if (complete) {
        code = run_share(&plain.run, &o->run);
        o->kept = code == STATUS_OK;
        o->id = (unsigned long)model->opened << 32;
    }
    session_finish(&plain);
    return code;
}

// Finds the run as opened, of a session that was opened with changes by computing it.
static void find_opened_run(explorer_model *model)
{
    fault f = {0};
    model_forget_opened_run(model);
    if (model->session.input_count > 0) {
        loss_unless(compute_opened_run(model, &f) != STATUS_NO_MEMORY);
    }
    loss_unless(model_follow_reference(model, &f) == STATUS_OK);
}

// How a session is shown at first.
static void show_from_start(explorer_model *model, explorer_view *view)
{
    model->opened++;
    find_opened_run(model);
    if (view->side.panel == PANEL_SWEEP) {
        view->side.panel = PANEL_PARAMETERS;
    }
    view->parameters.parameter = model_main_parameter(model);
    view->mark.set = false;
    begin_lesson(model, view);
    model_choose_knobs(model, &view->parameters);
    view->window = (time_window){0};
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        view->panes.pane[i].hidden = 0;
    }
    define_panes(model, view);
}

status state_init(explorer_model *model, explorer_view *view, scenario *s,
                  double patience, fault *f)
{
    memset(model, 0, sizeof *model);
    memset(view, 0, sizeof *view);
    TRY(session_open(&model->session, s, patience, f));

    model->visit_count = 1;
    model->limit.signal = -1;
    model->limit.quantity = -1;
    model->pinned.baseline = -1;
    model->sweep.metric = SUMMARY_INDEX(peak_force_N);
    view->playback.speed = 0.2;
    view->looks.mouse = true;
    view->looks.pixels = true;
    view->looks.bending = 1;
    view->playback.slow = USUAL_SLOW;
    view->side.panel = PANEL_PARAMETERS;
    scenario_menu_read(&view->scenarios);
    show_from_start(model, view);
    return STATUS_OK;
}

void state_finish(explorer_model *model, explorer_view *view)
{
    // what was found out about the runs goes before them
    for (int i = 0; i < SHOWN_RUNS; i++) {
        extremes_forget(&model->extremes[i]);
    }
    run_log_forget(&model->log);
    model_forget_opened_run(model);
    scenario_menu_finish(&view->scenarios);
    difference_finish(&model->difference);
    difference_finish(&model->residual);
    trace_finish(&model->measured);
    lab_sweep_end(&model->sweep);
    while (model->pinned.count > 0) {
        run_list_drop(&model->pinned, model->pinned.count - 1);
    }
    for (int i = 0; i < model->visit_count; i++) {
        run_origin_finish(&model->visits[i].from);
    }
    session_finish(&model->session);
    free(model->saved_looks);
}

// Puts a session in the place of the present one, which is compared with what that was.
static void replace_session(explorer_model *model, explorer_view *view, session *fresh)
{
    difference_finish(&model->difference);
    lab_sweep_end(&model->sweep);
    session_finish(&model->session);
    model->session = *fresh;
    run_list_name_strangers(&model->pinned, &model->session);
    show_from_start(model, view);
}

status state_take_session(explorer_model *model, explorer_view *view, session *fresh,
                          fault *f)
{
    // what there is, to be returned to
    visit left = {.lesson = model->lesson};
    TRY(run_origin_take(&left.from, &model->session, f));

    // what undoing had left is given up, and the oldest where there is no room
    for (int i = model->present_visit + 1; i < model->visit_count; i++) {
        run_origin_finish(&model->visits[i].from);
    }
    model->visits[model->present_visit] = left;
    if (model->present_visit == VISITS - 1) {
        run_origin_finish(&model->visits[0].from);
        memmove(&model->visits[0], &model->visits[1],
                (VISITS - 1) * sizeof model->visits[0]);
        model->present_visit--;
    }
    model->visits[++model->present_visit] = (visit){0};
    model->visit_count = model->present_visit + 1;
    replace_session(model, view, fresh);
    return STATUS_OK;
}

bool model_has_visit(const explorer_model *model, int direction)
{
    assert(direction == 1 || direction == -1);
    const int to = model->present_visit + direction;
    return to >= 0 && to < model->visit_count;
}

status state_change_visit(explorer_model *model, explorer_view *view, int direction,
                          fault *f)
{
    assert(model_has_visit(model, direction));
    visit left = {.lesson = model->lesson},
          *to = &model->visits[model->present_visit + direction];
    session fresh;
    TRY(run_origin_take(&left.from, &model->session, f));
    const status code = session_reopen(&fresh, &to->from, model->session.patience, f);
    if (code != STATUS_OK) {
        run_origin_finish(&left.from);
        return code;
    }
    replace_session(model, view, &fresh);
    model->lesson = to->lesson;
    model->visits[model->present_visit] = left;
    model->present_visit += direction;
    run_origin_finish(&to->from);
    return STATUS_OK;
}

// --- the runs --------------------------------------------------------------------------

parameters model_parameters(const explorer_model *model)
{
    return session_parameters_at(&model->session, model->session.now);
}

bool model_has_law(const explorer_model *model)
{
    return model->session.effective.parameters.control.law != LAW_NONE;
}

const law_modes *model_law_modes(explorer_model *model)
{
    law_modes *m = &model->modes;
    if (m->run != model_run_id(model)) {
        const parameters *p = &model->session.effective.parameters;
        m->run = model_run_id(model);
        m->count = rig_mode_names(p, m->names, LAW_MODES, &m->lockable);
    }
    return m;
}

const run_log *model_run_log(explorer_model *model)
{
    const session *s = &model->session;
    run_log_update(&model->log, model_run_id(model), &s->run.trace, s->computing == NULL);
    return &model->log;
}

void model_change_text(const explorer_model *model, int index, char *text, size_t size)
{
    assert(index >= 0 && index < model->session.input_count);
    const session_input *in = &model->session.inputs[index];
    if (in->kind == SESSION_INPUT_PUSH) {
        snprintf(text, size, "push %g N s", in->value);
        return;
    }
    const parameter_info *info = &parameter_table[in->parameter];
    char value[SESSION_INPUT_TEXT];
    input_value_text(in, value);
    snprintf(text, size, "%s = %s%s%s", info->path, value, info->unit[0] ? " " : "",
             info->unit);
}

int view_parameter_lines(const explorer_view *view, parameter_line lines[PARAMETER_LINES],
                         int *selected)
{
    return parameter_list_lines(&view->parameters, view->filters.text[PANEL_PARAMETERS],
                                lines, selected);
}

const char *model_inert_reason(const explorer_model *model, int parameter)
{
    return effect_none(&model->session.effective, parameter);
}

int model_levels(const explorer_model *model, const pane *p,
                 shown_level levels[SHOWN_LEVELS])
{
    const struct {
        int signal, parameter;
        bool both_ways;
    } kinds[] = {{SIGNAL_INDEX(force), PARAMETER_INDEX(control.force_limit), false},
                 {SIGNAL_INDEX(command), PARAMETER_INDEX(motor.voltage_limit), true},
                 {SIGNAL_INDEX(hub_angle), PARAMETER_INDEX(wall.angle), false},
                 {SIGNAL_INDEX(hub_velocity), PARAMETER_INDEX(control.speed_limit),
                  true}};
    int count = 0;

    // the bound that was asked for, of its signal
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] == model->limit.signal) {
            levels[count++] = (shown_level){"limit", model->limit.bound, p->signals[k]};
        }
    }

    // what the law is to hold, and the band in which it has settled
    const int first = p->signals[0];
    if (first == SIGNAL_INDEX(force)) {
        const value_range band = view_force_band(model);
        if (isfinite(band.low) && isfinite(band.high)) {
            const double middle = (band.low + band.high) / 2;
            levels[count++] = (shown_level){"command +/-5 %", band.high, first};
            levels[count++] = (shown_level){"", middle, first};
            levels[count++] = (shown_level){"", band.low, first};
        }
    }

    // those that belong to the first signal of the pane and have a value in the run
    const parameters now = model_parameters(model);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        const int parameter = kinds[i].parameter;
        if (p->signals[0] != kinds[i].signal ||
            model_inert_reason(model, parameter) != NULL) {
            continue;
        }
        const char *name = strchr(parameter_table[parameter].path, '.') + 1;
        const double value = parameter_get(&now, parameter);
        if (value == 0 && parameter != PARAMETER_INDEX(wall.angle)) {
            continue; // no limit
        }
        levels[count++] = (shown_level){name, value, p->signals[0]};
        if (kinds[i].both_ways) {
            levels[count++] = (shown_level){name, -value, p->signals[0]};
        }
    }
    return count;
}

// --- up to date ------------------------------------------------------------------------

// The forces by which measured data are aligned to a run: the same in both, else what
// the data have with the run's own. False if there are none.
static bool common_forces(const trace *data, const trace *run, int *of_data, int *of_run)
{
    static const int forces[] = {SIGNAL_INDEX(piezo_force), SIGNAL_INDEX(force_reading),
                                 SIGNAL_INDEX(force)};
    bool same = false;
    *of_data = -1;
    for (size_t i = 0; i < sizeof forces / sizeof forces[0]; i++) {
        const bool both = trace_has(run, forces[i]);
        if (trace_has(data, forces[i]) && (both || !same)) {
            *of_data = forces[i];
            same = both;
        }
    }
    *of_run = same ? *of_data : SIGNAL_INDEX(force);
    return *of_data >= 0 && trace_has(run, *of_run);
}

// The first instant at which a signal is above a level [s], NaN if it never is.
static double first_above(const trace *t, int signal, double level)
{
    for (size_t r = 0; r < t->row_count; r++) {
        if (signal_value(&t->rows[r], signal) > level) {
            return t->rows[r].time;
        }
    }
    return (double)NAN;
}

bool model_lay_data(explorer_model *model, double shift)
{
    const trace *run = &model->session.run.trace, *data = &model->measured;
    int force, of_run;
    const bool has_forces = common_forces(data, run, &force, &of_run);
    model->measured_aligned = isnan(shift);
    model->measured_run = model_run_id(model);

    // a tenth of the measured largest force marks the touch in both
    if (isnan(shift) && has_forces) {
        const double first = data->rows[0].time,
                     last = data->rows[data->row_count - 1].time;
        const double level = trace_statistics(data, force, first, last).maximum / 10;
        shift = model->measured_shift + first_above(run, of_run, level) -
                first_above(data, force, level);
    }
    if (!isfinite(shift)) {
        return false;
    }
    for (size_t r = 0; r < data->row_count; r++) {
        data->rows[r].time += shift - model->measured_shift;
    }
    model->measured_shift = shift;
    model->measured_id++;
    return true;
}

// The measured data minus the run, where a pane shows them.
static void update_residual(explorer_model *model, const explorer_view *view)
{
    run_difference *d = &model->residual;
    d->on = false;
    for (int i = 0; i < PANES; i++) {
        const pane *p = &view->panes.pane[i];
        d->on = d->on || (p->shown && p->view == VIEW_RESIDUAL);
    }
    if (!d->on || model->measured.row_count == 0) {
        difference_finish(d);
        return;
    }

    // a run that grows has more to compare with: all of it is computed again
    const trace *t = &model->session.run.trace;
    const unsigned long both =
        model_run_id(model) * 1000003 + model->measured_id * 997 + t->row_count;
    difference_update(d, both, &model->measured, t);
}

void state_update(explorer_model *model, explorer_view *view)
{
    // the panes depend on the law and on the room there is
    const bool taller = view->size.height != view->panes_height;
    if (model_has_law(model) != view->panes.controlled || taller) {
        define_panes(model, view);
        view->panes_height = view->size.height;
    }

    // what follows the run and its instant
    loss_unless(model_follow_reference(model, NULL) == STATUS_OK);
    const session *s = &model->session;
    const bool moved = s->computing == NULL && model->measured_run != model_run_id(model);
    if (moved && model->measured_aligned && model->measured.row_count > 0) {
        model_lay_data(model, (double)NAN);
    }
    if (s->has_other) {
        difference_update(&model->difference, model_run_id(model), &s->run.trace,
                          &s->other.trace);
    }
    update_residual(model, view);
    model_choose_knobs(model, &view->parameters);
    state_update_axes(model, view);
    model_law_modes(model);
    model_run_log(model);
}
