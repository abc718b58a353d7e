// Actions that change the run: values, pushes, undo, sliders, the list of changes.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

// act_give with a number, in small steps: several at one instant are one change, and none
// at all once the value is what it was.
static bool act_adjust(explorer_state *st, int parameter, double value)
{
    assert(parameter >= 0 && parameter < parameter_count);
    session *s = &st->session;
    parameters p = state_parameters(st);
    char text[LINE_TEXT];

    // checked and rounded as the table has it
    if (!act_worked(st, parameter_set_number(&p, parameter, value, &st->fault))) {
        return false;
    }
    parameter_format(&p, parameter, text, sizeof text);

    // a value that is as it was leaves no change
    const int changes = s->input_count;
    if (!act_worked(st, session_adjust(s, parameter, text, &st->fault))) {
        return false;
    }
    if (s->input_count < changes) {
        return act_tell(st, "%s is %s %s again", parameter_table[parameter].path, text,
                        parameter_table[parameter].unit);
    }
    return act_tell_change(st);
}

// The parameter of a path, of its last part or of a beginning of either.
static bool find_parameter(explorer_state *st, const char *name, int *parameter)
{
    *parameter = parameter_of_name(name);
    if (*parameter == -2) {
        return act_refuse(st, "several parameters begin with '%s' (Tab lists them)",
                          name);
    }
    if (*parameter < 0 && parameter_look_up(name, &st->fault) < 0) {
        return act_worked(st, STATUS_BAD_ARGUMENT);
    }
    return true;
}

bool act_set(explorer_state *st, const char *argument)
{
    // the path, and the value after blanks or an equals sign
    char path[LINE_TEXT];
    int parameter;
    const char *value = text_cut(argument, " =", path, sizeof path);
    if (path[0] == '\0') {
        return act_refuse(st, "set takes a parameter and a value, such as arm.k2 10");
    }
    if (!find_parameter(st, path, &parameter)) {
        return false;
    }

    // without a value it is only selected
    parameter_list_select(&st->parameters, (parameter_line){parameter, false});
    if (value[0] == '\0') {
        const parameter_info *info = &parameter_table[parameter];
        const char *inert = state_inert_reason(st, parameter);
        if (inert != NULL) {
            return act_tell(st, "%s: %s; without effect, %s", info->path,
                            info->description, inert);
        }
        return act_tell(st, "%s: %s", info->path, info->description);
    }
    return act_give(st, parameter, value);
}

// How far a nudge of a real parameter goes up from a value: a fixed step, or on a
// logarithmic scale a tenth of the value's decade.
static double nudge_step(int parameter, double value)
{
    enum { LEAST_STEPS = 50 };
    slider_scale scale;
    parameters p;

    // the scale is that of the usual value, so that it stays as the value moves
    parameters_defaults(&p, ARM_CORRECTED);
    double usual = parameter_get(&p, parameter);
    if (!isfinite(usual)) {
        usual = value;
    }
    if (!slider_scale_of(parameter, usual, &scale)) {
        return 0;
    }

    // what rounding leaves just below a power of ten counts as that power
    if (scale.logarithmic) {
        return pow(10, floor(log10(fabs(value)) + 1e-9)) / 10;
    }
    return pow(10, floor(log10((scale.high - scale.low) / LEAST_STEPS) + 1e-9));
}

// A real parameter's value one nudge up or down; what goes down comes up to where it was.
static double nudged(int parameter, double value, int direction)
{
    double above = value; // where the step is that of going up
    if (direction < 0) {
        above = value * (1 - 1e-6);
    }
    const double step = nudge_step(parameter, above);
    char text[NUMBER_TEXT];
    snprintf(text, sizeof text, "%.6g", value + direction * step);
    return strtod(text, NULL);
}

