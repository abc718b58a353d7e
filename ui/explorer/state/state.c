#include "ui/explorer/state/state.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/rig/controller.h"
#include "src/rig/rig.h"
#include "src/scenario/effect.h"

// --- opening and closing ---------------------------------------------------------------

// Fills the panes for the present run on the present screen.
static void define_panes(explorer_state *st)
{
    enum { FEWEST = 3, ROWS = 6, HEAD = 8 };
    const scenario *base = &st->session.base;
    const int room = (st->size.height - HEAD) * 3 / 5 / ROWS;

    // a lesson leaves little room next to its own panes
    const int least = st->lesson.on ? 2 : FEWEST;
    const pane_wishes wishes = {state_has_law(st), base->panes, base->pane_count,
                                st->lesson.on, room < least ? least : room};
    panes_define(&st->panes, &wishes);
}

// The parameter that a run is about: what its law presses with, or the voltage.
static int main_parameter(const explorer_state *st)
{
    const controller *law = controller_of(st->session.effective.parameters.control.law);
    const int force = PARAMETER_INDEX(control.force);
    int found = -1;

    // what the law presses with, if it does, else the first number of its own
    for (int i = 0; law != NULL && i < law->parameter_count && found != force; i++) {
        char path[PARAMETER_NAME];
        snprintf(path, sizeof path, "control.%s", law->parameters[i].name);
        const int own = parameter_find(path);
        if (i == 0 || own == force) {
            found = own;
        }
    }
    if (found >= 0) {
        return found;
    }
    if (state_has_law(st)) {
        return PARAMETER_INDEX(control.rate);
    }
    return PARAMETER_INDEX(motor.voltage);
}

// Begins the scenario's lesson, if it has one, with the parameters that matter to it.
static void begin_lesson(explorer_state *st)
{
    const lesson *l = &st->session.base.lesson;
    st->lesson = (lesson_progress){.on = l->step_count > 0};
    for (int i = 0; l->parameter_count > 0 && i < parameter_count; i++) {
        st->parameters.folded[i] = true;
    }
    for (int i = l->parameter_count; i-- > 0;) {
        parameter_list_select(&st->parameters, (parameter_line){l->parameters[i], false});
    }
}

// How a session is shown at first.
static void show_anew(explorer_state *st)
{
    st->opened++;
    if (st->side.panel == PANEL_SWEEP) {
        st->side.panel = PANEL_PARAMETERS;
    }
    parameter_list_arrange(&st->parameters, &st->session.effective, main_parameter(st));
    st->mark.set = false;
    begin_lesson(st);
    st->window = (time_window){0};
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        st->panes.pane[i].hidden = 0;
    }
    define_panes(st);
}

status state_init(explorer_state *st, scenario *s, double patience, fault *f)
{
    memset(st, 0, sizeof *st);
    TRY(session_open(&st->session, s, patience, f));

    st->visit_count = 1;
    st->limit.signal = st->band.signal = -1;
    st->pinned.baseline = -1;
    st->sweep.metric = SUMMARY_INDEX(peak_force_N);
    st->playback.speed = 0.2;
    st->looks.mouse = true;
    st->looks.pixels = true;
    st->looks.bending = 1;
    st->playback.slow = USUAL_SLOW;
    st->side.panel = PANEL_PARAMETERS;
    scenario_menu_read(&st->scenarios);
    show_anew(st);
    return STATUS_OK;
}

void state_finish(explorer_state *st)
{
    // what was found out about the runs goes before them
    for (int i = 0; i < SHOWN_RUNS; i++) {
        extremes_forget(&st->extremes[i]);
    }
    run_log_forget(&st->log);
    scenario_menu_finish(&st->scenarios);
    difference_finish(&st->difference);
    difference_finish(&st->residual);
    trace_finish(&st->measured);
    free(st->copied);
    lab_sweep_end(&st->sweep);
    while (st->pinned.count > 0) {
        run_list_drop(&st->pinned, st->pinned.count - 1);
    }
    for (int i = 0; i < st->visit_count; i++) {
        run_origin_finish(&st->visits[i].from);
    }
    session_finish(&st->session);
}

// Puts a session in the place of the present one, which is compared with what that was.
static void replace_session(explorer_state *st, session *fresh)
{
    const run_list *list = &st->pinned;
    difference_finish(&st->difference);
    lab_sweep_end(&st->sweep);
    session_finish(&st->session);
    st->session = *fresh;
    if (list->baseline >= 0) {
        loss_unless(session_keep_beside(&st->session, &list->runs[list->baseline].run,
                                        NULL) == STATUS_OK);
    }
    run_list_name_strangers(&st->pinned, &st->session);
    show_anew(st);
}

status state_take_session(explorer_state *st, session *fresh, fault *f)
{
    // what there is, to be returned to
    visit left = {.lesson = st->lesson};
    TRY(run_origin_take(&left.from, &st->session, f));

    // what undoing had left is given up, and the oldest where there is no room
    for (int i = st->present_visit + 1; i < st->visit_count; i++) {
        run_origin_finish(&st->visits[i].from);
    }
    st->visits[st->present_visit] = left;
    if (st->present_visit == VISITS - 1) {
        run_origin_finish(&st->visits[0].from);
        memmove(&st->visits[0], &st->visits[1], (VISITS - 1) * sizeof st->visits[0]);
        st->present_visit--;
    }
    st->visits[++st->present_visit] = (visit){0};
    st->visit_count = st->present_visit + 1;
    replace_session(st, fresh);
    return STATUS_OK;
}

