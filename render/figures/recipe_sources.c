// Where a recipe's curves come from: runs, measured data, tables.
#include "render/figures/recipe_parts.h"

#include <stddef.h>
#include <string.h>

#include "src/base/words.h"

#define SOURCE                   ((recipe_source *)into)

#define SOURCE_TEXT(name, field) FIELD_KEY(name, VALUE_TEXT, recipe_source, field)

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

// Adds a source; NULL if there is no room.
static recipe_source *new_source(recipe_context *c, const tree_node *node, source_kind kind)
{
    recipe *r = c->recipe;
    const recipe_room room = {"a recipe", "runs, data and tables", RECIPE_SOURCES};
    int index = recipe_add(c, node, &r->source_count, room);
    if (index < 0) {
        return NULL;
    }
    recipe_source *s = &r->sources[index];
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

    // a run is more than its scenario's name
    if (s->label == NULL && s->name == NULL && s->change_count > 0 && needed != NULL) {
        GString *label = g_string_new(needed);
        for (int i = 0; i < s->change_count; i++) {
            g_string_append_printf(label, "%s%s", i == 0 ? ", with " : ", ", s->change[i]);
        }
        g_ptr_array_add(c->recipe->owned, label->str);
        s->label = g_string_free(label, FALSE);
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

// A source of a kind, with its keys; checked as a whole, as what is missing shows only at its end.
static void take_source(recipe_context *c, const tree_node *node, source_kind kind,
                        const recipe_key *keys)
{
    static const char *const names[] = {
        [SOURCE_RUN] = "a run", [SOURCE_DATA] = "data", [SOURCE_TABLE] = "a table"};
    recipe_source *s = new_source(c, node, kind);
    if (s != NULL) {
        recipe_map(c, node, names[kind], keys, s);
        check_source(c, node, s);
    }
}

TAKE(take_run, recipe)
{
    (void)into;
    static const recipe_key keys[] = {{.key = "scenario",
                                       .kind = VALUE_TEXT,
                                       .offset = offsetof(recipe_source, scenario),
                                       .example = "scenario: thesis/fig-3-4"},
                                      SOURCE_TEXT("name", name),
                                      SOURCE_TEXT("label", label),
                                      OWN_KEY("set", take_set, NULL),
                                      {0}};
    take_source(c, node, SOURCE_RUN, keys);
}

TAKE(take_data, recipe)
{
    (void)into;
    static const recipe_key keys[] = {{.key = "file",
                                       .kind = VALUE_TEXT,
                                       .offset = offsetof(recipe_source, file),
                                       .example = "file: bench.csv"},
                                      SOURCE_TEXT("name", name),
                                      SOURCE_TEXT("label", label),
                                      SOURCE_TEXT("column", column),
                                      OWN_KEY("shift", take_shift, NULL),
                                      {0}};
    take_source(c, node, SOURCE_DATA, keys);
}

TAKE(take_table, recipe)
{
    (void)into;
    static const recipe_key keys[] = {{.key = "file",
                                       .kind = VALUE_TEXT,
                                       .offset = offsetof(recipe_source, file),
                                       .example = "file: sweep.sqlite"},
                                      SOURCE_TEXT("name", name),
                                      SOURCE_TEXT("label", label),
                                      SOURCE_TEXT("x", x),
                                      SOURCE_TEXT("y", y),
                                      SOURCE_TEXT("z", z),
                                      {0}};
    take_source(c, node, SOURCE_TABLE, keys);
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
        recipe_taker *take;
    } lists[] = {{"runs", take_run}, {"data", take_data}, {"tables", take_table}};

    // in this order, whatever the recipe's
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        const tree_node *node = recipe_child(root, lists[i].key);
        if (node != NULL) {
            recipe_list(c, node, lists[i].key, lists[i].take, c->recipe);
        }
    }
}
