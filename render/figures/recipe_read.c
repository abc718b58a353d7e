// Recipes: from YAML to what a figure shows.
#include <float.h>
#include <math.h>
#include <string.h>

#include "render/figures/recipe_parts.h"

// ---- panels

// Whether a signal has another unit than those that a panel shows.
static bool has_other_unit(const recipe_panel *p, int index)
{
    if (p->signal_count == 0) {
        return false;
    }
    const int first = signal_find_any(p->signals[0]);
    return strcmp(signal_table[first].unit, signal_table[index].unit) != 0;
}

// The index of a signal by its name, or of an expression of some; -1 after a fault.
static int find_signal(recipe_context *c, const tree_node *node)
{
    fault f = {0};
    const char *text = node_is_scalar(node) ? node->text : "";
    int index = signal_find(text);
    if (index > 0) {
        return index;
    }
    if (text[strcspn(text, "+-*/(")] == '\0') {
        report_node(&c->reader, node, "there is no signal '%.60s', did you mean '%s'?",
                    text, nearest_signal(text));
        return -1;
    }
    index = signal_of_text(text, &f);
    if (index < 0) {
        report_node(&c->reader, node, "%s", f.text);
    }
    return index;
}

// The signals that a panel shows.
static void read_panel_signals(recipe_context *c, const tree_node *node, void *into)
{
    recipe_panel *p = into;
    if (node->kind != TREE_LIST) {
        report_node(&c->reader, node, "signals is %s, expected a list such as [force]",
                    node_kind_name(node));
        return;
    }

    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        // known, with room, and of the panel's unit
        const int index = find_signal(c, item);
        if (index < 0) {
            continue;
        }
        if (p->signal_count == TRACE_SIGNALS) {
            report_node(&c->reader, item, "a panel shows at most %d signals",
                        TRACE_SIGNALS);
        } else if (has_other_unit(p, index)) {
            report_node(&c->reader, item,
                        "'%s' has another unit than '%s', expected a panel of its own",
                        item->text, p->signals[0]);
        } else {
            p->signals[p->signal_count++] = signal_table[index].name;
        }
    }
}

// The runs, data and tables that a panel shows.
static void read_panel_sources(recipe_context *c, const tree_node *node, void *into)
{
    recipe_panel *p = into;
    const tree_node *item = recipe_first(c, node, "from");
    for (; item != NULL; item = item->next) {
        int index = recipe_find_source(c, item);
        if (index >= 0 && p->source_count < RECIPE_SOURCES) {
            p->sources[p->source_count++] = index;
        }
    }
}

// The index of a run or of data, or -1 after a fault.
static int find_curve(recipe_context *c, const tree_node *node)
{
    const int index = recipe_find_source(c, node);
    if (index >= 0 && c->recipe->sources[index].kind == SOURCE_TABLE) {
        report_node(&c->reader, node, "'%s' is a table, expected a run or data",
                    node->text);
    }
    return index;
}

// The two sources whose difference a panel shows.
static void read_panel_difference(recipe_context *c, const tree_node *node, void *into)
{
    recipe_panel *p = into;
    if (!recipe_is_pair(node)) {
        report_node(&c->reader, node,
                    "difference is %s, expected two names: [this, less that]",
                    node_kind_name(node));
        return;
    }
    p->compared = true;
    p->of = find_curve(c, node->first);
    p->less = find_curve(c, node->first->next);
}

// A note says something; whether its text is one has been looked at.
static void check_note(recipe_context *c, const tree_node *node, void *into)
{
    const figure_note *note = into;
    if (note->text == NULL && node->kind == TREE_MAP &&
        recipe_child(node, "text") == NULL) {
        report_node(&c->reader, node, "a note needs 'text'");
    }
}

