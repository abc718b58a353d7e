// Figures from recipes: what the recipe names is opened, and what it shows is described.
#include "render/figures/figures.h"

#include <math.h>
#include <stdlib.h>

#include "render/figures/recipe_parts.h"
#include "render/plot/axis.h"
#include "render/plot/run_style.h"
#include "render/plot/study_plot.h"
#include "render/scene/plan.h"
#include "src/base/input_file.h"
#include "src/run/spectrum.h"

#define CURVES_ROOM 0.05 // of a table's values, free above and below its curve
#define POINTS_ROOM 0.03 // of its other axis, free at both ends

// ---- opening what the recipe names

// A file as the recipe's folder sees it; a scenario's name stays.
static char *path_of(const char *recipe_path, const char *name)
{
    g_autofree char *folder = g_path_get_dirname(recipe_path);
    if (g_path_is_absolute(name)) {
        return g_strdup(name);
    }
    return g_build_filename(folder, name, NULL);
}

// Reads measured data as a run without a scenario.
static status open_measured(recipe *r, recipe_source *s, const char *path, fault *f)
{
    trace_panel shown[FIGURE_PANELS];
    int count = 0;

    // the signals that a column without a signal's name may lie over
    for (int i = 0; i < r->shown.panel_count; i++) {
        if (r->panels[i].signal_count > 0) {
            shown[count++] = (trace_panel){.signals = {r->panels[i].signals[0]}};
        }
    }
    g_autofree char *name = NULL;
    opened_run *data = owned_figure_own(r->plot, g_new0(opened_run, 1), run_close);
    s->run = data;
    return overlay_read_column(&data->result.trace, path, s->column, s->shift, shown,
                               count, &name, f);
}

// Runs the scenario of a file beside the recipe, or of a name.
static status open_recipe_run(recipe *r, recipe_source *s, const char *path, fault *f)
{
    const char *name = s->scenario;
    opened_run *run = NULL;
    if (recipe_is_text(s)) {
        run = run_open_text(name, s->name, s->change, s->change_count, f);
    } else if (g_file_test(path, G_FILE_TEST_IS_REGULAR)) {
        run = run_open_changed(path, s->change, s->change_count, NULL, f);
    } else {
        run = run_open_changed(name, s->change, s->change_count, NULL, f);
    }
    s->run = owned_figure_own(r->plot, run, run_close);
    return f->code;
}

// Reads the columns of a sweep's database that are shown.
static status open_sweep_table(recipe *r, recipe_source *s, const char *path, fault *f)
{
    if (s->columns[0] != NULL) {
        return STATUS_OK; // its rows stand in the recipe
    }
    const char *const keys[] = {s->x, s->y, s->z};
    const int columns = s->z != NULL ? 3 : 2;
    const status code = sweep_table_read(path, keys, columns, s->columns, &s->count, f);
    for (int i = 0; i < SWEEP_TABLE_COLUMNS; i++) {
        owned_figure_own(r->plot, s->columns[i], free);
    }
    return code;
}

// Opens what a source names, by its kind.
static status open_source(recipe *r, recipe_source *s, const char *recipe_path, fault *f)
{
    static status (*const open[])(recipe * r, recipe_source * s, const char *path,
                                  fault *f) = {[SOURCE_RUN] = open_recipe_run,
                                               [SOURCE_DATA] = open_measured,
                                               [SOURCE_TABLE] = open_sweep_table};
    fault why = {0};
    g_autofree char *path =
        path_of(recipe_path, text_or(text_or(s->scenario, s->file), ""));
    const status code = open[s->kind](r, s, path, &why);

    // the place in the recipe stands before what went wrong
    FAULT_IF(code != STATUS_OK, f, code, "%s:%d:%d: %s", recipe_path, s->at.line,
             s->at.column, why.text);
    return STATUS_OK;
}

// ---- labels

// The legend text of a source, markup.
static const char *source_label(recipe *r, const recipe_source *s)
{
    return owned_figure_keep(r->plot, text_escape(text_or(s->label, s->name)));
}

