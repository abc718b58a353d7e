// Reading of recipes, its lower half: values, maps and lists, and where the curves come
// from.
#include <stddef.h>
#include <string.h>

#include "render/figures/recipe_parts.h"
#include "src/base/words.h"

// ==== values, with faults that name their place

const char *recipe_keep(recipe_context *c, char *text)
{
    return owned_figure_keep(c->recipe->plot, text);
}

const char *recipe_text(recipe_context *c, const tree_node *node, const char *what)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(&c->reader, node, "%s is %s, expected text", what,
                    node_kind_name(node));
        return NULL;
    }
    return recipe_keep(c, g_strdup(node->text));
}

static void read_pair(recipe_context *c, const tree_node *node, const char *what,
                      double *a, double *b)
{
    bool pair = node->kind == TREE_LIST && node->first != NULL &&
                node->first->next != NULL && node->first->next->next == NULL;
    if (!pair) {
        report_node(&c->reader, node, "%s is %s, expected two numbers such as [0, 1]",
                    what, node_kind_name(node));
        return;
    }
    reader_quantity(&c->reader, node->first, what, "", a);
    reader_quantity(&c->reader, node->first->next, what, "", b);
}

const tree_node *recipe_first(recipe_context *c, const tree_node *list, const char *what)
{
    if (list->kind != TREE_LIST) {
        report_node(&c->reader, list, "%s is %s, expected a list", what,
                    node_kind_name(list));
        return NULL;
    }
    return list->first;
}

static void read_number(recipe_context *c, const tree_node *node, const recipe_key *key,
                        double *value)
{
    if (!reader_quantity(&c->reader, node, key->key, text_or(key->unit, ""), value) ||
        key->expected == NULL) {
        return;
    }

    // within its range, and without decimals where it counts something
    const bool within = *value >= key->low && *value <= key->high;
    if (!within || (key->whole && *value != (int)*value)) {
        report_node(&c->reader, node, "%s is %g, expected %s", key->key, *value,
                    key->expected);
    }
}

// Reads an item of a list into the next place of its array.
static void take_item(recipe_context *c, const tree_node *node, const recipe_key *key,
                      void *into)
{
    const recipe_form *form = key->form;
    int *count = (int *)(void *)((char *)into + key->second);
    if (*count >= form->most) {
        report_node(&c->reader, node, "%s has more than %d %s", form->holder, form->most,
                    form->things);
        return;
    }
    void *item = (char *)into + key->offset + (size_t)(*count)++ * form->size;
    if (form->blank != NULL) {
        memcpy(item, form->blank, form->size);
    }
    recipe_map(c, node, form, item);
    if (form->end != NULL) {
        form->end(c, node, item);
    }
}

// Takes the value under a key.
static void take_value(recipe_context *c, const tree_node *node, const recipe_key *key,
                       void *into)
{
    void *field = (char *)into + key->offset;
    switch (key->kind) {
    case VALUE_OWN:
        key->take(c, node, into);
        break;
    case VALUE_ITEMS:
        for (const tree_node *i = recipe_first(c, node, key->key); i != NULL;
             i = i->next) {
            take_item(c, i, key, into);
        }
        break;
    case VALUE_MAP:
        recipe_map(c, node, key->form, into);
        break;
    case VALUE_TEXT:
        *(const char **)field = recipe_text(c, node, key->key);
        break;
    case VALUE_TRUTH:
        *(bool *)field = node_is_scalar(node) && strcmp(node->text, "true") == 0;
        if (!*(bool *)field &&
            !(node_is_scalar(node) && strcmp(node->text, "false") == 0)) {
            report_node(&c->reader, node, "%s is not true or false", key->key);
        }
        break;
    case VALUE_NUMBER:
        read_number(c, node, key, field);
        break;
    case VALUE_PAIR:
        read_pair(c, node, key->key, field,
                  (double *)(void *)((char *)into + key->second));
        break;
    }
}

// Reports a key that the form does not have, with the most similar one.
static void check_key(recipe_context *c, const tree_node *node, const recipe_form *form,
                      const char *key)
{
    nearest_word near = nearest_begin(key);
    for (int i = 0; form->keys[i].key != NULL; i++) {
        nearest_try(&near, form->keys[i].key);
        if (strcmp(form->keys[i].key, key) == 0) {
            return;
        }
    }
    report_node(&c->reader, node, "unknown key '%.60s' in %s, did you mean '%s'?", key,
                form->what, text_or(near.best, form->keys[0].key));
}

void recipe_map(recipe_context *c, const tree_node *map, const recipe_form *form,
                void *into)
{
    const recipe_key *keys = form->keys;
    if (!reader_expect_map(&c->reader, map, form->what, form->example)) {
        return;
    }

    // what is not known
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(&c->reader, map, child);
        if (key != NULL) {
            check_key(c, child->key, form, key);
        }
    }

    // the rest in the form's order, whatever the recipe's
    for (int i = 0; keys[i].key != NULL; i++) {
        const tree_node *child = recipe_child(map, keys[i].key);
        if (child != NULL) {
            take_value(c, child, &keys[i], into);
        }
    }
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

