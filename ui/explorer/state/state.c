#include "ui/explorer/state/state.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/rig/controller.h"
#include "src/rig/rig.h"

static double duration_of(const explorer_state *st)
{
    return st->session.effective.parameters.run.duration;
}

// --- opening and closing ----------------------------------------------------------------------

// Fills the panes for the present run on the present screen.
static void define_panes(explorer_state *st)
{
    enum { FEWEST = 3, ROWS = 6, HEAD = 8 };
    const scenario *base = &st->session.base;
    const int room = (st->size.height - HEAD) * 3 / 5 / ROWS;

    // a lesson leaves little room next to its own panes
    const int least = st->lesson.on ? 2 : FEWEST;
    const pane_wishes wishes = {state_has_law(st), base->panes, base->pane_count, st->lesson.on,
                                room < least ? least : room};
    panes_define(&st->panes, &wishes);
}

// The parameter that a run is about: what its law presses with, or the voltage.
static int main_parameter(const explorer_state *st)
{
    const parameters *p = &st->session.effective.parameters;
    const controller *law = controller_of(p->control.law);
    int found = state_has_law(st) ? PARAMETER_INDEX(control.rate) : PARAMETER_INDEX(motor.voltage);

    // what the law presses with, if it does, else the first number of its own
    for (int i = law != NULL ? law->parameter_count : 0; i-- > 0;) {
        char path[PARAMETER_NAME];
        snprintf(path, sizeof path, "control.%s", law->parameters[i].name);
        const int own = parameter_find(path);
        found = own >= 0 && (i == 0 || own == PARAMETER_INDEX(control.force)) &&
                        found != PARAMETER_INDEX(control.force)
                    ? own
                    : found;
    }
    return found;
}

// Begins the scenario's lesson, if it has one, with the parameters that matter to it.
static void begin_lesson(explorer_state *st)
{
    const lesson *l = &st->session.base.lesson;
    st->lesson = (lesson_progress){.on = l->step_count > 0};
    for (int i = 0; l->parameter_count > 0 && i < PARAMETER_GROUPS; i++) {
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
    parameter_list_arrange(&st->parameters, &st->session.effective.parameters, main_parameter(st));
    st->mark.set = false;
    begin_lesson(st);
    time_window_show_all(&st->window);
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
        loss_unless(session_keep_beside(&st->session, &list->runs[list->baseline].run, NULL) ==
                    STATUS_OK);
    }
    run_list_name_strangers(&st->pinned, &st->session);
    show_anew(st);
}

// What there is, to be returned to.
static status take_visit(const explorer_state *st, visit *v, fault *f)
{
    v->lesson = st->lesson;
    return run_origin_take(&v->from, &st->session, f);
}

status state_take_session(explorer_state *st, session *fresh, fault *f)
{
    visit left;
    TRY(take_visit(st, &left, f));

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
    visit left, *to = &st->visits[st->present_visit + direction];
    session fresh;
    status code = session_reopen(&fresh, &to->from, st->session.patience, f);
    TRY(code);
    code = take_visit(st, &left, f);
    if (code != STATUS_OK) {
        session_finish(&fresh);
        return code;
    }
    replace_session(st, &fresh);
    st->lesson = to->lesson;
    st->visits[st->present_visit] = left;
    st->present_visit += direction;
    run_origin_finish(&to->from);
    return STATUS_OK;
}

// --- the runs ---------------------------------------------------------------------------------

unsigned long state_run_id(const explorer_state *st)
{
    return ((unsigned long)st->opened << 32) | st->session.version;
}

int state_visible_pins(const explorer_state *st)
{
    int count = 0;
    for (int i = 0; i < st->pinned.count; i++) {
        count += !st->pinned.runs[i].hidden;
    }
    return count;
}

int state_run_count(const explorer_state *st)
{
    if (st->difference.on && st->session.has_other) {
        return 1;
    }
    return 1 + state_visible_pins(st) + lab_sweep_curves(&st->sweep) + st->session.has_ghost +
           (st->measured.row_count > 0);
}

