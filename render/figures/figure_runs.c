// Runs of scenarios for figures, and figures of their signals.
#include "render/figures/figures.h"

#include <assert.h>
#include <string.h>

#include "render/plot/run_style.h"
#include "src/base/words.h"

// ---- scenarios run for figures

void run_close(void *run)
{
    opened_run *r = run;
    if (r != NULL) {
        run_finish(&r->result);
        scenario_finish(&r->scenario);
        g_free(r);
    }
}

opened_run *run_open(const char *name, const char *change, fault *f)
{
    if (change == NULL) {
        return run_open_changed(name, NULL, 0, NULL, f);
    }
    return run_open_changed(name, &change, 1, NULL, f);
}

// Changes a scenario that was opened with `code` and `first` fault, and runs it.
static opened_run *run_opened(opened_run *r, status code, fault *first,
                              const char *const *changes, int count, run_monitor *monitor,
                              fault *f)
{
    const run_options options = {.keep_trace = true, .monitor = monitor};
    if (code == STATUS_OK && count > 0) {
        code = scenario_override_all(&r->scenario, (char *const *)changes, count,
                                     keep_first_fault, first);
    }
    if (code != STATUS_OK) {
        fault_set(f, code, "%s", first->text);
        run_close(r);
        return NULL;
    }

    // and the run
    code = run_scenario_with(&r->scenario, &options, &r->result);
    if (code != STATUS_OK) {
        fault_set(f, code, "%s: %s", r->scenario.name, r->result.summary.message);
        run_close(r);
        return NULL;
    }
    return r;
}

opened_run *run_open_changed(const char *name, const char *const *changes, int count,
                             run_monitor *monitor, fault *f)
{
    fault first = {STATUS_OK, ""};
    opened_run *r = g_new0(opened_run, 1);
    const status code = scenario_open(&r->scenario, name, keep_first_fault, &first);
    return run_opened(r, code, &first, changes, count, monitor, f);
}

opened_run *run_open_text(const char *text, const char *name, const char *const *changes,
                          int count, fault *f)
{
    fault first = {STATUS_OK, ""};
    opened_run *r = g_new0(opened_run, 1);
    const status code = scenario_parse(&r->scenario, text, strlen(text), name, name,
                                       keep_first_fault, &first);
    return run_opened(r, code, &first, changes, count, NULL, f);
}

// The run ends with the figure.
owned_figure *run_plot_create(const figure_order *order, const char *change, int panels,
                              const opened_run **run, fault *f)
{
    opened_run *opened = run_open(order->which->scenario, change, f);
    if (opened == NULL) {
        return NULL;
    }
    owned_figure *o = owned_figure_create(panels, "%s", order->title);
    *run = owned_figure_own(o, opened, run_close);
    o->figure.parameters = owned_figure_keep(o, parameters_line(&opened->scenario));
    return o;
}

// ---- the signals asked for

const char *nearest_signal(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 1; i < signal_count; i++) {
        nearest_try(&near, signal_table[i].name);
    }
    if (near.best != NULL) {
        return near.best;
    }
    return "force";
}

// Reads the signals of one panel, such as "hub_angle+last_angle".
static status read_signal_panel(const char *text, trace_panel *p, fault *f)
{
    g_auto(GStrv) words = g_strsplit(text, "+", -1);
    for (int i = 0; i == 0 || words[i] != NULL; i++) {
        const char *name = "";
        if (words[i] != NULL) {
            name = g_strstrip(words[i]);
        }
        int index = signal_find(name);

        // the signal is known, the panel has room, and its signals have one unit
        FAULT_IF(index <= 0, f, STATUS_BAD_ARGUMENT,
                 "there is no signal '%s', did you mean '%s'?", name,
                 nearest_signal(name));
        FAULT_IF(i == TRACE_SIGNALS, f, STATUS_BAD_ARGUMENT,
                 "'%s': a panel shows at most %d signals", text, TRACE_SIGNALS);
        p->signals[i] = signal_table[index].name;
        FAULT_IF(strcmp(signal_table[index].unit,
                        signal_table[signal_index(p->signals[0])].unit) != 0,
                 f, STATUS_BAD_ARGUMENT,
                 "'%s': the signals of a panel have one unit, expected a comma between "
                 "%s and %s",
                 text, p->signals[0], name);
    }
    return STATUS_OK;
}

