// Runs side by side: a run is a colour and a dash, a signal a panel. More runs than one
// panel can show get small multiples, a row for each.
#include "render/plot/trace_plot.h"

#include <assert.h>
#include <string.h>

#include "render/page/text.h"
#include "render/plot/run_style.h"

enum { DIFFERENCES_KEYED = 2, DIFFERENCES_NAMED = 4 };

#define MULTIPLE_WEIGHT 0.5 // height of a small multiple, as a share of a usual panel's

// Runs, panels of one signal each, and the figure that shows them.
typedef struct comparison_figure {
    trace_figure of; // its panels are these
    trace_panel signals[FIGURE_PANELS];
    int signal_count;
    int simulated; // runs that come first, before measured data
} comparison_figure;

// ---- one signal a panel

// Whether any run shows a signal of a panel.
static bool any_run_shows(const trace_run *runs, int count, const trace_panel *panel,
                          int index)
{
    for (int i = 0; i < count; i++) {
        if (!runs[i].points && trace_shows(&runs[i], panel, index)) {
            return true;
        }
    }
    return false;
}

// Gives each signal a panel, the first FIGURE_PANELS of them in `out`; returns how many
// there are.
static int divide_panels(const trace_panel *panels, int panel_count,
                         const trace_run *runs, int run_count,
                         trace_panel out[FIGURE_PANELS])
{
    int count = 0;
    for (int p = 0; p < panel_count; p++) {
        const trace_panel *panel = &panels[p];
        for (int i = 0; i < TRACE_SIGNALS && panel->signals[i] != NULL; i++) {
            if (!any_run_shows(runs, run_count, panel, signal_index(panel->signals[i]))) {
                continue;
            }
            if (count < FIGURE_PANELS) {
                out[count] = *panel;
                memset(out[count].signals, 0, sizeof out[count].signals);
                out[count].signals[0] = panel->signals[i];
                out[count].impulses = panel->impulses && i == 0;
                if (panel->signals[1] != NULL) {
                    out[count].label = NULL;
                }
            }
            count++;
        }
    }
    return count;
}

static int simulated_runs(const trace_run *runs, int run_count)
{
    int count = 0;
    while (count < run_count && !runs[count].points) {
        count++;
    }
    return count;
}

int trace_compare_panels(const trace_panel *panels, int panel_count,
                         const trace_run *runs, int run_count)
{
    trace_panel unused[FIGURE_PANELS];
    const int signals = divide_panels(panels, panel_count, runs, run_count, unused);
    const int simulated = simulated_runs(runs, run_count);
    if (simulated > RUNS_TOGETHER) {
        return signals * simulated;
    }
    return signals;
}

// ---- what differs

// Whether a parameter that some run was given has another value in another run.
static bool differs(const comparison_figure *c, int parameter)
{
    char first[PARAMETER_VALUE_SIZE], other[PARAMETER_VALUE_SIZE];
    bool given = false, alike = true;
    parameter_format(&c->of.runs[0].scenario->parameters, parameter, first, sizeof first);
    for (int i = 0; i < c->simulated; i++) {
        const parameters *p = &c->of.runs[i].scenario->parameters;
        parameter_format(p, parameter, other, sizeof other);
        given = given || p->set[parameter] != 0;
        alike = alike && strcmp(first, other) == 0;
    }
    return given && !alike;
}

// The parameters in which the runs differ, the first DIFFERENCES_NAMED of them in
// `found`; returns how many there are.
static int find_differences(const comparison_figure *c, int found[DIFFERENCES_NAMED])
{
    int count = 0;
    for (int i = 0; i < parameter_count; i++) {
        if (differs(c, i)) {
            if (count < DIFFERENCES_NAMED) {
                found[count] = i;
            }
            count++;
        }
    }
    return count;
}

// Whether a run's name says a parameter's value: by its path, as "arm.k2=10" does, or by
// its word.
static bool name_says(const char *name, const parameter_info *info, const char *value)
{
    return strstr(name, info->path) != NULL ||
           (info->choices != NULL && strstr(name, value) != NULL);
}