// The first source's scenario, whose bodies the symbols name.
static const scenario *first_scenario(const recipe *r)
{
    static const scenario none;
    if (r->sources[0].run != NULL) {
        return &r->sources[0].run->scenario;
    }
    return &none;
}

// The colour of curve number `index` of a panel; the first ones differ most.
static int colour_of(int index)
{
    static const int colours[] = {SLOT_BLUE,   SLOT_VERMILLION, SLOT_GREEN, SLOT_PURPLE,
                                  SLOT_ORANGE, SLOT_SKY_BLUE,   SLOT_GREY};
    return colours[index % (int)G_N_ELEMENTS(colours)];
}

// The axis of a table's column: label and unit of a parameter or summary quantity,
// otherwise the key itself.
static figure_axis column_axis(recipe *r, const char *key)
{
    const int parameter = parameter_find(key), quantity = summary_find(key);
    if (parameter >= 0) {
        const parameter_info *info = &parameter_table[parameter];
        figure_axis out = described_axis(r->plot, key, info->description, info->unit);
        axis_name_shortly(r->plot, &out, info->symbol);
        return out;
    }
    if (quantity >= 0) {
        const summary_info *info = &summary_table[quantity];
        return described_axis(r->plot, key, info->label, info->unit);
    }

    // what neither table describes goes by its own name, without a unit
    return described_axis(r->plot, key, NULL, "");
}

// ---- tables

// A table's column over another one.
static void add_curve(recipe *r, int panel, const recipe_source *s)
{
    // more curves than a panel has room for are left out
    const int index = r->plot->panels[panel].series_count;
    if (index == PANEL_SERIES) {
        return;
    }

    // points are marked while they are few enough to be told apart
    owned_figure_add(r->plot, panel,
                     (figure_series){s->name, source_label(r, s), s->columns[0],
                                     s->columns[1], s->count, .colour = colour_of(index),
                                     .marker = marker_of(s->count, (size_t)index)});
}

// A table's third column as colours over the other two.
static void add_map(recipe *r, int panel, const recipe_source *s)
{
    figure_panel *p = &r->plot->panels[panel];
    p->colours =
        OWNED(r->plot, figure_colours, .axis = column_axis(r, s->z), .bar = true);
    figure_map *map =
        figure_grid(r->plot, s->columns[0], s->columns[1], s->columns[2], s->count);

    // values that were drawn at random make no grid: dots with their shade
    if (map != NULL && map->columns > 1 && map->rows > 1) {
        p->map = map;
        return;
    }
    owned_figure_add(r->plot, panel,
                     (figure_series){s->name, NULL, s->columns[0], s->columns[1],
                                     s->count, .shade = s->columns[2], .no_line = true,
                                     .marker = MARKER_CIRCLE, .radius = 2.4});
}

// The curve of a table, or its map where the panel shows nothing else.
static void add_table(recipe *r, int panel, const recipe_source *s)
{
    const figure_panel *p = &r->plot->panels[panel];
    const bool empty = p->map == NULL && p->series_count == 0;
    if (s->z == NULL) {
        add_curve(r, panel, s);
    } else if (empty && s->count > 0) {
        add_map(r, panel, s);
    }
}

// ---- curves

// The amplitudes of a signal in the stretch that the recipe takes.
static figure_series spectrum_series(recipe *r, const trace_run *run, int index)
{
    const trace *rows = &run->result->trace;
    figure_series s = trace_series_over(run, index, SIGNAL_INDEX(time), 0, -1, r->plot);
    if (rows->row_count == 0) {
        return s;
    }
    const double from = fmax(r->from, rows->rows[0].time);
    const double to = fmin(r->to, rows->rows[rows->row_count - 1].time);
    trace_spectrum spectrum;
    if (!(from < to)) {
        return s;
    }
    trace_spectrum_take(rows, index, from, to, &spectrum);

    // a line of the spectrum is a point of the curve
    double *x = owned_figure_numbers(r->plot, SPECTRUM_LINES);
    double *y = owned_figure_numbers(r->plot, SPECTRUM_LINES);
    for (int k = 1; k < spectrum.lines; k++) {
        x[s.count] = k * spectrum.step;
        y[s.count++] = spectrum.amplitude[k];
    }
    s.x = x;
    s.y = y;
    return s;
}

