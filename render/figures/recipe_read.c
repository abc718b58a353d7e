// Recipes: from YAML to what a figure shows.
#include "render/figures/recipe_parts.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"

#define PANEL ((recipe_panel *)into)

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
            nearest_word near = nearest_begin(name);
            for (int i = 1; i < signal_count; i++) {
                nearest_try(&near, signal_table[i].name);
            }
            report_node(&c->reader, item, "there is no signal '%.60s', did you mean '%s'?", name,
                        near.best != NULL ? near.best : "force");
        } else if (p->signal_count == TRACE_SIGNALS) {
            report_node(&c->reader, item, "a panel shows at most %d signals", TRACE_SIGNALS);
        } else if (p->signal_count > 0 && strcmp(signal_table[signal_find(p->signals[0])].unit,
                                                 signal_table[index].unit) != 0) {
            report_node(&c->reader, item,
                        "'%s' has another unit than '%s', expected a panel of "
                        "its own",
                        name, p->signals[0]);
        } else {
            p->signals[p->signal_count++] = signal_table[index].name;
        }
    }
}

TAKE(take_sources, panel)
{
    recipe_panel *p = into;
    if (node->kind != TREE_LIST) {
        report_node(&c->reader, node, "from is %s, expected a list of names", node_kind_name(node));
        return;
    }
    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        int index = recipe_find_source(c, item);
        if (index >= 0 && p->source_count < RECIPE_SOURCES) {
            p->sources[p->source_count++] = index;
        }
    }
}

TAKE(take_difference, panel)
{
    recipe_panel *p = into;
    const tree_node *first = node->kind == TREE_LIST ? node->first : NULL;
    if (first == NULL || first->next == NULL || first->next->next != NULL) {
        report_node(&c->reader, node, "difference is %s, expected two names: [this, less that]",
                    node_kind_name(node));
        return;
    }
    p->of = recipe_find_source(c, first);
    p->less = recipe_find_source(c, first->next);
}

TAKE(take_heading, panel)
{
    PANEL->heading = recipe_text(c, node, "heading");
}

TAKE(take_panel_label, panel)
{
    PANEL->label = recipe_text(c, node, "label");
}

TAKE(take_weight, panel)
{
    recipe_number(c, node, "weight", &PANEL->weight);
    if (!(PANEL->weight > 0 && PANEL->weight <= 20)) {
        report_node(&c->reader, node, "weight is %g, expected a number above 0, up to 20",
                    PANEL->weight);
    }
}

TAKE(take_zero, panel)
{
    PANEL->zero = recipe_truth(c, node, "zero");
}

TAKE(take_panel_log, panel)
{
    PANEL->logarithmic = recipe_truth(c, node, "log");
}

TAKE(take_range, panel)
{
    recipe_pair(c, node, "range", &PANEL->low, &PANEL->high);
}

TAKE(take_note_text, note)
{
    ((recipe_note *)into)->text = recipe_text(c, node, "text");
}

TAKE(take_note_at, note)
{
    recipe_note *n = into;
    recipe_pair(c, node, "at", &n->x, &n->y);
}

TAKE(take_notes, panel)
{
    static const recipe_key keys[] = {
        {"text", take_note_text, "text: here"}, {"at", take_note_at, NULL}, {NULL, NULL, NULL}};
    recipe_panel *p = into;
    if (node->kind != TREE_LIST) {
        report_node(&c->reader, node, "notes is %s, expected a list", node_kind_name(node));
        return;
    }

    for (const tree_node *item = node->first; item != NULL; item = item->next) {
        if (p->note_count == RECIPE_NOTES) {
            report_node(&c->reader, item, "a panel has at most %d notes", RECIPE_NOTES);
            return;
        }

        recipe_note *note = &p->notes[p->note_count];
        *note = (recipe_note){0};
        recipe_map(c, item, "a note", keys, note);
        p->note_count += note->text != NULL;
    }
}

static void take_panel(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"signals", take_signals, "signals: [force]"},
                                      {"from", take_sources, NULL},
                                      {"difference", take_difference, NULL},
                                      {"heading", take_heading, NULL},
                                      {"label", take_panel_label, NULL},
                                      {"weight", take_weight, NULL},
                                      {"zero", take_zero, NULL},
                                      {"log", take_panel_log, NULL},
                                      {"range", take_range, NULL},
                                      {"notes", take_notes, NULL},
                                      {NULL, NULL, NULL}};
    recipe *r = c->recipe;
    if (r->panel_count == FIGURE_PANELS) {
        report_node(&c->reader, node, "a figure has more than %d panels", FIGURE_PANELS);
        return;
    }

    recipe_panel *p = &r->panels[r->panel_count++];
    *p = (recipe_panel){.of = -1, .less = -1, .at = {node->line, node->column}};
    recipe_map(c, node, "a panel", keys, p);

    // nothing named: all there is
    for (int i = 0; p->source_count == 0 && p->of < 0 && i < r->source_count; i++) {
        p->sources[i] = i;
    }
    p->source_count = p->source_count == 0 && p->of < 0 ? r->source_count : p->source_count;

    // runs and data need a signal, a difference only one
    bool tables = p->source_count > 0;
    for (int i = 0; i < p->source_count; i++) {
        tables = tables && r->sources[p->sources[i]].kind == SOURCE_TABLE;
    }
    if (p->signal_count == 0 && !tables) {
        report_node(&c->reader, node, "a panel of runs or data needs 'signals', such as [force]");
    }
    if (p->signal_count > 1 && p->of >= 0) {
        report_node(&c->reader, node, "a difference is that of one signal");
    }
}

