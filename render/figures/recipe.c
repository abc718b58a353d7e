#include "render/figures/recipe.h"

#include <assert.h>
#include <stdlib.h>

#include "render/figures/publication.h"
#include "render/figures/recipe_figure.h"
#include "render/figures/recipe_parts.h"
#include "render/figures/run_figure.h"
#include "render/plot/trace_plot.h"
#include "src/base/version.h"

void *recipe_own(recipe_figure *fig, void *block)
{
    g_ptr_array_add(fig->owned, block);
    return block;
}

static void release(void *owner)
{
    recipe_figure *fig = owner;
    for (int i = 0; i < fig->recipe.source_count; i++) {
        opened_source *s = &fig->sources[i];
        if (s->ran) {
            run_end(&s->run);
        }
        trace_finish(&s->data.trace);
        for (int k = 0; k < SWEEP_TABLE_COLUMNS; k++) {
            free(s->columns[k]);
        }
    }

    g_ptr_array_free(fig->owned, TRUE);
    recipe_finish(&fig->recipe);
    g_free(fig->path);
    g_free(fig);
}

// ---- opening what the recipe names

// A file as the recipe's folder sees it; a scenario's name stays.
static char *path_of(const recipe_figure *fig, const char *name)
{
    char *folder = g_path_get_dirname(fig->path);
    char *path = g_path_is_absolute(name) ? g_strdup(name) : g_build_filename(folder, name, NULL);
    g_free(folder);
    return path;
}

// Puts the place in the recipe before what went wrong.
static status at_source(const recipe_figure *fig, const recipe_source *s, status code,
                        const fault *why, fault *f)
{
    return fault_set(f, code, "%s:%d:%d: %s", fig->path, s->at.line, s->at.column, why->text);
}

static status open_run(recipe_figure *fig, const recipe_source *s, opened_source *out, fault *f)
{
    char *beside = path_of(fig, s->scenario);
    bool file = g_file_test(beside, G_FILE_TEST_IS_REGULAR);

    status code = run_begin_changed(&out->run, file ? beside : s->scenario, s->change,
                                    s->change_count, NULL, f);
    out->ran = code == STATUS_OK;
    g_free(beside);
    return code;
}

static status open_data(recipe_figure *fig, const recipe_source *s, opened_source *out, fault *f)
{
    trace_panel shown[FIGURE_PANELS];
    int count = 0;

    // the signals that a nameless column may lie over
    for (int i = 0; i < fig->recipe.panel_count; i++) {
        if (fig->recipe.panels[i].signal_count > 0) {
            shown[count++] = (trace_panel){.signals = {fig->recipe.panels[i].signals[0]}};
        }
    }

    char *path = path_of(fig, s->file), *name = NULL;
    status code =
        overlay_read_column(&out->data.trace, path, s->column, s->shift, shown, count, &name, f);
    g_free(name);
    g_free(path);
    return code;
}

static status open_source(recipe_figure *fig, int index, fault *f)
{
    const recipe_source *s = &fig->recipe.sources[index];
    opened_source *out = &fig->sources[index];
    fault why = {0};
    status code = STATUS_OK;

    if (s->kind == SOURCE_RUN) {
        code = open_run(fig, s, out, &why);
    } else if (s->kind == SOURCE_DATA) {
        code = open_data(fig, s, out, &why);
    } else {
        char *path = path_of(fig, s->file);
        const char *const keys[] = {s->x, s->y, s->z};
        code = sweep_table_read(path, keys, s->z != NULL ? 3 : 2, out->columns, &out->count, &why);
        g_free(path);
    }

    return code == STATUS_OK ? code : at_source(fig, s, code, &why, f);
}

// ---- curves

static const trace *trace_of(const recipe_figure *fig, int source)
{
    const opened_source *s = &fig->sources[source];
    return fig->recipe.sources[source].kind == SOURCE_RUN ? &s->run.result.trace : &s->data.trace;
}

