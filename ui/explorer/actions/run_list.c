// Actions on several runs: pinning and taking them, what they are compared with, sweeps.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_SWEPT_RUN 0.3 // that is computed between two pictures [s]

// --- pinned runs ------------------------------------------------------------------------------

// Makes the baseline the run for comparison with the present one.
static action_result settle_baseline(explorer_state *st)
{
    fault f = {0};
    const run_list *list = &st->pinned;
    if (list->baseline < 0) {
        session_forget_other(&st->session);
        return result_done();
    }
    const status code = session_keep_beside(&st->session, &list->runs[list->baseline].run, &f);
    return code == STATUS_OK ? result_done() : result_of(code, &f);
}

// Pins the present run and makes it the baseline.
static action_result pin(explorer_state *st, const char *name)
{
    fault f = {0};
    session_forget_ghost(&st->session);
    const action_result whole = act_need_whole_run(st);
    if (!result_ok(&whole)) {
        return whole;
    }
    const status code = run_list_pin(&st->pinned, &st->session, name, &f);
    return code == STATUS_OK ? settle_baseline(st) : result_of(code, &f);
}

action_result act_branch(explorer_state *st, const char *argument)
{
    (void)argument;
    const action_result pinned = pin(st, "");
    if (!result_ok(&pinned)) {
        return pinned;
    }
    return result_news("branched at %.4f s: change something, the old run stays beside it "
                       "(c compares, R lists all, B forgets it)",
                       st->session.now);
}

action_result act_pin(explorer_state *st, const char *argument)
{
    const action_result pinned = pin(st, argument);
    const run_list *list = &st->pinned;
    return result_ok(&pinned) ? result_news("pinned as '%s': the present run is compared with it",
                                            list->runs[list->baseline].name)
                              : pinned;
}

action_result act_forget(explorer_state *st, const char *argument)
{
    (void)argument;
    session_forget_ghost(&st->session);
    if (st->pinned.baseline >= 0) {
        run_list_drop(&st->pinned, st->pinned.baseline);
    }
    return settle_baseline(st);
}

action_result act_show_runs(explorer_state *st, const char *argument)
{
    (void)argument;
    st->page.panel = st->page.panel == PANEL_RUN_LIST ? PANEL_NONE : PANEL_RUN_LIST;
    return result_done();
}

// Reads the number of a pinned run, from 1; *rest is what follows it.
static action_result read_run(const explorer_state *st, const char *text, int *index,
                              const char **rest)
{
    char *end;
    const long number = strtol(text, &end, 10);

    // without a pinned run no number is right
    if (st->pinned.count == 0) {
        return result_refused("no run is pinned (b pins this one)");
    }

    // a number of the list, alone or before a blank
    if (end == text || (*end != '\0' && *end != ' ') || number < 1 || number > st->pinned.count) {
        return result_refused("pinned runs are numbered from 1 to %d (R lists them)",
                              st->pinned.count);
    }

    // the rest begins with a word
    while (*end == ' ') {
        end++;
    }
    *index = (int)number - 1;
    *rest = end;
    return result_done();
}

action_result act_take_run(explorer_state *st, const char *argument)
{
    int index = 0;
    const char *rest = "";
    const action_result read = read_run(st, argument, &index, &rest);
    if (!result_ok(&read)) {
        return read;
    }
    run_list *list = &st->pinned;
    if (run_list_is_present(&list->runs[index], &st->session)) {
        return result_news("this is that run");
    }

    // the present one must not be lost; pinning it moves none of the others
    const action_result pinned = pin(st, "");
    if (!result_ok(&pinned)) {
        return pinned;
    }
    fault f = {0};
    const pinned_run *taken = &list->runs[index];
    const status code = session_take_inputs(&st->session, taken->inputs, taken->input_count, &f);
    return code == STATUS_OK
               ? result_news("'%s' goes on; the run before is compared with it", taken->name)
               : result_of(code, &f);
}