// Fills in what a panel does not say, and looks whether its parts go together.
static void complete_panel(recipe_context *c, const tree_node *node, void *into)
{
    recipe_panel *p = into;
    const recipe *r = c->recipe;

    // an inset that is named finds a place, or there is no figure
    p->shown.zoom_asked = true;

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
    const int curves = p->signal_count * p->source_count;
    if (curves > PANEL_SERIES) {
        report_node(&c->reader, node, "a panel has %d curves, expected at most %d",
                    curves, PANEL_SERIES);
    }
    if (p->signal_count > 1 && p->compared) {
        report_node(&c->reader, node, "a difference is that of one signal");
    }
}

// ---- the forms

static const recipe_form notes = {
    .what = "a note",
    .example = "text: here",
    .keys = {FIELD_KEY("text", VALUE_TEXT, figure_note, text),
             PAIR_KEY("at", figure_note, x, y)},
    .holder = "a panel",
    .things = "notes",
    .size = sizeof(figure_note),
    .most = RECIPE_NOTES,
    .complete = check_note,
};

static const recipe_form levels = {
    .what = "a level",
    .example = "at: 2",
    .keys = {FIELD_KEY("at", VALUE_NUMBER, figure_level, y),
             FIELD_KEY("label", VALUE_TEXT, figure_level, label)},
    .holder = "a panel",
    .things = "levels",
    .size = sizeof(figure_level),
    .most = RECIPE_LEVELS,
};

// The run that a band lies round.
static void read_round(recipe_context *c, const tree_node *node, void *into)
{
    recipe_panel *p = into;
    p->round = recipe_find_source(c, node);
    if (p->round >= 0 && c->recipe->sources[p->round].kind != SOURCE_RUN) {
        report_node(&c->reader, node, "'%s' is no run", node->text);
    }
}

static const recipe_form band = {
    .what = "a band",
    .example = "tolerance: 0.1",
    .keys = {{"round", .read = read_round},
             FIELD_KEY("tolerance", VALUE_NUMBER, recipe_panel, tolerance)},
};

static const recipe_form panels = {
    .what = "a panel",
    .example = "signals: [force]",
    .keys = {{"signals", .read = read_panel_signals},
             {"from", .read = read_panel_sources},
             {"difference", .read = read_panel_difference},
             FIELD_KEY("heading", VALUE_TEXT, recipe_panel, shown.heading),
             FIELD_KEY("label", VALUE_TEXT, recipe_panel, shown.y.label),
             {"weight", VALUE_NUMBER, offsetof(recipe_panel, shown.weight),
              .low = DBL_MIN, .high = 20, .expected = "a number above 0, up to 20"},
             FIELD_KEY("zero", VALUE_TRUTH, recipe_panel, shown.y.with_zero),
             FIELD_KEY("log", VALUE_TRUTH, recipe_panel, logarithmic),
             FIELD_KEY("impulses", VALUE_TRUTH, recipe_panel, impulses),
             ITEMS_KEY("levels", &levels, recipe_panel, levels, shown.level_count),
             {"band", VALUE_MAP, .form = &band},
             PAIR_KEY("range", recipe_panel, shown.y.low, shown.y.high),
             PAIR_KEY("inset", recipe_panel, shown.zoom_from, shown.zoom_to),
             ITEMS_KEY("notes", &notes, recipe_panel, notes, shown.note_count)},
    .holder = "a figure",
    .things = "panels",
    .size = sizeof(recipe_panel),
    .most = FIGURE_PANELS,
    .complete = complete_panel,
    .blank = &(const recipe_panel){.round = -1},
};

// The signal across the panels.
static void read_over(recipe_context *c, const tree_node *node, void *into)
{
    recipe *r = into;
    const int index = find_signal(c, node);
    if (index > 0) {
        r->over = index;
    }
}