// Reads the signals of all panels, such as "force,hub_angle+last_angle".
static status read_signal_panels(const char *text, trace_panel *panels, int *count,
                                 fault *f)
{
    g_auto(GStrv) words = g_strsplit(text, ",", -1);
    for (*count = 0; *count == 0 || words[*count] != NULL; ++*count) {
        FAULT_IF(*count == FIGURE_PANELS - 1, f, STATUS_BAD_ARGUMENT,
                 "'%s': a figure has at most %d panels", text, FIGURE_PANELS - 1);
        trace_panel *p = &panels[*count];
        *p = (trace_panel){.weight = 1};
        TRY(read_signal_panel(text_or(words[*count], ""), p, f));

        // the first signal decides what else the panel shows
        const signal_info *signal = &signal_table[signal_index(p->signals[0])];
        p->with_zero = strcmp(signal->unit, "N") == 0 || strcmp(signal->unit, "V") == 0;
        p->wall = strcmp(signal->unit, "rad") == 0;
        p->impulses = *count == 0 && strcmp(signal->name, "force") == 0;
        if (p->signals[1] != NULL) {
            p->label = signal->quantity;
        } else {
            p->label = NULL;
        }
    }
    return STATUS_OK;
}

// ---- figures of runs

// Reads measured data as a run without a scenario; *name becomes its name in the legend,
// to be freed. NULL if overlay_read fails.
static opened_run *open_overlay(const char *overlay, const trace_panel *panels,
                                int panel_count, char **name, fault *f)
{
    opened_run *measured = g_new0(opened_run, 1);
    trace *rows = &measured->result.trace;
    if (overlay_read(rows, overlay, panels, panel_count, name, f) != STATUS_OK) {
        run_close(measured);
        return NULL;
    }
    return measured;
}

// Makes the figure of runs: chooses the panels, and adds measured data as one more run.
owned_figure *run_figure_create(const char *title, const trace_panel *panels,
                                int panel_count, const trace_run *runs, int run_count,
                                const figure_options *o, fault *f)
{
    assert(run_count >= 1);
    trace_run all[TRACE_RUNS];
    trace_panel asked[FIGURE_PANELS];

    // the panels: those asked for, those given, or the usual ones, of which many runs
    // side by side show less
    const bool together = panels == NULL && runs[0].rank > 0;
    if (together && run_count > RUNS_TOGETHER) {
        panels = multiple_panels;
        panel_count = MULTIPLE_PANELS;
    } else if (together) {
        panels = together_panels;
        panel_count = USUAL_PANELS;
    } else if (panels == NULL) {
        panels = usual_panels;
        panel_count = USUAL_PANELS;
    }
    if (o->signals != NULL) {
        if (read_signal_panels(o->signals, asked, &panel_count, f) != STATUS_OK) {
            return NULL;
        }
        panels = asked;
    }

    // room for all panels
    int needed = panel_count;
    if (runs[0].rank > 0) {
        needed = trace_compare_panels(panels, panel_count, runs, run_count);
    }
    if (needed > FIGURE_PANELS) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "%d runs of these signals make %d panels, expected at most %d: choose "
                  "signals by --signals",
                  run_count, needed, FIGURE_PANELS);
        return NULL;
    }

    // room for all runs
    int curves = run_count;
    if (o->overlay != NULL) {
        curves++;
    }
    if (curves > TRACE_RUNS) {
        fault_set(f, STATUS_BAD_ARGUMENT, "a figure shows at most %d runs and data",
                  TRACE_RUNS);
        return NULL;
    }

    // measured data are one more run, of points
    g_autofree char *name = NULL;
    opened_run *measured = NULL;
    memcpy(all, runs, (size_t)run_count * sizeof *runs);
    if (o->overlay != NULL) {
        measured = open_overlay(o->overlay, panels, panel_count, &name, f);
        if (measured == NULL) {
            return NULL;
        }
        all[run_count] =
            (trace_run){runs[0].scenario, &measured->result, name, .points = true};
    }

    // the figure owns them
    owned_figure *drawn = trace_figure_create(title, panels, panel_count, all, curves);
    owned_figure_own(drawn, measured, run_close);
    figure_take_look(&drawn->figure, &o->look);
    figure_take_range(&drawn->figure, o);
    return drawn;
}