// The number of a pinned run by its number among those that are not hidden.
static int visible_pin(const explorer_state *st, int wanted)
{
    int index = 0;
    for (; st->pinned.runs[index].hidden || wanted > 0; index++) {
        wanted -= !st->pinned.runs[index].hidden;
    }
    return index;
}

shown_run state_run(const explorer_state *st, int index)
{
    assert(index >= 0 && index < state_run_count(st));
    const session *s = &st->session;
    const int pins = state_visible_pins(st);
    const unsigned long pinned_id = 1ul << 62, swept_id = 1ul << 63, difference_id = 3ul << 62;

    // the present one, the pinned ones, the sweep's, the one before
    if (index == 0 && st->difference.on && s->has_other) {
        return (shown_run){SHOWN_DIFFERENCE, 0, &st->difference.trace,
                           difference_id | st->difference.built};
    }
    if (index == 0) {
        return (shown_run){SHOWN_PRESENT, 0, &s->run.trace, state_run_id(st)};
    }
    if (st->measured.row_count > 0 && index == state_run_count(st) - 1) {
        return (shown_run){SHOWN_MEASURED, 0, &st->measured, pinned_id >> 1 | st->measured_id};
    }
    if (index <= pins) {
        const int pin = visible_pin(st, index - 1);
        const pinned_run *p = &st->pinned.runs[pin];
        return (shown_run){SHOWN_PINNED, pin, &p->run.trace, pinned_id | p->id};
    }
    if (index <= pins + lab_sweep_curves(&st->sweep)) {
        const swept_run *r = &st->sweep.runs[index - 1 - pins];
        return (shown_run){SHOWN_SWEPT, index - 1 - pins, &r->run.trace, swept_id | r->id};
    }
    return (shown_run){SHOWN_BEFORE, 0, &s->ghost.trace, state_run_id(st)};
}

int state_pane_run_count(const explorer_state *st, const pane *p)
{
    return p->view == VIEW_RESIDUAL ? st->residual.trace.row_count > 0 : state_run_count(st);
}

shown_run state_pane_run(const explorer_state *st, const pane *p, int index)
{
    if (p->view != VIEW_RESIDUAL) {
        return state_run(st, index);
    }
    return (shown_run){SHOWN_MEASURED, 0, &st->residual.trace, 3ul << 61 | st->residual.built};
}

const char *state_run_name(const explorer_state *st, int index)
{
    const shown_run r = state_run(st, index);
    return r.kind == SHOWN_PINNED ? st->pinned.runs[r.index].name : "";
}

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
    snprintf(text, size, "%s = %s%s%s", info->path, value, info->unit[0] ? " " : "", info->unit);
}

int state_parameter_lines(const explorer_state *st, parameter_line lines[PARAMETER_LINES])
{
    return parameter_list_lines(&st->parameters, st->filters.text[PANEL_PARAMETERS], lines);
}

const char *state_inert_reason(const explorer_state *st, int parameter)
{
    return inert_reason(&st->session.effective.parameters, parameter);
}

// --- the visible part -------------------------------------------------------------------------

void state_window(const explorer_state *st, double *from, double *to)
{
    time_window_range(&st->window, duration_of(st), from, to);
}

void state_show_part(explorer_state *st, double from, double to)
{
    time_window_show(&st->window, duration_of(st), from, to);
}

// --- axes of values ---------------------------------------------------------------------------

// What a signal does in the rows from `first` to `last`, whole blocks at once where they are known.
static value_range range_of_rows(const trace *t, int signal, const double *pairs, size_t first,
                                 size_t last)
{
    value_range found = value_range_empty;

    // a whole block where it lies in the range, else one row
    for (size_t r = first; r <= last && r < t->row_count;) {
        if (pairs != NULL && r % EXTREMES_BLOCK == 0 && r + EXTREMES_BLOCK <= last + 1) {
            const double *pair = pairs + 2 * (r / EXTREMES_BLOCK);
            value_range_widen(&found, (value_range){pair[0], pair[1]});
            r += EXTREMES_BLOCK;
        } else {
            value_range_add(&found, signal_value(&t->rows[r++], signal));
        }
    }
    return found;
}

