// Recipes: from YAML to what a figure shows.
#include <float.h>
#include <string.h>

#include "render/figures/recipe_parts.h"

// ==== small multiples: runs and panels once for each value of a parameter
//
//     multiples: {vary: motor.voltage, values: [1 V, 2 V, 5 V]}
//
// Every run is made again with the parameter at each value, every panel is drawn again
// from the runs of that value; data and tables stay. Panels of one kind stand side by
// side.

enum { MULTIPLES_MOST = FIGURE_PANELS };

typedef struct multiples {
    const char *parameter; // its path
    const char *value[MULTIPLES_MOST];
    int count;
} multiples;

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

// "1 V" of a value with its unit, or of a bare number with the parameter's.
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
static bool add_run(recipe_context *c, const multiples *m, int index, recipe_source run)
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
            bool again = read.sources[i].kind == SOURCE_RUN;
            if (k > 0 && !again) {
                at[k][i] = at[0][i];
            } else {
                at[k][i] = r->source_count;
            }
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

// Reads `multiples` and repeats runs and panels for each of its values, after both are
// read.
TAKE(take_multiples, recipe)
{
    static const recipe_form form = {"multiples",
                                     "vary: motor.voltage",
                                     {FIELD_KEY("vary", VALUE_TEXT, multiples, parameter),
                                      OWN_KEY("values", take_values)}};
    recipe *r = into;
    multiples m = {0};
    int at[MULTIPLES_MOST][RECIPE_SOURCES];
    if (c->reader.faults == 0) {
        recipe_map(c, node, &form, &m);
    }
    if (m.parameter != NULL) {
        recipe_knows_parameter(c, recipe_child(node, "vary"), m.parameter);
    }
    if (c->reader.faults > 0) {
        return;
    }
    if (m.parameter == NULL || m.count == 0) {
        report_node(&c->reader, node,
                    "multiples needs 'vary', a parameter, and 'values'");
        return;
    }

    // the first run's contact is not that of the others
    r->contact = false;
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

// ==== the recipe

// ---- panels

TAKE(take_signals, panel)
{
    recipe_panel *p = into;
    if (node->kind != TREE_LIST) {
        report_node(&c->reader, node, "signals is %s, expected a list such as [force]",
                    node_kind_name(node));
        return;
    }

    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        const char *name = node_is_scalar(item) ? item->text : "";
        int index = signal_find(name);

        // known, with room, and of the panel's unit
        if (index <= 0) {
            report_node(&c->reader, item,
                        "there is no signal '%.60s', did you mean '%s'?", name,
                        nearest_signal(name));
        } else if (p->signal_count == TRACE_SIGNALS) {
            report_node(&c->reader, item, "a panel shows at most %d signals",
                        TRACE_SIGNALS);
        } else if (p->signal_count > 0 &&
                   strcmp(signal_table[signal_find(p->signals[0])].unit,
                          signal_table[index].unit) != 0) {
            report_node(&c->reader, item,
                        "'%s' has another unit than '%s', expected a panel of its own",
                        name, p->signals[0]);
        } else {
            p->signals[p->signal_count++] = signal_table[index].name;
        }
    }
}

TAKE(take_from, panel)
{
    recipe_panel *p = into;
    for (const tree_node *i = recipe_first(c, node, "from"); i != NULL; i = i->next) {
        int index = recipe_find_source(c, i);
        if (index >= 0 && p->source_count < RECIPE_SOURCES) {
            p->sources[p->source_count++] = index;
        }
    }
}

TAKE(take_difference, panel)
{
    recipe_panel *p = into;
    const tree_node *first = node->first;
    if (node->kind != TREE_LIST || first == NULL || first->next == NULL ||
        first->next->next != NULL) {
        report_node(&c->reader, node,
                    "difference is %s, expected two names: [this, less that]",
                    node_kind_name(node));
        return;
    }
    p->compared = true;
    p->of = recipe_find_source(c, first);
    p->less = recipe_find_source(c, first->next);
    for (const tree_node *item = first; item != NULL; item = item->next) {
        int index = p->less;
        if (item == first) {
            index = p->of;
        }
        if (index >= 0 && c->recipe->sources[index].kind == SOURCE_TABLE) {
            report_node(&c->reader, item, "'%s' is a table, expected a run or data",
                        item->text);
        }
    }
}

TAKE(end_note, note)
{
    if (((figure_note *)into)->text == NULL && node->kind == TREE_MAP &&
        recipe_child(node, "text") == NULL) {
        report_node(&c->reader, node, "a note needs 'text'");
    }
}

