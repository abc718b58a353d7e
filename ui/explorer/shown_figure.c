// What the lab shows as recipes of figures.
#include <glib.h>
#include <stdlib.h>
#include <string.h>

#include "render/drawing.h"
#include "src/base/numbers.h"
#include "ui/explorer/explorer.h"

// A recipe that is being written.
typedef struct shown_recipe {
    const explorer_model *model;
    const explorer_view *view;
    const char *folder; // of the picture
    FILE *stream;
    shown_run runs[SHOWN_RUNS]; // whose curves it has, measured data apart
    int run_count;
    int baseline; // among the runs, -1: none
    bool data;    // there are measured ones
} shown_recipe;

// --- which pictures there are ----------------------------------------------------------

// Whether a pane is on the screen.
static bool is_shown(const explorer_view *view, int index)
{
    const pane_set *set = &view->panes;
    const pane *p = &set->pane[index];
    return p->shown && p->count > 0 && (!set->alone || index == panes_focused(set));
}

// The panes of one picture: those over time (number 0), or one that is not (from 1 on);
// returns how many.
static int panes_of(const explorer_view *view, int number, int panes[PANES])
{
    int count = 0, others = 0;
    for (int i = 0; i < PANES; i++) {
        if (!is_shown(view, i)) {
            continue;
        }
        const bool over_time = pane_is_over_time(&view->panes.pane[i]);
        if (!over_time) {
            others++;
        }
        if ((number == 0 && over_time) || (!over_time && others == number)) {
            panes[count++] = i;
        }
    }
    return count;
}

// The pictures of panes that there are: the numbers of panes_of with any.
static int numbers_of(const explorer_view *view, int numbers[PANES + 1])
{
    int panes[PANES], count = 0;
    for (int number = 0; number <= PANES; number++) {
        if (panes_of(view, number, panes) > 0) {
            numbers[count++] = number;
        }
    }
    return count;
}

int shown_figure_count(const explorer_model *model, const explorer_view *view)
{
    int numbers[PANES + 1];
    const bool swept = view->side.panel == PANEL_SWEEP && model->sweep.count > 0;
    return numbers_of(view, numbers) + swept;
}

// --- words and numbers -----------------------------------------------------------------

// A text in double quotes.
static void write_quoted(const shown_recipe *r, const char *before, const char *text)
{
    fprintf(r->stream, "%s\"", before);
    for (; *text != '\0'; text++) {
        if (strchr("\"\\", *text) != NULL) {
            fputc('\\', r->stream);
        }
        fputc(*text, r->stream);
    }
    fputc('"', r->stream);
}

// The same of a plain text where markup is read.
static void write_plain(const shown_recipe *r, const char *before, const char *text)
{
    g_autofree char *escaped = g_markup_escape_text(text, -1);
    write_quoted(r, before, escaped);
}

static void write_value(const shown_recipe *r, const char *before, double value)
{
    char text[NUMBER_TEXT];
    number_format(text, value);
    fprintf(r->stream, "%s%s", before, isfinite(value) ? text : "null");
}

static void write_pair(const shown_recipe *r, const char *before, double a, double b)
{
    write_value(r, before, a);
    write_value(r, ", ", b);
    fputc(']', r->stream);
}

// --- runs ------------------------------------------------------------------------------

// A scenario's text, a block of lines.
static void write_scenario_text(const shown_recipe *r, const scenario *s)
{
    char *whole = scenario_as_text(s);
    fputs("    scenario: |\n", r->stream);
    for (char *rest = whole, *line; whole != NULL && *rest != '\0';) {
        line = strsep(&rest, "\n");
        fprintf(r->stream, "      %s\n", line);
    }
    free(whole);
}

// Whether a scenario is one that ships, as its file has it.
static bool is_shipped(const scenario *s)
{
    char changes[SCENARIO_CHANGES];
    g_autofree char *file = g_strconcat("/", s->name, ".yaml", NULL);
    return s->written != NULL && s->file != NULL && strcmp(s->name, s->file) != 0 &&
           g_str_has_suffix(s->file, file) && scenario_changes(s, changes)[0] == '\0';
}