// The same without the share of rows that sticks out at either end, so that a spike does not
// flatten all else; of many rows some, evenly spread.
static value_range calm_range(const trace *t, int signal, size_t first, size_t last)
{
    enum { ROWS = 4096, STICKS_OUT = 50 }; // one in so many
    static double values[ROWS];
    const size_t end = last < t->row_count ? last + 1 : t->row_count;
    const size_t stride = (end - first) / ROWS + 1;
    size_t count = 0;
    for (size_t r = first; r < end; r += stride) {
        const double value = signal_value(&t->rows[r], signal);
        if (isfinite(value)) {
            values[count++] = value;
        }
    }
    if (count == 0) {
        return value_range_empty;
    }
    qsort(values, count, sizeof *values, compare_numbers);
    const double low = values[count / STICKS_OUT], high = values[count - 1 - count / STICKS_OUT];
    const double margin = 0.05 * (high - low);
    return (value_range){low - margin, high + margin};
}

// What a pane's signals do between two instants, in the first `runs` of the runs shown.
static value_range range_between(const explorer_state *st, const pane *p, double from, double to,
                                 int runs)
{
    value_range found = value_range_empty;
    for (int run = 0; run < runs; run++) {
        const shown_run shown = state_pane_run(st, p, run);
        const trace *t = shown.trace;
        // one more row at the end, to which the line continues
        const size_t first = trace_row_at(t, from), last = trace_row_at(t, to) + 1;
        for (int k = 0; k < p->count; k++) {
            if (p->hidden >> k & 1) {
                continue;
            }
            const double *pairs = extremes_pairs(&st->extremes[run], shown.id, t, p->signals[k]);
            value_range_widen(&found, p->scaling == AXIS_CALM
                                          ? calm_range(t, p->signals[k], first, last)
                                          : range_of_rows(t, p->signals[k], pairs, first, last));
        }
    }
    return found;
}

bool state_pane_axis(const explorer_state *st, int index, value_range *axis)
{
    assert(index >= 0 && index < PANES);
    const pane *p = &st->panes.pane[index];
    double from, to;
    const bool subtracts = state_run(st, 0).kind == SHOWN_DIFFERENCE;
    if (!pane_is_over_time(p) || ((subtracts || p->view == VIEW_RESIDUAL) && pane_is_derived(p))) {
        return false;
    }
    state_window(st, &from, &to);
    value_range found = range_between(st, p, from, to, state_pane_run_count(st, p));
    if (!(found.high >= found.low)) {
        return false;
    }

    // what was found counts unless the axis grows or is fixed
    if (p->scaling == AXIS_GROW && p->grown.high >= p->grown.low) {
        found = p->grown;
    } else if (p->scaling == AXIS_FIXED) {
        found = p->fixed;
    }
    *axis = p->scaling == AXIS_FIXED ? found : value_range_opened(found);
    return true;
}

// --- up to date -------------------------------------------------------------------------------

// The blocks of all signals that are shown.
static void update_extremes(explorer_state *st)
{
    for (int run = 0; run < state_run_count(st); run++) {
        const shown_run shown = state_run(st, run);
        for (int i = 0; i < PANES; i++) {
            const pane *p = &st->panes.pane[i];
            for (int k = 0; p->shown && k < p->count; k++) {
                extremes_update(&st->extremes[run], shown.id, shown.trace, p->signals[k]);
            }
        }
    }
}

// Takes what has been seen into the axes that grow.
static void grow_axes(explorer_state *st)
{
    for (int i = 0; i < PANES; i++) {
        pane *p = &st->panes.pane[i];
        if (p->scaling == AXIS_GROW && p->shown && pane_is_over_time(p)) {
            const int runs = p->view == VIEW_TIME ? 1 : state_pane_run_count(st, p);
            value_range_widen(&p->grown, range_between(st, p, 0, st->session.seen, runs));
        }
    }
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
    const unsigned long both = state_run_id(st) * 1000003 + st->measured_id * 997 + t->row_count;
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
    if (s->has_other) {
        difference_update(&st->difference, state_run_id(st), &s->run.trace, &s->other.trace);
    }
    update_residual(st);
    update_extremes(st);
    grow_axes(st);
    time_window_follow(&st->window, duration_of(st), st->session.now);
    state_law_modes(st);
    state_run_log(st);
}
