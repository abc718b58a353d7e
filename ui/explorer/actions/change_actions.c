// Actions that change the run: values, pushes, undo, sliders, the list of changes.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

// Gives a parameter a number in small steps: several at one instant are one change, and
// none at all once the value is what it was.
static bool adjust_number(explorer_model *model, explorer_input *input, int parameter,
                          double value)
{
    assert(parameter >= 0 && parameter < parameter_count);
    session *s = &model->session;
    const int changes = s->input_count;
    if (!act_succeeded(input,
                       session_adjust_number(s, parameter, value, &input->fault))) {
        return false;
    }
    if (s->input_count >= changes) {
        return act_tell_change(model, input);
    }

    // a value that is as it was leaves no change
    char text[LINE_TEXT];
    const parameters p = model_parameters(model);
    parameter_format(&p, parameter, text, sizeof text);
    return act_tell(input, "%s is %s %s again", parameter_table[parameter].path, text,
                    parameter_table[parameter].unit);
}

// The parameter of a path, of its last part or of a beginning of either.
static bool find_parameter(explorer_input *input, const char *name, int *parameter)
{
    *parameter = parameter_of_name(name);
    if (*parameter == -2) {
        return act_refuse(input, "several parameters begin with '%s' (Tab lists them)",
                          name);
    }
    if (*parameter < 0 && parameter_look_up(name, &input->fault) < 0) {
        return act_succeeded(input, STATUS_BAD_ARGUMENT);
    }
    return true;
}

// Says what a parameter is, and why it has no effect if it has none.
static bool tell_parameter(const explorer_model *model, explorer_input *input,
                           int parameter)
{
    const parameter_info *info = &parameter_table[parameter];
    const char *inert = model_inert_reason(model, parameter);
    if (inert != NULL) {
        return act_tell(input, "%s: %s; without effect, %s", info->path,
                        info->description, inert);
    }
    return act_tell(input, "%s: %s", info->path, info->description);
}

