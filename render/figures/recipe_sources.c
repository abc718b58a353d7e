// Reading of recipes, its lower half: values, maps and lists, and where the curves come from.
#include <stddef.h>
#include <string.h>

#include "render/figures/recipe_parts.h"
#include "render/page/text.h"
#include "src/base/words.h"

// ==== values, with faults that name their place

const char *recipe_text(recipe_context *c, const tree_node *node, const char *what)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(&c->reader, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }
    char *copy = g_strdup(node->text);
    g_ptr_array_add(c->recipe->owned, copy);
    return copy;
}

static bool read_truth(recipe_context *c, const tree_node *node, const char *what)
{
    bool yes = node_is_scalar(node) && strcmp(node->text, "true") == 0;
    if (!yes && !(node_is_scalar(node) && strcmp(node->text, "false") == 0)) {
        report_node(&c->reader, node, "%s is not true or false", what);
    }
    return yes;
}

void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value)
{
    reader_quantity(&c->reader, node, what, "", value);
}

static bool read_pair(recipe_context *c, const tree_node *node, const char *what, double *a,
                      double *b)
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

// Takes the value under a key that was found.
static void take_value(recipe_context *c, const tree_node *node, const recipe_key *key, void *into)
{
    void *field = (char *)into + key->offset, *second = (char *)into + key->second;
    switch (key->kind) {
    case VALUE_OWN:
        key->take(c, node, into);
        break;
    case VALUE_TEXT:
        *(const char **)field = recipe_text(c, node, key->key);
        break;
    case VALUE_TRUTH:
        *(bool *)field = read_truth(c, node, key->key);
        break;
    case VALUE_NUMBER:
        recipe_number(c, node, key->key, field);
        break;
    case VALUE_PAIR:
        read_pair(c, node, key->key, field, second);
        break;
    case VALUE_TAKEN:
        break;
    }
}

void recipe_map(recipe_context *c, const tree_node *map, const char *what, const recipe_key *keys,
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
            take_value(c, child, found, into);
        } else if (key != NULL) {
            report_node(&c->reader, child->key, "unknown key '%.60s' in %s, did you mean '%s'?",
                        key, what, near.best != NULL ? near.best : keys[0].key);
        }
    }
}

void recipe_list(recipe_context *c, const tree_node *list, const char *what, recipe_taker *take,
                 void *into)
{
    if (list->kind != TREE_LIST) {
        report_node(&c->reader, list, "%s is %s, expected a list", what, node_kind_name(list));
        return;
    }
    for (const tree_node *item = list->first; item != NULL; item = item->next) {
        take(c, item, into);
    }
}

int recipe_add(recipe_context *c, const tree_node *node, int *count, recipe_room room)
{
    if (*count >= room.most) {
        report_node(&c->reader, node, "%s has more than %d %s", room.holder, room.most,
                    room.things);
        return -1;
    }
    return (*count)++;
}

const tree_node *recipe_child(const tree_node *map, const char *key)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        if (node_is_scalar(child->key) && strcmp(child->key->text, key) == 0) {
            return child;
        }
    }
    return NULL;
}

// ==== sources: runs, measured data, tables

#define SOURCE                   ((recipe_source *)into)

#define SOURCE_TEXT(name, field) FIELD_KEY(name, VALUE_TEXT, recipe_source, field)

TAKE(take_shift, source)
{
    reader_quantity(&c->reader, node, "shift", "s", &SOURCE->shift);
}

bool recipe_knows_parameter(recipe_context *c, const tree_node *node, const char *path)
{
    bool known = parameter_find(path) >= 0;
    nearest_word near = nearest_begin(path);
    for (int i = 0; i < parameter_count && !known; i++) {
        nearest_try(&near, parameter_table[i].path);
    }
    if (!known) {
        report_node(&c->reader, node, "there is no parameter '%.60s', did you mean '%s'?", path,
                    near.best != NULL ? near.best : "motor.voltage");
    }
    return known;
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
        if (!recipe_knows_parameter(c, child->key, path)) {
            continue;
        }
        if (s->change_count == RECIPE_CHANGES) {
            report_node(&c->reader, child->key, "a run has more than %d changes", RECIPE_CHANGES);
        } else if (!node_is_scalar(child)) {
            report_node(&c->reader, child, "%s is %s, expected a value", path,
                        node_kind_name(child));
        } else {
            char *change = text_printf("%s=%s", path, child->text);
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
            text_append(label, "%s%s", i == 0 ? ", with " : ", ", s->change[i]);
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