static void add_signal(recipe_figure *fig, int panel, int source, int signal, int signals)
{
    const recipe_source *from = &fig->recipe.sources[source];
    figure_panel *p = &fig->panels[panel];
    bool data = from->kind == SOURCE_DATA;
    int index = signal_index(fig->recipe.panels[panel].signals[signal]);

    // no room, or nothing measured
    if (p->series_count == PANEL_SERIES || (data && !trace_has(trace_of(fig, source), index))) {
        return;
    }

    const opened_source *s = &fig->sources[source];
    const trace_run run = {
        .scenario = &s->run.scenario, .result = data ? &s->data : &s->run.result, .points = data};
    figure_series *out = &fig->series[panel][p->series_count];
    *out = trace_series(&run, index, fig->owned);

    // several signals of one run are told by their symbols, several runs by their labels
    const char *label = recipe_label(fig, from);
    if (signals > 1) {
        const opened_source *first = &fig->sources[0];
        char *symbol = trace_symbol(data ? &first->run.scenario : run.scenario, index);
        label =
            recipe_own(fig, fig->recipe.source_count > 1 ? g_strdup_printf("%s %s", label, symbol)
                                                         : g_strdup(symbol));
        g_free(symbol);
    }

    // measured data are points without a line
    out->label = label;
    out->name = recipe_own(fig, g_strdup_printf("%s %s", from->name, signal_table[index].name));
    out->style = LINE_SOLID;
    out->colour = data ? 6 : recipe_colour(p->series_count);
    out->no_line = data;
    out->marker = data ? MARKER_CIRCLE : MARKER_NONE;
    p->series_count++;
}

// One signal of one source less that of another, at the instants of the first.
static void add_difference(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    const trace *of = trace_of(fig, from->of), *less = trace_of(fig, from->less);
    int index = signal_index(from->signals[0]);
    double *x = recipe_own(fig, g_new(double, of->row_count + 1));
    double *y = recipe_own(fig, g_new(double, of->row_count + 1));

    for (size_t i = 0; i < of->row_count; i++) {
        x[i] = of->rows[i].time;
        y[i] = signal_value(&of->rows[i], index) - trace_value_at(less, index, x[i]);
    }

    // points where data are compared, else a line
    bool data = fig->recipe.sources[from->of].kind == SOURCE_DATA;
    fig->series[panel][0] = (figure_series){.name = "difference",
                                            .x = x,
                                            .y = y,
                                            .count = of->row_count,
                                            .colour = data ? 6 : 7,
                                            .no_line = data,
                                            .marker = data ? MARKER_CIRCLE : MARKER_NONE};
    fig->panels[panel].series_count = 1;
}

// ---- panels

// "Contact force f (N)" of a signal, or the names of a table's columns.
static void describe_axis(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    figure_axis *y = &fig->panels[panel].y;
    *y = (figure_axis){.with_zero = from->zero,
                       .low = from->low,
                       .high = from->high,
                       .scale = from->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR};

    // a signal, or a column of a table
    if (from->signal_count > 0) {
        const signal_info *signal = &signal_table[signal_index(from->signals[0])];
        char *symbol = trace_symbol(&fig->sources[0].run.scenario, signal_index(signal->name));

        y->name = signal->name;
        y->unit = signal->unit;
        y->symbol = from->signal_count == 1
                        ? recipe_own(fig, g_strconcat(from->of >= 0 ? "Δ" : "", symbol, NULL))
                        : NULL;
        y->label = recipe_own(fig, from->of >= 0 ? g_strdup_printf("Difference of %s", symbol)
                                   : from->signal_count == 1
                                       ? g_strdup_printf("%s %s", signal->quantity, symbol)
                                       : g_strdup(signal->quantity));
        g_free(symbol);
    } else if (from->source_count > 0) {
        const recipe_source *table = &fig->recipe.sources[from->sources[0]];
        figure_axis column = recipe_column_axis(fig, table->y);
        column.with_zero = from->zero;
        column.low = from->low;
        column.high = from->high;
        column.scale = y->scale;
        column.room = table->z != NULL ? 0 : 0.05;
        *y = column;
    }

    // the recipe's own word
    if (from->label != NULL) {
        y->label = from->label;
    }
}

static void describe_panel(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    figure_panel *p = &fig->panels[panel];
    describe_axis(fig, panel);

    p->heading = from->heading;
    p->weight = from->weight;
    p->series = fig->series[panel];
    p->notes = fig->notes[panel];
    p->note_count = from->note_count;

    for (int i = 0; i < from->note_count; i++) {
        const recipe_note *n = &from->notes[i];
        fig->notes[panel][i] = (figure_note){n->x, n->y, n->text};
    }

    // curves
    if (from->of >= 0) {
        add_difference(fig, panel);
    }
    for (int i = 0; i < from->source_count; i++) {
        if (fig->recipe.sources[from->sources[i]].kind == SOURCE_TABLE) {
            recipe_add_table(fig, panel, from->sources[i]);
            continue;
        }
        for (int k = 0; k < from->signal_count; k++) {
            add_signal(fig, panel, from->sources[i], k, from->signal_count);
        }
    }
}