// ---- the top

TAKE(take_title, recipe)
{
    ((recipe *)into)->title = recipe_text(c, node, "title");
}

TAKE(take_caption, recipe)
{
    ((recipe *)into)->caption = recipe_text(c, node, "caption");
}

TAKE(take_panels, recipe)
{
    (void)into;
    recipe_list(c, node, "panels", take_panel);
}

TAKE(take_x_label, recipe)
{
    ((recipe *)into)->x_label = recipe_text(c, node, "label");
}

TAKE(take_x_unit, recipe)
{
    ((recipe *)into)->x_unit = recipe_text(c, node, "unit");
}

TAKE(take_x_range, recipe)
{
    recipe *r = into;
    recipe_pair(c, node, "range", &r->from, &r->to);
}

TAKE(take_x_log, recipe)
{
    ((recipe *)into)->logarithmic = recipe_truth(c, node, "log");
}

TAKE(take_x, recipe)
{
    static const recipe_key keys[] = {{"range", take_x_range, "range: [0, 1]"},
                                      {"label", take_x_label, NULL},
                                      {"unit", take_x_unit, NULL},
                                      {"log", take_x_log, NULL},
                                      {NULL, NULL, NULL}};
    recipe_map(c, node, "x", keys, into);
}

TAKE(take_columns, recipe)
{
    double columns = 1;
    recipe_number(c, node, "columns", &columns);
    if (!(columns >= 1 && columns <= 8 && columns == (int)columns)) {
        report_node(&c->reader, node, "columns is %g, expected a whole number from 1 to 8",
                    columns);
        columns = 1;
    }
    ((recipe *)into)->columns = (int)columns;
}

TAKE(take_shared, recipe)
{
    ((recipe *)into)->shared = recipe_truth(c, node, "shared");
}

TAKE(take_contact, recipe)
{
    ((recipe *)into)->contact = recipe_truth(c, node, "contact");
}

TAKE(take_mark_at, mark)
{
    recipe_number(c, node, "at", &((recipe_mark *)into)->x);
}

TAKE(take_mark_label, mark)
{
    ((recipe_mark *)into)->label = recipe_text(c, node, "label");
}

static void take_mark(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {
        {"at", take_mark_at, "at: 0.36"}, {"label", take_mark_label, NULL}, {NULL, NULL, NULL}};
    recipe *r = c->recipe;
    if (r->mark_count == RECIPE_MARKS) {
        report_node(&c->reader, node, "a figure has more than %d marks", RECIPE_MARKS);
        return;
    }
    recipe_map(c, node, "a mark", keys, &r->marks[r->mark_count++]);
}

TAKE(take_marks, recipe)
{
    (void)into;
    recipe_list(c, node, "marks", take_mark);
}

// What was taken already.
TAKE(take_nothing, recipe)
{
    (void)c;
    (void)node;
    (void)into;
}

static void take_recipe(recipe_context *c, const tree_node *root)
{
    static const recipe_key keys[] = {{"panels", take_panels, "panels:"},
                                      {"title", take_title, NULL},
                                      {"caption", take_caption, NULL},
                                      {"x", take_x, NULL},
                                      {"columns", take_columns, NULL},
                                      {"shared", take_shared, NULL},
                                      {"contact", take_contact, NULL},
                                      {"marks", take_marks, NULL},
                                      {"multiples", NULL, NULL},
                                      {"runs", NULL, NULL},
                                      {"data", NULL, NULL},
                                      {"tables", NULL, NULL},
                                      {NULL, NULL, NULL}};
    recipe_key rest[G_N_ELEMENTS(keys)];

    if (!reader_expect_map(&c->reader, root, "a recipe", "panels:")) {
        return;
    }

    // what panels name comes first, wherever it stands
    recipe_take_sources(c, root);

    // the rest, in any order
    memcpy(rest, keys, sizeof keys);
    for (size_t i = 0; rest[i].key != NULL; i++) {
        rest[i].take = rest[i].take != NULL ? rest[i].take : take_nothing;
    }
    recipe_map(c, root, "a recipe", rest, c->recipe);

    if (c->recipe->panel_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no panels here");
    }
    if (c->recipe->source_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no runs, data or tables here");
    }

    // and last what repeats all of it
    const tree_node *multiples = recipe_child(root, "multiples");
    if (multiples != NULL && c->reader.faults == 0) {
        recipe_take_multiples(c, multiples);
    }
}

bool recipe_read(recipe *r, const char *path, const char *text, size_t length, fault_handler report,
                 void *report_context)
{
    assert(r != NULL && path != NULL && text != NULL && report != NULL);
    fault f = {0};
    recipe_context c = {.reader = {.path = path}, .recipe = r};
    *r = (recipe){.columns = 1, .contact = true};
    r->owned = g_ptr_array_new_with_free_func(g_free);

    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        c.reader.no_memory = f.code == STATUS_NO_MEMORY;
        reader_report_at(&c.reader, f.line, f.column, "%s", f.text);
    } else {
        take_recipe(&c, root);
        tree_free(root);
    }

    bool good = c.reader.faults == 0 && !c.reader.no_memory;
    reader_report_all(&c.reader, report, report_context);
    return good;
}

void recipe_finish(recipe *r)
{
    if (r->owned != NULL) {
        g_ptr_array_free(r->owned, TRUE);
    }
    memset(r, 0, sizeof *r);
}
