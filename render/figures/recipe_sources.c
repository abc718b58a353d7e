// Where a recipe's curves come from: runs, measured data, tables.
#include "render/figures/recipe_parts.h"

#include <string.h>

#include "src/base/words.h"

#define SOURCE ((recipe_source *)into)

// takes a text of a source: KEY's value goes to FIELD
#define TAKE_TEXT(function, field, key)                                                            \
    TAKE(function, source)                                                                         \
    {                                                                                              \
        SOURCE->field = recipe_text(c, node, key);                                                 \
    }

TAKE_TEXT(take_name, name, "name")
TAKE_TEXT(take_label, label, "label")
TAKE_TEXT(take_scenario, scenario, "scenario")
TAKE_TEXT(take_file, file, "file")
TAKE_TEXT(take_column, column, "column")
TAKE_TEXT(take_x_column, x, "x")
TAKE_TEXT(take_y_column, y, "y")
TAKE_TEXT(take_z_column, z, "z")

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
static recipe_source *new_source(recipe_context *c, const tree_node *node, source_kind kind)
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
static void check_source(recipe_context *c, const tree_node *node, recipe_source *s)
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

static void take_run(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"scenario", take_scenario, "scenario: thesis/fig-3-4"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"set", take_set, NULL},
                                      {NULL, NULL, NULL}};
    recipe_source *s = new_source(c, node, SOURCE_RUN);
    if (s != NULL) {
        recipe_map(c, node, "a run", keys, s);
        check_source(c, node, s);
    }
}

static void take_data(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"file", take_file, "file: bench.csv"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"column", take_column, NULL},
                                      {"shift", take_shift, NULL},
                                      {NULL, NULL, NULL}};
    recipe_source *s = new_source(c, node, SOURCE_DATA);
    if (s != NULL) {
        recipe_map(c, node, "data", keys, s);
        check_source(c, node, s);
    }
}

static void take_table(recipe_context *c, const tree_node *node)
{
    static const recipe_key keys[] = {{"file", take_file, "file: sweep.sqlite"},
                                      {"name", take_name, NULL},
                                      {"label", take_label, NULL},
                                      {"x", take_x_column, NULL},
                                      {"y", take_y_column, NULL},
                                      {"z", take_z_column, NULL},
                                      {NULL, NULL, NULL}};

    // checked as a whole: what is missing shows only at its end
    recipe_source *s = new_source(c, node, SOURCE_TABLE);
    if (s != NULL) {
        recipe_map(c, node, "a table", keys, s);
        check_source(c, node, s);
    }
}

int recipe_find_source(recipe_context *c, const tree_node *node)
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

void recipe_take_sources(recipe_context *c, const tree_node *root)
{
    static const struct {
        const char *key;
        void (*take)(recipe_context *c, const tree_node *node);
    } lists[] = {{"runs", take_run}, {"data", take_data}, {"tables", take_table}};

    // in this order, whatever the recipe's
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        const tree_node *node = recipe_child(root, lists[i].key);
        if (node != NULL) {
            recipe_list(c, node, lists[i].key, lists[i].take);
        }
    }
}