// Writes a scenario with changes: its name and values, if that says all, else its text.
static status write_changed(const shown_recipe *r, const scenario *base,
                            const session_input *inputs, int count, fault *f)
{
    enum { SET_VALUES = 16 };
    bool plain = is_shipped(base) && count <= SET_VALUES;
    for (int i = 0; i < count; i++) {
        plain = plain && inputs[i].kind == SESSION_INPUT_START;
        for (int k = 0; k < i; k++) {
            plain = plain && inputs[i].parameter != inputs[k].parameter;
        }
    }
    if (!plain) {
        scenario changed;
        const status code = session_scenario(base, inputs, count, &changed, f);
        if (code == STATUS_OK) {
            write_scenario_text(r, &changed);
        }
        free(changed.actions);
        return code;
    }

    // the values as they were given
    fprintf(r->stream, "    scenario: %s\n", base->name);
    for (int i = 0; i < count; i++) {
        fprintf(r->stream, "%s%s", i == 0 ? "    set: {" : ", ",
                parameter_table[inputs[i].parameter].path);
        write_quoted(r, ": ", inputs[i].text);
    }
    fputs(count > 0 ? "}\n" : "", r->stream);
    return STATUS_OK;
}

// A run of a sweep.
static status write_swept(const shown_recipe *r, int index, fault *f)
{
    const lab_sweep *swept = &r->model->sweep;
    scenario changed;
    TRY(sweep_axes_scenario(&swept->axis, 1, &swept->runs[index].value,
                            &r->model->session.effective, &changed, f));
    write_scenario_text(r, &changed);
    return STATUS_OK;
}

// What a run is called.
static void run_label(const shown_recipe *r, const shown_run *run, char label[RUN_NAME])
{
    const lab_sweep *swept = &r->model->sweep;
    if (run->kind == SHOWN_SWEPT) {
        char value[SWEEP_VALUE_TEXT];
        sweep_axis_format(&swept->axis, swept->runs[run->index].value, value,
                          sizeof value);
        snprintf(label, RUN_NAME, "%s %s",
                 strchr(sweep_axis_parameter(&swept->axis)->path, '.') + 1, value);
    } else if (run->kind == SHOWN_PINNED) {
        snprintf(label, RUN_NAME, "%s", r->model->pinned.runs[run->index].name);
    } else if (run->kind == SHOWN_OPENED) {
        snprintf(label, RUN_NAME, "%s", AS_OPENED);
    } else if (model_kept_run(r->model) != NULL) {
        snprintf(label, RUN_NAME, "%s", model_kept_run(r->model)->name);
    } else {
        run_list_describe(&r->model->session, label, RUN_NAME);
    }
}

// The runs, then the measured data, named "run 1" and so on and "data".
static status write_sources(const shown_recipe *r, fault *f)
{
    const explorer_model *model = r->model;
    fputs("runs:\n", r->stream);
    for (int i = 0; i < r->run_count; i++) {
        const shown_run *run = &r->runs[i];
        char label[RUN_NAME];
        run_label(r, run, label);
        fprintf(r->stream, "  - name: run %d\n", i + 1);
        write_quoted(r, "    label: ", label);
        fputc('\n', r->stream);
        if (shown_run_rank(run) > 0) {
            fprintf(r->stream, "    look: %d\n", shown_run_rank(run));
        }
        if (run->kind == SHOWN_SWEPT) {
            TRY(write_swept(r, run->index, f));
        } else if (run->kind == SHOWN_PINNED) {
            const run_origin *from = &model->pinned.runs[run->index].from;
            TRY(write_changed(r, &from->base, from->inputs, from->input_count, f));
        } else {
            const session *s = &model->session;
            const int changes = run->kind == SHOWN_OPENED ? 0 : s->input_count;
            TRY(write_changed(r, &s->base, s->inputs, changes, f));
        }
    }
    if (!r->data) {
        return STATUS_OK;
    }

    // a file beside the picture goes by its name alone
    g_autofree char *path = g_canonicalize_filename(model->measured_file, NULL);
    g_autofree char *folder = g_path_get_dirname(path), *leaf = g_path_get_basename(path);
    g_autofree char *here = g_canonicalize_filename(r->folder, NULL);
    fputs("data:\n  - {name: data", r->stream);
    write_quoted(r, ", label: ", leaf);
    write_quoted(r, ", file: ", strcmp(folder, here) == 0 ? leaf : path);
    write_value(r, ", shift: ", model->measured_shift);
    fputs("}\n", r->stream);
    return STATUS_OK;
}

