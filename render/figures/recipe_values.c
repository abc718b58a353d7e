// Values, maps and lists of a recipe, with faults that name their place.
#include <string.h>

#include "render/figures/recipe_parts.h"
#include "src/base/words.h"

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

bool recipe_is_pair(const tree_node *node)
{
    return node->kind == TREE_LIST && node->first != NULL && node->first->next != NULL &&
           node->first->next->next == NULL;
}

// Reads a list of two numbers; reports any other node.
static void read_pair(recipe_context *c, const tree_node *node, const char *what,
                      double *a, double *b)
{
    if (!recipe_is_pair(node)) {
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

// Reads a number with its unit; reports one outside the range of its key.
static void read_quantity_field(recipe_context *c, const tree_node *node,
                                const recipe_key *key, double *value)
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

// Reads an item of a list into the next place of an array of `count` items.
static void read_item(recipe_context *c, const tree_node *node, const recipe_form *form,
                      void *array, int *count)
{
    if (*count >= form->most) {
        report_node(&c->reader, node, "%s has more than %d %s", form->holder, form->most,
                    form->things);
        return;
    }
    void *item = (char *)array + (size_t)*count * form->size;
    *count += 1;
    if (form->blank != NULL) {
        memcpy(item, form->blank, form->size);
    }
    recipe_map(c, node, form, item);
    if (form->complete != NULL) {
        form->complete(c, node, item);
    }
}

// Reads "true" or "false"; reports any other word and takes it for false.
static void read_truth(recipe_context *c, const tree_node *node, const char *what,
                       bool *value)
{
    const char *word = node_is_scalar(node) ? node->text : "";
    *value = strcmp(word, "true") == 0;
    if (!*value && strcmp(word, "false") != 0) {
        report_node(&c->reader, node, "%s is not true or false", what);
    }
}

// Reads the value under a key into its field of the object.
static void read_field(recipe_context *c, const tree_node *node, const recipe_key *key,
                       void *into)
{
    void *field = (char *)into + key->offset;
    void *second = (char *)into + key->second;
    const tree_node *item = NULL;

    switch (key->kind) {
    case VALUE_OWN:
        key->read(c, node, into);
        break;
    case VALUE_ITEMS:
        for (item = recipe_first(c, node, key->key); item != NULL; item = item->next) {
            read_item(c, item, key->form, field, second);
        }
        break;
    case VALUE_MAP:
        recipe_map(c, node, key->form, into);
        break;
    case VALUE_TEXT:
        *(const char **)field = recipe_text(c, node, key->key);
        break;
    case VALUE_TRUTH:
        read_truth(c, node, key->key, field);
        break;
    case VALUE_NUMBER:
        read_quantity_field(c, node, key, field);
        break;
    case VALUE_PAIR:
        read_pair(c, node, key->key, field, second);
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

// Key by key in the order of the form, so that what others name comes first.
void recipe_map(recipe_context *c, const tree_node *map, const recipe_form *form,
                void *into)
{
    const recipe_key *keys = form->keys;
    if (!reader_expect_map(&c->reader, map, form->what, form->example)) {
        return;
    }

    // keys that the form does not have are reported
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(&c->reader, map, child);
        if (key != NULL) {
            check_key(c, child->key, form, key);
        }
    }

    // the others are read in the form's order, not in the recipe's
    for (int i = 0; keys[i].key != NULL; i++) {
        const tree_node *child = recipe_child(map, keys[i].key);
        if (child != NULL) {
            read_field(c, child, &keys[i], into);
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
