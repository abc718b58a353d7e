// Actions on several runs: pinning and taking them, what they are compared with, sweeps.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/clock.h"

#define LONGEST_MAP_PIECE 0.015 // of a map, between two pictures [s]

// --- pinned runs -----------------------------------------------------------------------

bool act_apply_baseline(explorer_model *model, explorer_input *input)
{
    return act_succeeded(input, model_follow_reference(model, &input->fault));
}

// Pins the present run and makes it the baseline.
static bool pin(explorer_model *model, explorer_input *input, const char *name)
{
    return act_need_whole_run(model, input) &&
           act_succeeded(input, run_list_pin(&model->pinned, &model->session, name,
                                             &input->fault)) &&
           act_apply_baseline(model, input);
}

bool act_branch(explorer_model *model, explorer_input *input)
{
    return pin(model, input, "") &&
           act_tell(input,
                    "branched at %.4f s: change something, the old run stays beside "
                    "it (c compares, R lists all, B drops it)",
                    model->session.now);
}

bool act_pin(explorer_model *model, explorer_input *input, const char *argument)
{
    const run_list *list = &model->pinned;
    return pin(model, input, argument) &&
           act_tell(input, "pinned as '%s': the present run is compared with it",
                    list->runs[list->baseline].name);
}

bool act_forget(explorer_model *model, explorer_input *input)
{
    if (model->pinned.baseline >= 0) {
        run_list_drop(&model->pinned, model->pinned.baseline);
    }
    return act_apply_baseline(model, input);
}

// The index of the pinned run whose number begins an argument, which moves behind it; -1
// after a refusal.
static int read_run(const explorer_model *model, explorer_input *input,
                    const char **argument)
{
    const int count = model->pinned.count;
    if (count == 0) {
        act_refuse(input, "no run is pinned (b pins this one)");
        return -1;
    }
    return act_read_index(input, argument, count, "pinned runs", "R");
}

// Puts a pinned run in the place of the present one: its inputs, where both are of one
// scenario, else a session of its own.
static status take_origin(explorer_model *model, explorer_view *view,
                          const run_origin *from, fault *f)
{
    session *s = &model->session;
    if (same_base(&from->base, &s->base)) {
        return session_take_inputs(s, from->inputs, from->input_count, f);
    }
    session other;
    TRY(session_reopen(&other, from, s->patience, f));
    const status code = state_take_session(model, view, &other, f);
    if (code != STATUS_OK) {
        session_finish(&other);
    }
    return code;
}

bool act_take_run(explorer_model *model, explorer_view *view, explorer_input *input,
                  int index)
{
    const run_list *list = &model->pinned;
    assert(index >= 0 && index < list->count);
    if (run_origin_is_of(&list->runs[index].from, &model->session)) {
        return act_tell(input, "this is that run");
    }

    // the present one must not be lost; pinning it moves none of the others
    if (!pin(model, input, "")) {
        return false;
    }
    const pinned_run *taken = &list->runs[index];
    const status code = take_origin(model, view, &taken->from, &input->fault);
    return act_succeeded(input, code) &&
           act_tell(input, "'%s' goes on; the run before is compared with it",
                    taken->name);
}

bool act_take(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const int index = read_run(model, input, &argument);
    return index >= 0 && act_take_run(model, view, input, index);
}

void act_hide_run(explorer_model *model, int index)
{
    assert(index >= 0 && index < model->pinned.count);
    model->pinned.runs[index].hidden = !model->pinned.runs[index].hidden;
}

bool act_hide(explorer_model *model, explorer_input *input, const char *argument)
{
    const int index = read_run(model, input, &argument);
    if (index < 0) {
        return false;
    }
    act_hide_run(model, index);
    return true;
}

bool act_compare_with(explorer_model *model, explorer_input *input, int index)
{
    assert(index >= 0 && index < model->pinned.count);
    model->pinned.baseline = index;
    return act_apply_baseline(model, input) &&
           act_tell(input, "compared with '%s' from now on",
                    model->pinned.runs[index].name);
}

bool act_baseline(explorer_model *model, explorer_input *input, const char *argument)
{
    const int index = read_run(model, input, &argument);
    return index >= 0 && act_compare_with(model, input, index);
}

void act_ask_run_name(const explorer_model *model, explorer_input *input, int index)
{
    assert(index >= 0 && index < model->pinned.count);
    prompt_open(&input->prompt, model->pinned.runs[index].name, "rename %d ", index + 1);
}