// Fills in what a panel does not say, and looks whether its parts go together.
TAKE(end_panel, panel)
{
    recipe_panel *p = into;
    const recipe *r = c->recipe;

    // nothing named: all there is
    const bool all = p->source_count == 0 && !p->compared;
    for (int i = 0; all && i < r->source_count; i++) {
        p->sources[p->source_count++] = i;
    }

    // runs and data need a signal, a difference only one
    bool tables = p->source_count > 0 && !p->compared;
    for (int i = 0; i < p->source_count; i++) {
        tables = tables && r->sources[p->sources[i]].kind == SOURCE_TABLE;
    }
    if (p->signal_count == 0 && !tables) {
        report_node(&c->reader, node,
                    "a panel of runs or data needs 'signals', such as [force]");
    }
    if (p->signal_count > 1 && p->compared) {
        report_node(&c->reader, node, "a difference is that of one signal");
    }
}

// ---- the forms

static const recipe_form notes = {"a note",
                                  "text: here",
                                  {FIELD_KEY("text", VALUE_TEXT, figure_note, text),
                                   PAIR_KEY("at", figure_note, x, y)},
                                  "a panel",
                                  "notes",
                                  sizeof(figure_note),
                                  RECIPE_NOTES,
                                  end_note};

static const recipe_form panels = {
    "a panel",
    "signals: [force]",
    {OWN_KEY("signals", take_signals),
     OWN_KEY("from", take_from),
     OWN_KEY("difference", take_difference),
     FIELD_KEY("heading", VALUE_TEXT, recipe_panel, shown.heading),
     FIELD_KEY("label", VALUE_TEXT, recipe_panel, shown.y.label),
     {"weight", VALUE_NUMBER, offsetof(recipe_panel, shown.weight), .low = DBL_MIN,
      .high = 20, .expected = "a number above 0, up to 20"},
     FIELD_KEY("zero", VALUE_TRUTH, recipe_panel, shown.y.with_zero),
     FIELD_KEY("log", VALUE_TRUTH, recipe_panel, logarithmic),
     PAIR_KEY("range", recipe_panel, shown.y.low, shown.y.high),
     ITEMS_KEY("notes", &notes, recipe_panel, notes, shown.note_count)},
    "a figure",
    "panels",
    sizeof(recipe_panel),
    FIGURE_PANELS,
    end_panel};

static const recipe_form horizontal = {
    "x",
    "range: [0, 1]",
    {PAIR_KEY("range", recipe, shown.x.low, shown.x.high),
     FIELD_KEY("label", VALUE_TEXT, recipe, shown.x.label),
     FIELD_KEY("unit", VALUE_TEXT, recipe, shown.x.unit),
     FIELD_KEY("log", VALUE_TRUTH, recipe, logarithmic)}};

static const recipe_form marks = {"a mark",
                                  "at: 0.36",
                                  {FIELD_KEY("at", VALUE_NUMBER, figure_mark, x),
                                   FIELD_KEY("label", VALUE_TEXT, figure_mark, label)},
                                  "a figure",
                                  "marks",
                                  sizeof(figure_mark),
                                  RECIPE_MARKS};

// What panels name comes first, and last what repeats all of it.
static const recipe_form whole = {
    "a recipe",
    "panels:",
    {ITEMS_KEY("runs", &recipe_runs, recipe, sources, source_count),
     ITEMS_KEY("data", &recipe_data, recipe, sources, source_count),
     ITEMS_KEY("tables", &recipe_tables, recipe, sources, source_count),
     ITEMS_KEY("panels", &panels, recipe, panels, shown.panel_count),
     FIELD_KEY("title", VALUE_TEXT, recipe, shown.title),
     FIELD_KEY("caption", VALUE_TEXT, recipe, shown.caption),
     {"x", VALUE_MAP, .form = &horizontal},
     {"columns", VALUE_NUMBER, offsetof(recipe, columns), .low = 1, .high = 8,
      .whole = true, .expected = "a whole number from 1 to 8"},
     FIELD_KEY("shared", VALUE_TRUTH, recipe, shown.shared_y),
     FIELD_KEY("contact", VALUE_TRUTH, recipe, contact),
     ITEMS_KEY("marks", &marks, recipe, marks, shown.mark_count),
     OWN_KEY("multiples", take_multiples)}};

static void take_recipe(recipe_context *c, const tree_node *root)
{
    recipe_map(c, root, &whole, c->recipe);
    if (c->recipe->shown.panel_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no panels here");
    }
    if (c->recipe->source_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no runs, data or tables here");
    }
}

bool recipe_read(recipe *r, const char *path, const char *text, size_t length,
                 fault_handler report, void *report_context)
{
    fault f = {0};
    recipe_context c = {.reader = {.path = path}, .recipe = r};
    *r = (recipe){.columns = 1, .contact = true};
    r->plot = owned_figure_create(0, "%s", path);

    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        reader_report_at(&c.reader, f.line, f.column, "%s", f.text);
    } else {
        take_recipe(&c, root);
        tree_free(root);
    }

    bool good = c.reader.faults == 0 && !c.reader.no_memory;
    reader_report_all(&c.reader, report, report_context);
    return good;
}