// The next or the previous value of the selected parameter: a step more or less, another
// choice.
bool act_nudge(explorer_state *st, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1, index = st->parameters.parameter;
    if (st->side.panel == PANEL_SWEEP && lab_sweep_is_map(&st->sweep)) {
        const int across = (int)st->sweep.axis.count,
                  to = st->sweep.selected % across + direction;
        if (to >= 0 && to < across) {
            act_select_swept(st, direction);
        }
        return true;
    }
    const parameter_info *info = &parameter_table[index];
    if (st->parameters.on_heading) {
        return act_refuse(st, "no parameter is selected (arrows up and down select one)");
    }
    parameters p = state_parameters(st);
    double value = parameter_get(&p, index);
    if (strcmp(info->path, "control.lock") == 0) {
        return act_lock(st, direction > 0 ? "next" : "previous");
    }
    if (parameter_is_text(info)) {
        return act_refuse(st, "%s is a %s: Enter edits it", info->path,
                          info->type == PARAMETER_LIST ? "list" : "text");
    }

    // a number by a step, anything else to its neighbour
    if (info->type == PARAMETER_REAL) {
        value = nudged(index, value, direction);
    } else {
        value = value + direction;
    }
    return act_adjust(st, index, fmax(info->minimum, fmin(info->maximum, value)));
}

// Makes the run of the selected value the present run, by a change from the start.
static bool take_swept(explorer_state *st)
{
    const lab_sweep *sweep = &st->sweep;
    session *s = &st->session;
    char value[SWEEP_VALUE_TEXT];
    double values[2];
    if (sweep->selected >= sweep->count) {
        return act_refuse(st, "the sweep has no run yet");
    }

    // a change from the start, whatever is looked at
    const double now = s->now;
    const sweep_axis *axes[] = {&sweep->axis, &sweep->second};
    bool changed = true;
    lab_sweep_values(sweep, sweep->selected, values);
    for (int i = 0; i <= lab_sweep_is_map(sweep) && changed; i++) {
        session_seek(s, 0);
        sweep_axis_format(axes[i], values[i], value, sizeof value);
        changed = act_give(st, axes[i]->parameter, value);
    }
    const double seen = s->seen;
    session_seek(s, now);
    s->seen = fmax(seen, s->now);
    return changed;
}

bool act_edit(explorer_state *st, const char *argument)
{
    // a parameter by name is selected first
    int index = st->parameters.parameter;
    if (argument[0] != '\0') {
        if (!find_parameter(st, argument, &index)) {
            return false;
        }
        parameter_list_select(&st->parameters, (parameter_line){index, false});
    } else if (st->side.panel == PANEL_SWEEP) {
        return take_swept(st);
    }
    if (st->parameters.on_heading) {
        parameter_list_fold(&st->parameters, index);
        return true;
    }
    char value[LINE_TEXT];
    const parameters p = state_parameters(st);
    const parameter_info *info = &parameter_table[index];
    parameter_format(&p, index, value, sizeof value);
    if (info->type == PARAMETER_REAL && value[0] != '\0') {
        snprintf(value, sizeof value, "%.15g", parameter_get(&p, index));
    }
    prompt_open(&st->prompt, value, "set %s ", info->path);

    // what can be typed, or why it makes no difference
    const char *inert = state_inert_reason(st, index), *about = info->description;
    if (inert != NULL) {
        return act_warn(st, "%s has no effect: %s", info->path, inert);
    }
    if (info->choices != NULL && info->type == PARAMETER_CHOICE) {
        return act_tell(st, "%s: %s", about, info->choices);
    }
    if (info->type != PARAMETER_TEXT && info->type != PARAMETER_BOOLEAN) {
        return act_tell(st, "%s: %g to %g %s", about, info->minimum, info->maximum,
                        info->unit);
    }
    return act_tell(st, "%s", about);
}

bool act_push(explorer_state *st, const char *argument)
{
    session_forget_ghost(&st->session);
    double impulse = 0.01;
    return act_read_number_or(st, argument, "", &impulse) &&
           act_worked(st, session_push(&st->session, impulse, &st->fault)) &&
           (act_tell_failed_run(st) ||
            act_tell(st, "pushed with %g N s at %.4f s", impulse, st->session.now));
}

// Takes the last change back (direction -1) or puts it in again (1), and so with the
// opening of a scenario, which is before the first change and after the last.
static bool turn(explorer_state *st, int direction)
{
    session *s = &st->session;
    session_forget_ghost(s);
    const bool back = direction < 0;
    const int last = back ? 0 : s->input_total;
    if (s->input_count == last && state_can_turn(st, direction)) {
        if (!act_worked(st, state_turn(st, direction, &st->fault))) {
            return false;
        }
        if (back) {
            return act_tell(st, "in %s again, U opens the one you left", s->base.name);
        }
        return act_tell(st, "in %s again, u goes back", s->base.name);
    }

    // a change
    if (back) {
        return act_worked(st, session_undo(s, &st->fault)) &&
               act_tell(st, "undone, U puts it in again");
    }
    return act_worked(st, session_redo(s, &st->fault)) && act_tell(st, "put in again");
}