bool act_rename(explorer_model *model, explorer_input *input, const char *argument)
{
    const int index = read_run(model, input, &argument);
    if (index < 0) {
        return false;
    }
    if (argument[0] != '\0') {
        pinned_run *p = &model->pinned.runs[index];
        snprintf(p->name, sizeof p->name, "%s", argument);
    } else {
        act_ask_run_name(model, input, index);
    }
    return true;
}

bool act_drop_run(explorer_model *model, explorer_input *input, int index)
{
    assert(index >= 0 && index < model->pinned.count);
    run_list_drop(&model->pinned, index);
    return act_apply_baseline(model, input);
}

bool act_unpin(explorer_model *model, explorer_input *input, const char *argument)
{
    const int index = read_run(model, input, &argument);
    return index >= 0 && act_drop_run(model, input, index);
}

// Says where the first signal of the pane in focus leaves the tolerance.
static bool tell_difference(const explorer_model *model, const explorer_view *view,
                            explorer_input *input)
{
    const char *name = model_reference_name(model);
    const int focused = panes_focused(&view->panes);
    if (focused < 0) {
        return act_tell(input, "minus '%s'; D shows the runs again", name);
    }

    // signals that are not subtracted
    const int signal = view->panes.pane[focused].signals[0];
    const signal_info *info = &signal_table[signal];
    if (signal_is_derived(signal)) {
        return act_tell(
            input, "minus '%s', but an expression has no difference; D shows the runs",
            name);
    }
    if (signal_is_state(signal)) {
        return act_tell(
            input, "minus '%s', but states such as %s are this run's; D shows the runs",
            name, info->name);
    }

    // the others
    const double tolerance = model->difference.tolerance;
    const double first = difference_first_beyond(&model->difference, signal, tolerance);
    if (first < 0) {
        return act_tell(input, "minus '%s': %s never differs by more than %g %s", name,
                        info->name, tolerance, info->unit);
    }
    return act_tell(
        input,
        "minus '%s': %s differs by more than %g %s from %.5f s on; D shows the runs",
        name, info->name, tolerance, info->unit, first);
}

bool act_difference(explorer_model *model, const explorer_view *view,
                    explorer_input *input, const char *argument)
{
    run_difference *d = &model->difference;
    if (strcmp(argument, "off") == 0 || (argument[0] == '\0' && d->on)) {
        d->on = false;
        return act_tell(input, "the runs themselves");
    }

    // a tolerance, and something to subtract
    double tolerance = 0;
    if (!act_read_number_or(input, argument, "", &tolerance)) {
        return false;
    }
    if (!model->session.has_other) {
        return act_refuse(input, "there is nothing to subtract: b pins this run first");
    }
    if (tolerance < 0) {
        return act_refuse(input, "a tolerance is not negative");
    }

    // the differences, which are drawn from now on
    d->on = true;
    d->tolerance = tolerance;
    difference_update(d, model_run_id(model), &model->session.run.trace,
                      &model->session.other.trace);
    return tell_difference(model, view, input);
}

const char *act_full_path(const char *word, char *text, size_t size)
{
    const char *values = word + strcspn(word, "=");
    char name[LINE_TEXT];
    text_cut(word, "=", name, sizeof name);
    const int parameter = parameter_of_name(name);
    if (parameter >= 0) {
        snprintf(text, size, "%s%s", parameter_table[parameter].path, values);
    } else {
        snprintf(text, size, "%s%s", name, values);
    }
    return text;
}

// --- sweeps ----------------------------------------------------------------------------

bool act_continue_sweep(explorer_model *model, explorer_input *input)
{
    lab_sweep *sweep = &model->sweep;

    // asked again and again: a finished sweep stays as it is
    if (lab_sweep_is_done(sweep)) {
        return true;
    }

    // one run a call, of a map as many as a picture may wait for, so that keys are read
    // in between
    const double begin = clock_seconds(CLOCK_MONOTONIC);
    do {
        if (!act_succeeded(input, lab_sweep_compute_next(sweep, &model->session.effective,
                                                         &input->fault))) {
            return false;
        }
    } while (lab_sweep_is_map(sweep) && !lab_sweep_is_done(sweep) &&
             clock_seconds(CLOCK_MONOTONIC) - begin < LONGEST_MAP_PIECE);

    // the last one is said
    if (!lab_sweep_is_done(sweep)) {
        return true;
    }
    const char *across = lab_sweep_is_map(sweep) ? " and < >" : "";
    return act_tell(input,
                    "%d runs: arrows%s choose one, Enter opens it, Esc ends the sweep",
                    sweep->count, across);
}