action_result act_hide_run(explorer_state *st, const char *argument)
{
    int index = 0;
    const char *rest = "";
    const action_result read = read_run(st, argument, &index, &rest);
    if (result_ok(&read)) {
        st->pinned.runs[index].hidden = !st->pinned.runs[index].hidden;
    }
    return read;
}

action_result act_set_baseline(explorer_state *st, const char *argument)
{
    int index = 0;
    const char *rest = "";
    const action_result read = read_run(st, argument, &index, &rest);
    if (!result_ok(&read)) {
        return read;
    }
    st->pinned.baseline = index;
    const action_result settled = settle_baseline(st);
    return result_ok(&settled)
               ? result_news("compared with '%s' from now on", st->pinned.runs[index].name)
               : settled;
}

action_result act_rename_run(explorer_state *st, const char *argument)
{
    int index = 0;
    const char *name = "";
    const action_result read = read_run(st, argument, &index, &name);
    if (!result_ok(&read)) {
        return read;
    }
    pinned_run *p = &st->pinned.runs[index];

    // without a name it is asked for
    if (name[0] == '\0') {
        char line[32];
        snprintf(line, sizeof line, "rename %d ", index + 1);
        prompt_open_value(&st->prompt, line, p->name);
        return result_done();
    }
    snprintf(p->name, sizeof p->name, "%s", name);
    return result_done();
}

action_result act_unpin(explorer_state *st, const char *argument)
{
    int index = 0;
    const char *rest = "";
    const action_result read = read_run(st, argument, &index, &rest);
    if (!result_ok(&read)) {
        return read;
    }
    run_list_drop(&st->pinned, index);
    return settle_baseline(st);
}

action_result act_show_difference(explorer_state *st, const char *argument)
{
    run_difference *d = &st->difference;
    double tolerance = 0;
    const bool off = strcmp(argument, "off") == 0 || (argument[0] == '\0' && d->on);
    if (off) {
        d->on = false;
        return result_news("the runs themselves");
    }
    const action_result read = act_read_optional(argument, &tolerance);
    if (!result_ok(&read)) {
        return read;
    }
    if (!st->session.has_other) {
        return result_refused("there is nothing to subtract: b pins this run first");
    }
    if (tolerance < 0) {
        return result_refused("a tolerance is not negative");
    }
    d->on = true;
    d->tolerance = tolerance;
    difference_update(d, state_run_id(st), &st->session);

    // where the first signal of the pane in focus leaves the tolerance
    const char *name = st->pinned.runs[st->pinned.baseline].name;
    const int focused = panes_focused(&st->panes);
    if (focused < 0) {
        return result_news("minus '%s'; D shows the runs again", name);
    }
    const int signal = st->panes.pane[focused].signals[0];
    if (signal_is_state(signal)) {
        return result_news("minus '%s', but states such as %s are this run's; D shows the runs",
                           name, signal_table[signal].name);
    }
    const double first = difference_first_beyond(d, signal, tolerance);
    if (first < 0) {
        return result_news("minus '%s': %s never differs by more than %g %s", name,
                           signal_table[signal].name, tolerance, signal_table[signal].unit);
    }
    return result_news("minus '%s': %s differs by more than %g %s from %.5f s on; D shows the runs",
                       name, signal_table[signal].name, tolerance, signal_table[signal].unit,
                       first);
}

// --- sweeps -----------------------------------------------------------------------------------

action_result act_continue_sweep(explorer_state *st)
{
    assert(st != NULL);
    fault f = {0};
    lab_sweep *sweep = &st->sweep;

    // asked again and again: a finished sweep stays as it is
    if (lab_sweep_is_done(sweep)) {
        return result_done();
    }

    // one run a call, so that keys are read in between
    const status code = lab_sweep_compute_next(sweep, &st->session.effective, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }

    // only the last one is news
    if (!lab_sweep_is_done(sweep)) {
        return result_done();
    }
    return result_news("%d runs: arrows choose one, Enter opens it, M another metric, Esc ends it",
                       sweep->count);
}

