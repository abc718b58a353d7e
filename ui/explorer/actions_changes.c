// Actions that change the run: values, pushes, branches, undo.
#include "ui/explorer/actions.h"
#include "src/base/numbers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool lab_change(lab *l, int parameter, const char *text)
{
    fault f = {0};
    session *s = &l->session;
    const parameter_info *info = &parameter_table[parameter];
    if (!lab_complain(l, session_change(s, parameter, text, &f), &f)) {
        return false;
    }
    const session_input *in = &s->inputs[s->input_count - 1];
    if (s->run.summary.status != STATUS_OK) {
        lab_say(l, true, "the run stops: %s", s->run.summary.message);
    } else if (in->kind == SESSION_INPUT_TIMED) {
        lab_say(l, false, "%s = %s %s from %.4f s on", info->path, text, info->unit, in->time);
    } else {
        lab_say(l, false, "%s = %s %s from the start", info->path, text, info->unit);
    }
    return true;
}

bool act_set(lab *l, const char *argument)
{
    char path[LAB_TEXT];
    size_t length = strcspn(argument, " =");
    snprintf(path, sizeof path, "%.*s", (int)length, argument);
    const char *value = argument + length + strspn(argument + length, " =");
    int parameter = parameter_find(path);
    if (parameter < 0) {
        const char *near = parameter_suggest(path);
        lab_say(l, true, "there is no parameter '%s'%s%s%s", path, near ? ", did you mean " : "",
                near ? near : "", near ? "?" : "");
        return false;
    }
    if (value[0] == '\0') {
        const parameter_info *info = &parameter_table[parameter];
        l->parameter = parameter;
        lab_say(l, false, "%s: %s", info->path, info->description);
        return true;
    }
    l->parameter = parameter;
    return lab_change(l, parameter, value);
}

// The next or the previous value of the selected parameter: a tenth more or less, another choice.
bool act_nudge(lab *l, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1, index = l->parameter;
    const parameter_info *info = &parameter_table[index];
    parameters p = session_parameters_at(&l->session, l->session.now);
    double value = parameter_get(&p, index);
    char text[LAB_TEXT];
    fault f = {0};
    if (strcmp(info->path, "control.lock") == 0) {
        return act_lock(l, direction > 0 ? "next" : "previous");
    }
    if (info->type == PARAMETER_TEXT) {
        lab_say(l, true, "%s is a text: Enter edits it", info->path);
        return false;
    }
    if (info->type == PARAMETER_REAL) {
        double size = value != 0 ? fabs(value) : 0.1;
        value += direction * pow(10, floor(log10(size) + 1e-9)) / 10;
        snprintf(text, sizeof text, "%.6g", value);
        value = strtod(text, NULL);
    } else {
        value += direction;
    }
    value = fmax(info->minimum, fmin(info->maximum, value));
    if (!lab_complain(l, parameter_set_number(&p, index, value, &f), &f)) {
        return false;
    }
    parameter_format(&p, index, text, sizeof text);
    return lab_change(l, index, text);
}

bool act_edit(lab *l, const char *argument)
{
    (void)argument;
    char value[LAB_TEXT];
    parameters p = session_parameters_at(&l->session, l->session.now);
    parameter_format(&p, l->parameter, value, sizeof value);
    const parameter_info *info = &parameter_table[l->parameter];
    l->prompting = true;
    snprintf(l->prompt, sizeof l->prompt, "set %s %.160s", info->path, value);
    if (info->choices != NULL && info->type == PARAMETER_CHOICE) {
        lab_say(l, false, "%s: %s", info->description, info->choices);
    } else if (info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER) {
        lab_say(l, false, "%s: %g to %g %s", info->description, info->minimum, info->maximum,
                info->unit);
    } else {
        lab_say(l, false, "%s", info->description);
    }
    return true;
}

bool act_push(lab *l, const char *argument)
{
    double impulse = 0.01;
    fault f = {0};
    if (argument[0] != '\0' && !lab_take_number(l, argument, &impulse)) {
        return false;
    }
    if (!lab_complain(l, session_push(&l->session, impulse, &f), &f)) {
        return false;
    }
    lab_say(l, false, "pushed with %g N s at %.4f s", impulse, l->session.now);
    return true;
}

bool act_undo(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = lab_complain(l, session_undo(&l->session, &f), &f);
    if (done) {
        lab_say(l, false, "undone, U puts it in again");
    }
    return done;
}

bool act_redo(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = lab_complain(l, session_redo(&l->session, &f), &f);
    if (done) {
        lab_say(l, false, "put in again");
    }
    return done;
}

bool act_branch(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = lab_complain(l, session_branch(&l->session, &f), &f);
    if (done) {
        lab_say(l, false,
                "branched at %.4f s: change something, the old run stays beside it "
                "(c compares, B forgets it)",
                l->session.now);
    }
    return done;
}

bool act_forget(lab *l, const char *argument)
{
    (void)argument;
    session_forget_other(&l->session);
    return true;
}

bool act_exchange_model(lab *l, const char *argument)
{
    (void)argument;
    bool printed = l->session.effective.parameters.arm.model == ARM_PRINTED;
    return lab_change(l, PARAMETER_INDEX(arm.model), printed ? "corrected" : "printed");
}

bool act_extend(lab *l, const char *argument)
{
    char text[NUMBER_TEXT];
    double duration = l->session.effective.parameters.run.duration, more = duration;
    if (argument[0] != '\0' && !lab_take_number(l, argument, &more)) {
        return false;
    }
    double seen = l->session.seen;
    number_format(text, duration + more);
    if (!lab_change(l, PARAMETER_INDEX(run.duration), text)) {
        return false;
    }
    l->session.seen = seen;
    return true;
}