// --- panels ----------------------------------------------------------------------------

// The end of a panel: its range, unless that follows from the data (`follows`).
static void end_panel(const shown_recipe *r, int pane_index, bool follows)
{
    value_range axis;
    const bool is_fixed = r->view->panes.pane[pane_index].is_fixed;
    if ((is_fixed || !follows) && view_pane_axis(r->model, r->view, pane_index, &axis)) {
        write_pair(r, ", range: [", axis.low, axis.high);
    }
    fputs("}\n", r->stream);
}

// A panel with the difference of a signal between two sources.
static void write_difference(const shown_recipe *r, int pane_index, int signal,
                             const char *of, const char *less)
{
    fprintf(r->stream, "  - {difference: [%s, %s]", of, less);
    write_quoted(r, ", signals: [", signal_table[signal].name);
    fputc(']', r->stream);
    end_panel(r, pane_index, true);
}

// Setpoints and limits of a panel over time, as far as the pane has room for them.
static void write_bounds(const shown_recipe *r, int pane_index, int first)
{
    shown_level levels[SHOWN_LEVELS];
    value_range axis = {-HUGE_VAL, HUGE_VAL};
    const pane *p = &r->view->panes.pane[pane_index];
    const int count = model_levels(r->model, p, levels);
    const char *before = ", levels: [{at: ";
    view_pane_axis(r->model, r->view, pane_index, &axis);
    for (int i = 0; i < count; i++) {
        const double at = levels[i].value;
        if (levels[i].signal != first || at < axis.low || at > axis.high) {
            continue;
        }
        write_value(r, before, at);
        if (levels[i].name[0] != '\0') {
            write_plain(r, ", label: ", levels[i].name);
        }
        fputc('}', r->stream);
        before = ", {at: ";
    }
    fputs(before[2] == '{' ? "]" : "", r->stream);
}

// The signals of a pane that are not hidden; returns how many.
static int visible_signals(const pane *p, int signals[PANE_SIGNALS])
{
    int count = 0;
    for (int k = 0; k < p->count; k++) {
        if ((p->hidden >> k & 1) == 0) {
            signals[count++] = p->signals[k];
        }
    }
    return count;
}

// The curves of a pane: of one run a panel for each unit, of several one for each signal.
static void write_curves(const shown_recipe *r, int pane_index, const int *signals,
                         int count)
{
    const bool alone = r->run_count == 1 && !r->data;
    bool written[PANE_SIGNALS] = {false};
    for (int k = 0; k < count; k++) {
        if (written[k]) {
            continue;
        }
        const char *unit = signal_table[signals[k]].unit;
        write_quoted(r, "  - {signals: [", signal_table[signals[k]].name);
        for (int i = k + 1; i < count && alone; i++) {
            if (strcmp(signal_table[signals[i]].unit, unit) == 0) {
                write_quoted(r, ", ", signal_table[signals[i]].name);
                written[i] = true;
            }
        }
        fputc(']', r->stream);
        const bool is_force = signals[k] == SIGNAL_INDEX(force);
        if (is_force) {
            fputs(", weight: 2, zero: true, impulses: true", r->stream);
        }
        write_bounds(r, pane_index, signals[k]);

        // readings beside the force do not count for the range
        end_panel(r, pane_index, !(is_force && alone && count > 1));
    }
}

// A pane over time as one panel or several.
static void write_pane(const shown_recipe *r, int pane_index)
{
    const pane *p = &r->view->panes.pane[pane_index];
    int signals[PANE_SIGNALS];
    const int count = visible_signals(p, signals);
    const bool residual = p->view == VIEW_RESIDUAL;
    if (!residual && !model_subtracts(r->model)) {
        write_curves(r, pane_index, signals, count);
        return;
    }
    char baseline[32];
    snprintf(baseline, sizeof baseline, "run %d", r->baseline + 1);
    for (int k = 0; k < count; k++) {
        if (residual && r->data) {
            write_difference(r, pane_index, signals[k], "data", "run 1");
        } else if (!residual && !signal_is_derived(signals[k])) {
            write_difference(r, pane_index, signals[k], "run 1", baseline);
        }
    }
}