// "<i>k</i><sub>2</sub> = 10 N·m/rad".
static void add_value(GString *out, const parameter_info *info, const char *value)
{
    g_autofree char *escaped = text_escape(value), *unit = text_unit(info->unit);
    g_autofree char *symbol = text_symbol(text_or(info->symbol, ""));
    const char *name = info->symbol != NULL ? symbol : info->path;
    const char *space = unit[0] == '\0' ? "" : "\u2009";
    text_append(out, "%s = %s%s%s", name, escaped, space, unit);
}

// A run for the key: its name, and where the runs differ in few parameters its values
// that the name does not say.
static char *run_label(const comparison_figure *c, const trace_run *run)
{
    int differ[DIFFERENCES_NAMED];
    const int count = find_differences(c, differ);
    const char *name = text_or(run->name, ""), *before = ": ";
    g_autofree char *escaped = text_escape(name);
    GString *out = g_string_new(escaped);
    for (int i = 0; i < count && count <= DIFFERENCES_KEYED; i++) {
        char value[PARAMETER_VALUE_SIZE];
        const parameter_info *info = &parameter_table[differ[i]];
        parameter_format(&run->scenario->parameters, differ[i], value, sizeof value);
        if (!name_says(name, info, value)) {
            g_string_append(out, before);
            add_value(out, info, value);
            before = ", ";
        }
    }
    return g_string_free(out, FALSE);
}

// Whether all runs have as many links.
static bool have_one_length(const comparison_figure *c)
{
    const int links = c->of.runs[0].scenario->parameters.arm.links;
    bool one = true;
    for (int i = 1; i < c->simulated; i++) {
        one = one && c->of.runs[i].scenario->parameters.arm.links == links;
    }
    return one;
}

// What the indices of the signals stand for: "Indices: 1 hub, 3 last link."
static void add_bodies(GString *out, const comparison_figure *c)
{
    const char *before = " Indices: ";
    for (signal_body body = BODY_HUB; body <= BODY_LAST_LINK; body++) {
        bool shown = false;
        for (int i = 0; i < c->signal_count; i++) {
            const int index = signal_index(c->signals[i].signals[0]);
            shown = shown || signal_table[index].body == body;
        }
        if (shown) {
            int number = (int)body;
            if (body == BODY_LAST_LINK) {
                number = c->of.runs[0].scenario->parameters.arm.links + 1;
            }
            text_append(out, "%s%d %s", before, number, signal_body_name(body));
            if (body == BODY_LAST_LINK && !have_one_length(c)) {
                g_string_append(out, " of each run");
            }
            before = ", ";
        }
    }
    if (before[0] == ',') {
        g_string_append_c(out, '.');
    }
}

// What the runs share, and the parameters in which they differ.
static char *comparison_caption(const comparison_figure *c)
{
    g_autofree char *shared = trace_shared(c->of.runs, c->simulated);
    GString *out = g_string_new(NULL);
    text_append(out, "%s runs: %s.", c->simulated == 2 ? "Both" : "All", shared);

    // by their names
    int differ[DIFFERENCES_NAMED];
    const int count = find_differences(c, differ);
    const char *before = " They differ in ";
    for (int i = 0; i < count && i < DIFFERENCES_NAMED; i++) {
        const parameter_info *info = &parameter_table[differ[i]];
        text_append(out, "%s%s", before, info->path);
        if (info->symbol != NULL) {
            g_autofree char *symbol = text_symbol(info->symbol);
            text_append(out, " (%s)", symbol);
        }
        before = ", ";
        if (i + 2 == count) {
            before = " and ";
        }
    }
    if (count > DIFFERENCES_NAMED) {
        text_append(out, " and %d more", count - DIFFERENCES_NAMED);
    }
    if (count > 0) {
        g_string_append_c(out, '.');
    }

    // the grey line of small multiples
    if (c->simulated > RUNS_TOGETHER) {
        g_autofree char *name = text_escape(text_or(c->of.runs[0].name, ""));
        text_append(out, " Grey: %s.", name);
    }
    add_bodies(out, c);
    trace_add_ending(out, c->of.runs, c->simulated);
    return g_string_free(out, FALSE);
}

