// Actions on several runs: pinning and taking them, what they are compared with, sweeps.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/clock.h"
#include "src/study/solve.h"

#define LONGEST_MAP_PIECE 0.015 // of a map, between two pictures [s]

// --- pinned runs -----------------------------------------------------------------------

// Makes the baseline the run for comparison with the present one.
bool act_apply_baseline(explorer_model *model, explorer_input *input)
{
    const run_list *list = &model->pinned;
    if (list->baseline < 0) {
        session_forget_other(&model->session);
        return true;
    }
    return act_succeeded(input, session_keep_beside(&model->session,
                                                    &list->runs[list->baseline].run,
                                                    &input->fault));
}

// Pins the present run and makes it the baseline.
static bool pin(explorer_model *model, explorer_input *input, const char *name)
{
    session_forget_ghost(&model->session);
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
    session_forget_ghost(&model->session);
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

bool act_take_run(explorer_model *model, explorer_view *view, explorer_input *input,
                  int index)
{
    assert(index >= 0 && index < model->pinned.count);
    const run_list *list = &model->pinned;
    if (run_origin_is_of(&list->runs[index].from, &model->session)) {
        return act_tell(input, "this is that run");
    }

    // the present one must not be lost; pinning it moves none of the others
    if (!pin(model, input, "")) {
        return false;
    }
    const pinned_run *taken = &list->runs[index];
    const run_origin *from = &taken->from;
    session other;
    status code = STATUS_OK;
    if (same_base(&from->base, &model->session.base)) {
        code = session_take_inputs(&model->session, from->inputs, from->input_count,
                                   &input->fault);
    } else {
        code = session_reopen(&other, from, model->session.patience, &input->fault);
        if (code != STATUS_OK) {
            return act_succeeded(input, code);
        }
        code = state_take_session(model, view, &other, &input->fault);
        if (code != STATUS_OK) {
            session_finish(&other);
        }
    }
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

bool act_difference(explorer_model *model, const explorer_view *view,
                    explorer_input *input, const char *argument)
{
    run_difference *d = &model->difference;
    double tolerance = 0;
    if (strcmp(argument, "off") == 0 || (argument[0] == '\0' && d->on)) {
        d->on = false;
        return act_tell(input, "the runs themselves");
    }
    if (!act_read_number_or(input, argument, "", &tolerance)) {
        return false;
    }
    if (!model->session.has_other) {
        return act_refuse(input, "there is nothing to subtract: b pins this run first");
    }
    if (tolerance < 0) {
        return act_refuse(input, "a tolerance is not negative");
    }
    d->on = true;
    d->tolerance = tolerance;
    difference_update(d, model_run_id(model), &model->session.run.trace,
                      &model->session.other.trace);

    // where the first signal of the pane in focus leaves the tolerance
    const char *name = model->pinned.runs[model->pinned.baseline].name;
    const int focused = panes_focused(&view->panes);
    if (focused < 0) {
        return act_tell(input, "minus '%s'; D shows the runs again", name);
    }
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
    const double first = difference_first_beyond(d, signal, tolerance);
    if (first < 0) {
        return act_tell(input, "minus '%s': %s never differs by more than %g %s", name,
                        info->name, tolerance, info->unit);
    }
    return act_tell(
        input,
        "minus '%s': %s differs by more than %g %s from %.5f s on; D shows the runs",
        name, info->name, tolerance, info->unit, first);
}

// --- limits ----------------------------------------------------------------------------

enum { SOLVE_THREADS = 4 };

// The signal whose values a quantity is one of, -1 if there is none.
static int signal_of_quantity(int quantity)
{
    static const struct {
        int quantity, signal;
    } pairs[] = {{SUMMARY_INDEX(peak_force_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(first_pulse_peak_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(steady_force_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(largest_command_V), SIGNAL_INDEX(command)},
                 {SUMMARY_INDEX(approach_speed_m_s), SIGNAL_INDEX(gap_velocity)}};
    int found = -1;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (pairs[i].quantity == quantity) {
            found = pairs[i].signal;
        }
    }
    return found;
}

status act_pin_value(explorer_model *model, const sweep_axis *axis, double value,
                     const char *name, fault *f)
{
    parameters p = model->session.effective.parameters;
    char text[PARAMETER_TEXT_SIZE];
    run_origin from;
    session other;
    TRY(sweep_axis_apply(axis, value, &p, f));
    parameter_format(&p, axis->parameter, text, sizeof text);
    TRY(run_origin_take(&from, &model->session, f));

    // the present run's changes, and the value from the start
    status code = session_reopen(&other, &from, HUGE_VAL, f);
    run_origin_finish(&from);
    TRY(code);
    session_seek(&other, 0);
    code = session_change_from_start(&other, axis->parameter, text, f);
    if (code == STATUS_OK) {
        code = run_list_pin(&model->pinned, &other, name, f);
    }
    session_finish(&other);
    return code;
}

const char *act_full_path(const char *word, char *text, size_t size)
{
    char name[LINE_TEXT];
    text_cut(word, "=", name, sizeof name);
    const int index = parameter_of_name(name);
    snprintf(text, size, "%s%s", index >= 0 ? parameter_table[index].path : name,
             word + strcspn(word, "="));
    return text;
}

// The limit that is nearest to the value the run has.
static int nearest_limit(const explorer_model *model, const sweep_axis *axis,
                         const solution *found)
{
    const double value =
        parameter_get(&model->session.effective.parameters, axis->parameter);
    int nearest = 0;
    for (int i = 1; i < found->count && axis->element == 0; i++) {
        const double here = fabs(found->limits[i].value - value);
        if (here < fabs(found->limits[nearest].value - value)) {
            nearest = i;
        }
    }
    return nearest;
}

// Says what was found: the limit that is pinned, and where others are; true if there is
// one.
static bool tell_limits(const explorer_model *model, explorer_input *input,
                        const sweep_axis *axis, const solve_condition *c,
                        const solution *found)
{
    const char *unit = sweep_axis_parameter(axis)->unit;
    const summary_info *quantity = &summary_table[c->quantity];
    char others[160] = "";
    if (found->count == 0) {
        const double low = fmin(axis->low, axis->high),
                     high = fmax(axis->low, axis->high);
        return act_refuse(input,
                          "no limit of %s from %g to %g %s: the %s is as asked in %d "
                          "runs, and not in %d%s%s",
                          axis->name, low, high, unit, quantity->label, found->holding,
                          found->failing,
                          found->unknown > 0 ? "; first of the others: " : "",
                          found->reason);
    }
    const int nearest = nearest_limit(model, axis, found);
    for (int i = 0; i < found->count; i++) {
        if (i != nearest) {
            text_add(others, sizeof others, "%s%.5g",
                     others[0] == '\0' ? "; limits also at " : ", ",
                     found->limits[i].value);
        }
    }
    const solve_limit *l = &found->limits[nearest];
    return act_tell(input, "%s %s = %#.5g%s%s: %#.5g %s%s%s; that run is pinned",
                    l->holds_below ? "up to" : "from", axis->name, l->value,
                    unit[0] ? " " : "", unit, l->reached, quantity->unit,
                    l->jumps ? ", where it jumps" : "", others);
}

bool act_solve(explorer_model *model, explorer_input *input, const char *argument)
{
    sweep_axis axis = {0};
    solve_condition condition;
    static solution found;
    char path[LINE_TEXT];
    const char *rest = argument + strcspn(argument, " ");
    fault *f = &input->fault;
    snprintf(path, sizeof path, "%.*s", (int)(rest - argument), argument);
    if (*rest == '\0') {
        return act_refuse(input, "solve takes a parameter and a condition, such as "
                                 "motor.voltage peak_force_N<2");
    }
    if (!(act_need_whole_run(model, input) &&
          act_need_short_runs(model, input, "solve", 2 * SOLVE_POINTS))) {
        return false;
    }

    // a parameter may be given by the last part of its path
    char whole[2 * LINE_TEXT], name[RUN_NAME];
    act_full_path(path, whole, sizeof whole);
    status code = solve_condition_read(rest, &condition, f);
    const scenario *s = &model->session.effective;
    if (code == STATUS_OK) {
        code = solve_axis_read(&axis, whole, s, f);
    }
    if (code == STATUS_OK) {
        code = solve(s, &axis, &condition, SOLVE_POINTS, SOLVE_THREADS, NULL, &found, f);
    }
    if (code == STATUS_OK && found.count > 0) {
        model->limit =
            (solved_limit){signal_of_quantity(condition.quantity), condition.bound};
        const double value = found.limits[nearest_limit(model, &axis, &found)].value;
        snprintf(name, sizeof name, "%s %.5g", strchr(axis.name, '.') + 1, value);
        code = act_pin_value(model, &axis, value, name, f);
    }
    const bool done = act_succeeded(input, code) &&
                      tell_limits(model, input, &axis, &condition, &found);
    sweep_axis_finish(&axis);
    return done && act_apply_baseline(model, input);
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

    // only the last one is news
    if (!lab_sweep_is_done(sweep)) {
        return true;
    }
    const char *across = lab_sweep_is_map(sweep) ? " and < >" : "";
    return act_tell(
        input,
        "%d runs: arrows%s choose one, Enter opens it, M another metric, Esc ends it",
        sweep->count, across);
}

bool act_sweep(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument)
{
    lab_sweep *sweep = &model->sweep;
    if (strcmp(argument, "off") == 0) {
        lab_sweep_end(sweep);
        if (view->side.panel == PANEL_SWEEP) {
            view->side.panel = PANEL_PARAMETERS;
        }
        return true;
    }

    // without an argument the selected parameter's is begun, about its value if that is
    // positive
    if (argument[0] == '\0') {
        slider_scale scale = {0};
        const int parameter = view->parameters.parameter;
        const parameters p = model_parameters(model);
        const double value = parameter_get(&p, parameter);
        const bool number = slider_scale_of(parameter, value, &scale);
        const char *path = parameter_table[parameter].path, *spacing = "";
        if (number && value > 0) {
            scale.low = fmax(scale.low, value / 4);
            scale.high = fmin(scale.high, value * 4);
        }
        if (value > 0 && scale.logarithmic) {
            spacing = ":log";
        }
        if (number) {
            prompt_open(&input->prompt, NULL, "sweep %s=%g:%g:8%s", path, scale.low,
                        scale.high, spacing);
        } else {
            prompt_open(&input->prompt, NULL, "sweep %s=", path);
        }
        return act_tell(input,
                        "first value, last value, number of runs; or values with commas");
    }

    // each run is computed while the lab waits, so they must be short
    if (!(act_need_whole_run(model, input) &&
          act_need_short_runs(model, input, "sweep", SWEPT_RUNS) &&
          act_succeeded(input, lab_sweep_begin(sweep, argument, &input->fault)))) {
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

bool act_metric(explorer_model *model, explorer_input *input, const char *argument)
{
    lab_sweep *sweep = &model->sweep;
    int metric = summary_find(argument);
    if (argument[0] != '\0' && metric < 0) {
        const char *near = summary_suggest(argument);
        if (near == NULL) {
            return act_refuse(input, "there is no number '%.60s' of a run's summary",
                              argument);
        }
        return act_refuse(
            input, "there is no number '%.60s' of a run's summary, did you mean '%s'?",
            argument, near);
    }

    // the next one that any of the runs has
    for (int step = 1; argument[0] == '\0' && metric < 0 && step <= summary_count;
         step++) {
        const int next = (sweep->metric + step) % summary_count;
        bool known = sweep->count == 0;
        for (int i = 0; i < sweep->count; i++) {
            known = known || isfinite(lab_sweep_metric(sweep, i, next));
        }
        if (known && !summary_table[next].timing) {
            metric = next;
        } else {
            metric = -1;
        }
    }
    if (metric >= 0) {
        sweep->metric = metric;
    }
    return act_tell(input, "%s: %s", summary_table[sweep->metric].label,
                    summary_table[sweep->metric].description);
}

void act_select_swept(explorer_model *model, int direction)
{
    lab_sweep *sweep = &model->sweep;
    const int last = sweep->count - 1, at = sweep->selected + direction;

    // the first and the last of a sweep are its ends; in a map there is nothing beyond an
    // edge
    if (at >= 0 && at <= last) {
        sweep->selected = at;
    } else if (!lab_sweep_is_map(sweep)) {
        if (at < 0 || last < 0) {
            sweep->selected = 0;
        } else {
            sweep->selected = last;
        }
    }
}
