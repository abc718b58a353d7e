// Actions that change the run: values, pushes, branches, undo, sliders.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

// What the last input came to: that the run stops with it, that it has no effect, or its news.
static action_result tell_change(const explorer_state *st)
{
    const session *s = &st->session;
    const session_input *in = &s->inputs[s->input_count - 1];
    const parameter_info *info = &parameter_table[in->parameter];
    char when[48] = "from the start";
    if (s->run.summary.status != STATUS_OK || s->run.summary.inaccurate) {
        return act_tell_failed_run(st);
    }
    if (in->kind == SESSION_INPUT_TIMED) {
        snprintf(when, sizeof when, "from %.4f s on", in->time);
    }

    // a change without effect must not look like one with it
    const parameters p = session_parameters_at(s, in->time);
    const char *inert = state_inert_reason(st, in->parameter);
    const char *blank = info->unit[0] ? " " : "";
    if (inert != NULL) {
        return result_warning("%s = %s%s%s %s, without effect: %s", info->path, in->text, blank,
                              info->unit, when, inert);
    }
    if (in->parameter == PARAMETER_INDEX(motor.voltage) &&
        fabs(p.motor.voltage) > p.motor.voltage_limit) {
        return result_warning("%s = %s V %s, more than motor.voltage_limit: the command saturates "
                              "at %g V",
                              info->path, in->text, when, p.motor.voltage_limit);
    }
    return result_news("%s = %s%s%s %s", info->path, in->text, blank, info->unit, when);
}

action_result act_change(explorer_state *st, int parameter, const char *text)
{
    assert(st != NULL && text != NULL && parameter >= 0 && parameter < parameter_count);
    session_forget_ghost(&st->session);
    fault f = {0};
    status code = session_change(&st->session, parameter, text, &f);
    return code != STATUS_OK ? result_of(code, &f) : tell_change(st);
}

