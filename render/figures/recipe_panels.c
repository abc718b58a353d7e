// Panels of a recipe: curves of runs, data and their differences, curves and maps from tables.
#include "render/figures/recipe_parts.h"

#include <math.h>
#include <stdlib.h>

#include "src/base/numbers.h"

// The legend text of a source, markup.
static const char *label_of(recipe_figure *fig, const recipe_source *s)
{
    return owned_figure_keep(&fig->plot, text_escape(s->label != NULL ? s->label : s->name));
}

// The colour of curve number `index` of a panel; the first ones differ most.
static int colour_of(int index)
{
    static const int colours[] = {0, 5, 2, 4, 1, 3, 7};
    return colours[index % (int)G_N_ELEMENTS(colours)];
}

figure_axis recipe_column_axis(recipe_figure *fig, const char *key)
{
    int parameter = parameter_find(key), quantity = summary_find(key);
    const char *words = parameter >= 0  ? parameter_table[parameter].description
                        : quantity >= 0 ? summary_table[quantity].label
                                        : NULL;

    // what neither table describes goes by its own name, without a unit
    g_autofree char *label = words != NULL ? text_label(words) : g_strdup(key);
    figure_axis axis = {.name = key,
                        .label = owned_figure_keep(&fig->plot, text_escape(label)),
                        .unit = parameter >= 0  ? parameter_table[parameter].unit
                                : quantity >= 0 ? summary_table[quantity].unit
                                                : ""};
    return axis;
}

// ---- tables

static void add_curve(recipe_figure *fig, int panel, int source)
{
    static const marker_kind markers[] = {MARKER_CIRCLE, MARKER_SQUARE, MARKER_TRIANGLE,
                                          MARKER_DIAMOND};
    figure_panel *p = &fig->plot.panels[panel];
    const opened_source *s = &fig->sources[source];

    // more curves than a panel has room for are left out
    if (p->series_count == PANEL_SERIES) {
        return;
    }

    // points are marked while they are few enough to be told apart
    fig->plot.series[panel][p->series_count] =
        (figure_series){.name = fig->recipe.sources[source].name,
                        .label = label_of(fig, &fig->recipe.sources[source]),
                        .x = s->columns[0],
                        .y = s->columns[1],
                        .count = s->count,
                        .colour = colour_of(p->series_count),
                        .marker = s->count > 80 ? MARKER_NONE : markers[p->series_count % 4]};
    p->series_count++;
}

// The different values of a column, ascending. Returns their number.
static size_t different_values(const double *column, size_t count, double *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        out[i] = column[i];
    }
    qsort(out, count, sizeof *out, compare_numbers);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || out[i] != out[kept - 1]) {
            out[kept++] = out[i];
        }
    }
    return kept;
}

static size_t place_among(const double *values, size_t count, double value)
{
    const double *found = bsearch(&value, values, count, sizeof *values, compare_numbers);
    return (size_t)(found - values);
}

// Cells over the grid that the first two columns make; a point without a run is hatched.
static void describe_cells(recipe_figure *fig, int panel, const opened_source *s)
{
    figure_map *map = &fig->maps[panel];
    size_t cells = map->columns * map->rows;
    double *z = owned_figure_numbers(&fig->plot, cells);

    // the map goes column by column; cells that no run fills keep no number
    for (size_t i = 0; i < cells; i++) {
        z[i] = (double)NAN;
    }
    for (size_t i = 0; i < s->count; i++) {
        size_t column = place_among(map->x, map->columns, s->columns[0][i]);
        size_t row = place_among(map->y, map->rows, s->columns[1][i]);
        z[column * map->rows + row] = s->columns[2][i];
    }
    map->z = z;
    map->contours = true;
    fig->plot.panels[panel].map = map;
}