// A panel with the first one's curves needs no legend of its own.
static void share_legend(recipe_figure *fig, int panel)
{
    const figure_panel *first = &fig->panels[0], *p = &fig->panels[panel];
    bool same = panel > 0 && p->series_count == first->series_count;
    for (int i = 0; i < p->series_count && same; i++) {
        same = g_strcmp0(p->series[i].label, first->series[i].label) == 0 &&
               p->series[i].colour == first->series[i].colour;
    }
    if (same) {
        fig->panels[panel].legend = LEGEND_NONE;
    }
}

// The axis below all panels: time, or the first column of the first table.
static figure_axis horizontal_axis(recipe_figure *fig)
{
    const recipe *r = &fig->recipe;
    const recipe_source *first = &r->sources[0];
    figure_axis x = {.name = "time", .label = "Time <i>t</i>", .unit = "s"};

    if (first->kind == SOURCE_TABLE) {
        x = recipe_column_axis(fig, first->x);
        x.room = first->z != NULL ? 0 : 0.03;
    }

    // what the recipe says of it
    x.label = r->x_label != NULL ? r->x_label : x.label;
    x.unit = r->x_unit != NULL ? r->x_unit : x.unit;
    x.low = r->from;
    x.high = r->to;
    x.scale = r->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR;
    return x;
}

// The recipe's runs with every parameter, for the file.
static char *parameters_of(const recipe_figure *fig)
{
    GString *out = g_string_new(NULL);
    for (int i = 0; i < fig->recipe.source_count; i++) {
        if (fig->sources[i].ran) {
            char *line = parameters_line(&fig->sources[i].run.scenario);
            g_string_append_printf(out, "%s%s", out->len > 0 ? "; " : "", line);
            g_free(line);
        }
    }
    return g_string_free(out, FALSE);
}

static void describe(recipe_figure *fig, const figure_options *o)
{
    const recipe *r = &fig->recipe;
    for (int i = 0; i < r->panel_count; i++) {
        describe_panel(fig, i);
        share_legend(fig, i);
    }

    for (int i = 0; i < r->mark_count; i++) {
        fig->marks[i] = (figure_mark){r->marks[i].x, r->marks[i].label};
    }

    fig->figure =
        (figure){.title = r->title,
                 .caption = r->caption,
                 .x = horizontal_axis(fig),
                 .panels = fig->panels,
                 .panel_count = r->panel_count,
                 .columns = r->columns,
                 .shared_y = r->shared,
                 .marks = fig->marks,
                 .mark_count = r->mark_count,
                 .software = recipe_own(fig, g_strconcat("impactlab ", lab_version(), NULL)),
                 .parameters = recipe_own(fig, parameters_of(fig))};

    // the first run's contact
    if (r->contact && fig->sources[0].ran) {
        fig->figure.intervals = trace_contact(&fig->sources[0].run.result.trace,
                                              &fig->figure.interval_count, fig->owned);
    }

    figure_take_look(&fig->figure, &o->look);
    figure_take_range(&fig->figure, o);
}

status recipe_open(const char *path, const figure_options *o, fault_handler report, void *context,
                   artwork *out, fault *f)
{
    assert(path != NULL && o != NULL && report != NULL && out != NULL);
    gchar *text = NULL;
    gsize length = 0;
    GError *error = NULL;
    if (!g_file_get_contents(path, &text, &length, &error)) {
        fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path, error->message);
        g_error_free(error);
        return STATUS_CANNOT_READ;
    }

    // what it says
    recipe_figure *fig = g_new0(recipe_figure, 1);
    fig->path = g_strdup(path);
    fig->owned = g_ptr_array_new_with_free_func(g_free);
    status code = recipe_read(&fig->recipe, path, text, length, report, context)
                      ? STATUS_OK
                      : STATUS_BAD_SCENARIO;
    g_free(text);

    // what it names
    for (int i = 0; i < fig->recipe.source_count && code == STATUS_OK; i++) {
        code = open_source(fig, i, f);
    }
    if (code != STATUS_OK) {
        release(fig);
        return code;
    }

    // what it shows
    describe(fig, o);
    *out = artwork_of_figure(&fig->figure, fig, release);
    return STATUS_OK;
}

bool recipe_is(const char *path)
{
    assert(path != NULL);
    gchar *text = NULL;
    gsize length = 0;
    if (!g_file_get_contents(path, &text, &length, NULL)) {
        return false;
    }

    // its faults are reported when it is opened
    fault unused = {0};
    tree_node *root = tree_parse(text, length, &unused);
    bool is = root != NULL && root->kind == TREE_MAP && recipe_child(root, "panels") != NULL;
    tree_free(root);
    g_free(text);
    return is;
}
