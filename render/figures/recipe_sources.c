// Reading of recipes, its lower half: values, maps and lists, and where the curves come from.
#include <stddef.h>
#include <string.h>

#include "render/figures/recipe_parts.h"
#include "src/base/words.h"

// ==== values, with faults that name their place

const char *recipe_keep(recipe_context *c, char *text)
{
    g_ptr_array_add(c->recipe->owned, text);
    return text;
}

const char *recipe_text(recipe_context *c, const tree_node *node, const char *what)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(&c->reader, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }
    return recipe_keep(c, g_strdup(node->text));
}

void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value)
{
    reader_quantity(&c->reader, node, what, "", value);
}

static void read_pair(recipe_context *c, const tree_node *node, const char *what, double *a,
                      double *b)
{
    bool pair = node->kind == TREE_LIST && node->first != NULL && node->first->next != NULL &&
                node->first->next->next == NULL;
    if (!pair) {
        report_node(&c->reader, node, "%s is %s, expected two numbers such as [0, 1]", what,
                    node_kind_name(node));
        return;
    }
    recipe_number(c, node->first, what, a);
    recipe_number(c, node->first->next, what, b);
}

static const tree_node *first_item(recipe_context *c, const tree_node *list, const char *what)
{
    if (list->kind != TREE_LIST) {
        report_node(&c->reader, list, "%s is %s, expected a list", what, node_kind_name(list));
        return NULL;
    }
    return list->first;
}

// Takes the value under a key that was found.
static void take_value(recipe_context *c, const tree_node *node, const recipe_key *key, void *into)
{
    void *field = (char *)into + key->offset;
    switch (key->kind) {
    case VALUE_OWN:
        key->take(c, node, into);
        break;
    case VALUE_LIST:
        for (const tree_node *i = first_item(c, node, key->key); i != NULL; i = i->next) {
            key->take(c, i, into);
        }
        break;
    case VALUE_TEXT:
        *(const char **)field = recipe_text(c, node, key->key);
        break;
    case VALUE_TRUTH:
        *(bool *)field = node_is_scalar(node) && strcmp(node->text, "true") == 0;
        if (!*(bool *)field && !(node_is_scalar(node) && strcmp(node->text, "false") == 0)) {
            report_node(&c->reader, node, "%s is not true or false", key->key);
        }
        break;
    case VALUE_NUMBER:
        recipe_number(c, node, key->key, field);
        break;
    case VALUE_PAIR:
        read_pair(c, node, key->key, field, (double *)((char *)into + key->second));
        break;
    case VALUE_TAKEN:
        break;
    }
}

void recipe_map(recipe_context *c, const tree_node *map, const recipe_form *form, void *into)
{
    const recipe_key *keys = form->keys;
    if (!reader_expect_map(&c->reader, map, form->what, form->example)) {
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
                        key, form->what, near.best != NULL ? near.best : keys[0].key);
        }
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

TAKE(take_shift, source)
{
    reader_quantity(&c->reader, node, "shift", "s", &((recipe_source *)into)->shift);
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
            s->change[s->change_count++] = recipe_keep(c, text_printf("%s=%s", path, child->text));
        }
    }
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
        s->label = recipe_keep(c, g_string_free(label, FALSE));
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

#define SOURCE_TEXT(name, field) FIELD_KEY(name, VALUE_TEXT, recipe_source, field)

// The list of each kind of source, and one of them.
static const struct {
    const char *key;
    recipe_form form;
} lists[] = {
    [SOURCE_RUN] = {"runs",
                    {"a run",
                     "scenario: thesis/fig-3-4",
                     {SOURCE_TEXT("scenario", scenario), SOURCE_TEXT("name", name),
                      SOURCE_TEXT("label", label), OWN_KEY("set", take_set)}}},
    [SOURCE_DATA] = {"data",
                     {"data",
                      "file: bench.csv",
                      {SOURCE_TEXT("file", file), SOURCE_TEXT("name", name),
                       SOURCE_TEXT("label", label), SOURCE_TEXT("column", column),
                       OWN_KEY("shift", take_shift)}}},
    [SOURCE_TABLE] = {"tables",
                      {"a table",
                       "file: sweep.sqlite",
                       {SOURCE_TEXT("file", file), SOURCE_TEXT("name", name),
                        SOURCE_TEXT("label", label), SOURCE_TEXT("x", x), SOURCE_TEXT("y", y),
                        SOURCE_TEXT("z", z)}}},
};

// A source, checked as a whole, as what is missing shows only at its end.
static void take_source(recipe_context *c, const tree_node *node, source_kind kind)
{
    recipe *r = c->recipe;
    const recipe_room room = {"a recipe", "runs, data and tables", RECIPE_SOURCES};
    int index = recipe_add(c, node, &r->source_count, room);
    if (index >= 0) {
        recipe_source *s = &r->sources[index];
        *s = (recipe_source){.kind = kind, .at = {node->line, node->column}};
        recipe_map(c, node, &lists[kind].form, s);
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
    // in this order, whatever the recipe's
    for (size_t kind = 0; kind < G_N_ELEMENTS(lists); kind++) {
        const tree_node *list = recipe_child(root, lists[kind].key);
        const tree_node *item = list != NULL ? first_item(c, list, lists[kind].key) : NULL;
        for (; item != NULL; item = item->next) {
            take_source(c, item, (source_kind)kind);
        }
    }
}