bool act_set(explorer_model *model, explorer_view *view, explorer_input *input,
             const char *argument)
{
    // the path, and the value after blanks or an equals sign
    char path[LINE_TEXT];
    int parameter;
    const char *value = text_cut(argument, " =", path, sizeof path);
    if (path[0] == '\0') {
        return act_refuse(input, "set takes a parameter and a value, such as arm.k2 10");
    }
    if (!find_parameter(input, path, &parameter)) {
        return false;
    }

    // without a value it is only selected
    view->parameters.parameter = parameter;
    if (value[0] == '\0') {
        return tell_parameter(model, input, parameter);
    }
    return act_change_parameter(model, input, parameter, value);
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

// A value with six significant digits.
static double round_to_six_digits(double value)
{
    char text[NUMBER_TEXT];
    snprintf(text, sizeof text, "%.6g", value);
    return strtod(text, NULL);
}

// A real parameter's value one nudge up or down; what goes down comes up to where it was.
static double nudged(int parameter, double value, int direction)
{
    double above = value; // where the step is that of going up
    if (direction < 0) {
        above = value * (1 - 1e-6);
    }
    return round_to_six_digits(value + direction * nudge_step(parameter, above));
}

// Moves to the next run of a row of a map; its ends have no neighbours.
static void nudge_map(explorer_model *model, int direction)
{
    const int across = (int)model->sweep.axis.count;
    const int to = model->sweep.selected % across + direction;
    if (to >= 0 && to < across) {
        act_select_swept(model, direction);
    }
}

bool act_nudge(explorer_model *model, const explorer_view *view, explorer_input *input,
               const char *argument)
{
    const int direction = argument[0] == '-' ? -1 : 1;
    if (view->side.panel == PANEL_SWEEP && lab_sweep_is_map(&model->sweep)) {
        nudge_map(model, direction);
        return true;
    }
    // what is no number: a lock goes round its modes
    const int index = view->parameters.parameter;
    const parameter_info *info = &parameter_table[index];
    if (index == PARAMETER_INDEX(control.lock)) {
        return act_lock(model, input, direction > 0 ? "next" : "previous");
    }
    if (parameter_is_text(info)) {
        const char *kind = info->type == PARAMETER_LIST ? "list" : "text";
        return act_refuse(input, "%s is a %s: Enter edits it", info->path, kind);
    }

    // a real number by a step, anything else to its neighbour
    const parameters p = model_parameters(model);
    double value = parameter_get(&p, index);
    if (info->type == PARAMETER_REAL) {
        value = nudged(index, value, direction);
    } else {
        value = value + direction;
    }
    return adjust_number(model, input, index,
                         fmax(info->minimum, fmin(info->maximum, value)));
}

// Makes the run of the selected value the present run, by changes from the start.
static bool take_swept(explorer_model *model, explorer_input *input)
{
    const lab_sweep *sweep = &model->sweep;
    if (sweep->selected >= sweep->count) {
        return act_refuse(input, "the sweep has no run yet");
    }
    double values[2];
    lab_sweep_values(sweep, sweep->selected, values);

    // at the start, where a change is one from the start
    session *s = &model->session;
    const double now = s->now;
    session_seek(s, 0);
    bool changed = act_change_number(model, input, sweep->axis.parameter, values[0]);
    if (changed && lab_sweep_is_map(sweep)) {
        session_seek(s, 0);
        changed = act_change_number(model, input, sweep->second.parameter, values[1]);
    }

    // and back to the instant that is looked at
    const double seen = s->seen;
    session_seek(s, now);
    s->seen = fmax(seen, s->now);
    return changed;
}

// Opens the prompt with a parameter's present value, and says what can be typed.
static bool ask_value(const explorer_model *model, explorer_input *input, int index)
{
    const parameter_info *info = &parameter_table[index];
    const parameters p = model_parameters(model);
    char value[LINE_TEXT];
    parameter_format(&p, index, value, sizeof value);
    if (info->type == PARAMETER_REAL && value[0] != '\0') {
        snprintf(value, sizeof value, "%.15g", parameter_get(&p, index));
    }
    prompt_open(&input->prompt, value, "set %s ", info->path);

    // what can be typed, or why it makes no difference
    const char *inert = model_inert_reason(model, index), *about = info->description;
    if (inert != NULL) {
        return act_warn(input, "%s has no effect: %s", info->path, inert);
    }
    if (info->choices != NULL && info->type == PARAMETER_CHOICE) {
        return act_tell(input, "%s: %s", about, info->choices);
    }
    if (info->type != PARAMETER_TEXT && info->type != PARAMETER_BOOLEAN) {
        return act_tell(input, "%s: %g to %g %s", about, info->minimum, info->maximum,
                        info->unit);
    }
    return act_tell(input, "%s", about);
}

bool act_edit(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    // a parameter by name is selected first
    int index = view->parameters.parameter;
    if (argument[0] != '\0') {
        if (!find_parameter(input, argument, &index)) {
            return false;
        }
        view->parameters.parameter = index;
    } else if (view->side.panel == PANEL_SWEEP) {
        return take_swept(model, input);
    }
    return ask_value(model, input, index);
}

bool act_push(explorer_model *model, explorer_input *input, const char *argument)
{
    session *s = &model->session;
    double impulse = 0.01;
    if (!act_read_number_or(input, argument, "", &impulse) ||
        !act_succeeded(input, session_push(s, impulse, &input->fault))) {
        return false;
    }
    return act_tell_failed_run(model, input) ||
           act_tell(input, "pushed with %g N s at %.4f s", impulse, s->now);
}

// Returns to the scenario that was opened before the present one (direction -1), or goes
// on to the one that this left (1).
static bool change_scenario(explorer_model *model, explorer_view *view,
                            explorer_input *input, int direction)
{
    if (!act_succeeded(input,
                       state_change_visit(model, view, direction, &input->fault))) {
        return false;
    }
    const char *name = model->session.base.name;
    if (direction < 0) {
        return act_tell(input, "in %s again, U opens the one you left", name);
    }
    return act_tell(input, "in %s again, u goes back", name);
}

// The opening of a scenario is undone as a change is, before the first one.
bool act_undo(explorer_model *model, explorer_view *view, explorer_input *input)
{
    session *s = &model->session;
    if (s->input_count == 0 && model_has_visit(model, -1)) {
        return change_scenario(model, view, input, -1);
    }
    return act_succeeded(input, session_undo(s, &input->fault)) &&
           act_tell(input, "undone, U puts it in again");
}

bool act_redo(explorer_model *model, explorer_view *view, explorer_input *input)
{
    session *s = &model->session;
    if (s->input_count == s->input_total && model_has_visit(model, 1)) {
        return change_scenario(model, view, input, 1);
    }
    return act_succeeded(input, session_redo(s, &input->fault)) &&
           act_tell(input, "put in again");
}

bool act_model(explorer_model *model, explorer_input *input)
{
    arm_model_kind other = ARM_PRINTED;
    if (model->session.effective.parameters.arm.model == ARM_PRINTED) {
        other = ARM_CORRECTED;
    }
    return act_change_number(model, input, PARAMETER_INDEX(arm.model), other);
}

bool act_extend(explorer_model *model, explorer_input *input, const char *argument)
{
    const double duration = model->session.effective.parameters.run.duration;
    double more = duration;
    if (!act_read_number_or(input, argument, "", &more)) {
        return false;
    }

    // what has been seen stays seen: only rows are added
    const double seen = model->session.seen;
    const bool longer =
        act_change_number(model, input, PARAMETER_INDEX(run.duration), duration + more);
    if (longer) {
        model->session.seen = seen;
    }
    return longer;
}

// --- sliders ---------------------------------------------------------------------------

void act_drag_slider(const explorer_model *model, explorer_view *view, int parameter,
                     double share, int cells)
{
    assert(parameter >= 0 && parameter < parameter_count);
    slider_grip *grip = &view->slider;
    const parameters p = model_parameters(model);

    // the scale stays as it was when the mouse took hold
    const bool begins = !grip->held || grip->parameter != parameter;
    if (begins &&
        !slider_scale_of(parameter, parameter_get(&p, parameter), &grip->scale)) {
        return;
    }
    grip->held = true;
    grip->parameter = parameter;
    view->parameters.parameter = parameter;
    grip->value = slider_value(&grip->scale, parameter, share, cells);
}

bool act_apply_slider(explorer_model *model, const explorer_view *view,
                      explorer_input *input)
{
    const slider_grip *grip = &view->slider;
    const parameters p = model_parameters(model);
    if (!grip->held || parameter_get(&p, grip->parameter) == grip->value) {
        return true;
    }
    return adjust_number(model, input, grip->parameter, grip->value);
}

bool act_release_slider(explorer_model *model, explorer_view *view, explorer_input *input)
{
    const bool followed = act_apply_slider(model, view, input);
    view->slider.held = false;
    return followed;
}

// --- the list of changes ---------------------------------------------------------------

// Refused where there are none.
static bool need_changes(const explorer_model *model, explorer_input *input)
{
    return model->session.input_count > 0 || act_refuse(input, "there are no changes");
}

// Reads the number of a change off *text; -1 if it is refused.
static int read_change(const explorer_model *model, explorer_input *input,
                       const char **text)
{
    if (!need_changes(model, input)) {
        return -1;
    }
    return act_read_index(input, text, model->session.input_count, "changes", ":changes");
}

// Gives a change another value, which is the last change from then on.
static bool change_value(explorer_model *model, explorer_view *view,
                         explorer_input *input, int index, const char *value)
{
    if (!act_succeeded(input, session_change_input(&model->session, index, value,
                                                   &input->fault))) {
        return false;
    }
    char text[LINE_TEXT];
    view->change = model->session.input_count - 1;
    model_change_text(model, view->change, text, sizeof text);
    return act_tell(input, "%s at the same instant, u takes it back", text);
}

bool act_edit_change(explorer_model *model, explorer_view *view, explorer_input *input,
                     int index)
{
    if (!need_changes(model, input)) {
        return false;
    }
    assert(index >= 0 && index < model->session.input_count);
    const session_input *in = &model->session.inputs[index];

    // a push has no value that could be asked for: what is said of that is said here
    if (in->kind == SESSION_INPUT_PUSH) {
        return change_value(model, view, input, index, "");
    }
    prompt_open(&input->prompt, in->text, "change %d ", index + 1);
    return act_tell(input, "%s", parameter_table[in->parameter].description);
}

bool act_change(explorer_model *model, explorer_view *view, explorer_input *input,
                const char *argument)
{
    const int index = read_change(model, input, &argument);
    if (index < 0) {
        return false;
    }
    if (argument[0] == '\0') {
        return act_edit_change(model, view, input, index);
    }
    return change_value(model, view, input, index, argument);
}

bool act_drop_change(explorer_model *model, explorer_view *view, explorer_input *input,
                     int index)
{
    if (!need_changes(model, input)) {
        return false;
    }

    // the text first: the change is gone afterwards
    char text[LINE_TEXT];
    model_change_text(model, index, text, sizeof text);
    if (!act_succeeded(input,
                       session_drop_input(&model->session, index, &input->fault))) {
        return false;
    }

    // the selection stays within the list
    const int last = model->session.input_count - 1;
    if (view->change > last) {
        view->change = last > 0 ? last : 0;
    }
    return act_tell(input, "without %s; U puts it in again", text);
}

bool act_drop(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const int index = read_change(model, input, &argument);
    return index >= 0 && act_drop_change(model, view, input, index);
}
