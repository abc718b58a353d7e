// Recipes: from YAML to what a figure shows.
#include "render/figures/recipe_model.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"

typedef struct context {
    reader reader;
    recipe *recipe;
} context;

// What may stand under a key: how its value is taken.
typedef struct recipe_key {
    const char *key;
    void (*take)(context *c, const tree_node *node, void *into);
    const char *example; // of a value
} recipe_key;

// ---- values

static const char *take_text(context *c, const tree_node *node, const char *what)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(&c->reader, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }
    char *copy = g_strdup(node->text);
    g_ptr_array_add(c->recipe->owned, copy);
    return copy;
}

static bool take_truth(context *c, const tree_node *node, const char *what)
{
    bool yes = node_is_scalar(node) && strcmp(node->text, "true") == 0;
    if (!yes && !(node_is_scalar(node) && strcmp(node->text, "false") == 0)) {
        report_node(&c->reader, node, "%s is not true or false", what);
    }
    return yes;
}

static void take_number(context *c, const tree_node *node, const char *what, double *value)
{
    reader_quantity(&c->reader, node, what, "", value);
}

// Two numbers, [a, b].
static bool take_pair(context *c, const tree_node *node, const char *what, double *a, double *b)
{
    bool pair = node->kind == TREE_LIST && node->first != NULL && node->first->next != NULL &&
                node->first->next->next == NULL;
    if (!pair) {
        report_node(&c->reader, node, "%s is %s, expected two numbers such as [0, 1]", what,
                    node_kind_name(node));
        return false;
    }
    bool first = reader_quantity(&c->reader, node->first, what, "", a);
    return reader_quantity(&c->reader, node->first->next, what, "", b) && first;
}

// Every key of a map by the table; unknown ones are reported with the nearest.
static void take_map(context *c, const tree_node *map, const char *what, const recipe_key *keys,
                     void *into)
{
    if (!reader_expect_map(&c->reader, map, what, keys[0].example)) {
        return;
    }

    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(&c->reader, map, child);
        const recipe_key *found = NULL;
        nearest_word near = key != NULL ? nearest_begin(key) : (nearest_word){0};
        for (int i = 0; key != NULL && keys[i].key != NULL; i++) {
            nearest_try(&near, keys[i].key);
            found = strcmp(keys[i].key, key) == 0 ? &keys[i] : found;
        }

        if (found != NULL) {
            found->take(c, child, into);
        } else if (key != NULL) {
            report_node(&c->reader, child->key, "unknown key '%.60s' in %s, did you mean '%s'?",
                        key, what, near.best != NULL ? near.best : keys[0].key);
        }
    }
}

// Each item of a list.
static void take_list(context *c, const tree_node *list, const char *what,
                      void (*take)(context *c, const tree_node *node))
{
    if (list->kind != TREE_LIST) {
        report_node(&c->reader, list, "%s is %s, expected a list", what, node_kind_name(list));
        return;
    }
    for (const tree_node *item = list->first; item != NULL; item = item->next) {
        take(c, item);
    }
}

// ---- sources

#define TAKE(name, what) static void name(context *c, const tree_node *node, void *into)
#define SOURCE           ((recipe_source *)into)
#define PANEL            ((recipe_panel *)into)

TAKE(take_name, source)
{
    SOURCE->name = take_text(c, node, "name");
}

TAKE(take_label, source)
{
    SOURCE->label = take_text(c, node, "label");
}

TAKE(take_scenario, source)
{
    SOURCE->scenario = take_text(c, node, "scenario");
}

TAKE(take_file, source)
{
    SOURCE->file = take_text(c, node, "file");
}

TAKE(take_column, source)
{
    SOURCE->column = take_text(c, node, "column");
}

TAKE(take_x_column, source)
{
    SOURCE->x = take_text(c, node, "x");
}

TAKE(take_y_column, source)
{
    SOURCE->y = take_text(c, node, "y");
}

TAKE(take_shift, source)
{
    reader_quantity(&c->reader, node, "shift", "s", &SOURCE->shift);
}

TAKE(take_set, source)
{
    recipe_source *s = into;
    if (!reader_expect_map(&c->reader, node, "set", "arm.k2: 3")) {
        return;
    }

    for (const tree_node *child = node->first; child != NULL; child = child->next) {
        const char *path = reader_key(&c->reader, node, child);
        if (path == NULL) {
            continue;
        }

        // a known path with a value, as on the command line
        if (parameter_find(path) < 0) {
            nearest_word near = nearest_begin(path);
            for (int i = 0; i < parameter_count; i++) {
                nearest_try(&near, parameter_table[i].path);
            }
            report_node(&c->reader, child->key, "there is no parameter '%.60s', did you mean '%s'?",
                        path, near.best != NULL ? near.best : "arm.k2");
        } else if (s->change_count == RECIPE_CHANGES) {
            report_node(&c->reader, child->key, "a run has more than %d changes", RECIPE_CHANGES);
        } else if (!node_is_scalar(child)) {
            report_node(&c->reader, child, "%s is %s, expected a value", path,
                        node_kind_name(child));
        } else {
            char *change = g_strdup_printf("%s=%s", path, child->text);
            g_ptr_array_add(c->recipe->owned, change);
            s->change[s->change_count++] = change;
        }
    }
}