// A signal over what the recipe has across its panels.
static figure_series recipe_series(recipe *r, const trace_run *run, int index)
{
    if (r->spectrum) {
        return spectrum_series(r, run, index);
    }
    if (r->over != SIGNAL_INDEX(time)) {
        return trace_series_over(run, index, r->over, r->from, r->to, r->plot);
    }
    return trace_series(run, index, r->plot);
}

// A signal of a run, or of measured data.
static void add_recorded(recipe *r, int panel, const recipe_source *s, int index,
                         int signals)
{
    figure_panel *p = &r->plot->panels[panel];
    const bool data = s->kind == SOURCE_DATA;

    // no room, or nothing measured
    if (p->series_count == PANEL_SERIES ||
        (data && !trace_has(&s->run->result.trace, index))) {
        return;
    }

    const trace_run run = {&s->run->scenario, &s->run->result, .points = data};
    const int colour_of_run = colour_of(p->series_count);
    figure_series *out = owned_figure_add(r->plot, panel, recipe_series(r, &run, index));

    // several signals of one run are told apart by symbols, several runs by labels
    const char *label = source_label(r, s);
    if (signals > 1) {
        const scenario *bodies = run.scenario;
        if (data) {
            bodies = first_scenario(r);
        }
        g_autofree char *symbol = trace_symbol(bodies, index);
        if (r->source_count > 1) {
            label = owned_figure_printf(r->plot, "%s %s", label, symbol);
        } else {
            label = owned_figure_keep(r->plot, g_steal_pointer(&symbol));
        }
    }

    // measured data are points without a line
    out->label = label;
    out->name = owned_figure_printf(r->plot, "%s %s", s->name, signal_table[index].name);
    out->style = LINE_SOLID;
    out->colour = colour_of_run;
    if (signals == 1 && !data) {
        out->run = s->rank;
        out->colour = run_style_of(s->rank).slot;
    }
    if (data) {
        out->colour = SLOT_BLACK;
        out->no_line = true;
        out->marker = MARKER_CIRCLE;
    }
}

// The signals of a panel, of a run or of data.
static void add_signals(recipe *r, int panel, const recipe_source *s,
                        const recipe_panel *from)
{
    for (int i = 0; i < from->signal_count; i++) {
        add_recorded(r, panel, s, signal_find_any(from->signals[i]), from->signal_count);
    }
    if (from->impulses && s->kind == SOURCE_RUN) {
        const trace_run run = {&s->run->scenario, &s->run->result, .name = s->name,
                               .rank = s->rank};
        trace_add_impulses(r->plot, &r->plot->panels[panel], &run);
    }
}

// The curve of a run shifted up and down by the tolerance of a panel's band.
static void add_recipe_band(recipe *r, int panel)
{
    const recipe_panel *from = &r->panels[panel];
    const opened_run *round = r->sources[from->round].run;
    const trace_run run = {&round->scenario, &round->result};
    const int signal = signal_find_any(from->signals[0]);
    const char *label = owned_figure_printf(r->plot, "± %g\u2009%s", from->tolerance,
                                            signal_table[signal].unit);
    for (int side = -1; side <= 1; side += 2) {
        if (r->plot->panels[panel].series_count == PANEL_SERIES) {
            return;
        }
        const figure_series s = recipe_series(r, &run, signal);
        double *y = owned_figure_numbers(r->plot, s.count);
        double *x = owned_figure_numbers(r->plot, s.count);
        for (size_t i = 0; i < s.count; i++) {
            x[i] = series_x(&s, i);
            y[i] = series_y(&s, i) + side * from->tolerance;
        }
        owned_figure_add(r->plot, panel,
                         (figure_series){"band", side < 0 ? label : NULL, x, y, s.count,
                                         .run = RUN_BEHIND, .secondary = true});
    }
}