// Proposes a sweep of the selected parameter, about its value if that is positive.
static bool propose_sweep(const explorer_model *model, const explorer_view *view,
                          explorer_input *input)
{
    const int parameter = view->parameters.parameter;
    const char *path = parameter_table[parameter].path;
    const parameters p = model_parameters(model);
    const double value = parameter_get(&p, parameter);

    // from a quarter of the value to four times of it, within the slider's range
    slider_scale scale;
    if (slider_scale_of(parameter, value, &scale)) {
        const char *spacing = "";
        if (value > 0) {
            scale.low = fmax(scale.low, value / 4);
            scale.high = fmin(scale.high, value * 4);
            spacing = scale.logarithmic ? ":log" : "";
        }
        prompt_open(&input->prompt, NULL, "sweep %s=%g:%g:8%s", path, scale.low,
                    scale.high, spacing);
    } else {
        prompt_open(&input->prompt, NULL, "sweep %s=", path);
    }
    return act_tell(input,
                    "first value, last value, number of runs; or values with commas");
}

static void end_sweep(explorer_model *model, explorer_view *view)
{
    lab_sweep_end(&model->sweep);
    if (view->side.panel == PANEL_SWEEP) {
        view->side.panel = PANEL_PARAMETERS;
    }
}

bool act_sweep(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument)
{
    lab_sweep *sweep = &model->sweep;
    if (strcmp(argument, "off") == 0) {
        end_sweep(model, view);
        return true;
    }
    if (argument[0] == '\0') {
        return propose_sweep(model, view, input);
    }

    // each run is computed while the lab waits, so they must be short
    if (!act_need_whole_run(model, input) ||
        !act_need_short_runs(model, input, "sweep", SWEPT_RUNS) ||
        !act_succeeded(input, lab_sweep_begin(sweep, argument, &input->fault))) {
        return false;
    }
    view->side.panel = PANEL_SWEEP;
    model->difference.on = false;

    // with each picture a run, without pictures all
    bool done = act_continue_sweep(model, input);
    while (done && isinf(model->session.patience) && !lab_sweep_is_done(sweep)) {
        done = act_continue_sweep(model, input);
    }
    return done;
}

static bool refuse_metric(explorer_input *input, const char *name)
{
    const char *near = summary_suggest(name);
    if (near == NULL) {
        return act_refuse(input, "there is no number '%.60s' of a run's summary", name);
    }
    return act_refuse(input,
                      "there is no number '%.60s' of a run's summary, did you mean '%s'?",
                      name, near);
}

bool act_quantity(const explorer_model *model, explorer_input *input,
                  const char *argument)
{
    const int index = summary_find_begun(argument);
    if (index < 0) {
        return refuse_metric(input, argument);
    }
    const summary_info *info = &summary_table[index];
    const double value = summary_value(&model->session.run.summary, index);
    if (!isfinite(value)) {
        return act_tell(input, "%s did not occur: %s", info->key, info->description);
    }
    return act_tell(input, "%s = %.6g%s%s: %s", info->key, value,
                    info->unit[0] ? " " : "", info->unit, info->description);
}

bool act_metric(explorer_model *model, explorer_input *input, const char *argument)
{
    lab_sweep *sweep = &model->sweep;
    const int metric = summary_find_begun(argument);
    if (metric < 0) {
        return refuse_metric(input, argument);
    }
    sweep->metric = metric;
    return act_tell(input, "%s: %s", summary_table[metric].label,
                    summary_table[metric].description);
}

void act_select_swept(explorer_model *model, int direction)
{
    lab_sweep *sweep = &model->sweep;
    const int last = sweep->count - 1, at = sweep->selected + direction;

    // the first and the last of a sweep are its ends; in a map there is nothing beyond an
    // edge
    if (at >= 0 && at <= last) {
        sweep->selected = at;
    } else if (lab_sweep_is_map(sweep)) {
        return;
    } else if (at < 0 || last < 0) {
        sweep->selected = 0;
    } else {
        sweep->selected = last;
    }
}