// act_change with a number, in small steps: several at one instant are one change, and none at all
// once the value is what it was.
static action_result act_adjust(explorer_state *st, int parameter, double value)
{
    assert(st != NULL && parameter >= 0 && parameter < parameter_count);
    session *s = &st->session;
    parameters p = state_parameters(st);
    char text[LINE_TEXT];
    fault f = {0};

    // checked and rounded as the table has it
    status code = parameter_set_number(&p, parameter, value, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    parameter_format(&p, parameter, text, sizeof text);

    // a value that is as it was leaves no change
    const int changes = s->input_count;
    code = session_adjust(s, parameter, text, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    if (s->input_count < changes) {
        return result_news("%s is %s %s again", parameter_table[parameter].path, text,
                           parameter_table[parameter].unit);
    }
    return tell_change(st);
}

// The parameter of a path, of its last part or of a beginning of either.
static action_result find_parameter(const char *name, int *parameter)
{
    fault f = {0};
    *parameter = parameter_of_name(name);
    if (*parameter == -2) {
        return result_refused("several parameters begin with '%s' (Tab lists them)", name);
    }
    if (*parameter < 0 && parameter_look_up(name, &f) < 0) {
        return result_of(STATUS_BAD_ARGUMENT, &f);
    }
    return result_done();
}

action_result act_set(explorer_state *st, const char *argument)
{
    // the path, and the value after blanks or an equals sign
    char path[LINE_TEXT];
    int parameter;
    size_t length = strcspn(argument, " =");
    if (length == 0) {
        return result_refused("set takes a parameter and a value, such as arm.k2 10");
    }
    snprintf(path, sizeof path, "%.*s", (int)length, argument);
    const char *value = argument + length + strspn(argument + length, " =");
    const action_result found = find_parameter(path, &parameter);
    if (!result_ok(&found)) {
        return found;
    }

    // without a value it is only selected
    parameter_list_select(&st->parameters, (parameter_line){parameter, false});
    if (value[0] == '\0') {
        const parameter_info *info = &parameter_table[parameter];
        const char *inert = state_inert_reason(st, parameter);
        return result_news("%s: %s%s%s", info->path, info->description,
                           inert != NULL ? "; without effect, " : "", inert != NULL ? inert : "");
    }
    return act_change(st, parameter, value);
}

// How far a nudge of a real parameter goes up from a value: a fixed step, or on a logarithmic scale
// a tenth of the value's decade.
static double nudge_step(int parameter, double value)
{
    enum { LEAST_STEPS = 50 };
    slider_scale scale;
    parameters p;

    // the scale is that of the usual value, so that it stays as the value moves
    parameters_defaults(&p, ARM_CORRECTED);
    const double usual = parameter_get(&p, parameter);
    if (!slider_scale_of(parameter, isfinite(usual) ? usual : value, &scale)) {
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
    const double step = nudge_step(parameter, direction < 0 ? value * (1 - 1e-6) : value);
    char text[NUMBER_TEXT];
    snprintf(text, sizeof text, "%.6g", value + direction * step);
    return strtod(text, NULL);
}

// The next or the previous value of the selected parameter: a step more or less, another choice.
action_result act_nudge(explorer_state *st, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1, index = st->parameters.parameter;
    const parameter_info *info = &parameter_table[index];
    if (st->parameters.on_heading) {
        return result_refused("no parameter is selected (arrows up and down select one)");
    }
    parameters p = state_parameters(st);
    double value = parameter_get(&p, index);
    if (strcmp(info->path, "control.lock") == 0) {
        return act_lock(st, direction > 0 ? "next" : "previous");
    }
    if (parameter_is_text(info)) {
        return result_refused("%s is a %s: Enter edits it", info->path,
                              info->type == PARAMETER_LIST ? "list" : "text");
    }

    // a number by a step, anything else to its neighbour
    value = info->type == PARAMETER_REAL ? nudged(index, value, direction) : value + direction;
    return act_adjust(st, index, fmax(info->minimum, fmin(info->maximum, value)));
}

action_result act_edit(explorer_state *st, const char *argument)
{
    // a parameter by name is selected first
    if (argument[0] != '\0') {
        int parameter;
        const action_result found = find_parameter(argument, &parameter);
        if (!result_ok(&found)) {
            return found;
        }
        parameter_list_select(&st->parameters, (parameter_line){parameter, false});
    } else if (st->side.panel == PANEL_SWEEP) {
        return act_take_swept(st);
    }
    if (st->parameters.on_heading) {
        parameter_list_fold(&st->parameters, st->parameters.parameter);
        return result_done();
    }
    char value[LINE_TEXT];
    parameters p = state_parameters(st);
    parameter_format(&p, st->parameters.parameter, value, sizeof value);
    const parameter_info *info = &parameter_table[st->parameters.parameter];
    char line[LINE_TEXT];
    snprintf(line, sizeof line, "set %s ", info->path);
    prompt_open_value(&st->prompt, line, value);

    // what can be typed, or why it makes no difference
    const char *inert = state_inert_reason(st, st->parameters.parameter);
    if (inert != NULL) {
        return result_warning("%s has no effect: %s", info->path, inert);
    }
    if (info->choices != NULL && info->type == PARAMETER_CHOICE) {
        return result_news("%s: %s", info->description, info->choices);
    }
    if (info->type != PARAMETER_TEXT && info->type != PARAMETER_BOOLEAN) {
        return result_news("%s: %g to %g %s", info->description, info->minimum, info->maximum,
                           info->unit);
    }
    return result_news("%s", info->description);
}

action_result act_push(explorer_state *st, const char *argument)
{
    session_forget_ghost(&st->session);
    double impulse = 0.01;
    fault f = {0};
    action_result read = act_read_optional(argument, &impulse);
    if (!result_ok(&read)) {
        return read;
    }
    status code = session_push(&st->session, impulse, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    const action_result stopped = act_tell_failed_run(st);
    return stopped.speaks ? stopped
                          : result_news("pushed with %g N s at %.4f s", impulse, st->session.now);
}

action_result act_undo(explorer_state *st, const char *argument)
{
    session_forget_ghost(&st->session);
    (void)argument;
    fault f = {0};
    status code = session_undo(&st->session, &f);
    return code != STATUS_OK ? result_of(code, &f) : result_news("undone, U puts it in again");
}

action_result act_redo(explorer_state *st, const char *argument)
{
    session_forget_ghost(&st->session);
    (void)argument;
    fault f = {0};
    status code = session_redo(&st->session, &f);
    return code != STATUS_OK ? result_of(code, &f) : result_news("put in again");
}

action_result act_exchange_model(explorer_state *st, const char *argument)
{
    (void)argument;
    bool printed = st->session.effective.parameters.arm.model == ARM_PRINTED;
    return act_change(st, PARAMETER_INDEX(arm.model), printed ? "corrected" : "printed");
}

action_result act_extend(explorer_state *st, const char *argument)
{
    char text[NUMBER_TEXT];
    double duration = st->session.effective.parameters.run.duration, more = duration;
    action_result read = act_read_optional(argument, &more);
    if (!result_ok(&read)) {
        return read;
    }

    // what has been seen stays seen: only rows are added
    double seen = st->session.seen;
    number_format(text, duration + more);
    action_result changed = act_change(st, PARAMETER_INDEX(run.duration), text);
    if (result_ok(&changed)) {
        st->session.seen = seen;
    }
    return changed;
}

// --- sliders ----------------------------------------------------------------------------------

void act_hold_slider(explorer_state *st, slider_drag d)
{
    assert(st != NULL && d.parameter >= 0 && d.parameter < parameter_count);
    slider_grip *grip = &st->slider;
    parameters p = state_parameters(st);

    // the scale stays as it was when the mouse took hold
    bool begins = !grip->held || grip->parameter != d.parameter;
    if (begins && !slider_scale_of(d.parameter, parameter_get(&p, d.parameter), &grip->scale)) {
        return;
    }
    grip->held = true;
    grip->parameter = d.parameter;
    parameter_list_select(&st->parameters, (parameter_line){d.parameter, false});
    grip->value = slider_value(&grip->scale, d.parameter, d.share, d.cells);
}

action_result act_follow_slider(explorer_state *st)
{
    assert(st != NULL);
    const slider_grip *grip = &st->slider;
    const parameters p = state_parameters(st);
    if (!grip->held || parameter_get(&p, grip->parameter) == grip->value) {
        return result_done();
    }
    return act_adjust(st, grip->parameter, grip->value);
}

action_result act_drop_slider(explorer_state *st)
{
    assert(st != NULL);
    const action_result followed = act_follow_slider(st);
    st->slider.held = false;
    return followed;
}