// One signal of one source less that of another, at the instants of the first.
static void add_recipe_difference(recipe *r, int panel)
{
    const recipe_panel *from = &r->panels[panel];
    const recipe_source *of = &r->sources[from->of], *less = &r->sources[from->less];
    figure_series *s =
        owned_figure_add(r->plot, panel,
                         trace_difference(&of->run->result.trace,
                                          &less->run->result.trace,
                                          signal_find_any(from->signals[0]), r->plot));

    // points where data are compared, else a line
    s->name = "difference";
    s->colour = SLOT_GREY;
    if (of->kind == SOURCE_DATA) {
        s->colour = SLOT_BLACK;
        s->no_line = true;
        s->marker = MARKER_CIRCLE;
    }
}

// ---- panels

// An expression as it is written, as markup.
static const char *symbol_of_expression(recipe *r, int index)
{
    return owned_figure_keep(r->plot, text_escape(signal_table[index].name));
}

// The axis of a panel's signals: "Contact force f (N)" of a single one.
static figure_axis signals_axis(recipe *r, const recipe_panel *from)
{
    const int index = signal_find_any(from->signals[0]);
    const signal_info *signal = &signal_table[index];
    g_autofree char *symbol = trace_symbol(first_scenario(r), index);
    figure_axis y = {.name = signal->name, .unit = signal->unit};
    if (from->signal_count > 1) {
        y.label = signal->quantity;
    } else if (from->compared) {
        y.label = owned_figure_printf(r->plot, "Difference of %s", symbol);
        y.symbol = owned_figure_printf(r->plot, "Δ%s", symbol);
    } else if (r->spectrum) {
        y.label = owned_figure_printf(r->plot, "Amplitude of %s", symbol);
    } else if (signal_is_derived(index)) {
        y.label = symbol_of_expression(r, index);
    } else {
        y.label = owned_figure_printf(r->plot, "%s %s", signal->quantity, symbol);
        y.symbol = owned_figure_keep(r->plot, g_steal_pointer(&symbol));
    }
    return y;
}

// The vertical axis of a panel; the recipe's own label comes first.
static void describe_vertical(recipe *r, const recipe_panel *from, figure_axis *y)
{
    figure_axis usual = {0};
    if (from->signal_count > 0) {
        usual = signals_axis(r, from);
    } else if (from->source_count > 0) {
        // a map reaches to the edges
        const recipe_source *table = &r->sources[from->sources[0]];
        usual = column_axis(r, table->y);
        if (table->z == NULL) {
            usual.room = CURVES_ROOM;
        }
    }

    y->name = usual.name;
    y->unit = usual.unit;
    y->room = usual.room;
    y->symbol = usual.symbol;
    y->label = text_or(y->label, usual.label);
    if (from->logarithmic) {
        y->scale = SCALE_LOGARITHMIC;
    }
}

// The curves of a panel before those of its band.
static int curves_before_band(const figure_panel *p)
{
    int count = p->series_count;
    while (count > 0 && p->series[count - 1].run == RUN_BEHIND) {
        count--;
    }
    return count;
}

// Whether two panels have curves of the same labels and colours.
static bool have_one_legend(const figure_panel *a, const figure_panel *b)
{
    const int count = curves_before_band(a);
    bool same = count == a->series_count && count == curves_before_band(b);
    for (int i = 0; i < count && same; i++) {
        same = g_strcmp0(a->series[i].label, b->series[i].label) == 0 &&
               a->series[i].colour == b->series[i].colour;
    }
    return same;
}