static void add_map(recipe_figure *fig, int panel, int source)
{
    const opened_source *s = &fig->sources[source];
    const recipe_source *from = &fig->recipe.sources[source];
    figure_panel *p = &fig->plot.panels[panel];
    double *x = owned_figure_numbers(&fig->plot, s->count + 1);
    double *y = owned_figure_numbers(&fig->plot, s->count + 1);
    size_t columns = different_values(s->columns[0], s->count, x);
    size_t rows = different_values(s->columns[1], s->count, y);

    fig->colours[panel] = (figure_colours){.axis = recipe_column_axis(fig, from->z), .bar = true};
    p->colours = &fig->colours[panel];
    fig->maps[panel] = (figure_map){.x = x, .y = y, .columns = columns, .rows = rows};

    // values that were drawn at random make no grid: dots with their shade
    if (columns * rows <= 2 * s->count && columns > 1 && rows > 1) {
        describe_cells(fig, panel, s);
        return;
    }
    fig->plot.series[panel][p->series_count++] = (figure_series){
        from->name,        .x = s->columns[0], .y = s->columns[1],      .shade = s->columns[2],
        .count = s->count, .no_line = true,    .marker = MARKER_CIRCLE, .radius = 2.4};
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
    figure_panel *p = &fig->plot.panels[panel];
    bool data = from->kind == SOURCE_DATA;
    int index = signal_index(fig->recipe.panels[panel].signals[signal]);

    // no room, or nothing measured
    if (p->series_count == PANEL_SERIES || (data && !trace_has(trace_of(fig, source), index))) {
        return;
    }

    const opened_source *s = &fig->sources[source];
    const trace_run run = {
        .scenario = &s->run.scenario, .result = data ? &s->data : &s->run.result, .points = data};
    figure_series *out = &fig->plot.series[panel][p->series_count];
    *out = trace_series(&run, index, &fig->plot);

    // several signals of one run are told by their symbols, several runs by their labels
    const char *label = label_of(fig, from);
    if (signals > 1) {
        const opened_source *first = &fig->sources[0];
        g_autofree char *symbol = trace_symbol(data ? &first->run.scenario : run.scenario, index);
        label = owned_figure_keep(&fig->plot, fig->recipe.source_count > 1
                                                  ? text_printf("%s %s", label, symbol)
                                                  : g_strdup(symbol));
    }

    // measured data are points without a line
    out->label = label;
    out->name =
        owned_figure_keep(&fig->plot, text_printf("%s %s", from->name, signal_table[index].name));
    out->style = LINE_SOLID;
    out->colour = data ? 6 : colour_of(p->series_count);
    out->no_line = data;
    out->marker = data ? MARKER_CIRCLE : MARKER_NONE;
    p->series_count++;
}

// One signal of one source less that of another, at the instants of the first.
static void add_difference(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    figure_series *s = &fig->plot.series[panel][0];
    *s = trace_difference(trace_of(fig, from->of), trace_of(fig, from->less),
                          signal_index(from->signals[0]), &fig->plot);

    // points where data are compared, else a line
    bool data = fig->recipe.sources[from->of].kind == SOURCE_DATA;
    s->name = "difference";
    s->colour = data ? 6 : 7;
    s->no_line = data;
    s->marker = data ? MARKER_CIRCLE : MARKER_NONE;
    fig->plot.panels[panel].series_count = 1;
}

// ---- panels

// "Contact force f (N)" of a signal, or the names of a table's columns.
static void describe_axis(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    figure_axis *y = &fig->plot.panels[panel].y;
    *y = (figure_axis){.with_zero = from->zero,
                       .low = from->low,
                       .high = from->high,
                       .scale = from->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR};

    // a signal, or a column of a table
    if (from->signal_count > 0) {
        const signal_info *signal = &signal_table[signal_index(from->signals[0])];
        g_autofree char *symbol =
            trace_symbol(&fig->sources[0].run.scenario, signal_index(signal->name));

        y->name = signal->name;
        y->unit = signal->unit;
        y->symbol = from->signal_count == 1
                        ? owned_figure_keep(&fig->plot,
                                            g_strconcat(from->compared ? "Δ" : "", symbol, NULL))
                        : NULL;
        y->label = owned_figure_keep(
            &fig->plot, from->compared            ? text_printf("Difference of %s", symbol)
                        : from->signal_count == 1 ? text_printf("%s %s", signal->quantity, symbol)
                                                  : g_strdup(signal->quantity));
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

void recipe_describe_panel(recipe_figure *fig, int panel)
{
    const recipe_panel *from = &fig->recipe.panels[panel];
    figure_panel *p = &fig->plot.panels[panel];
    describe_axis(fig, panel);

    p->heading = from->heading;
    p->weight = from->weight;
    p->notes = from->notes;
    p->note_count = from->note_count;

    // curves
    if (from->compared) {
        add_difference(fig, panel);
    }
    for (int i = 0; i < from->source_count; i++) {
        const int source = from->sources[i];
        const recipe_source *s = &fig->recipe.sources[source];
        const bool empty = p->map == NULL && p->series_count == 0;
        if (s->kind == SOURCE_TABLE && s->z == NULL) {
            add_curve(fig, panel, source);
        } else if (s->kind == SOURCE_TABLE && empty && fig->sources[source].count > 0) {
            add_map(fig, panel, source);
        }
        for (int k = 0; k < from->signal_count && s->kind != SOURCE_TABLE; k++) {
            add_signal(fig, panel, source, k, from->signal_count);
        }
    }

    // a panel with the first one's curves needs no legend of its own
    const figure_panel *first = &fig->plot.panels[0];
    bool same = panel > 0 && p->series_count == first->series_count;
    for (int i = 0; i < p->series_count && same; i++) {
        same = g_strcmp0(p->series[i].label, first->series[i].label) == 0 &&
               p->series[i].colour == first->series[i].colour;
    }
    p->keyless = same;
}
