// Small multiples: runs and panels of a recipe once for each value of a parameter.
//
//     multiples: {vary: motor.voltage, values: [1 V, 2 V, 5 V]}
//
// Every run is made again with the parameter at each value, every panel is drawn again
// from the runs of that value; data and tables stay. Panels of one kind stand side by
// side.
#include <string.h>

#include "render/figures/recipe_parts.h"

enum { MULTIPLES_MOST = FIGURE_PANELS };

typedef struct multiples {
    const char *parameter; // its path
    const char *value[MULTIPLES_MOST];
    int count;
} multiples;

// Reads the list of values of the parameter.
static void read_multiple_values(recipe_context *c, const tree_node *node, void *into)
{
    multiples *m = into;
    if (node->kind != TREE_LIST || node->first == NULL) {
        report_node(&c->reader, node, "values is %s, expected a list such as [1, 2, 5]",
                    node_kind_name(node));
        return;
    }

    // they are kept as texts, so that headings show them as they were written
    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        if (m->count == MULTIPLES_MOST) {
            report_node(&c->reader, item, "there are more than %d values",
                        MULTIPLES_MOST);
            return;
        }
        const char *value = recipe_text(c, item, "a value");
        if (value != NULL) {
            m->value[m->count++] = value;
        }
    }
}

// The heading of a value such as "1 V": as it is written if it has a unit, else with the
// parameter's unit, or if that has none, with the parameter's name.
static const char *heading_of(recipe_context *c, const multiples *m, int index)
{
    const parameter_info *info = &parameter_table[parameter_find(m->parameter)];
    const char *value = m->value[index], *rest = value + strspn(value, "+-.0123456789eE");
    g_autofree char *escaped = text_escape(value);
    if (rest[0] != '\0') {
        return recipe_keep(c, g_steal_pointer(&escaped));
    }
    if (info->unit[0] != '\0') {
        g_autofree char *unit = text_unit(info->unit);
        return recipe_keep(c, text_printf("%s\u2009%s", escaped, unit));
    }

    // the name of the parameter says what a number without any unit is
    const char *name = info->path, *dot = strrchr(name, '.');
    if (dot != NULL) {
        name = dot + 1;
    }
    return recipe_keep(c, text_printf("%s = %s", name, escaped));
}

// A run with the parameter at a value; false after a fault.
static bool repeat_run(recipe_context *c, const multiples *m, int index,
                       recipe_source run)
{
    recipe *r = c->recipe;
    if (r->source_count == RECIPE_SOURCES || run.change_count == RECIPE_CHANGES) {
        return false;
    }
    if (run.label == NULL) {
        run.label = run.name;
    }
    run.name = recipe_keep(c, text_printf("%s %s", run.name, m->value[index]));
    run.change[run.change_count++] =
        recipe_keep(c, text_printf("%s=%s", m->parameter, m->value[index]));
    r->sources[r->source_count++] = run;
    return true;
}

// The sources of the first value take the place of the runs themselves; those of later
// values follow. at[k][i] is the index of source i for value k.
static bool repeat_runs(recipe_context *c, const multiples *m, int at[][RECIPE_SOURCES])
{
    recipe *r = c->recipe;
    const recipe read = *r;
    r->source_count = 0;

    // other sources than runs are taken once, for all values
    for (int k = 0; k < m->count; k++) {
        for (int i = 0; i < read.source_count; i++) {
            const recipe_source *source = &read.sources[i];
            at[k][i] = r->source_count;
            if (source->kind == SOURCE_RUN) {
                if (!repeat_run(c, m, k, *source)) {
                    return false;
                }
            } else if (k == 0) {
                r->sources[r->source_count++] = *source;
            } else {
                at[k][i] = at[0][i];
            }
        }
    }
    return true;
}

// Each panel once for every value, panels of one kind side by side.
static bool repeat_panels(recipe_context *c, const multiples *m, int at[][RECIPE_SOURCES])
{
    recipe *r = c->recipe;
    const recipe read = *r;
    if (read.shown.panel_count * m->count > FIGURE_PANELS) {
        return false;
    }

    r->shown.panel_count = 0;
    for (int p = 0; p < read.shown.panel_count; p++) {
        for (int k = 0; k < m->count; k++) {
            recipe_panel panel = read.panels[p];
            for (int i = 0; i < panel.source_count; i++) {
                panel.sources[i] = at[k][panel.sources[i]];
            }
            panel.of = at[k][panel.of];
            panel.less = at[k][panel.less];
            if (p == 0) {
                panel.shown.heading = heading_of(c, m, k);
            }
            r->panels[r->shown.panel_count++] = panel;
        }
    }
    return true;
}

static const recipe_form multiples_form = {
    .what = "multiples",
    .example = "vary: motor.voltage",
    .keys = {FIELD_KEY("vary", VALUE_TEXT, multiples, parameter),
             {"values", .read = read_multiple_values}},
};

// Reads the map; false after a fault.
static bool read_map(recipe_context *c, const tree_node *node, multiples *m)
{
    if (c->reader.faults == 0) {
        recipe_map(c, node, &multiples_form, m);
    }
    if (m->parameter != NULL) {
        recipe_knows_parameter(c, recipe_child(node, "vary"), m->parameter);
    }
    if (c->reader.faults > 0) {
        return false;
    }
    if (m->parameter == NULL || m->count == 0) {
        report_node(&c->reader, node,
                    "multiples needs 'vary', a parameter, and 'values'");
        return false;
    }
    return true;
}

// Repeats runs, then panels.
void recipe_read_multiples(recipe_context *c, const tree_node *node, void *into)
{
    recipe *r = into;
    multiples m = {0};
    int at[MULTIPLES_MOST][RECIPE_SOURCES];
    if (!read_map(c, node, &m)) {
        return;
    }

    // the first run's contact is not that of the others
    r->contact = false;

    // panels of one kind side by side
    if (r->shown.panel_count > 1) {
        r->columns = m.count;
    } else if (!(r->columns > 1)) {
        r->columns = MIN(m.count, 3);
    }

    if (!repeat_runs(c, &m, at)) {
        report_node(&c->reader, node,
                    "%d values make more than %d runs, or more than %d changes", m.count,
                    RECIPE_SOURCES, RECIPE_CHANGES);
    } else if (!repeat_panels(c, &m, at)) {
        report_node(&c->reader, node, "%d values of %d panels make more than %d panels",
                    m.count, r->shown.panel_count, FIGURE_PANELS);
    }
}