// ---- curves

// A curve of a run in a panel; a rank of 0 is for measured data.
static figure_series *add_curve(const comparison_figure *c, int panel,
                                const trace_run *run, int rank, int index)
{
    owned_figure *o = c->of.drawn;
    figure_series *s = owned_figure_add(o, panel, trace_series(run, index, o));
    s->name = owned_figure_keep(o, g_strdup(text_or(run->name, s->name)));
    s->run = rank;
    if (rank > 0) {
        s->colour = run_style_of(rank).slot;
        s->style = run_style_of(rank).dash;
    }
    if (run->points) {
        s->no_line = true;
        s->marker = MARKER_CIRCLE;
        s->colour = SLOT_BLACK;
    }
    return s;
}

// Measured data where they have the signal of a panel.
static void add_points(const comparison_figure *c, int panel, const trace_panel *from)
{
    const int index = signal_index(from->signals[0]);
    for (int i = c->simulated; i < c->of.run_count; i++) {
        if (trace_shows(&c->of.runs[i], from, index)) {
            add_curve(c, panel, &c->of.runs[i], 0, index);
        }
    }
}

void trace_add_impulses(owned_figure *o, figure_panel *panel, const trace_run *run)
{
    int count = 0;
    const figure_impulse *own = trace_impulses(&run->result->trace, &count, o);
    const int before = panel->impulse_count;
    figure_impulse *all = g_new(figure_impulse, (gsize)(before + count) + 1);
    if (before > 0) {
        memcpy(all, panel->impulses, (size_t)before * sizeof *all);
    }

    for (int i = 0; i < count; i++) {
        all[before + i] = own[i];
        all[before + i].run = run->rank;
        all[before + i].of = run->name;
    }
    panel->impulses = owned_figure_keep(o, all);
    panel->impulse_count = before + count;
    panel->impulse_label = "Impulse";
    panel->impulse_unit = signal_table[SIGNAL_INDEX(impulse)].unit;
}

// The wall's angle where it is that of all runs.
static void add_wall(const comparison_figure *c, figure_panel *panel)
{
    const wall_parameters *first = &c->of.runs[0].scenario->parameters.wall;
    for (int i = 0; i < c->simulated; i++) {
        const wall_parameters *wall = &c->of.runs[i].scenario->parameters.wall;
        if (wall->kind == WALL_NONE || wall->angle != first->angle) {
            return;
        }
    }
    panel->levels = OWNED(c->of.drawn, figure_level, first->angle, "wall");
    panel->level_count = 1;
}

// A panel of one signal with some of the runs, those from `first` to before `end`, and
// behind them the run `behind` (-1: none).
static void describe_panel(const comparison_figure *c, int panel, int signal, int first,
                           int end, int behind)
{
    owned_figure *o = c->of.drawn;
    figure_panel *p = &o->panels[panel];
    const trace_panel *from = &c->signals[signal];
    const int index = signal_index(from->signals[0]);
    p->y = trace_signal_axis(&c->of, from);
    p->weight = from->weight;

    // curves
    if (behind >= 0) {
        add_curve(c, panel, &c->of.runs[behind], RUN_BEHIND, index);
    }
    for (int i = first; i < end; i++) {
        const trace_run *run = &c->of.runs[i];
        add_curve(c, panel, run, run->rank, index);
        if (from->impulses) {
            trace_add_impulses(o, p, run);
        }
    }
    add_points(c, panel, from);
    if (from->wall) {
        add_wall(c, p);
    }
}

// ---- the key

static void add_key(figure_panel *key, figure_series *entries, figure_series entry)
{
    entry.name = entry.label;
    entries[key->series_count++] = entry;
}

