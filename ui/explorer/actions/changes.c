// Actions that change the run: values, pushes, branches, undo, sliders.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

action_result act_change(explorer_state *st, int parameter, const char *text)
{
    assert(st != NULL && text != NULL && parameter >= 0 && parameter < parameter_count);
    fault f = {0};
    session *s = &st->session;
    const parameter_info *info = &parameter_table[parameter];
    status code = session_change(s, parameter, text, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }

    // the run may stop with the new value, which must be known
    const session_input *in = &s->inputs[s->input_count - 1];
    if (s->run.summary.status != STATUS_OK || s->run.summary.inaccurate) {
        return act_tell_failed_run(st);
    }
    if (in->kind == SESSION_INPUT_TIMED) {
        return result_news("%s = %s %s from %.4f s on", info->path, text, info->unit, in->time);
    }
    return result_news("%s = %s %s from the start", info->path, text, info->unit);
}

action_result act_set(explorer_state *st, const char *argument)
{
    // the path, and the value after blanks or an equals sign
    char path[LINE_TEXT];
    size_t length = strcspn(argument, " =");
    snprintf(path, sizeof path, "%.*s", (int)length, argument);
    const char *value = argument + length + strspn(argument + length, " =");
    int parameter = parameter_find(path);
    if (parameter < 0) {
        const char *near = parameter_suggest(path);
        return result_refused("there is no parameter '%s'%s%s%s", path,
                              near ? ", did you mean " : "", near ? near : "", near ? "?" : "");
    }

    // without a value it is only selected
    st->side.parameter = parameter;
    if (value[0] == '\0') {
        const parameter_info *info = &parameter_table[parameter];
        return result_news("%s: %s", info->path, info->description);
    }
    return act_change(st, parameter, value);
}

// The next or the previous value of the selected parameter: a tenth more or less, another choice.
action_result act_nudge(explorer_state *st, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1, index = st->side.parameter;
    const parameter_info *info = &parameter_table[index];
    parameters p = state_parameters(st);
    double value = parameter_get(&p, index);
    char text[LINE_TEXT];
    fault f = {0};
    if (strcmp(info->path, "control.lock") == 0) {
        return act_lock(st, direction > 0 ? "next" : "previous");
    }
    if (info->type == PARAMETER_TEXT) {
        return result_refused("%s is a text: Enter edits it", info->path);
    }

    // a number by a tenth of its decade, anything else to its neighbour
    if (info->type == PARAMETER_REAL) {
        double size = value != 0 ? fabs(value) : 0.1;
        value += direction * pow(10, floor(log10(size) + 1e-9)) / 10;
        snprintf(text, sizeof text, "%.6g", value);
        value = strtod(text, NULL);
    } else {
        value += direction;
    }
    value = fmax(info->minimum, fmin(info->maximum, value));
    status code = parameter_set_number(&p, index, value, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    parameter_format(&p, index, text, sizeof text);
    return act_change(st, index, text);
}

action_result act_edit(explorer_state *st, const char *argument)
{
    (void)argument;
    char value[LINE_TEXT];
    parameters p = state_parameters(st);
    parameter_format(&p, st->side.parameter, value, sizeof value);
    const parameter_info *info = &parameter_table[st->side.parameter];
    prompt_open(&st->prompt, "set %s %.160s", info->path, value);

    // what can be typed
    if (info->choices != NULL && info->type == PARAMETER_CHOICE) {
        return result_news("%s: %s", info->description, info->choices);
    }
    if (info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER) {
        return result_news("%s: %g to %g %s", info->description, info->minimum, info->maximum,
                           info->unit);
    }
    return result_news("%s", info->description);
}

action_result act_push(explorer_state *st, const char *argument)
{
    double impulse = 0.01;
    fault f = {0};
    action_result read = act_read_optional(argument, &impulse);
    if (!result_ok(&read)) {
        return read;
    }
    status code = session_push(&st->session, impulse, &f);
    return code != STATUS_OK
               ? result_of(code, &f)
               : result_news("pushed with %g N s at %.4f s", impulse, st->session.now);
}

action_result act_undo(explorer_state *st, const char *argument)
{
    (void)argument;
    fault f = {0};
    status code = session_undo(&st->session, &f);
    return code != STATUS_OK ? result_of(code, &f) : result_news("undone, U puts it in again");
}

action_result act_redo(explorer_state *st, const char *argument)
{
    (void)argument;
    fault f = {0};
    status code = session_redo(&st->session, &f);
    return code != STATUS_OK ? result_of(code, &f) : result_news("put in again");
}

action_result act_branch(explorer_state *st, const char *argument)
{
    (void)argument;
    fault f = {0};
    status code = session_branch(&st->session, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    return result_news("branched at %.4f s: change something, the old run stays beside it "
                       "(c compares, B forgets it)",
                       st->session.now);
}

action_result act_forget(explorer_state *st, const char *argument)
{
    (void)argument;
    session_forget_other(&st->session);
    return result_done();
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
    grip->parameter = st->side.parameter = d.parameter;
    grip->value = slider_value(&grip->scale, d.parameter, d.share, d.cells);
}

action_result act_drop_slider(explorer_state *st)
{
    assert(st != NULL);
    const slider_grip grip = st->slider;
    st->slider.held = false;
    parameters p = state_parameters(st);
    if (!grip.held || parameter_get(&p, grip.parameter) == grip.value) {
        return result_done();
    }

    // the value is given as text, as one that was typed would be
    char text[64];
    fault f = {0};
    status code = parameter_set_number(&p, grip.parameter, grip.value, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    parameter_format(&p, grip.parameter, text, sizeof text);
    return act_change(st, grip.parameter, text);
}