// Describes a panel with its curves.
static void describe_recipe_panel(recipe *r, int panel)
{
    const recipe_panel *from = &r->panels[panel];
    figure_panel *p = &r->plot->panels[panel];
    *p = from->shown;
    p->notes = from->notes;
    p->levels = from->levels;
    p->series = r->plot->series[panel];
    describe_vertical(r, from, &p->y);

    // its curves
    if (from->compared) {
        add_recipe_difference(r, panel);
    }
    for (int i = 0; i < from->source_count; i++) {
        const recipe_source *s = &r->sources[from->sources[i]];
        if (s->kind == SOURCE_TABLE) {
            add_table(r, panel, s);
        } else {
            add_signals(r, panel, s, from);
        }
    }

    if (from->round >= 0 && from->signal_count > 0) {
        add_recipe_band(r, panel);
    }

    // a panel with the first one's curves needs no legend of its own
    p->keyless = panel > 0 && have_one_legend(p, &r->plot->panels[0]);
}

// ---- the page

// The axis of a signal across the panels.
static figure_axis signal_axis(recipe *r, int index)
{
    const signal_info *signal = &signal_table[index];
    figure_axis x = {.name = signal->name, .unit = signal->unit};
    if (signal_is_derived(index)) {
        x.label = symbol_of_expression(r, index);
    } else {
        g_autofree char *symbol = trace_symbol(first_scenario(r), index);
        x.label = owned_figure_printf(r->plot, "%s %s", signal->quantity, symbol);
    }
    return x;
}

// The axis below all panels: time, another signal, frequency, or the first column of the
// first table; and what the recipe says of it.
static void describe_horizontal(recipe *r, figure_axis *x)
{
    const recipe_source *first = &r->sources[0];
    figure_axis usual = {.name = "time", .label = "Time <i>t</i>", .unit = "s"};
    if (first->kind == SOURCE_TABLE) {
        usual = column_axis(r, first->x);
    } else if (r->spectrum) {
        usual = (figure_axis){.name = "frequency",
                              .label = "Frequency <i>ν</i>",
                              .unit = "Hz"};
    } else if (r->over != SIGNAL_INDEX(time)) {
        usual = signal_axis(r, r->over);
        x->room = POINTS_ROOM;
    }
    if (first->kind == SOURCE_TABLE && first->z == NULL) {
        x->room = POINTS_ROOM;
    }

    // the recipe's own label and unit come first
    x->name = usual.name;
    if (x->label == NULL) {
        x->symbol = usual.symbol;
    }
    x->label = text_or(x->label, usual.label);
    x->unit = text_or(x->unit, usual.unit);
    if (r->logarithmic) {
        x->scale = SCALE_LOGARITHMIC;
    }
}

// ---- the arm

// Paints a plan that fills the place.
static void paint_arm(cairo_t *cr, const void *of, double width, double height,
                      figure_theme theme)
{
    enum { SAMPLES = 2000 };
    const palette *page = palette_of(theme);
    plan shown = *(const plan *)of;
    plan_extent extent = {0};
    shown.colours = (plan_colours){.ground = page->page,
                                   .arm = palette_series(theme, SLOT_BLUE, 0),
                                   .hub = page->text,
                                   .wall = page->faint_text,
                                   .force = palette_series(theme, SLOT_VERMILLION, 1),
                                   .other = palette_series(theme, SLOT_GREY, 2),
                                   .frame = page->grid};
    plan_extent_add(&extent, shown.rows, &shown.parameters->arm, 0, SAMPLES);
    const plan_view view = plan_whole(&extent, shown.parameters, width, height);
    plan_paint(cr, &shown, &view);
}