static const recipe_form horizontal = {
    .what = "x",
    .example = "range: [0, 1]",
    .keys = {PAIR_KEY("range", recipe, shown.x.low, shown.x.high),
             {"signal", .read = read_over},
             FIELD_KEY("spectrum", VALUE_TRUTH, recipe, spectrum),
             PAIR_KEY("time", recipe, from, to),
             FIELD_KEY("label", VALUE_TEXT, recipe, shown.x.label),
             FIELD_KEY("unit", VALUE_TEXT, recipe, shown.x.unit),
             FIELD_KEY("log", VALUE_TRUTH, recipe, logarithmic)},
};

static const recipe_form marks = {
    .what = "a mark",
    .example = "at: 0.36",
    .keys = {FIELD_KEY("at", VALUE_NUMBER, figure_mark, x),
             FIELD_KEY("label", VALUE_TEXT, figure_mark, label)},
    .holder = "a figure",
    .things = "marks",
    .size = sizeof(figure_mark),
    .most = RECIPE_MARKS,
};

// What panels name comes first, and last what repeats all of it.
static const recipe_form whole = {
    .what = "a recipe",
    .example = "panels:",
    .keys = {ITEMS_KEY("runs", &recipe_runs, recipe, sources, source_count),
             ITEMS_KEY("data", &recipe_data, recipe, sources, source_count),
             ITEMS_KEY("tables", &recipe_tables, recipe, sources, source_count),
             ITEMS_KEY("panels", &panels, recipe, panels, shown.panel_count),
             FIELD_KEY("title", VALUE_TEXT, recipe, shown.title),
             FIELD_KEY("caption", VALUE_TEXT, recipe, shown.caption),
             {"width", VALUE_NUMBER, offsetof(recipe, shown.width), .low = 20,
              .high = 2000, .unit = "mm", .expected = "a width from 20 to 2000 mm"},
             {"x", VALUE_MAP, .form = &horizontal},
             {"columns", VALUE_NUMBER, offsetof(recipe, columns), .low = 1, .high = 8,
              .whole = true, .expected = "a whole number from 1 to 8"},
             FIELD_KEY("shared", VALUE_TRUTH, recipe, shown.shared_y),
             FIELD_KEY("contact", VALUE_TRUTH, recipe, contact),
             {"arm", VALUE_NUMBER, offsetof(recipe, arm), .low = 0, .high = 1e9,
              .unit = "s", .expected = "an instant of the first run"},
             ITEMS_KEY("marks", &marks, recipe, marks, shown.mark_count),
             {"multiples", .read = recipe_read_multiples}},
};

// By the form of a whole recipe.
bool recipe_read(recipe *r, const char *path, const char *text, size_t length,
                 fault_handler report, void *report_context)
{
    fault f = {0};
    recipe_context c = {.reader = {.path = path}, .recipe = r};
    *r = (recipe){.columns = 1,
                  .contact = true,
                  .arm = (double)NAN,
                  .over = SIGNAL_INDEX(time),
                  .from = -HUGE_VAL,
                  .to = HUGE_VAL};
    r->plot = owned_figure_create(0, "%s", path);

    // its text as a tree, and the tree by its form
    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        reader_report_at(&c.reader, f.line, f.column, "%s", f.text);
    } else {
        recipe_map(&c, root, &whole, r);
    }

    // what a recipe cannot do without
    if (r->shown.panel_count == 0 && c.reader.faults == 0) {
        report_node(&c.reader, root, "there are no panels here");
    }
    if (r->source_count == 0 && c.reader.faults == 0) {
        report_node(&c.reader, root, "there are no runs, data or tables here");
    }
    const bool by_time = r->over == SIGNAL_INDEX(time) && !r->spectrum;
    if (!by_time && r->over != SIGNAL_INDEX(time) && r->spectrum) {
        report_node(&c.reader, root, "x is a signal or the frequency of a spectrum");
    }
    if (!(r->from < r->to)) {
        report_node(&c.reader, root, "time ends before it begins");
    }
    tree_free(root);

    bool good = c.reader.faults == 0 && !c.reader.no_memory;
    reader_report_all(&c.reader, report, report_context);
    return good;
}