bool state_can_turn(const explorer_state *st, int direction)
{
    assert(direction == 1 || direction == -1);
    const int to = st->present_visit + direction;
    return to >= 0 && to < st->visit_count;
}

status state_turn(explorer_state *st, int direction, fault *f)
{
    assert(state_can_turn(st, direction));
    visit left = {.lesson = st->lesson}, *to = &st->visits[st->present_visit + direction];
    session fresh;
    TRY(run_origin_take(&left.from, &st->session, f));
    const status code = session_reopen(&fresh, &to->from, st->session.patience, f);
    if (code != STATUS_OK) {
        run_origin_finish(&left.from);
        return code;
    }
    replace_session(st, &fresh);
    st->lesson = to->lesson;
    st->visits[st->present_visit] = left;
    st->present_visit += direction;
    run_origin_finish(&to->from);
    return STATUS_OK;
}

// --- the runs --------------------------------------------------------------------------

parameters state_parameters(const explorer_state *st)
{
    return session_parameters_at(&st->session, st->session.now);
}

bool state_has_law(const explorer_state *st)
{
    return st->session.effective.parameters.control.law != LAW_NONE;
}

const law_modes *state_law_modes(explorer_state *st)
{
    law_modes *m = &st->modes;
    if (m->run != state_run_id(st)) {
        const parameters *p = &st->session.effective.parameters;
        m->run = state_run_id(st);
        m->count = rig_mode_names(p, m->names, LAW_MODES, &m->lockable);
    }
    return m;
}

const run_log *state_run_log(explorer_state *st)
{
    const session *s = &st->session;
    run_log_update(&st->log, state_run_id(st), &s->run.trace, s->computing == NULL);
    return &st->log;
}

void state_change_text(const explorer_state *st, int index, char *text, size_t size)
{
    assert(index >= 0 && index < st->session.input_count);
    const session_input *in = &st->session.inputs[index];
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

int state_parameter_lines(const explorer_state *st, parameter_line lines[PARAMETER_LINES],
                          int *selected)
{
    return parameter_list_lines(&st->parameters, st->filters.text[PANEL_PARAMETERS],
                                lines, selected);
}

const char *state_inert_reason(const explorer_state *st, int parameter)
{
    return effect_none(&st->session.effective, parameter);
}

// --- up to date ------------------------------------------------------------------------

// The force by which two traces are aligned, -1 if none is in both.
static int common_force(const trace *a, const trace *b)
{
    static const int forces[] = {SIGNAL_INDEX(piezo_force), SIGNAL_INDEX(force_reading),
                                 SIGNAL_INDEX(force)};
    int found = -1;
    for (size_t i = 0; i < sizeof forces / sizeof forces[0]; i++) {
        if (trace_has(a, forces[i]) && trace_has(b, forces[i])) {
            found = forces[i];
        }
    }
    return found;
}

// The first instant at which a signal is above a level [s], NaN if it never is.
static double first_above(const trace *t, int signal, double level)
{
    size_t r = 0;
    while (r < t->row_count && !(signal_value(&t->rows[r], signal) > level)) {
        r++;
    }
    if (r < t->row_count) {
        return t->rows[r].time;
    }
    return (double)NAN;
}

bool state_lay_data(explorer_state *st, double shift)
{
    const trace *run = &st->session.run.trace, *data = &st->measured;
    const int force = common_force(data, run);
    st->measured_aligned = isnan(shift);
    st->measured_run = state_run_id(st);

    // a tenth of the measured largest force marks the touch in both
    if (isnan(shift) && force >= 0) {
        const double first = data->rows[0].time,
                     last = data->rows[data->row_count - 1].time;
        const double level = trace_statistics(data, force, first, last).maximum / 10;
        shift = st->measured_shift + first_above(run, force, level) -
                first_above(data, force, level);
    }
    if (!isfinite(shift)) {
        return false;
    }
    for (size_t r = 0; r < data->row_count; r++) {
        data->rows[r].time += shift - st->measured_shift;
    }
    st->measured_shift = shift;
    st->measured_id++;
    return true;
}

// The measured data minus the run, where a pane shows them.
static void update_residual(explorer_state *st)
{
    run_difference *d = &st->residual;
    d->on = false;
    for (int i = 0; i < PANES; i++) {
        const pane *p = &st->panes.pane[i];
        d->on = d->on || (p->shown && p->view == VIEW_RESIDUAL);
    }
    if (!d->on || st->measured.row_count == 0) {
        difference_finish(d);
        return;
    }

    // a run that grows has more to compare with: all of it anew
    const trace *t = &st->session.run.trace;
    const unsigned long both =
        state_run_id(st) * 1000003 + st->measured_id * 997 + t->row_count;
    difference_update(d, both, &st->measured, t);
}

void state_update(explorer_state *st)
{
    // the panes depend on the law and on the room there is
    const bool taller = st->size.height != st->panes_height;
    if (state_has_law(st) != st->panes.controlled || taller) {
        define_panes(st);
        st->panes_height = st->size.height;
    }

    // what follows the run and its instant
    const session *s = &st->session;
    const bool moved = s->computing == NULL && st->measured_run != state_run_id(st);
    if (moved && st->measured_aligned && st->measured.row_count > 0) {
        state_lay_data(st, (double)NAN);
    }
    if (s->has_other) {
        difference_update(&st->difference, state_run_id(st), &s->run.trace,
                          &s->other.trace);
    }
    update_residual(st);
    state_update_axes(st);
    state_law_modes(st);
    state_run_log(st);
}