// Opens room for a source; NULL where there is none left.
static recipe_source *new_source(context *c, const tree_node *node, source_kind kind)
{
    recipe *r = c->recipe;
    if (r->source_count == RECIPE_SOURCES) {
        report_node(&c->reader, node, "a recipe has more than %d runs, data and tables",
                    RECIPE_SOURCES);
        return NULL;
    }
    recipe_source *s = &r->sources[r->source_count++];
    *s = (recipe_source){.kind = kind, .at = {node->line, node->column}};
    return s;
}

// What every source has, and what each kind needs.
static void check_source(context *c, const tree_node *node, recipe_source *s)
{
    const char *needed = s->kind == SOURCE_RUN ? s->scenario : s->file;

    if (needed == NULL) {
        report_node(&c->reader, node, "there is no '%s' here",
                    s->kind == SOURCE_RUN ? "scenario" : "file");
    }

    if (s->kind == SOURCE_TABLE && (s->x == NULL || s->y == NULL)) {
        report_node(&c->reader, node, "a table needs 'x' and 'y', the names of its columns");
    }

    // a name that only it has
    s->name = s->name != NULL ? s->name : needed != NULL ? needed : "";
    for (const recipe_source *other = c->recipe->sources; other != s; other++) {
        if (strcmp(other->name, s->name) == 0) {
            report_node(&c->reader, node, "the name '%s' is there twice (first at line %d)",
                        s->name, other->at.line);
        }
    }
}

static void take_run(context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"scenario", take_scenario, "scenario: thesis/fig-3-4"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"set", take_set, NULL},
                                      {NULL, NULL, NULL}};
    recipe_source *s = new_source(c, node, SOURCE_RUN);
    if (s != NULL) {
        take_map(c, node, "a run", keys, s);
        check_source(c, node, s);
    }
}

static void take_data(context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"file", take_file, "file: bench.csv"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"column", take_column, NULL},
                                      {"shift", take_shift, NULL},
                                      {NULL, NULL, NULL}};
    recipe_source *s = new_source(c, node, SOURCE_DATA);
    if (s != NULL) {
        take_map(c, node, "data", keys, s);
        check_source(c, node, s);
    }
}

static void take_table(context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"file", take_file, "file: sweep.sqlite"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"x", take_x_column, NULL},
                                      {"y", take_y_column, NULL},
                                      {NULL, NULL, NULL}};
    recipe_source *s = new_source(c, node, SOURCE_TABLE);
    if (s != NULL) {
        take_map(c, node, "a table", keys, s);
        check_source(c, node, s);
    }
}

// The index of a source that a panel names, or -1 after a fault.
static int find_source(context *c, const tree_node *node)
{
    nearest_word near = nearest_begin(node_is_scalar(node) ? node->text : "");
    for (int i = 0; node_is_scalar(node) && i < c->recipe->source_count; i++) {
        nearest_try(&near, c->recipe->sources[i].name);
        if (strcmp(c->recipe->sources[i].name, node->text) == 0) {
            return i;
        }
    }

    report_node(&c->reader, node, "no run, data or table is named '%.60s'%s%s%s",
                node_is_scalar(node) ? node->text : "", near.best ? ", did you mean '" : "",
                near.best ? near.best : "", near.best ? "'?" : "");
    return -1;
}

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
        int index = find_source(c, item);
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
    p->of = find_source(c, first);
    p->less = find_source(c, first->next);
}

TAKE(take_heading, panel)
{
    PANEL->heading = take_text(c, node, "heading");
}

TAKE(take_panel_label, panel)
{
    PANEL->label = take_text(c, node, "label");
}

TAKE(take_weight, panel)
{
    take_number(c, node, "weight", &PANEL->weight);
    if (!(PANEL->weight > 0 && PANEL->weight <= 20)) {
        report_node(&c->reader, node, "weight is %g, expected a number above 0, up to 20",
                    PANEL->weight);
    }
}

TAKE(take_zero, panel)
{
    PANEL->zero = take_truth(c, node, "zero");
}

TAKE(take_panel_log, panel)
{
    PANEL->logarithmic = take_truth(c, node, "log");
}

TAKE(take_range, panel)
{
    take_pair(c, node, "range", &PANEL->low, &PANEL->high);
}

TAKE(take_note_text, note)
{
    ((recipe_note *)into)->text = take_text(c, node, "text");
}

TAKE(take_note_at, note)
{
    recipe_note *n = into;
    take_pair(c, node, "at", &n->x, &n->y);
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
        take_map(c, item, "a note", keys, note);
        p->note_count += note->text != NULL;
    }
}

static void take_panel(context *c, const tree_node *node)
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
    take_map(c, node, "a panel", keys, p);

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
    ((recipe *)into)->title = take_text(c, node, "title");
}

TAKE(take_caption, recipe)
{
    ((recipe *)into)->caption = take_text(c, node, "caption");
}