bool act_undo(explorer_state *st, const char *argument)
{
    (void)argument;
    return turn(st, -1);
}

bool act_redo(explorer_state *st, const char *argument)
{
    (void)argument;
    return turn(st, 1);
}

bool act_model(explorer_state *st, const char *argument)
{
    (void)argument;
    bool printed = st->session.effective.parameters.arm.model == ARM_PRINTED;
    return act_give(st, PARAMETER_INDEX(arm.model), printed ? "corrected" : "printed");
}

bool act_extend(explorer_state *st, const char *argument)
{
    char text[NUMBER_TEXT];
    double duration = st->session.effective.parameters.run.duration, more = duration;
    if (!act_read_number_or(st, argument, "", &more)) {
        return false;
    }

    // what has been seen stays seen: only rows are added
    const double seen = st->session.seen;
    number_format(text, duration + more);
    const bool longer = act_give(st, PARAMETER_INDEX(run.duration), text);
    if (longer) {
        st->session.seen = seen;
    }
    return longer;
}

// --- sliders ---------------------------------------------------------------------------

void act_hold_slider(explorer_state *st, int parameter, double share, int cells)
{
    assert(parameter >= 0 && parameter < parameter_count);
    slider_grip *grip = &st->slider;
    const parameters p = state_parameters(st);

    // the scale stays as it was when the mouse took hold
    const bool begins = !grip->held || grip->parameter != parameter;
    if (begins &&
        !slider_scale_of(parameter, parameter_get(&p, parameter), &grip->scale)) {
        return;
    }
    grip->held = true;
    grip->parameter = parameter;
    parameter_list_select(&st->parameters, (parameter_line){parameter, false});
    grip->value = slider_value(&grip->scale, parameter, share, cells);
}

bool act_follow_slider(explorer_state *st)
{
    const slider_grip *grip = &st->slider;
    const parameters p = state_parameters(st);
    return !grip->held || parameter_get(&p, grip->parameter) == grip->value ||
           act_adjust(st, grip->parameter, grip->value);
}

bool act_drop_slider(explorer_state *st)
{
    const bool followed = act_follow_slider(st);
    st->slider.held = false;
    return followed;
}

// --- the list of changes ---------------------------------------------------------------

// Reads the number of a change off *text; -1 if it is refused.
static int read_change(explorer_state *st, const char **text)
{
    const int count = st->session.input_count;
    if (count == 0) {
        act_refuse(st, "there are no changes");
        return -1;
    }
    return act_read_index(st, text, count, "changes", ":changes");
}

bool act_change(explorer_state *st, const char *argument)
{
    const int index = read_change(st, &argument);
    if (index < 0) {
        return false;
    }
    char text[LINE_TEXT];
    const session_input *in = &st->session.inputs[index];

    // without a value it is asked for
    if (argument[0] == '\0' && in->kind != SESSION_INPUT_PUSH) {
        prompt_open(&st->prompt, in->text, "change %d ", index + 1);
        return act_tell(st, "%s", parameter_table[in->parameter].description);
    }
    if (!act_worked(st,
                    session_change_input(&st->session, index, argument, &st->fault))) {
        return false;
    }
    st->change = st->session.input_count - 1;
    state_change_text(st, st->change, text, sizeof text);
    return act_tell(st, "%s at the same instant, u takes it back", text);
}

bool act_drop(explorer_state *st, const char *argument)
{
    char text[LINE_TEXT];
    const int index = read_change(st, &argument);
    if (index < 0) {
        return false;
    }

    // the text first: the change is gone afterwards
    state_change_text(st, index, text, sizeof text);
    if (!act_worked(st, session_drop_input(&st->session, index, &st->fault))) {
        return false;
    }

    // the selection stays within the list
    const int last = st->session.input_count - 1;
    if (st->change > last) {
        if (last < 0) {
            st->change = 0;
        } else {
            st->change = last;
        }
    }
    return act_tell(st, "without %s; U puts it in again", text);
}