bool recipe_knows_parameter(recipe_context *c, const tree_node *node, const char *path)
{
    if (parameter_find(path) >= 0) {
        return true;
    }
    nearest_word near = nearest_begin(path);
    for (int i = 0; i < parameter_count; i++) {
        nearest_try(&near, parameter_table[i].path);
    }
    report_node(&c->reader, node, "there is no parameter '%.60s', did you mean '%s'?",
                path, text_or(near.best, "motor.voltage"));
    return false;
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
            report_node(&c->reader, child->key, "a run has more than %d changes",
                        RECIPE_CHANGES);
        } else if (!node_is_scalar(child)) {
            report_node(&c->reader, child, "%s is %s, expected a value", path,
                        node_kind_name(child));
        } else {
            s->change[s->change_count++] =
                recipe_keep(c, text_printf("%s=%s", path, child->text));
        }
    }
}

// What every source has, and what each kind needs: what is missing shows only at its end.
TAKE(end_source, source)
{
    recipe_source *s = into;
    s->at = (place){node->line, node->column};
    const char *needed = s->file, *key = "file";
    if (s->kind == SOURCE_RUN) {
        needed = s->scenario;
        key = "scenario";
    }
    if (needed == NULL) {
        report_node(&c->reader, node, "there is no '%s' here", key);
    }
    if (s->kind == SOURCE_TABLE && (s->x == NULL || s->y == NULL)) {
        report_node(&c->reader, node,
                    "a table needs 'x' and 'y', the names of its columns");
    }

    // a run is more than its scenario's name
    if (s->label == NULL && s->name == NULL && s->change_count > 0 && needed != NULL) {
        GString *label = g_string_new(needed);
        const char *before = ", with ";
        for (int i = 0; i < s->change_count; i++) {
            text_append(label, "%s%s", before, s->change[i]);
            before = ", ";
        }
        s->label = recipe_keep(c, g_string_free(label, FALSE));
    }

    // a name that only it has
    if (s->name == NULL) {
        s->name = text_or(needed, "");
    }
    for (const recipe_source *other = c->recipe->sources; other != s; other++) {
        if (strcmp(other->name, s->name) == 0) {
            report_node(&c->reader, node,
                        "the name '%s' is there twice (first at line %d)", s->name,
                        other->at.line);
        }
    }
}

#define SOURCE_TEXT(name) FIELD_KEY(#name, VALUE_TEXT, recipe_source, name)
#define SOURCE_ROOM                                                                      \
    "a recipe", "runs, data and tables", sizeof(recipe_source), RECIPE_SOURCES

const recipe_form recipe_runs = {"a run",
                                 "scenario: thesis/fig-3-4",
                                 {SOURCE_TEXT(scenario), SOURCE_TEXT(name),
                                  SOURCE_TEXT(label), OWN_KEY("set", take_set)},
                                 SOURCE_ROOM,
                                 end_source,
                                 &(const recipe_source){SOURCE_RUN}};
const recipe_form recipe_data = {"data",
                                 "file: bench.csv",
                                 {SOURCE_TEXT(file),
                                  SOURCE_TEXT(name),
                                  SOURCE_TEXT(label),
                                  SOURCE_TEXT(column),
                                  {"shift", VALUE_NUMBER, offsetof(recipe_source, shift),
                                   .unit = "s"}},
                                 SOURCE_ROOM,
                                 end_source,
                                 &(const recipe_source){SOURCE_DATA}};
const recipe_form recipe_tables = {"a table",
                                   "file: sweep.sqlite",
                                   {SOURCE_TEXT(file), SOURCE_TEXT(name),
                                    SOURCE_TEXT(label), SOURCE_TEXT(x), SOURCE_TEXT(y),
                                    SOURCE_TEXT(z)},
                                   SOURCE_ROOM,
                                   end_source,
                                   &(const recipe_source){SOURCE_TABLE}};

int recipe_find_source(recipe_context *c, const tree_node *node)
{
    if (!node_is_scalar(node)) {
        report_node(&c->reader, node, "no run, data or table is named ''");
        return -1;
    }
    nearest_word near = nearest_begin(node->text);
    for (int i = 0; i < c->recipe->source_count; i++) {
        nearest_try(&near, c->recipe->sources[i].name);
        if (strcmp(c->recipe->sources[i].name, node->text) == 0) {
            return i;
        }
    }

    // with the most similar one, where there is one
    if (near.best == NULL) {
        report_node(&c->reader, node, "no run, data or table is named '%.60s'",
                    node->text);
    } else {
        report_node(&c->reader, node,
                    "no run, data or table is named '%.60s', did you mean '%s'?",
                    node->text, near.best);
    }
    return -1;
}