TAKE(take_runs, recipe)
{
    (void)into;
    take_list(c, node, "runs", take_run);
}

TAKE(take_all_data, recipe)
{
    (void)into;
    take_list(c, node, "data", take_data);
}

TAKE(take_tables, recipe)
{
    (void)into;
    take_list(c, node, "tables", take_table);
}

TAKE(take_panels, recipe)
{
    (void)into;
    take_list(c, node, "panels", take_panel);
}

TAKE(take_x_label, recipe)
{
    ((recipe *)into)->x_label = take_text(c, node, "label");
}

TAKE(take_x_unit, recipe)
{
    ((recipe *)into)->x_unit = take_text(c, node, "unit");
}

TAKE(take_x_range, recipe)
{
    recipe *r = into;
    take_pair(c, node, "range", &r->from, &r->to);
}

TAKE(take_x_log, recipe)
{
    ((recipe *)into)->logarithmic = take_truth(c, node, "log");
}

TAKE(take_x, recipe)
{
    static const recipe_key keys[] = {{"range", take_x_range, "range: [0, 1]"},
                                      {"label", take_x_label, NULL},
                                      {"unit", take_x_unit, NULL},
                                      {"log", take_x_log, NULL},
                                      {NULL, NULL, NULL}};
    take_map(c, node, "x", keys, into);
}

TAKE(take_columns, recipe)
{
    double columns = 1;
    take_number(c, node, "columns", &columns);
    if (!(columns >= 1 && columns <= 8 && columns == (int)columns)) {
        report_node(&c->reader, node, "columns is %g, expected a whole number from 1 to 8",
                    columns);
        columns = 1;
    }
    ((recipe *)into)->columns = (int)columns;
}

TAKE(take_shared, recipe)
{
    ((recipe *)into)->shared = take_truth(c, node, "shared");
}

TAKE(take_contact, recipe)
{
    ((recipe *)into)->contact = take_truth(c, node, "contact");
}

TAKE(take_mark_at, mark)
{
    take_number(c, node, "at", &((recipe_mark *)into)->x);
}

TAKE(take_mark_label, mark)
{
    ((recipe_mark *)into)->label = take_text(c, node, "label");
}

static void take_mark(context *c, const tree_node *node)
{
    static const recipe_key keys[] = {
        {"at", take_mark_at, "at: 0.36"}, {"label", take_mark_label, NULL}, {NULL, NULL, NULL}};
    recipe *r = c->recipe;
    if (r->mark_count == RECIPE_MARKS) {
        report_node(&c->reader, node, "a figure has more than %d marks", RECIPE_MARKS);
        return;
    }
    take_map(c, node, "a mark", keys, &r->marks[r->mark_count++]);
}

TAKE(take_marks, recipe)
{
    (void)into;
    take_list(c, node, "marks", take_mark);
}

static const tree_node *child_of(const tree_node *map, const char *key)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        if (node_is_scalar(child->key) && strcmp(child->key->text, key) == 0) {
            return child;
        }
    }
    return NULL;
}

// What was taken already.
TAKE(take_nothing, recipe)
{
    (void)c;
    (void)node;
    (void)into;
}

static void take_recipe(context *c, const tree_node *root)
{
    static const recipe_key sources[] = {
        {"runs", take_runs, NULL}, {"data", take_all_data, NULL}, {"tables", take_tables, NULL}};
    static const recipe_key keys[] = {{"panels", take_panels, "panels:"},
                                      {"title", take_title, NULL},
                                      {"caption", take_caption, NULL},
                                      {"x", take_x, NULL},
                                      {"columns", take_columns, NULL},
                                      {"shared", take_shared, NULL},
                                      {"contact", take_contact, NULL},
                                      {"marks", take_marks, NULL},
                                      {"runs", NULL, NULL},
                                      {"data", NULL, NULL},
                                      {"tables", NULL, NULL},
                                      {NULL, NULL, NULL}};
    recipe_key rest[G_N_ELEMENTS(keys)];

    if (!reader_expect_map(&c->reader, root, "a recipe", "panels:")) {
        return;
    }

    // what panels name comes first, wherever it stands
    for (size_t i = 0; i < G_N_ELEMENTS(sources); i++) {
        const tree_node *node = child_of(root, sources[i].key);
        if (node != NULL) {
            sources[i].take(c, node, c->recipe);
        }
    }

    // the rest, in any order
    memcpy(rest, keys, sizeof keys);
    for (size_t i = 0; rest[i].key != NULL; i++) {
        rest[i].take = rest[i].take != NULL ? rest[i].take : take_nothing;
    }
    take_map(c, root, "a recipe", rest, c->recipe);

    if (c->recipe->panel_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no panels here");
    }
    if (c->recipe->source_count == 0 && c->reader.faults == 0) {
        report_node(&c->reader, root, "there are no runs, data or tables here");
    }
}

bool recipe_read(recipe *r, const char *path, const char *text, size_t length, fault_handler report,
                 void *report_context)
{
    assert(r != NULL && path != NULL && text != NULL && report != NULL);
    fault f = {0};
    context c = {.reader = {.path = path}, .recipe = r};
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
