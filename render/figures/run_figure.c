#include "render/figures/run_figure.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"

// ---- scenarios run for figures

void run_end(opened_run *r)
{
    run_finish(&r->result);
    scenario_finish(&r->scenario);
}

status run_begin(opened_run *r, const char *name, const char *change, fault *f)
{
    return run_begin_changed(r, name, &change, change != NULL ? 1 : 0, NULL, f);
}

status run_begin_changed(opened_run *r, const char *name, const char *const *changes, int count,
                         run_monitor *monitor, fault *f)
{
    const run_options options = {.keep_trace = true, .monitor = monitor};
    fault first = {STATUS_OK, ""};
    status code = scenario_open(&r->scenario, name, keep_first_fault, &first);
    FAIL_IF(code != STATUS_OK, fault_set(f, code, "%s", first.text));

    // changes lie above what the file says
    if (count > 0) {
        code = scenario_override_all(&r->scenario, (char *const *)changes, count, keep_first_fault,
                                     &first);
        fault_set(f, code, "%s", first.text);
    }

    // a run that fails takes its rows with it
    if (code == STATUS_OK) {
        code = run_scenario_with(&r->scenario, &options, &r->result);
        if (code == STATUS_OK) {
            return code;
        }
        fault_set(f, code, "%s: %s", name, r->result.summary.message);
        run_finish(&r->result);
    }

    // after any fault the caller has nothing to finish
    scenario_finish(&r->scenario);
    return code;
}

// ---- the signals asked for

const char *nearest_signal(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 1; i < signal_count; i++) {
        nearest_try(&near, signal_table[i].name);
    }
    return near.best != NULL ? near.best : "force";
}

// One panel, "hub_angle+last_angle".
static status read_panel(const char *text, trace_panel *p, fault *f)
{
    g_auto(GStrv) words = g_strsplit(text, "+", -1);
    for (int i = 0; words[i] != NULL; i++) {
        const char *name = g_strstrip(words[i]);
        int index = signal_find(name);

        // known, with room, and of the panel's one unit
        FAIL_IF(index <= 0,
                fault_set(f, STATUS_BAD_ARGUMENT, "there is no signal '%s', did you mean '%s'?",
                          name, nearest_signal(name)));
        FAIL_IF(i == TRACE_SIGNALS,
                fault_set(f, STATUS_BAD_ARGUMENT, "'%s': a panel shows at most %d signals", text,
                          TRACE_SIGNALS));
        p->signals[i] = signal_table[index].name;
        FAIL_IF(strcmp(signal_table[index].unit, signal_table[signal_index(p->signals[0])].unit) !=
                    0,
                fault_set(f, STATUS_BAD_ARGUMENT,
                          "'%s': the signals of a panel have one unit, expected a comma between "
                          "%s and %s",
                          text, p->signals[0], name));
    }
    return STATUS_OK;
}

// All panels, "force,hub_angle+last_angle".
static status read_signals(const char *text, trace_panel *panels, int *count, fault *f)
{
    status code = STATUS_OK;
    g_auto(GStrv) words = g_strsplit(text, ",", -1);
    for (*count = 0; words[*count] != NULL && code == STATUS_OK; ++*count) {
        FAIL_IF(*count == FIGURE_PANELS - 1,
                fault_set(f, STATUS_BAD_ARGUMENT, "'%s': a figure has at most %d panels", text,
                          FIGURE_PANELS - 1));
        trace_panel *p = &panels[*count];
        *p = (trace_panel){.weight = 1};
        code = read_panel(words[*count], p, f);
        if (code == STATUS_OK) {
            // what goes without saying for a panel of its first signal
            const signal_info *signal = &signal_table[signal_index(p->signals[0])];
            p->with_zero = strcmp(signal->unit, "N") == 0 || strcmp(signal->unit, "V") == 0;
            p->wall = strcmp(signal->unit, "rad") == 0;
            p->impulses = *count == 0 && strcmp(signal->name, "force") == 0;
            p->label = p->signals[1] != NULL ? signal->quantity : NULL;
        }
    }
    return code;
}

// ---- the figure

void run_figure_finish(run_figure *r)
{
    trace_figure_finish(&r->traces);
    trace_finish(&r->overlay.trace);
    g_free(r->overlay_name);
    memset(r, 0, sizeof *r);
}

status run_figure_init(run_figure *r, const char *title, const trace_panel *panels, int panel_count,
                       const trace_run *runs, int run_count, const figure_options *o, fault *f)
{
    assert(run_count >= 1);
    trace_run all[TRACE_RUNS];
    trace_panel asked[FIGURE_PANELS];
    status code = STATUS_OK;
    memset(r, 0, sizeof *r);
    panel_count = panels != NULL ? panel_count : USUAL_PANELS;
    panels = panels != NULL ? panels : usual_panels;
    if (o->signals != NULL) {
        code = read_signals(o->signals, asked, &panel_count, f);
        panels = asked;
    }
    if (code == STATUS_OK && run_count + (o->overlay != NULL) > TRACE_RUNS) {
        code = fault_set(f, STATUS_BAD_ARGUMENT, "a figure shows at most %d runs and data",
                         TRACE_RUNS);
    }

    // measured data are one more run, of points
    if (code == STATUS_OK) {
        memcpy(all, runs, (size_t)run_count * sizeof *runs);
    }
    if (code == STATUS_OK && o->overlay != NULL) {
        code =
            overlay_read(&r->overlay.trace, o->overlay, panels, panel_count, &r->overlay_name, f);
        all[run_count++] =
            (trace_run){runs[0].scenario, &r->overlay, r->overlay_name, .points = true};
    }
    if (code == STATUS_OK) {
        code = trace_figure_init(&r->traces, title, panels, panel_count, all, run_count, f);
    }
    if (code != STATUS_OK) {
        run_figure_finish(r);
        return code;
    }
    figure_take_look(&r->traces.plot.figure, &o->look);
    figure_take_range(&r->traces.plot.figure, o);
    return STATUS_OK;
}