// The arm of the first run at an instant, and behind it that of the second, if that has
// as many links.
static void add_arm(recipe *r)
{
    enum { HEIGHT = 100 }; // [pt]
    const opened_run *first = r->sources[0].run, *second = r->sources[1].run;
    if (!isfinite(r->arm) || r->sources[0].kind != SOURCE_RUN ||
        first->result.trace.row_count == 0) {
        return;
    }
    const trace *other = NULL;
    if (r->source_count > 1 && r->sources[1].kind == SOURCE_RUN &&
        second->result.trace.angle_count == first->result.trace.angle_count) {
        other = &second->result.trace;
    }
    const plan *shown =
        OWNED(r->plot, plan, .rows = &first->result.trace,
              .parameters = &first->scenario.parameters, .time = r->arm, .other = other,
              .exaggerate = 1, .peak = first->result.summary.peak_force_N);
    r->plot->figure.scene =
        OWNED(r->plot, figure_scene, .height = HEIGHT, .paint = paint_arm, .of = shown);
}

// Fills in the figure that the recipe asks for.
static void describe_recipe(recipe *r, const figure_options *o)
{
    // panels with one horizontal axis
    figure *shown = &r->plot->figure;
    *shown = r->shown;
    shown->panels = r->plot->panels;
    shown->columns = (int)r->columns;
    shown->marks = r->marks;
    for (int i = 0; i < shown->panel_count; i++) {
        describe_recipe_panel(r, i);
    }
    describe_horizontal(r, &shown->x);
    add_arm(r);

    // runs with every parameter, for the file
    GString *values = g_string_new(NULL);
    for (int i = 0; i < r->source_count; i++) {
        if (r->sources[i].kind == SOURCE_RUN) {
            g_autofree char *line = parameters_line(&r->sources[i].run->scenario);
            const char *separator = values->len > 0 ? "; " : "";
            text_append(values, "%s%s", separator, line);
        }
    }
    shown->parameters = owned_figure_keep(r->plot, g_string_free(values, FALSE));

    // the first run's contact
    const bool by_time = r->over == SIGNAL_INDEX(time) && !r->spectrum;
    if (r->contact && by_time && r->sources[0].kind == SOURCE_RUN) {
        trace_shade(r->plot, &r->sources[0].run->result.trace, false);
    }
    figure_take_look(shown, &o->look);
    figure_take_range(shown, o);
}

status recipe_open(const char *path, const figure_options *o, fault_handler report,
                   void *context, artwork *out, fault *f)
{
    size_t length;
    fault why = {0};
    char *text = input_file_read(path, TREE_MAX_BYTES + 1, &length, &why);
    if (text == NULL) {
        return input_file_fault(path, &why, f);
    }
    const status code = recipe_open_text(text, length, path, o, report, context, out, f);
    free(text);
    return code;
}

// Reads the recipe, opens its sources, describes its figure.
status recipe_open_text(const char *text, size_t length, const char *path,
                        const figure_options *o, fault_handler report, void *context,
                        artwork *out, fault *f)
{
    // what it says, and what it names
    recipe *r = g_new0(recipe, 1);
    status code = STATUS_OK;
    if (!recipe_read(r, path, text, length, report, context)) {
        code = STATUS_BAD_SCENARIO;
    }
    owned_figure_keep(r->plot, r);
    for (int i = 0; i < r->source_count && code == STATUS_OK; i++) {
        code = open_source(r, &r->sources[i], path, f);
    }
    if (code != STATUS_OK) {
        owned_figure_destroy(r->plot);
        return code;
    }

    // what it shows
    describe_recipe(r, o);
    *out = artwork_of_owned(r->plot);
    return STATUS_OK;
}

char *recipe_command(const char *path)
{
    g_autofree char *leaf = g_path_get_basename(path), *quoted = g_shell_quote(leaf);
    return g_strconcat("impactlab plot ", quoted, NULL);
}

// A map with panels.
bool recipe_is(const char *path)
{
    size_t length;
    fault unused = {0};
    char *text = input_file_read(path, TREE_MAX_BYTES, &length, &unused);
    if (text == NULL) {
        return false;
    }

    // its faults are reported when it is opened
    tree_node *root = tree_parse(text, length, &unused);
    bool is =
        root != NULL && root->kind == TREE_MAP && recipe_child(root, "panels") != NULL;
    tree_free(root);
    free(text);
    return is;
}
