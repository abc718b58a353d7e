// Small multiples of a recipe: its runs and panels once for each value of a parameter.
//
//     multiples: {vary: motor.voltage, values: [1 V, 2 V, 5 V]}
//
// Every run is made again with the parameter at each value, every panel is drawn again from the
// runs of that value; data and tables stay. Panels of one kind stand side by side.
#include "render/figures/recipe_parts.h"

#include <string.h>

#include "render/page/text.h"
#include "src/base/words.h"

enum { MULTIPLES_MOST = FIGURE_PANELS };

typedef struct multiples {
    const char *parameter; // its path
    const char *value[MULTIPLES_MOST];
    int count;
} multiples;

static const char *keep(recipe_context *c, char *text)
{
    g_ptr_array_add(c->recipe->owned, text);
    return text;
}

TAKE(take_vary, multiples)
{
    const char *path = recipe_text(c, node, "vary");
    if (path != NULL && parameter_find(path) < 0) {
        nearest_word near = nearest_begin(path);
        for (int i = 0; i < parameter_count; i++) {
            nearest_try(&near, parameter_table[i].path);
        }
        report_node(&c->reader, node, "there is no parameter '%.60s', did you mean '%s'?", path,
                    near.best != NULL ? near.best : "motor.voltage");
        return;
    }
    ((multiples *)into)->parameter = path;
}

TAKE(take_values, multiples)
{
    multiples *m = into;
    if (node->kind != TREE_LIST || node->first == NULL) {
        report_node(&c->reader, node, "values is %s, expected a list such as [1, 2, 5]",
                    node_kind_name(node));
        return;
    }

    // as texts, so that a heading can show them the way they were written
    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        if (m->count == MULTIPLES_MOST) {
            report_node(&c->reader, item, "there are more than %d values", MULTIPLES_MOST);
            return;
        }
        const char *value = recipe_text(c, item, "a value");
        if (value != NULL) {
            m->value[m->count++] = value;
        }
    }
}

// "1 V" of a value with its unit, or of a bare number with the parameter's.
static const char *heading_of(recipe_context *c, const multiples *m, int index)
{
    const parameter_info *info = &parameter_table[parameter_find(m->parameter)];
    const char *value = m->value[index], *rest = value + strspn(value, "+-.0123456789eE");
    char unit[64];
    text_unit(rest[0] == '\0' ? info->unit : "", unit, sizeof unit);
    char *escaped = text_escape(value);

    // the name of the parameter says what a number without any unit is
    const char *dot = strrchr(info->path, '.');
    bool bare = rest[0] == '\0' && unit[0] == '\0';
    char *heading = bare
                        ? g_strdup_printf("%s = %s", dot != NULL ? dot + 1 : info->path, escaped)
                        : g_strdup_printf("%s%s%s", escaped, unit[0] != '\0' ? "\u2009" : "", unit);
    g_free(escaped);
    return keep(c, heading);
}

// A run with the parameter at a value; false after a fault.
static bool add_run(recipe_context *c, const multiples *m, int index, recipe_source run)
{
    recipe *r = c->recipe;
    if (r->source_count == RECIPE_SOURCES || run.change_count == RECIPE_CHANGES) {
        return false;
    }
    run.label = run.label != NULL ? run.label : run.name;
    run.name = keep(c, g_strdup_printf("%s %s", run.name, m->value[index]));
    run.change[run.change_count++] =
        keep(c, g_strdup_printf("%s=%s", m->parameter, m->value[index]));
    r->sources[r->source_count++] = run;
    return true;
}

// The sources of the first value take the place of the runs themselves; those of later values
// follow. at[k][i] is the index of source i for value k.
static bool repeat_runs(recipe_context *c, const multiples *m, int at[][RECIPE_SOURCES])
{
    recipe *r = c->recipe;
    const recipe read = *r;
    r->source_count = 0;

    // other sources than runs are taken once, for all values
    for (int k = 0; k < m->count; k++) {
        for (int i = 0; i < read.source_count; i++) {
            bool again = read.sources[i].kind == SOURCE_RUN;
            at[k][i] = k > 0 && !again ? at[0][i] : r->source_count;
            if (again && !add_run(c, m, k, read.sources[i])) {
                return false;
            }
            if (!again && k == 0) {
                r->sources[r->source_count++] = read.sources[i];
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
    if (read.panel_count * m->count > FIGURE_PANELS) {
        return false;
    }

    r->panel_count = 0;
    for (int p = 0; p < read.panel_count; p++) {
        for (int k = 0; k < m->count; k++) {
            recipe_panel panel = read.panels[p];
            for (int i = 0; i < panel.source_count; i++) {
                panel.sources[i] = at[k][panel.sources[i]];
            }
            panel.of = panel.of >= 0 ? at[k][panel.of] : -1;
            panel.less = panel.less >= 0 ? at[k][panel.less] : -1;
            panel.heading = p == 0 ? heading_of(c, m, k) : panel.heading;
            r->panels[r->panel_count++] = panel;
        }
    }
    return true;
}

void recipe_take_multiples(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {OWN_KEY("vary", take_vary, "vary: motor.voltage"),
                                      OWN_KEY("values", take_values, NULL),
                                      {0}};
    recipe *r = c->recipe;
    multiples m = {0};
    int at[MULTIPLES_MOST][RECIPE_SOURCES];
    recipe_map(c, node, "multiples", keys, &m);
    if (c->reader.faults > 0) {
        return;
    }
    if (m.parameter == NULL || m.count == 0) {
        report_node(&c->reader, node, "multiples needs 'vary', a parameter, and 'values'");
        return;
    }

    // the first run's contact is not that of the others
    r->contact = false;
    r->columns = r->panel_count > 1 ? m.count
                 : r->columns > 1   ? r->columns
                 : m.count < 3      ? m.count
                                    : 3;
    if (!repeat_runs(c, &m, at)) {
        report_node(&c->reader, node, "%d values make more than %d runs, or more than %d changes",
                    m.count, RECIPE_SOURCES, RECIPE_CHANGES);
    } else if (!repeat_panels(c, &m, at)) {
        report_node(&c->reader, node, "%d values of %d panels make more than %d panels", m.count,
                    r->panel_count, FIGURE_PANELS);
    }
}