// --- the whole -------------------------------------------------------------------------

// Title, caption and width; over time what is shaded, too.
static void write_texts(const shown_recipe *r, bool over_time, double width)
{
    const explorer_model *model = r->model;
    const session *s = &model->session;
    char titled[SCENARIO_TITLED];
    const trace_run run = {&s->effective, &s->run};
    g_autofree char *caption = over_time ? drawing()->trace_caption(&run, 1, "contact")
                                         : drawing()->trace_shared(&run, 1);
    caption[0] = g_ascii_toupper(caption[0]);
    fputs("# impactlab plot draws this picture of the lab again\n", r->stream);
    write_quoted(r, "title: ",
                 r->run_count > 1 ? s->base.title
                                  : scenario_titled(&s->effective, titled));
    write_quoted(r, "\ncaption: ", caption);
    fputc('\n', r->stream);
    if (width > 0) {
        write_value(r, "width: ", width);
        fputc('\n', r->stream);
    }
}

// The runs of the panes: all that are shown, but of a pane over another axis only those
// that it draws.
static void take_runs(shown_recipe *r, const pane *only)
{
    const explorer_model *model = r->model;
    const int pinned = model->pinned.baseline;
    const shown_run baseline = {.kind = pinned >= 0 ? SHOWN_PINNED : SHOWN_OPENED,
                                .index = pinned >= 0 ? pinned : 0};
    const bool compares = model->session.has_other;
    shown_run all[SHOWN_RUNS] = {{.kind = SHOWN_PRESENT}};
    int count = 1;
    if (only == NULL && !model_subtracts(model)) {
        count = model_runs(model, NULL, all);
    } else if (compares && (only == NULL || only->view == VIEW_PHASE)) {
        all[count++] = baseline;
    }
    all[0].kind = SHOWN_PRESENT;
    r->baseline = -1;
    for (int i = 0; i < count; i++) {
        const bool is_baseline =
            all[i].kind == baseline.kind && all[i].index == baseline.index;
        if (all[i].kind == SHOWN_MEASURED) {
            continue;
        }

        // one that is the present run itself is not drawn twice
        if (is_baseline && model_kept_run(model) != NULL) {
            r->baseline = 0;
            continue;
        }
        if (compares && is_baseline) {
            r->baseline = r->run_count;
        }
        r->runs[r->run_count++] = all[i];
    }
    r->data = only == NULL && model->measured.row_count > 0;
}

// A line at an instant [s]; the first one begins the list of marks.
static void write_mark(const shown_recipe *r, bool *begun, double time, const char *label)
{
    write_value(r, *begun ? "  - {at: " : "marks:\n  - {at: ", time);
    write_plain(r, ", label: ", label);
    fputs("}\n", r->stream);
    *begun = true;
}

// The notes, and the mark with the cursor that is compared with it.
static void write_marks(const shown_recipe *r)
{
    const explorer_model *model = r->model;
    const time_mark *mark = &r->view->mark;
    bool begun = false;
    for (int i = 0; i < model->note_count; i++) {
        write_mark(r, &begun, model->notes[i].time, model->notes[i].text);
    }
    if (mark->set) {
        char after[48];
        snprintf(after, sizeof after, "%+.5g s", model->session.now - mark->time);
        write_mark(r, &begun, mark->time, "mark");
        write_mark(r, &begun, model->session.now, after);
    }
}

// The modes of the law over time, named.
static void write_modes(const shown_recipe *r)
{
    const law_modes *modes = &r->model->modes;
    const char *before = "  - {signals: [controller_mode], from: [run 1], weight: 0.6, "
                         "label: Mode of the law, range: [-0.5, ";
    if (!model_has_law(r->model) || modes->count == 0) {
        return;
    }
    fprintf(r->stream, "%s%d.5], levels: [", before, modes->count - 1);
    for (int i = 0; i < modes->count; i++) {
        fprintf(r->stream, "%s{at: %d", i > 0 ? ", " : "", i);
        write_plain(r, ", label: ", modes->names[i]);
        fputc('}', r->stream);
    }
    fputs("]}\n", r->stream);
}