// One legend above all panels: a line for each run, a point for data.
static void add_common_key(const comparison_figure *c)
{
    owned_figure *o = c->of.drawn;
    figure_panel *key = owned_figure_keep(o, g_new0(figure_panel, 1));
    figure_series *entries = owned_figure_keep(o, g_new0(figure_series, TRACE_RUNS));
    for (int i = 0; i < c->of.run_count; i++) {
        const trace_run *run = &c->of.runs[i];
        const char *name = owned_figure_keep(o, text_escape(text_or(run->name, "")));
        if (run->points) {
            add_key(key, entries,
                    (figure_series){.label = name,
                                    .no_line = true,
                                    .marker = MARKER_CIRCLE,
                                    .colour = SLOT_BLACK});
        } else {
            add_key(key, entries,
                    (figure_series){.label = owned_figure_keep(o, run_label(c, run)),
                                    .run = run->rank,
                                    .colour = run_style_of(run->rank).slot});
        }
    }

    key->series = entries;
    o->figure.key = key;
    o->figure.common_legend = true;
}

// Names the run's curve in a panel, which has its key above it.
static void add_own_key(const comparison_figure *c, int panel, const trace_run *run)
{
    owned_figure *o = c->of.drawn;
    figure_panel *p = &o->panels[panel];
    for (int i = 0; i < p->series_count; i++) {
        if (o->series[panel][i].run == run->rank) {
            o->series[panel][i].label = owned_figure_keep(o, run_label(c, run));
        }
    }
    p->key_above = true;
}

// ---- the whole

// All runs in the panel of each signal, two columns of panels where there are many.
static void show_together(const comparison_figure *c)
{
    enum { MANY_PANELS = 4 };
    figure *fig = &c->of.drawn->figure;
    for (int i = 0; i < c->signal_count; i++) {
        describe_panel(c, i, i, 0, c->simulated, -1);
    }
    if (c->signal_count >= MANY_PANELS) {
        fig->columns = 2;
    }
    fig->panel_count = c->signal_count;

    // their key, and data
    add_common_key(c);
    trace_add_residuals(&c->of);
}

// The panel of a run's row that has the run's key: the first without a strip of impulses,
// whose height the key can use.
static int key_panel(const comparison_figure *c, int run)
{
    const int first = run * c->signal_count;
    for (int k = 0; k < c->signal_count; k++) {
        if (c->of.drawn->panels[first + k].impulse_count == 0) {
            return first + k;
        }
    }
    return first;
}

// A row for each run and a column for each signal, the first run behind all others.
static void show_multiples(const comparison_figure *c)
{
    owned_figure *o = c->of.drawn;
    for (int i = 0; i < c->simulated; i++) {
        for (int k = 0; k < c->signal_count; k++) {
            const int panel = i * c->signal_count + k;
            describe_panel(c, panel, k, i, i + 1, i > 0 ? 0 : -1);
            o->panels[panel].weight = MULTIPLE_WEIGHT;
        }
        add_own_key(c, key_panel(c, i), &c->of.runs[i]);
    }

    o->figure.panel_count = c->signal_count * c->simulated;
    o->figure.columns = c->signal_count;
    o->figure.common_scales = true;
}

owned_figure *trace_compare_create(const char *title, const trace_panel *panels,
                                   int panel_count, const trace_run *runs, int run_count)
{
    comparison_figure c = {.of = {.runs = runs, .run_count = run_count},
                           .simulated = simulated_runs(runs, run_count)};
    assert(c.simulated > 0);
    assert(trace_compare_panels(panels, panel_count, runs, run_count) <= FIGURE_PANELS);
    c.of.panels = c.signals;
    c.signal_count = divide_panels(panels, panel_count, runs, run_count, c.signals);

    // the page
    owned_figure *o = c.of.drawn = owned_figure_create(1, "%s", text_or(title, "Runs"));
    o->figure.caption = owned_figure_keep(o, comparison_caption(&c));
    o->figure.x = (figure_axis){"time", "Time <i>t</i>", .unit = "s"};
    o->figure.parameters = owned_figure_keep(o, parameters_line(runs[0].scenario));

    if (c.simulated > RUNS_TOGETHER) {
        show_multiples(&c);
    } else {
        show_together(&c);
    }
    return o;
}