action_result act_sweep(explorer_state *st, const char *argument)
{
    lab_sweep *sweep = &st->sweep;
    fault f = {0};
    if (strcmp(argument, "off") == 0) {
        lab_sweep_end(sweep);
        st->side.panel = st->side.panel == PANEL_SWEEP ? panel_first_on_side() : st->side.panel;
        return result_done();
    }

    // without an argument the selected parameter's is begun
    if (argument[0] == '\0') {
        char line[LINE_TEXT];
        slider_scale scale = {0};
        const int parameter = st->parameters.parameter;
        const parameters p = state_parameters(st);
        const double value = parameter_get(&p, parameter);
        snprintf(line, sizeof line, "sweep %s=", parameter_table[parameter].path);
        if (slider_scale_of(parameter, value, &scale) && scale.logarithmic) {
            prompt_open(&st->prompt, "%s%g:%g:8:log", line, fmax(scale.low, value / 4),
                        fmin(scale.high, value * 4));
        } else if (slider_scale_of(parameter, value, &scale)) {
            prompt_open(&st->prompt, "%s%g:%g:8", line, scale.low, scale.high);
        } else {
            prompt_open(&st->prompt, "%s", line);
        }
        return result_news("first value, last value, number of runs; or values with commas");
    }

    // each run is computed while the lab waits, so they must be short
    const action_result whole = act_need_whole_run(st);
    if (!result_ok(&whole)) {
        return whole;
    }
    if (isfinite(st->session.patience) && st->session.run.summary.wall_time_s > LONGEST_SWEPT_RUN) {
        return result_refused("a run takes %.1f s here: 'impactlab sweep' computes them beside",
                              st->session.run.summary.wall_time_s);
    }
    const status code = lab_sweep_begin(sweep, argument, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    st->side.panel = PANEL_SWEEP;
    st->difference.on = false;

    // with each picture a run, without pictures all
    action_result news = act_continue_sweep(st);
    while (result_ok(&news) && isinf(st->session.patience) && !lab_sweep_is_done(sweep)) {
        news = act_continue_sweep(st);
    }
    return news;
}

action_result act_set_metric(explorer_state *st, const char *argument)
{
    lab_sweep *sweep = &st->sweep;
    int metric = summary_find(argument);
    if (argument[0] != '\0' && metric < 0) {
        const char *near = summary_suggest(argument);
        return result_refused("there is no number '%.60s' of a run's summary%s%s%s", argument,
                              near ? ", did you mean '" : "", near ? near : "", near ? "'?" : "");
    }

    // the next one that any of the runs has
    for (int step = 1; argument[0] == '\0' && metric < 0 && step <= summary_count; step++) {
        const int next = (sweep->metric + step) % summary_count;
        bool known = sweep->count == 0;
        for (int i = 0; i < sweep->count; i++) {
            known = known || isfinite(summary_value(&sweep->runs[i].run.summary, next));
        }
        metric = known && !summary_table[next].timing ? next : -1;
    }
    sweep->metric = metric < 0 ? sweep->metric : metric;
    return result_news("%s: %s", summary_table[sweep->metric].label,
                       summary_table[sweep->metric].description);
}

void act_select_swept(explorer_state *st, int direction)
{
    assert(st != NULL);
    lab_sweep *sweep = &st->sweep;
    const int last = sweep->count - 1;
    int at = sweep->selected + direction;
    at = at > last ? last : at;
    sweep->selected = at < 0 ? 0 : at;
}

action_result act_take_swept(explorer_state *st)
{
    assert(st != NULL);
    const lab_sweep *sweep = &st->sweep;
    session *s = &st->session;
    char value[SWEEP_VALUE_TEXT];
    if (sweep->selected >= sweep->count) {
        return result_refused("the sweep has no run yet");
    }

    // a change from the start, whatever is looked at
    const double now = s->now;
    sweep_axis_format(&sweep->axis, sweep->runs[sweep->selected].value, value, sizeof value);
    session_seek(s, 0);
    const action_result changed = act_change(st, sweep->axis.parameter, value);
    const double seen = s->seen;
    session_seek(s, now);
    s->seen = fmax(seen, s->now);
    return changed;
}