// The panes over time, with the arm, the modes of the law, notes and marks.
static status write_over_time(shown_recipe *r, const int *panes, int count, double width,
                              fault *f)
{
    const time_window *w = &r->view->window;
    take_runs(r, NULL);
    write_texts(r, true, width);
    TRY(write_sources(r, f));
    fputs("panels:\n", r->stream);
    for (int i = 0; i < count; i++) {
        write_pane(r, panes[i]);
    }
    write_modes(r);
    write_value(r, "arm: ", r->model->session.now);
    fputc('\n', r->stream);
    if (w->to > w->from) {
        write_pair(r, "x: {range: [", w->from, w->to);
        fputs("}\n", r->stream);
    }
    write_marks(r);
    return STATUS_OK;
}

// A pane over another signal, or of a spectrum.
static status write_over_other(shown_recipe *r, int pane_index, double width, fault *f)
{
    const pane *p = &r->view->panes.pane[pane_index];
    double from, to;
    view_window(r->model, r->view, &from, &to);
    take_runs(r, p);
    write_texts(r, false, width);
    TRY(write_sources(r, f));
    write_quoted(r, "panels:\n  - {signals: [", signal_table[p->signals[0]].name);
    fputs("], weight: 2}\n", r->stream);
    if (p->view == VIEW_PHASE) {
        write_quoted(r, "x: {signal: ", signal_table[p->signals[1]].name);
    } else {
        fputs("x: {spectrum: true", r->stream);
        to = fmin(to, r->model->session.seen);
    }
    write_pair(r, ", time: [", from, to);
    fputs("}\n", r->stream);
    return STATUS_OK;
}

// The quantity of a sweep over its parameter, or as a map over two.
static status write_sweep_figure(shown_recipe *r, double width)
{
    const lab_sweep *swept = &r->model->sweep;
    const bool is_map = lab_sweep_is_map(swept);
    const char *metric = summary_table[swept->metric].key;
    write_texts(r, false, width);
    fprintf(r->stream, "tables:\n  - name: sweep\n    x: %s\n    y: %s\n",
            sweep_axis_parameter(&swept->axis)->path,
            is_map ? sweep_axis_parameter(&swept->second)->path : metric);
    if (is_map) {
        fprintf(r->stream, "    z: %s\n", metric);
    }
    fputs("    rows:\n", r->stream);
    for (int i = 0; i < swept->count; i++) {
        double values[2];
        lab_sweep_values(swept, i, values);
        write_value(r, "      - [", values[0]);
        if (is_map) {
            write_value(r, ", ", values[1]);
        }
        write_value(r, ", ", lab_sweep_metric(swept, i, swept->metric));
        fputs("]\n", r->stream);
    }
    fprintf(r->stream, "panels:\n  - {from: [sweep]%s, weight: 2}\n",
            is_map && swept->second.logarithmic ? ", log: true" : "");
    fputs(swept->axis.logarithmic ? "x: {log: true}\n" : "", r->stream);
    return STATUS_OK;
}

status shown_figure_write(const explorer_model *model, const explorer_view *view,
                          int index, const char *folder, double width, FILE *stream,
                          fault *f)
{
    int numbers[PANES + 1], panes[PANES];
    const int count = numbers_of(view, numbers);
    shown_recipe *r = g_new0(shown_recipe, 1);
    *r = (shown_recipe){.model = model, .view = view, .folder = folder, .stream = stream};
    status code;
    if (index >= count) {
        code = write_sweep_figure(r, width);
    } else if (numbers[index] == 0) {
        const int shown = panes_of(view, 0, panes);
        code = write_over_time(r, panes, shown, width, f);
    } else {
        panes_of(view, numbers[index], panes);
        code = write_over_other(r, panes[0], width, f);
    }
    g_free(r);
    return code;
}
